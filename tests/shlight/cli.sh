#!/bin/sh
# cli.sh SHLIGHT: tests the program shlight from outside. Every format it reads must give the same coefficients; every bad file or
# argument must give one line on stderr, exit status 2, and leave the output alone.
set -u

shlight=$1
case $shlight in /*) ;; *) shlight=$PWD/$shlight ;; esac
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/shlight.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
LC_ALL=C
export LC_ALL
passed=0
failed=0

# check NAME COMMAND...: one test.
check() {
    name=$1
    shift
    if "$@" >check.log 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $name"
        sed 's/^/    /' check.log
    fi
}

# bytes OCTAL... : writes escapes as bytes.
bytes() {
    # The escapes are the format: POSIX printf has no other way to write a zero byte.
    # shellcheck disable=SC2059
    for b in "$@"; do printf -- "$b"; done
}

encode() { # encode FILE KIND [VARIABLE=VALUE...]
    file=$1
    kind=$2
    shift 2
    for assignment in "$@"; do
        set -- "$@" -v "$assignment"
        shift
    done
    bytes "$(awk -v kind="$kind" "$@" -f "$here/encode.awk")" >"$file"
}

# run ARGUMENT...: leaves out.txt, err.txt and status.
run() {
    status=0
    "$shlight" "$@" >out.txt 2>err.txt || status=$?
}

# report ARGUMENT...: a run without a picture, where the report alone is under test.
report() {
    run --no-picture "$@"
}

coefficients() { # coefficients FILE: as printed
    report --models none "$1"
    sed -n '/^coefficients/,/^$/p' out.txt
}

row() { # row NAME: the numbers of a line of out.txt
    sed -n "s/^$1  *//p" out.txt | head -n 1
}

# ---- It works -------------------------------------------------------------------------------------------------------------------------

default_run() {
    run
    [ "$status" = 0 ] && [ -s shlight.png ] && [ ! -s err.txt ] && grep -q 'picture *shlight.png' out.txt &&
        grep -q '^L2 linear *9 ' out.txt && ! grep -qiwE '(nan|inf)' out.txt
}
check 'default run: a picture, a report, nothing on stderr' default_run

png_is_complete() {
    [ "$(od -An -tx1 -N 8 shlight.png | tr -d ' \n')" = 89504e470d0a1a0a ] &&
        [ "$(tail -c 12 shlight.png | od -An -tx1 | tr -d ' \n')" = 0000000049454e44ae426082 ]
}
check 'the picture begins and ends as a PNG' png_is_complete

png_inflates() {
    python3 - <<'END'
import struct, zlib
png = open("shlight.png", "rb").read()
at, data, size = 8, b"", None
while at < len(png):
    length, = struct.unpack(">I", png[at:at + 4])
    body = png[at + 4:at + 8 + length]
    assert zlib.crc32(body) == struct.unpack(">I", png[at + 8 + length:at + 12 + length])[0], body[:4]
    if body[:4] == b"IHDR":
        size = struct.unpack(">II", body[4:12])
    if body[:4] == b"IDAT":
        data += body[4:]
    at += 12 + length
assert len(zlib.decompress(data)) == size[1] * (3 * size[0] + 1)
END
}
if command -v python3 >/dev/null; then
    check 'the picture inflates to its size, check sums hold' png_inflates
fi

help_lists_options() {
    run --help
    [ "$status" = 0 ] && [ ! -s err.txt ] || return 1
    for option in '-o OUT.png' --order --models --bounds --no-picture --quiet --help; do
        grep -q -e "^  $option " out.txt || return 1
    done
}
check '--help lists the options' help_lists_options

encode base.pfm pfm-little
coefficients base.pfm >expected.txt
report base.pfm
cp out.txt base.txt

quiet_run() {
    run --quiet --models none -o quiet.png base.pfm
    [ "$status" = 0 ] && [ ! -s err.txt ] && [ -s quiet.png ] && grep -q 'picture *quiet.png' out.txt
}
check '--quiet: nothing on stderr, the picture where -o says' quiet_run

order_run() { # order_run N MODELS
    run --order "$1" base.pfm -o order.png
    [ "$status" = 0 ] && [ "$(sed -n '/^model/,/^$/p' out.txt | grep -c '^L')" = "$2" ] && [ "$(grep -c '^R[012]' out.txt)" = "$3" ]
}
check '--order 0: one model, one coefficient' order_run 0 1 1
check '--order 1: six models, four coefficients' order_run 1 6 4

