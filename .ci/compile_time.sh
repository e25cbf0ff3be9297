#!/usr/bin/env bash
# What including sh.h adds to the time of compiling an empty file, by compiler and backend, as a table:
#     .ci/compile_time.sh [RUNS [COMPILER...]]
# In milliseconds at -O2; the median of RUNS (9) compilations, interleaved so that every cell sees the same noise; by default with each
# of gcc, g++, clang and clang++ that exists. The first column is the empty file itself; "C headers" are the headers of the C library
# that sh.h includes, and that most files include anyway; the last column is the compiler's own header of intrinsics.
set -eu

include=$(cd "$(dirname "$0")/../include" && pwd)
runs=${1:-9}
[ $# = 0 ] || shift
compilers=("$@")
if [ ${#compilers[@]} = 0 ]; then
    for compiler in gcc g++ clang clang++; do
        command -v "$compiler" >/dev/null && compilers+=("$compiler")
    done
fi

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

: >"$dir/empty.c"
sed -n '/^#include </p' "$include/sh.h" | grep -v -e intrin -e arm_neon -e wasm >"$dir/headers.c"
echo '#include "sh.h"' >"$dir/sh.c"
echo '#include <immintrin.h>' >"$dir/intrinsics.c"

# A column is a title, a source and its flags.
variants=(
    "empty file|empty"
    "C headers|headers"
    "SH_NO_BATCH|sh|-DSH_NO_BATCH"
    "SH_NO_SIMD|sh|-DSH_NO_SIMD"
    "default|sh"
)
if [ "$(uname -m)" = x86_64 ]; then
    variants+=(
        "AVX2|sh|-mavx2 -mfma"
        "AVX-512|sh|-mavx512f"
        "immintrin.h|intrinsics|-mavx2 -mfma"
    )
fi

compile() { # COMPILER VARIANT: prints microseconds
    local name source flags start language=c
    IFS='|' read -r name source flags <<<"$2"
    [[ $1 == *++* ]] && language=c++
    start=${EPOCHREALTIME/./}
    # shellcheck disable=SC2086 # the flags are words
    "$1" -x $language -O2 $flags -I"$include" -c "$dir/$source.c" -o "$dir/out.o"
    echo $((${EPOCHREALTIME/./} - start))
}

for ((run = 0; run < runs; run++)); do
    for c in "${!compilers[@]}"; do
        for v in "${!variants[@]}"; do
            compile "${compilers[c]}" "${variants[v]}" >>"$dir/$c.$v"
        done
    done
done

median() { sort -n "$dir/$1" | sed -n "$(((runs + 1) / 2))p"; }

row() {
    printf '|'
    printf ' %s |' "$@"
    printf '\n'
}

row compiler "${variants[@]%%|*}"
row --- "${variants[@]/*/---:}"
for c in "${!compilers[@]}"; do
    empty=$(median "$c.0")
    cells=($(((empty + 500) / 1000)))
    for v in "${!variants[@]}"; do
        [ "$v" = 0 ] || cells+=($((($(median "$c.$v") - empty + 500) / 1000)))
    done
    row "${compilers[c]}" "${cells[@]}"
done
