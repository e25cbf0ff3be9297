# The kernels and the golden values on other targets, natively or in emulators, warnings as errors; each fails unless it runs the backend
# asked for. README's table of targets is made here, and compared: after a change, `.ci/run targets; .ci/targets_table.sh write`.
source .ci/targets.sh
need_gcc
need_clang
need aarch64-linux-gnu-gcc gcc-aarch64-linux-gnu libc6-dev-arm64-cross
need arm-linux-gnueabihf-gcc gcc-arm-linux-gnueabihf libc6-dev-armhf-cross
need s390x-linux-gnu-gcc gcc-s390x-linux-gnu libc6-dev-s390x-cross
need riscv64-linux-gnu-gcc gcc-riscv64-linux-gnu libc6-dev-riscv64-cross
need i686-linux-gnu-gcc gcc-i686-linux-gnu libc6-dev-i386-cross
need qemu-aarch64 qemu-user
need x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64-win32
need wine wine wine64
need clang-19 clang-19 lld-19 wasi-libc libclang-rt-19-dev-wasm32
need node nodejs
need musl-gcc musl-tools
need tcc tcc

printf '| target | compiler | run by | backend | test programs |\n|---|---|---|---|---|\n' >"$work/targets.md"

export build=build_with golden_flags="-ffp-contract=off -DGOLDEN_EXACT"
target "x86-64, -DSH_NO_SIMD" SCALAR env gcc -O2 -DSH_NO_SIMD
target "x86-64" SSE2 env gcc -O2
target "x86-64, -mavx2 -mfma" AVX2 env clang -O2 -mavx2 -mfma
if grep -qw avx512f /proc/cpuinfo; then
    target "x86-64, -mavx512f" AVX512 env gcc -O2 -mavx512f
else
    need bochs bochs bochsbios vgabios bochs-term isolinux syslinux-common xorriso cpio
    check "target x86-64, -mavx512f, in Bochs" target_avx512
fi
target "x86-64, musl" SSE2 env musl-gcc -O2 -static
target "AArch64" NEON qemu-aarch64 aarch64-linux-gnu-gcc -O2 -static
target "ARM, 32 bits, -mfpu=neon" NEON qemu-arm arm-linux-gnueabihf-gcc -O2 -static -mfpu=neon
target "s390x, big-endian" SCALAR qemu-s390x s390x-linux-gnu-gcc -O2 -static
kernel_tests="golden vocabulary batch samples product" target "RISC-V, 64 bits" SCALAR qemu-riscv64 riscv64-linux-gnu-gcc -O2 -static
target "WebAssembly, -msimd128" WASM "node --no-warnings .ci/wasi.mjs" clang-19 --target=wasm32-wasi -O2 -msimd128 -Wl,-z,stack-size=1048576

export WINEDEBUG=-all WINEPREFIX=$work/wine
check "wine starts" wine cmd /c exit 0
target "Windows, 64 bits" AVX2 wine x86_64-w64-mingw32-gcc -O2 -static -mavx2 -mfma
build=build_msvc golden_flags="/clang:-ffp-contract=off -DGOLDEN_EXACT" \
    target "Windows, 64 bits, MSVC mode" AVX2 wine clang-19 --driver-mode=cl --target=x86_64-pc-windows-msvc /O2 /arch:AVX2
# With tcc 0.9.27 the closures' test finds NaN in its own long double; their golden values are compared.
kernel_tests=${kernel_tests/closure /} golden_flags=-DGOLDEN_EXACT target "x86-64, tcc" SCALAR env tcc -DFLT_EVAL_METHOD=0
# The other tests compare bits that a result's place must not change: on the x87 they are the compiler's choice.
kernel_tests="golden vocabulary texels product storage" golden_flags="" target "x86, 32 bits, x87 arithmetic" SCALAR qemu-i386 i686-linux-gnu-gcc -O2 -static -march=i486 -mno-sse -mfpmath=387

if command -v nvcc >/dev/null; then
    check "CUDA $(nvcc --version | sed -n 's/.*release \([0-9.]*\),.*/\1/p'), compiled" compile_cuda
else
    echo "skipped CUDA: no nvcc"
fi
check "README's table of targets" .ci/targets_table.sh check
