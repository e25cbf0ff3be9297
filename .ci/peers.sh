#!/bin/sh
# Compares conversions with the engines themselves. Usage: peers.sh npm|cmgen WORK-DIRECTORY
#   npm    three.js and Babylon.js, which it installs into WORK-DIRECTORY: without a network, it fails
#   cmgen  Filament's tool (Debian: libfilament-tools)
# Exit status 0 if they agree.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
engines=$1
work=$2
mkdir -p "$work"
"${CC:-cc}" -std=c99 -O2 -I "$here/../include" "$here/peers/peers.c" -o "$work/peers" -lm

case $engines in
npm)
    npm install --silent --no-audit --no-fund --prefix "$work" three@0.187.0 @babylonjs/core@9.35.0
    "$work/peers" >"$work/ours.json"
    node "$here/peers/peers.mjs" "$work/ours.json" "$work"
    ;;
cmgen)
    "$work/peers" "$work/panorama.hdr" >"$work/ours.txt"
    cmgen --quiet --sh=3 --sh-window=no --sh-irradiance --sh-shader --sh-output="$work/cmgen.txt" "$work/panorama.hdr"
    # Lines are ( r, g, b); // L00, irradiance, pre-scaled base
    sed 's/[(),;]/ /g; s|//.*||' "$work/cmgen.txt" | paste - "$work/ours.txt" | awk '
        function check(a, b, d) { d = a - b; if (d < 0) d = -d; if (!(d <= worst)) worst = d }
        NF == 6 { check($1, $4); check($2, $5); check($3, $6); n++; if (n == 1) scale = $5 }
        END { passed = n == 9 && scale > 0 && worst <= 0.002 * scale
              print (passed ? "ok    " : "FAILED") " Filament cmgen: " worst / (scale ? scale : 1) " of 0.002"
              exit !passed }'
    ;;
esac
