/* Bakes many probes: each thread takes probes, and one probe that is expensive is split over all threads. Accumulators are plain sums,
 * so partial ones merge. Without OpenMP the same program runs on one thread. */
#include <stdio.h>

#include "sh.h"

enum { PROBES = 64, SAMPLES = 4096, PARTS = 16, SIZE = 3 * SH_COUNT(SH_L2) };

/* What a ray tracer would return: a sky with a wide sun, over grass, and a red wall at x = 1 that is 2 high. */
static void trace(const float from[3], const float dir[3], float rgb[3]) {
    const float distance = dir[0] > 0.0f ? (1.0f - from[0]) / dir[0] : 1e9f, height = from[2] + distance * dir[2];
    const int wall = dir[0] > 0.0f && height > 0.0f && height < 2.0f;
    const float sun = dir[1] > 0.9f ? 10.0f : 0.0f;
    rgb[0] = wall ? 0.6f : dir[2] > 0.0f ? 0.4f + sun : 0.1f;
    rgb[1] = wall ? 0.1f : dir[2] > 0.0f ? 0.6f + sun : 0.2f;
    rgb[2] = wall ? 0.1f : dir[2] > 0.0f ? 1.0f + sun : 0.1f;
}

static void sample(const float from[3], uint32_t first, uint32_t last, sh_accum accum[3]) {
    for (uint32_t i = first; i < last; i++) {
        float dir[3], rgb[3];
        sh_direction_fibonacci(i, SAMPLES, dir);
        trace(from, dir, rgb);
        for (int k = 0; k < 3; k++)
            sh_accum_sample(SH_L2, dir, rgb[k], 1.0f, &accum[k]);
    }
}

int main(void) {
    static float probes[PROBES][SIZE];
    const float corner[3] = { 0.0f, 0.0f, 0.5f };
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (int p = 0; p < PROBES; p++) {
        const float from[3] = { 0.9f * (float)p / (PROBES - 1), 0.0f, 0.5f };
        sh_accum accum[3];
        sh_accum_clear(3, accum);
        sample(from, 0, SAMPLES, accum);
        sh_accum_finish(SH_L2, 3, accum, probes[p]);
    }

    sh_accum parts[PARTS][3], sum[3];
    float split[SIZE], difference = 0.0f;
#ifdef _OPENMP
#pragma omp parallel for
#endif
    for (int part = 0; part < PARTS; part++) {
        sh_accum_clear(3, parts[part]);
        sample(corner, (uint32_t)part * (SAMPLES / PARTS), (uint32_t)(part + 1) * (SAMPLES / PARTS), parts[part]);
    }
    sh_accum_clear(3, sum);
    for (int part = 0; part < PARTS; part++) /* in this order, however many threads there were: the same bits */
        sh_accum_merge(3, parts[part], sum);
    sh_accum_finish(SH_L2, 3, sum, split);
    for (int i = 0; i < SIZE; i++)
        difference = fmaxf(difference, fabsf(split[i] - probes[0][i]));

    const float wall[3] = { 1, 0, 0 };
    const int blue = 2 * SH_COUNT(SH_L2);
    const float far_blue = sh_irradiance(SH_L2, probes[0] + blue, wall), near_blue = sh_irradiance(SH_L2, probes[PROBES - 1] + blue, wall);
    printf("%d probes of %d rays; blue light on a surface that faces the wall: %.3f far from it, %.3f near it\n", PROBES, SAMPLES,
           (double)far_blue, (double)near_blue);
    printf("a probe in %d parts differs by %.1e\n", PARTS, (double)difference);
    return difference < 1e-6f && near_blue < far_blue ? 0 : 1;
}