no_picture() {
    rm -f ./*.png
    report base.pfm
    [ "$status" = 0 ] && [ ! -s err.txt ] && ! grep -q picture out.txt || return 1
    for left in ./*.png ./*.part; do
        [ -e "$left" ] && return 1
    done
    return 0
}
check '--no-picture: no file' no_picture

# The models in the order of the list, with the numbers that they have among all.
chosen_models() {
    report --models 'L2 closure,L1 ZH3' base.pfm
    sed -n '/^model/,/^$/s/^L/&/p' out.txt >actual.txt
    { grep '^L2 closure' base.txt && grep '^L1 ZH3' base.txt; } | diff - actual.txt
}
check '--models: these and no others' chosen_models
no_models() {
    report --models none base.pfm
    [ "$status" = 0 ] && ! grep -qE '^(model|L[0-2])' out.txt && grep -q '^R2 yz' out.txt
}
check '--models none' no_models

# size FILE: width and height of a PNG.
size() {
    od -An -tu1 -j 16 -N 8 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }'
}

# bounds_run ORDER: two lines of bounds at order 2, one at 1; those of L2 are narrower, and the truth is between them but for what brute
# force is uncertain by. The picture grows by a card for each.
bounds_run() {
    run --order "$1" --models none base.pfm -o plain.png
    run --order "$1" --models none --bounds base.pfm -o bounds.png
    [ "$status" = 0 ] && [ ! -s err.txt ] || return 1
    sed -n '/^proven/,/^$/s/^L//p' out.txt >bounds.txt
    [ "$(wc -l <bounds.txt)" = "$1" ] &&
        awk '$2 != ($1 + 1) ^ 2 || !($3 > 0.01 && $3 < 4) || (NR > 1 && $3 > width) || $4 > 0.001 { exit 1 } { width = $3 }' bounds.txt &&
        echo "$(size plain.png) $(size bounds.png) $1" | awk '{ exit !($1 == $3 && $4 > $2 + 250 * $5 && $4 < $2 + 400 * $5) }'
}
check '--bounds, order 1' bounds_run 1
check '--bounds, order 2' bounds_run 2

# The bounds of a single light close on it: 4 from where it shines, 0 from behind.
bounds_close() {
    { bytes 'Pf\n64 32\n-1\n' && head -c 4500 /dev/zero && bytes '\000\000\200\077' && head -c 3688 /dev/zero; } >file.pfm
    report --models none --bounds file.pfm
    awk '/^L[12] / { n++; if (!($3 < 0.02 && $4 < 0.001)) exit 1 } END { exit n != 2 }' out.txt
}
check '--bounds of a single light are narrow' bounds_close

# ---- Every format reads the same ------------------------------------------------------------------------------------------------------

same_coefficients() { # same_coefficients FILE
    coefficients "$1" >actual.txt
    [ "$status" = 0 ] && [ "$(wc -l <actual.txt)" = 11 ] && diff expected.txt actual.txt
}

encode file.pfm pfm-big
check 'PFM, big-endian' same_coefficients file.pfm
for kind in flat old new; do
    encode file.hdr "$kind"
    check "Radiance, $kind" same_coefficients file.hdr
done
for order in '+Y +X' '-Y -X' '+Y -X' '+X -Y' '-X -Y' '+X +Y' '-X +Y'; do
    encode file.hdr new "first=${order% *}" "second=${order#* }"
    check "Radiance, orientation $order" same_coefficients file.hdr
done

grey_is_red() { # grey_is_red KIND
    encode file.pfm "$1"
    coefficients file.pfm | awk 'NR > 1 && NF { print $NF }' >actual.txt
    awk 'NR > 1 && NF { print $(NF - 2) }' expected.txt | diff - actual.txt
}
check 'PFM grey, little-endian' grey_is_red grey-little
check 'PFM grey, big-endian' grey_is_red grey-big

encode half.pfm pfm-little scale=0.5
coefficients half.pfm >half.txt
encode file.hdr new header=EXPOSURE=2
exposure_divides() {
    coefficients file.hdr | diff half.txt - && ! cmp -s half.txt expected.txt
}
check 'EXPOSURE is divided out, the scale of a PFM multiplied in' exposure_divides

colour_correction() {
    encode file.hdr flat 'header=COLORCORR= 1 2 4'
    before=$(sed -n 's/^R0  *//p' base.txt)
    report --models none file.hdr
    after=$(row R0)
    echo "$before / $after"
    echo "$before $after" | awk 'function near(a, b) { return a - b < 1e-7 && b - a < 1e-7 } { exit !(near($1, $4) && near($2, 2 * $5) && near($3, 4 * $6)) }'
}
check 'COLORCORR is divided out' colour_correction

