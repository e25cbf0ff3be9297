# Which lines of sh.h the tests execute, with which of its errors; and how many of its mutants they kill, in a sample drawn by a fixed
# seed. `.ci/mutate.py --help` says how to run all.
need_gcc
need_clang
need python3 python3
need prlimit util-linux

check "coverage" .ci/coverage.sh "$work/coverage"
cat "$work"/coverage/{lines,errors}.txt | grep %
check "mutation" .ci/mutate.py --coverage "$work/coverage" --sample 200
grep 'all$' "$work/log/mutation.log"
