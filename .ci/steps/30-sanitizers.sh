# All tests under the address and undefined-behaviour sanitizers, with both compilers' own: each sees other variants of the tests of
# kernels. The fuzz targets are under clang's in 35-fuzz.sh.
need_cmake
need_gcc
need_clang

sanitizers() { # COMPILER VARIANTS
    check "$1 -fsanitize=address,undefined" build_and_test "$1-sanitize" "$1" \
        "-O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all" \
        -DSH_TEST_VARIANTS="default;$2"
}

sanitizers gcc "c++;avx2"
sanitizers clang "scalar;avx512"
