#!/bin/sh
# Looks at generated code: a literal order leaves no trace of the bands above it.
#   check.sh [CC]    x86-64, gcc or clang; elsewhere it says that it skipped
set -u
cc=${1:-${CC:-cc}}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

if ! $cc -dM -E -x c /dev/null 2>/dev/null | grep -q __x86_64__; then
    echo "skipped: $cc does not say that it compiles for x86-64"
    exit 0
fi

# check DESCRIPTION LEFT OPERATOR RIGHT, two integers
check() {
    if test "$2" "$3" "$4"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $1: $2 $3 $4"
    fi
}

# assemble SOURCE ORDER LEVEL OUTPUT
assemble() {
    $cc -std=c99 "$3" -DORDER="$2" -I"$here/../../include" -S "$here/$1" -o "$4" || exit 1
}

# measure FILE FUNCTION: prints instructions, jumps and calls, multiplications, and the largest offset from a pointer.
# Offsets from the stack and the instruction pointer are not from arguments, and 72 is the weight of an sh_accum. FUNCTION `*` is the
# whole file.
measure() {
    awk -v function_name="$2" '
        /^[A-Za-z_.]/ {
            label = $1
            sub(/:.*/, "", label)
            if (label !~ /^[.]/ && label !~ /^L/)
                inside = function_name == "*" || label == function_name || label == "_" function_name
        }
        inside && /^[ \t]+[a-z]/ {
            instructions++
            if ($1 ~ /^(j|call)/)
                branches++
            if ($1 ~ /mul|fmadd|fmsub|fnmadd|fnmsub/)
                multiplications++
            rest = $0
            while (match(rest, /(0x)?[0-9a-f]*\(%[a-z0-9]+/)) {
                operand = substr(rest, RSTART, RLENGTH)
                rest = substr(rest, RSTART + RLENGTH)
                offset = operand
                sub(/\(.*/, "", offset)
                if (operand !~ /%(rsp|rip)/ && offset != 72 && offset + 0 > largest)
                    largest = offset + 0
            }
        }
        END { print instructions + 0, branches + 0, multiplications + 0, largest + 0 }' "$1"
}

# single LEVEL FUNCTION BYTES STRAIGHT BANDS: checks one function of single.c at one level of optimisation.
#   BYTES     of a coefficient
#   STRAIGHT  1: no jumps or calls
#   BANDS     the highest band that the function has a use for
single() {
    before=0
    for order in 0 1 2; do
        set -- "$1" "$2" "$3" "$4" "$5" $(measure "$work/single.$order.s" "$2")
        name="$2, order $order, $1"
        check "$name: instructions" "$6" -gt 0
        if [ "$order" -le "$5" ]; then
            check "$name: more instructions than the order below" "$6" -gt "$before"
        else
            check "$name: as many instructions as the order below" "$6" -eq "$before"
        fi
        before=$6
        [ "$4" -eq 0 ] || check "$name: jumps and calls" "$7" -eq 0
        # The highest order has no bands above it; its vector kernels address tables of their own.
        [ "$order" -eq 2 ] || check "$name: offset beyond the coefficients" "$9" -lt $(($3 * (order + 1) * (order + 1)))
    done
}

for level in -O1 -O2; do
    for order in 0 1 2; do
        assemble single.c $order $level "$work/single.$order.s"
    done
    single $level radiance 4 1 2
    single $level irradiance 4 1 2
    single $level irradiance_opposite 4 1 1
    single $level irradiance_ao 4 0 2
    single $level dot 4 1 2
    single $level basis 4 1 2
    single $level add_sample 4 0 2
    single $level accum_sample 8 1 2

    # The measure sees what it looks for: L2 does multiply and does read its last coefficient, L0 is a load.
    set -- $(measure "$work/single.2.s" irradiance)
    check "irradiance, order 2, $level: multiplications" "$3" -ge 8
    check "irradiance, order 2, $level: the last coefficient's offset" "$4" -eq 32
    set -- $(measure "$work/single.1.s" irradiance)
    check "irradiance, order 1, $level: multiplications" "$3" -le 4
    set -- $(measure "$work/single.0.s" irradiance)
    check "irradiance, order 0, $level: multiplications" "$3" -eq 0
    check "irradiance, order 0, $level: instructions" "$1" -le 3

done

before=0
for order in 0 1 2; do
    assemble many.c $order -O1 "$work/many.s"
    set -- $(measure "$work/many.s" '*')
    check "many.c, order $order: more instructions than the order below" "$1" -gt "$before"
    before=$1
done
assemble many.c order -O1 "$work/many.s"
set -- $(measure "$work/many.s" '*')
check "many.c, any order: half again as many instructions as order 2" $((2 * $1)) -gt $((3 * before))

echo "$passed passed, $failed failed"
[ "$passed" -gt 0 ] && [ "$failed" -eq 0 ]
