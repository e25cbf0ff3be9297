#!/bin/sh
# Compares conversions with the engines themselves: three.js and Babylon.js from npm, and Filament's cmgen where it is installed (Debian:
# libfilament-tools). Usage: peers.sh [WORK-DIRECTORY]. Exit status 0: all agree; 1: one does not; 77: nothing to compare with.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=${1:-$(mktemp -d)}
mkdir -p "$work"
cc=${CC:-cc}
compared=0

"$cc" -std=c99 -O2 -I "$here/../include" "$here/peers/peers.c" -o "$work/peers" -lm

if command -v npm >/dev/null && command -v node >/dev/null; then
    [ -d "$work/node_modules/three" ] || npm install --silent --no-audit --no-fund --prefix "$work" three @babylonjs/core
    "$work/peers" >"$work/ours.json"
    node "$here/peers/peers.mjs" "$work/ours.json" "$work"
    compared=1
else
    echo "skipped: three.js and Babylon.js, no npm"
fi

if command -v cmgen >/dev/null; then
    "$work/peers" "$work/panorama.hdr" >"$work/ours.txt"
    cmgen --quiet --sh=3 --sh-window=no --sh-irradiance --sh-shader --sh-output="$work/cmgen.txt" "$work/panorama.hdr"
    # Lines are ( r, g, b); // L00, irradiance, pre-scaled base
    sed 's/[(),;]/ /g; s|//.*||' "$work/cmgen.txt" | paste - "$work/ours.txt" | awk '
        function check(a, b, d) { d = a - b; if (d < 0) d = -d; if (d > worst) worst = d }
        NF == 6 { check($1, $4); check($2, $5); check($3, $6); n++; if (n == 1) scale = $5 }
        END { print (n == 9 && worst <= 0.01 * scale ? "ok    " : "FAILED") " Filament cmgen: " worst / scale " of 0.01"
              exit !(n == 9 && worst <= 0.01 * scale) }'
    compared=1
else
    echo "skipped: Filament, no cmgen"
fi
[ $compared -eq 1 ] || exit 77