# 600 texels of radiance 1: 87 + 2 * 256 repeats.
long_run() {
    bytes '#?RGBE\n\n-Y 1 +X 600\n' '\200\200\200\201' '\001\001\001\127' '\001\001\001\002' >file.hdr
    report --models none file.hdr
    [ "$status" = 0 ] && row R0 | awk '{ exit !($1 == 1 && $2 == 1 && $3 == 1) }'
}
check 'Radiance, old run longer than 255' long_run

carriage_returns() {
    bytes 'PF\r\n1 1\r\n1\r\n' '\077\200\000\000\077\200\000\000\077\200\000\000' >file.pfm
    report --models none file.pfm
    [ "$status" = 0 ] && row R0 | awk '{ exit !($1 == 1 && $2 == 1 && $3 == 1) }'
}
check 'PFM, lines ended as on Windows' carriage_returns

# ---- Light that is hard to take ---------------------------------------------------------------------------------------------------------

no_nan() {
    [ "$status" = 0 ] && ! grep -qiwE '(nan|inf)' out.txt
}

black() {
    { bytes 'PF\n8 4\n-1\n' && head -c 384 /dev/zero; } >file.pfm
    run file.pfm -o picture.png
    no_nan && grep -q '^L2 linear *9 *0.0000 *0.0000' out.txt
}
check 'black' black

# One row of NaN, infinity, -1 and 1.
hard_texels() {
    bytes 'Pf\n4 1\n1\n' '\177\300\000\000' '\177\200\000\000' '\277\200\000\000' '\077\200\000\000' >file.pfm
    run file.pfm -o picture.png
    no_nan && grep -q '4: 2 not finite (left out), 1 negative (clamped to 0)' out.txt && [ "$(row R0)" = 0.25 ]
}
check 'NaN, infinite and negative texels are counted and do no harm' hard_texels

magnitude() { # magnitude SCALE
    encode file.pfm pfm-little scale="$1"
    report file.pfm
    sed -n '/^model/,/^$/p' base.txt >expected_model.txt
    sed -n '/^model/,/^$/p' out.txt | diff expected_model.txt -
}
check 'errors do not depend on the unit: 2^-60' magnitude 8.673617379884035e-19
check 'errors do not depend on the unit: 2^50' magnitude 1125899906842624

# ---- What is bad is refused in one line -----------------------------------------------------------------------------------------------

