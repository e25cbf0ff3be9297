#!/bin/sh
# Fuzzes: tests/fuzz/run.sh SECONDS [TARGET...] builds the targets and runs each, or all, for so many seconds from the committed inputs,
# seeds, and what earlier runs found; prints how many inputs each executed. Of the environment: CLANG, BUILD (build-fuzz), JOBS (2).
# Fails if an input crashes, takes 10 s or needs 1 GiB; it is kept in $BUILD/fuzz/TARGET.
set -eu
seconds=$1
shift
cd "$(dirname "$0")/../.."
source=$PWD
build=${BUILD:-build-fuzz}
jobs=${JOBS:-2}

cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER="${CLANG:-clang}" -DSH_FUZZERS=ON -DSH_BUILD_EXAMPLES=OFF \
    -DSH_BUILD_BENCH=OFF -DSH_INSTALL=OFF
cmake --build "$build" -j "$jobs" --target fuzz
cd "$build"
build=$PWD

[ $# -gt 0 ] || set -- $(cd "$source/tests/fuzz/corpus" && echo *)
for target; do
    mkdir -p "fuzz/$target/found"
    bin/fuzz_seeds "$target" "fuzz/$target/found"
done

printf '%s\n' "$@" | xargs -P "$jobs" -n 1 sh -c '
    cd "$1/fuzz/$4"
    UBSAN_OPTIONS=print_stacktrace=1 "$1/bin/fuzz_$4" -max_total_time="$3" -max_len=192 -timeout=10 -rss_limit_mb=1024 \
        -print_final_stats=1 found "$2/tests/fuzz/corpus/$4" >log 2>&1 || { tail -n 60 log && echo "FAILED $4" && exit 1; }
    sed -n "s/^stat::number_of_executed_units: *\(.*\)/\1 executions of $4/p" log
    ' sh "$build" "$source" "$seconds" >executions || status=1
cat executions
awk '/ executions of / { sum += $1 } END { printf "%.0f executions in all\n", sum }' executions
exit ${status:-0}
