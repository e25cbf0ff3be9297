# Static analysis of the header, tests, examples and benchmarks: clang-tidy with the checks of .clang-tidy, cppcheck, gcc's analyzer.
# What they are told not to look for is argued where they are told: in .clang-tidy, below, and in comments beside the code.
need_gcc
need_clang
need clang-tidy clang-tidy
need cppcheck cppcheck

sources=(tests/test_*.c tests/include/{alone,windows}.c examples/*.c bench/*.c)

# each COMMAND...: the command for every source, in parallel.
each() {
    printf "%s\n" "${sources[@]/#/$* }" | parallel
}

# clang_tidy SOURCE
clang_tidy() {
    clang-tidy --quiet "$1" -- -std=c99 -Iinclude -DSH_ENVS_DIR='"x"'
}

# gcc_analyzer SOURCE: function by function, the scalar kernels: what is inlined by force would be analysed again in each place, for
# minutes. An array that a loop fills is uninitialised to gcc, which clang's analyzer follows.
gcc_analyzer() {
    gcc -std=c99 -fanalyzer -Werror -Wno-analyzer-use-of-uninitialized-value -Dalways_inline=unused -DSH_NO_SIMD \
        -Iinclude -DSH_ENVS_DIR='"x"' -c "$1" -o /dev/null
}
export -f clang_tidy gcc_analyzer

check "clang-tidy" each clang_tidy
check "gcc -fanalyzer" each gcc_analyzer
# uninitvar: takes an array that a function fills for one that it reads. invalidFunctionArg: does not see a condition before sqrt.
check "cppcheck" cppcheck --quiet --error-exitcode=1 --enable=warning,performance,portability --inline-suppr --suppress=uninitvar \
    --suppress=invalidFunctionArg \
    -j "$jobs" --std=c99 -Iinclude -DSH_ENVS_DIR='"x"' "${sources[@]}"
