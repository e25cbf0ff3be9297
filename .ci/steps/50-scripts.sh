# What only depends on the compiler: the machine code of literal orders, the choice of the
# backend, the one-line build. README's test command did it with cc.
need_gcc
need_clang

for cc in gcc clang; do
    check "codegen $cc" sh tests/codegen/check.sh $cc
    check "include selector $cc" sh tests/include/selector.sh $cc
    check "one-line build $cc" env CC=$cc sh tests/consumer/check.sh one_line "$work/$cc"
done
