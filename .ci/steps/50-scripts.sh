# What depends only on the compiler: the machine code of literal orders, the choice of the backend, README's code, the one-line build;
# and what depends on nothing.
need_gcc
need_clang

for cc in gcc clang; do
    check "codegen $cc" sh tests/codegen/check.sh $cc
    check "include selector $cc" sh tests/include/selector.sh $cc
    check "README $cc" env CC=$cc sh tests/readme.sh
    check "one-line build $cc" env CC=$cc sh tests/consumer/check.sh one_line "$work/$cc"
done

check "intrinsics only in the vocabulary" sh .ci/check_intrinsics.sh
