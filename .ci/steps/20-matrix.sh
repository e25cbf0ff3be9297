# All tests, warnings as errors: every C and C++ standard and every level of optimisation, spread over both compilers. Strict ISO C also keeps
# gcc from fusing multiplies and adds. At -O2, which the library is tuned for, the benchmarks as well, and with gcc every variant of
# every test and the committed inputs of the fuzz targets.
need_cmake
need_gcc
need_clang

matrix() { # COMPILER LEVEL C-STANDARD C++-STANDARD
    local bench=OFF all=OFF
    [ "$2" = -O2 ] && bench=ON
    [ "$1" = gcc ] && all=$bench
    check "$1 $2 C$3 C++$4" build_and_test "$1$2" "$1" "$2" -DSH_BUILD_BENCH=$bench -DSH_TEST_ALL=$all -DSH_TEST_FUZZ=$all \
        -DCMAKE_C_STANDARD="$3" -DCMAKE_CXX_STANDARD="$4" -DCMAKE_C_EXTENSIONS=OFF -DCMAKE_CXX_EXTENSIONS=OFF
}

matrix gcc -O0 99 11
matrix gcc -O2 11 17
matrix clang -O2 99 11
matrix clang -O3 17 20
