#!/bin/sh
# mca.sh [CPU]: what llvm-mca makes of the inner loops of four kernels at gcc -O2 -mavx2 -mfma: cycles of a pass if nothing but its
# instructions counted, with every load in the first-level cache. CPU is one of llvm-mca's -mcpu, such as icelake-server or znver3.
set -eu
cpu=${1:-icelake-server}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/kernels.c" <<'C'
#include "sh.h"
void planar(const float *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    shi_evaluate(SH_L2, p, x, y, z, out, count, NULL, NULL);
}
void interleaved(const shi_aos *job) { shi_evaluate_aos_rgb(SH_L2, job); }
void equirect(const unsigned char *const here[2], const unsigned char *const opposite[2], shi_next *next, size_t vectors,
              const shi_columns *columns, const float turn[4], shi_v a[SHI_PHASES][SHI_SUMS], shi_v b[SHI_PHASES][SHI_SUMS]) {
    shi_fold_block(SH_L2, here, opposite, next, vectors, 3, columns, turn, a, b);
}
void cubemap(const unsigned char *const row[4], shi_next *next, size_t vectors, const shi_factors *factors,
             shi_v total[SHI_PHASES][SHI_FRAME_SUMS]) {
    shi_cube_block(SH_L2, 1, row, next, vectors, 3, factors, total);
}
C
${CC:-gcc} -O2 -mavx2 -mfma -fno-asynchronous-unwind-tables -I"$here/../include" -S "$work/kernels.c" -o "$work/kernels.s"

echo "kernel: instructions, multiply-adds, cycles of a pass on $cpu"
for kernel in planar interleaved equirect cubemap; do
    # The innermost loop: from the last label to the jump back to it.
    awk -v kernel="$kernel:" '
        $1 == kernel { inside = 1 }
        inside && /^\.L[0-9]+:/ { body = ""; label = substr($1, 1, length($1) - 1); fma = 0 }
        inside { body = body "\n" $0 }
        inside && /vfmadd/ { fma++ }
        inside && /^\tj/ && $2 == label && fma >= 8 { print body; exit }' "$work/kernels.s" >"$work/loop.s"
    cycles=$(llvm-mca -mcpu="$cpu" -iterations=100 "$work/loop.s" 2>/dev/null | sed -n 's/^Block RThroughput: *//p')
    echo "$kernel: $(grep -c "^	[a-z]" "$work/loop.s"), $(grep -c vfmadd "$work/loop.s"), $cycles"
done
