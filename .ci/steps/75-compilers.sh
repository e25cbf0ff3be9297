# Compilers old and new, and flags that cheat: what docs/portability.md says still holds. Warnings as errors.
source .ci/targets.sh
need_gcc
need_clang
need gcc-11 gcc-11
need clang-13 clang-13
need clang-16 clang-16
need clang-19 clang-19 lld-19
need i686-linux-gnu-gcc gcc-i686-linux-gnu libc6-dev-i386-cross
need s390x-linux-gnu-gcc gcc-s390x-linux-gnu libc6-dev-s390x-cross
need qemu-i386 qemu-user

export build=build_with golden_flags="-ffp-contract=off -DGOLDEN_EXACT"
for cc in gcc-11 clang-13 clang-16 clang-19; do
    compiler "$cc" "golden vocabulary batch" $cc -O2 -mavx2 -mfma
done
compiler "gcc -O3 -flto" "golden batch" gcc -O3 -flto
compiler "clang-19 -O3 -flto" "golden batch" clang-19 -O3 -flto -fuse-ld=lld
compiler "flush-to-zero, denormals-are-zero" "golden samples product rotate" gcc -O2 "$(gcc -print-file-name=crtfastmath.o)"

# Here the compiler rounds as it likes, and golden values are met to 1e-6.
export golden_flags=""
compiler "gcc, scalar code with FMA" "golden reconstruction closure product samples" gcc -O3 -march=haswell -DSH_NO_SIMD
compiler "gcc, kernels with FMA" "golden closure product samples" gcc -O2 -mavx2 -mfma
compiler "clang-19 -ffp-contract=fast" "golden closure product samples" clang-19 -O2 -mavx2 -mfma -ffp-contract=fast
# test.h names NaN, of which clang 19 warns.
fast_math_tests="golden basis convert product projection rotate"
compiler "gcc -Ofast" "$fast_math_tests" gcc -Ofast
compiler "clang-19 -ffast-math" "$fast_math_tests" clang-19 -O2 -ffast-math -mavx2 -mfma -Wno-nan-infinity-disabled
check "x87 at -O0" run_all "$work/compilers/x87" qemu-i386 "golden product" \
    i686-linux-gnu-gcc -O0 -static -march=i486 -mno-sse -mfpmath=387
check "s390x, float in double" run_all "$work/compilers/s390x" qemu-s390x "golden reconstruction closure" \
    s390x-linux-gnu-gcc -std=c99 -O2 -static -Wno-error=double-promotion # every sum of floats is one of doubles there

# fast_math COMPILER FLAG...: sh.h under -ffast-math, called by code that is compiled without, denormals kept and flushed.
fast_math() {
    local dir=$work/fast_math/${*//[^A-Za-z0-9]/_} link
    mkdir -p "$dir"
    # $warnings is a list of words.
    # shellcheck disable=SC2086
    {
        "$@" -ffast-math $warnings -Werror -Iinclude -c tests/fast_math/unit.c -o "$dir/unit.o"
        gcc -O1 -ffp-contract=off $warnings -Werror -Iinclude -c tests/fast_math/main.c -o "$dir/main.o"
    }
    for link in -fno-fast-math -ffast-math; do
        gcc $link "$dir"/*.o -o "$dir/fast_math" -lm
        "$dir/fast_math"
    done
}
check "fast_math gcc" fast_math gcc -O3
check "fast_math clang" fast_math clang -O2 -DSH_NO_SIMD
check "fast_math clang-19" fast_math clang-19 -O2 -mavx2 -mfma
