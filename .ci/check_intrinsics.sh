#!/bin/sh
# check_intrinsics.sh [HEADER]: fails if intrinsics or vector types appear outside the header's vector vocabulary, or not within it.
set -eu
header=${1:-"$(dirname "$0")/../include/sh.h"}
awk '
    /^\/\* ---- / { inside = /^\/\* ---- Vector vocabulary/ }
    /(^|[^[:alnum:]_])(_mm[0-9]*_[a-z]|_MM_|__m(64|128|256|512)|__mmask|wasm_[a-z]|v128_t|v[a-z]+[0-9]*q?_[a-z0-9_]*(f|s|u|p)(8|16|32|64)([^[:alnum:]_]|$)|(float|int|uint|poly)(8|16|32|64)x[0-9]+)/ {
        if (inside)
            within++
        else {
            printf "%s:%d: outside the vector vocabulary: %s\n", FILENAME, FNR, $0
            outside++
        }
    }
    END {
        if (!within)
            print "no intrinsics in a section named Vector vocabulary"
        exit outside || !within
    }' "$header"
