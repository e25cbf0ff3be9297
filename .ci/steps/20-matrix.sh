# All tests, warnings as errors: every C and C++ standard and every level of optimisation with both compilers. Strict ISO C also keeps
# gcc from fusing multiplies and adds. At -O2, which the library is tuned for, every variant of the tests and the benchmarks.
need_cmake
need_gcc
need_clang

matrix() { # COMPILER LEVEL C-STANDARD C++-STANDARD
    local all=OFF
    [ "$2" = -O2 ] && all=ON
    check "$1 $2 C$3 C++$4" build_and_test "$1$2" "$1" "$2" -DSH_TEST_ALL=$all -DSH_BUILD_BENCH=$all \
        -DCMAKE_C_STANDARD="$3" -DCMAKE_CXX_STANDARD="$4" -DCMAKE_C_EXTENSIONS=OFF -DCMAKE_CXX_EXTENSIONS=OFF
}

matrix gcc -O0 99 11
matrix gcc -O2 11 17
matrix gcc -O3 17 20
matrix clang -O0 17 20
matrix clang -O2 99 11
matrix clang -O3 11 17
