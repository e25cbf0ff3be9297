# The table of what including sh.h costs a translation unit; printed, not judged.
need_gcc
need_clang

check "compile time" .ci/compile_time.sh 3
sed -n '/^|/p' "$work/log/compile_time.log"
