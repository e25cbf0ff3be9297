# Runs tests on other targets and with other compilers, natively or in emulators. A target is a line of a table in
# .ci/steps/70-targets.sh; its tests are compiled and run in parallel. $warnings, $work and parallel come from .ci/lib.sh.

# The tests that every target runs: the vocabulary, whose program also fails if its backend is not the one asked for; everything that is
# built on it; and results of most of the library compared bit for bit (golden). Those of image projections against quadrature take
# long in an emulator that has to emulate long double as well.
export kernel_tests="golden vocabulary batch closure samples texels product rotate storage"

# build_with SOURCE PROGRAM COMPILER FLAG...
build_with() {
    local source=$1 program=$2
    shift 2
    # $warnings is a list of words.
    # shellcheck disable=SC2086
    "$@" $warnings -Werror -Iinclude "$source" -o "$program" -lm
}

# build_msvc SOURCE PROGRAM COMPILER FLAG...: clang as cl.exe, with our own few headers; mingw links.
build_msvc() {
    local source=$1 program=$2
    shift 2
    "$@" /nologo /W4 /WX /GS- /Zl /X -imsvc .ci/msvc/include -imsvc "$("$1" -print-resource-dir)/include" -Iinclude /c "$source" \
        "/Fo$program.obj"
    x86_64-w64-mingw32-gcc -static "$program.obj" .ci/msvc/start.c -o "$program.exe"
}

# run_on DIR RUN TEST: runs a test program in an emulator (or `env`); fails unless it says that nothing failed.
run_on() {
    local dir=$1 run=$2 test=$3 program=$1/$3
    if [ -e "$program.exe" ]; then
        program+=.exe
    fi
    # $run is a command of several words.
    # shellcheck disable=SC2086
    timeout 240 $run "$program" 2>&1 | tr -d '\r' | tee "$dir/$test.out"
    tail -n 1 "$dir/$test.out" | grep -q "^[1-9][0-9]* passed, 0 failed$"
}

# build_and_run BUILD DIR RUN TEST COMPILER FLAG...: golden values are compared without fusion by the compiler.
build_and_run() {
    local build=$1 dir=$2 run=$3 test=$4
    shift 4
    if [ "$test" = golden ]; then
        # A list of words.
        # shellcheck disable=SC2086
        set -- "$@" $golden_flags
    fi
    $build "tests/test_$test.c" "$dir/$test" "$@"
    [ -z "$run" ] || run_on "$dir" "$run" "$test"
}
export -f build_with build_msvc run_on build_and_run

# run_all DIR RUN TESTS COMPILER FLAG...: RUN is an emulator, `env` for this machine, or empty to build only. $build and $golden_flags are
# settings of the target.
run_all() {
    local dir=$1 run=$2 tests=$3 test
    shift 3
    mkdir -p "$dir"
    for test in $tests; do
        echo "build_and_run $build '$dir' '$run' $test $*"
    done | parallel
}

# target NAME BACKEND RUN COMPILER FLAG...: a check that builds and runs $kernel_tests, and adds a row to the table if all is well.
target() {
    check "target $1" run_target "$@"
}
run_target() {
    local name=$1 backend=$2 run=$3 dir=$work/targets/${1//[^A-Za-z0-9]/_}
    shift 3
    run_all "$dir" "$run" "$kernel_tests" "$@" "-DSH_EXPECT_SIMD=SH_SIMD_$backend"
    [ -z "$run" ] || add_row "$name" "$(compiler_name "$1")" "$run" "$dir"
}

# compiler NAME TESTS COMPILER FLAG...: a check that builds and runs these tests on this machine.
compiler() {
    check "compiler $1" run_all "$work/compilers/${1//[^A-Za-z0-9]/_}" env "${@:2}"
}

# add_row NAME COMPILER RUN DIR: the backend is the one that the test of the vocabulary ran.
add_row() {
    local backend label=${3%% *}
    label=${label/#env/natively}
    backend=$(sed -n '/^backend .* lanes [0-9]*$/{s/^backend \(.*\) lanes .*/\1/p;q}' "$4/vocabulary.out")
    echo "| $1 | $2 | ${label} | $backend | $(echo "$kernel_tests" | wc -w) |" >>"$work/targets.md"
}

# The target AVX-512 on a machine without it: all programs in one start of the emulator.
target_avx512() {
    local dir=$work/targets/avx512
    run_target avx512 AVX512 "" gcc -O2 -static -mavx512f
    # A list of words.
    # shellcheck disable=SC2086
    (cd "$dir" && "$OLDPWD/.ci/avx512.sh" $kernel_tests) | tee "$dir/vocabulary.out"
    add_row "x86-64, -mavx512f" "$(compiler_name gcc)" env "$dir" # the same row as natively
}

# Device code of every function that takes single directions; there is no device to run it on.
compile_cuda() {
    nvcc -std=c++17 -arch=sm_90 -Werror all-warnings -Iinclude -c tests/cuda/device.cu -o "$work/device.o"
}

# compiler_name COMPILER: as in the table.
compiler_name() {
    case $1 in
    *tcc) tcc -v | sed -n 's/^tcc version \([0-9.]*\).*/tcc \1/p' ;;
    musl-gcc) echo "gcc $(gcc -dumpversion)" ;;
    *gcc*) echo "gcc $("$1" -dumpversion | sed 's/-.*//')" ;;
    *clang*) echo "clang $("$1" -dumpversion | sed 's/\..*//')" ;;
    esac
}
