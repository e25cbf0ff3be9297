/* Bakes a probe on many machines: each projects its share of the rays, and one reduction of 10 doubles per channel adds them up. */
#include <mpi.h>
#include <stdio.h>

#include "sh.h"

enum { SAMPLES = 65536, CHANNELS = 3 };

/* A hemisphere of sky, whose coefficients are known: R0 = 1/2, z = 1/4, the rest 0, times the colour. */
static void trace(const float dir[3], float rgb[3]) {
    static const float color[3] = { 0.4f, 0.6f, 1.0f };
    for (int k = 0; k < 3; k++)
        rgb[k] = dir[2] > 0.0f ? color[k] : 0.0f;
}

int main(int argc, char **argv) {
    int rank, ranks, failed = 0;
    sh_accum mine[CHANNELS], all[CHANNELS];
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);

    sh_accum_clear(CHANNELS, mine);
    for (int i = rank; i < SAMPLES; i += ranks) {
        float dir[3], rgb[CHANNELS];
        sh_direction_fibonacci((uint32_t)i, SAMPLES, dir);
        trace(dir, rgb);
        for (int k = 0; k < CHANNELS; k++)
            sh_accum_sample(SH_L2, dir, rgb[k], 1.0f, &mine[k]);
    }
    /* An sh_accum is ten doubles, whose sum is the accumulator of all samples. */
    MPI_Reduce(mine, all, CHANNELS * (int)(sizeof(sh_accum) / sizeof(double)), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);

    if (rank == 0) {
        float c[CHANNELS * SH_COUNT(SH_L2)];
        sh_accum_finish(SH_L2, CHANNELS, all, c);
        printf("%d ranks: R0 = %.4f, z = %.4f\n", ranks, (double)c[SH_R0], (double)c[SH_Z]);
        failed = !(fabsf(c[SH_R0] - 0.2f) < 1e-4f && fabsf(c[SH_Z] - 0.1f) < 1e-4f && fabsf(c[SH_XX]) < 1e-4f);
    }
    MPI_Finalize();
    return failed;
}
