#!/bin/sh
# selector.sh CC: which backend sh.h takes under which flags of the compiler CC, and that it refuses one that the target lacks.
set -u
cc=$1
include=$(cd "$(dirname "$0")/../../include" && pwd)
passed=0
failed=0

# expect NAME FLAG...: SH_SIMD_NAME is NAME under the flags, or, for NAME "error", sh.h does not compile.
expect() {
    name=$1
    shift
    found=$(printf '#include "sh.h"\nSH_SIMD_NAME\n' | $cc -E -x c -I"$include" "$@" - 2>/dev/null) || found='"error"'
    found=$(printf '%s\n' "$found" | tail -n 1)
    if [ "$found" = "\"$name\"" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "$cc $*: $found, not \"$name\""
    fi
}

expect scalar -DSH_NO_SIMD
expect scalar -DSH_SIMD=SH_SIMD_SCALAR
expect scalar -DSH_NO_SIMD -DSH_SIMD=SH_SIMD_SSE2
expect error -DSH_SIMD=99
if printf '__x86_64__\n' | $cc -E -x c - | grep -q '^1$'; then
    expect SSE2 -march=x86-64
    expect SSE2 -march=x86-64 -mavx2
    expect AVX2+FMA -march=x86-64 -mavx2 -mfma
    expect AVX-512 -march=x86-64 -mavx512f
    expect SSE2 -march=x86-64 -mavx512f -DSH_SIMD=SH_SIMD_SSE2
    expect AVX2+FMA -march=x86-64 -mavx512f -mfma -DSH_SIMD=SH_SIMD_AVX2
    expect AVX2+FMA -march=x86-64 -mavx512f -mfma -DSH_SIMD=2
    expect error -march=x86-64 -DSH_SIMD=SH_SIMD_AVX2
    expect error -march=x86-64 -mavx2 -mfma -DSH_SIMD=SH_SIMD_AVX512
    expect error -march=x86-64 -DSH_SIMD=SH_SIMD_NEON
    expect error -march=x86-64 -DSH_SIMD=SH_SIMD_WASM
fi

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
