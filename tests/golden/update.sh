#!/bin/sh
# update.sh [CC]: writes tests/golden/unfused.h and fused.h anew, after a change of sh.h that is meant to change results: look at the
# difference before you commit it. Needs an x86-64 machine with AVX2 and FMA.
set -eu
cc=${1:-cc}
cd "$(dirname "$0")"
program=$(mktemp)
trap 'rm -f "$program"' EXIT

# generate FILE FLAG...
generate() {
    file=$1
    shift
    $cc -O2 -ffp-contract=off -I../../include "$@" generate.c -o "$program" -lm
    "$program" >"$file"
}
generate unfused.h
generate fused.h -mavx2 -mfma