# refused STATUS WORDS ARGUMENT...: stderr is one line with WORDS; no report; the picture stays as it was, or absent.
refused() {
    expected=$1
    words=$2
    shift 2
    rm -f ./*.png ./*.part
    run "$@"
    cat err.txt
    [ "$status" = "$expected" ] && [ ! -s out.txt ] && [ "$(wc -l <err.txt)" = 1 ] && grep -qF -e "$words" err.txt || return 1
    for left in ./*.png ./*.part; do
        [ -e "$left" ] && return 1
    done
    echo keep >shlight.png
    run "$@"
    [ "$status" = "$expected" ] && [ "$(cat shlight.png)" = keep ]
}

# bad NAME WORDS BYTES...: a file of those bytes is refused with its name.
bad() {
    name=$1
    words=$2
    shift 2
    bytes "$@" >bad.file
    check "$name" refused 2 "bad.file: $words" bad.file
}

hdr='#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n'
pixel='\200\200\200\201'
check 'missing file' refused 2 'missing.hdr: ' missing.hdr
check 'a directory' refused 2 '/: ' /
check 'unknown option' refused 2 --gamma --gamma
check 'no argument: -o' refused 2 '-o needs' -o
check 'no argument: --order' refused 2 '--order needs' --order
check 'order 3' refused 2 '--order 3' --order 3
check 'order -1' refused 2 '--order -1' --order -1
check 'no argument: --models' refused 2 '--models needs' --models
check 'a model that there is not' refused 2 'the models of order 2 are' --models 'L1 closure,L3 closure'
check 'an empty name of a model' refused 2 'the models of order 2 are' --models 'L1 closure,'
check 'a model above the order' refused 2 'the models of order 1 are' --order 1 --models 'L2 closure'
check 'bounds at order 0' refused 2 '--bounds needs order 1 or 2' --order 0 --bounds
check 'order 1x' refused 2 '--order 1x' --order 1x
check 'two panoramas' refused 2 'one panorama' a.hdr b.hdr
check 'a picture that is no PNG' refused 2 'picture.jpg' -o picture.jpg
bad 'empty' 'empty' ''
bad 'text' 'neither' 'Hello, world\n'
bad 'another picture format' 'neither' '\211PNG\r\n\032\n\000\000\000\015IHDR'
bad 'almost PFM' 'neither' 'PG\n1 1\n1\n'
bad 'PFM: nothing but the magic' 'the PFM header has no width and height' 'PF\n'
bad 'PFM: width is text' 'the PFM header has no width and height' 'PF\nwide 1\n1\n'
bad 'PFM: negative height' 'the PFM header has no width and height' 'PF\n1 -1\n1\n'
bad 'PFM: no scale' 'the PFM header has no scale' 'PF\n1 1\n'
bad 'PFM: scale 0' 'the scale' 'PF\n1 1\n0\n' '\000\000\000\000\000\000\000\000\000\000\000\000'
bad 'PFM: scale NaN' 'the scale' 'PF\n1 1\nnan\n' '\000\000\000\000\000\000\000\000\000\000\000\000'
bad 'PFM: scale -inf' 'the scale' 'PF\n1 1\n-inf\n' '\000\000\000\000\000\000\000\000\000\000\000\000'
bad 'PFM: no texels' 'width or height' 'PF\n0 0\n1\n'
bad 'PFM: too wide' 'too large' 'PF\n99999999999999999999 1\n1\n'
bad 'PFM: more than 2 GiB' 'shorter' 'PF\n32768 32768\n1\n' '\000'
bad 'PFM: a byte short' 'shorter' 'Pf\n1 1\n1\n' '\077\200\000'
bad 'Radiance: header only' 'the Radiance header does not end' '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n'
bad 'Radiance: no resolution' 'no resolution line' "$hdr"
bad 'Radiance: resolution is text' 'its resolution line' "$hdr" 'large\n' "$pixel"
bad 'Radiance: axis twice' 'its resolution line' "$hdr" '-Y 1 +Y 1\n' "$pixel"
bad 'Radiance: negative size' 'its resolution line' "$hdr" '-Y -1 +X 1\n' "$pixel"
bad 'Radiance: no texels' 'width or height' "$hdr" '-Y 0 +X 1\n' "$pixel"
bad 'Radiance: too high' 'too large' "$hdr" '-Y 32769 +X 1\n' "$pixel"
bad 'Radiance: far too wide' 'too large' "$hdr" '-Y 1 +X 4294967297\n' "$pixel"
bad 'Radiance: more scanlines than bytes' 'shorter' "$hdr" '-Y 32768 +X 32768\n' "$pixel"
bad 'Radiance: flat, a byte short' 'shorter' "$hdr" '-Y 1 +X 2\n' "$pixel" '\200\200\200'
bad 'Radiance: old run before any pixel' 'a run in its run-length coding has no pixel' "$hdr" '-Y 1 +X 2\n' '\001\001\001\002'
bad 'Radiance: old run over the end' 'a run in its run-length coding overruns' "$hdr" '-Y 1 +X 2\n' "$pixel" '\001\001\001\002'
bad 'Radiance: old runs without end' 'a run in its run-length coding overruns' "$hdr" '-Y 1 +X 2\n' "$pixel" \
    '\001\001\001\000\001\001\001\000\001\001\001\000\001\001\001\000\001\001\001\000\001\001\001\000'
bad 'Radiance: new run over the end' 'a run in its run-length coding overruns' "$hdr" '-Y 1 +X 8\n' '\002\002\000\010' '\211\200'
bad 'Radiance: new literal over the end' 'a run in its run-length coding overruns' "$hdr" '-Y 1 +X 8\n' '\002\002\000\010' '\011\200'
bad 'Radiance: new, empty run' 'an empty run' "$hdr" '-Y 1 +X 8\n' '\002\002\000\010' '\000\200'
bad 'Radiance: new, another length' "a scanline's length" "$hdr" '-Y 1 +X 8\n' '\002\002\000\011' '\211\200'
bad 'Radiance: new, cut short' 'shorter' "$hdr" '-Y 1 +X 8\n' '\002\002\000\010' '\210\200\210'
bad 'Radiance: new literal, cut short' 'shorter' "$hdr" '-Y 1 +X 8\n' '\002\002\000\010' '\010\200\200'
bad 'Radiance: XYZE' 'XYZE pixels' '#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n' "$pixel"
bad 'Radiance: unknown FORMAT' 'unknown FORMAT' '#?RADIANCE\nFORMAT=ascii\n\n-Y 1 +X 1\n' "$pixel"
bad 'Radiance: EXPOSURE 0' 'EXPOSURE' '#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n' "$pixel"
bad 'Radiance: EXPOSUREs out of range' 'EXPOSURE' '#?RADIANCE\nEXPOSURE=1e30\nEXPOSURE=1e30\n\n-Y 1 +X 1\n' "$pixel"
bad 'Radiance: two COLORCORR' 'COLORCORR' '#?RADIANCE\nCOLORCORR=1 2\n\n-Y 1 +X 1\n' "$pixel"

# Every cut of a good file is refused.
every_cut() {
    encode whole.hdr new
    size=$(wc -c <whole.hdr)
    cut=1
    while [ "$cut" -lt "$size" ]; do
        head -c "$cut" whole.hdr >cut.hdr
        rm -f picture.png
        run cut.hdr -o picture.png
        if [ "$status" != 2 ] || [ -s out.txt ] || [ "$(wc -l <err.txt)" != 1 ] || [ -e picture.png ]; then
            echo "cut after $cut bytes: exit status $status"
            cat err.txt
            return 1
        fi
        cut=$((cut + 37))
    done
}
check 'Radiance: cut anywhere' every_cut

# ---- A picture that cannot be written -------------------------------------------------------------------------------------------------

no_folder() {
    run --models none base.pfm -o no/such/folder.png
    [ "$status" = 1 ] && [ ! -s out.txt ] && [ "$(wc -l <err.txt)" = 1 ] && grep -q 'no/such/folder.png: ' err.txt
}
check 'no such folder: exit status 1, one line' no_folder

a_folder() {
    mkdir folder.png
    run --models none base.pfm -o folder.png
    [ "$status" = 1 ] && [ "$(wc -l <err.txt)" = 1 ] && [ -d folder.png ] && [ ! -e folder.png.part ]
}
check 'the name of a folder: exit status 1, nothing left behind' a_folder

links_and_pipes() {
    echo old >target.png
    ln -s target.png link.png
    mkfifo pipe.png
    cat pipe.png >piped.png &
    run --models none base.pfm -o link.png && run --models none base.pfm -o pipe.png
    wait
    [ "$status" = 0 ] && [ -L link.png ] && [ -p pipe.png ] && [ -s piped.png ] && cmp target.png piped.png && [ ! -e pipe.png.part ]
}
check 'a link and a pipe are written to, not replaced' links_and_pipes

full() {
    rm -f shlight.png
    echo keep >full.png
    (
        trap '' XFSZ
        ulimit -f 8
        status=0
        "$shlight" --models none base.pfm -o full.png >/dev/null 2>/dev/null || status=$?
        [ "$status" = 1 ]
    ) && [ "$(cat full.png)" = keep ] && [ ! -e full.png.part ]
}
check 'no room for the picture: the old one stays, nothing left behind' full

full_report() {
    status=0
    "$shlight" --models none base.pfm -o picture.png >/dev/full 2>err.txt || status=$?
    [ "$status" = 1 ] && [ "$(wc -l <err.txt)" = 1 ]
}
[ -e /dev/full ] && check 'no room for the report: exit status 1, one line' full_report

# ---- Real panoramas, where there are any ----------------------------------------------------------------------------------------------

real_panorama() { # real_panorama FILE: L2 is better than L1, L1 better than L0
    report "$1"
    no_nan && awk '/^L0 /{ a = $3 } /^L1 linear/{ b = $4 } /^L2 linear/{ c = $4 } END { exit !(a > b && b > c && c > 0 && c < 0.1) }' out.txt
}
envs=${SH_ENVS_DIR:-$here/../../../shared/envs}
for file in "$envs/studio.pfm" "$envs/sunset.pfm"; do
    [ -r "$file" ] && check "$(basename "$file")" real_panorama "$file"
done

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
