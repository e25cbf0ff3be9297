# tests/include: sh.h alone, twice, last, after windows.h's macros and without batches, with every compiler, standard and level; and the
# whole header as one backend, where every function is compiled whether used or not.
need_gcc
need_clang

include_probes() { # COMPILER LANGUAGE STANDARD LEVEL FLAG...
    local program
    program=$(mktemp -p "$work")
    # $warnings is a list of words.
    # shellcheck disable=SC2086
    "$1" -x "$2" -std="$3" "$4" "${@:5}" $warnings -Werror -Iinclude \
        tests/include/{main,alone,twice,last,windows,no_batch}.c -o "$program" -lm
    "$program"
    rm "$program"
}
export -f include_probes

include_matrix() { # COMPILER "LEVEL..." FLAG...
    local level standard
    for level in $2; do
        for standard in c99 c11 c17; do
            echo include_probes "$1" c $standard $level "${@:3}"
        done
        for standard in c++11 c++17 c++20; do
            echo include_probes "$(cxx_of "$1")" c++ $standard $level "${@:3}"
        done
    done | parallel
}

for cc in gcc clang; do
    check "include $cc" include_matrix $cc "-O0 -O2 -O3"
    check "include $cc SH_NO_SIMD" include_matrix $cc -O2 -DSH_NO_SIMD
done
