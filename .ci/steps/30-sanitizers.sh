# All tests under the address and undefined-behaviour sanitizers, with both compilers' own.
need_cmake
need_gcc
need_clang

for cc in gcc clang; do
    check "$cc -fsanitize=address,undefined" build_and_test "$cc-sanitize" $cc \
        "-O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all"
done
