# Each fuzz target for a few seconds under libFuzzer and the sanitizers, from the committed inputs; ctest replays those elsewhere.
need_cmake
need_clang

fuzz_targets() {
    JOBS=$jobs BUILD=$work/fuzz sh tests/fuzz/run.sh 3
}

check "fuzz" fuzz_targets
grep -a " executions in all" "$work/log/fuzz.log"
rm -rf "$work/fuzz"
