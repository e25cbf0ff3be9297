/* A grid of probes of mixed orders. Each is stored at the lowest order that its irradiance needs under a tolerance; looking up a point
 * interpolates the eight probes around it, each by its own order, which is within the tolerance of interpolating full ones. */
#include <stdio.h>

#include "sh.h"

enum { N = 8 };

typedef struct probe {
    int order;
    float *c; /* SH_COUNT(order) floats in the pool */
} probe;

static float pool[N * N * N * SH_COUNT(SH_L2)], full_pool[N * N * N * SH_COUNT(SH_L2)];
static probe grid[N][N][N], full_grid[N][N][N]; /* the second to compare with */

/* Light at a point of the unit cube: a sky, and a lamp near one corner. */
static void bake(const float at[3], float c[9]) {
    const float up[3] = { 0, 0, 1 }, sky = 1.0f, ground = 0.7f, lamp = 20.0f;
    const float to_lamp[3] = { 0.1f - at[0], 0.1f - at[1], 0.1f - at[2] };
    for (int i = 0; i < SH_COUNT(SH_L2); i++)
        c[i] = 0.0f;
    sh_add_hemisphere(SH_L2, 1, up, &sky, &ground, c);
    sh_add_sphere(SH_L2, 1, to_lamp, 0.05f, SH_RADIANCE, &lamp, c);
}

/* Trilinear interpolation at p in [0, N - 1]^3. */
static float irradiance(probe probes[N][N][N], const float p[3], const float n[3]) {
    int cell[3];
    float t[3], sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        cell[k] = p[k] < N - 2 ? (int)p[k] : N - 2;
        t[k] = p[k] - (float)cell[k];
    }
    for (int corner = 0; corner < 8; corner++) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        const float weight = (x ? t[0] : 1 - t[0]) * (y ? t[1] : 1 - t[1]) * (z ? t[2] : 1 - t[2]);
        const probe *a = &probes[cell[2] + z][cell[1] + y][cell[0] + x];
        sum += weight * sh_irradiance(a->order, a->c, n);
    }
    return sum;
}

int main(void) {
    const float tolerance = 0.02f;
    int used = 0, count[3] = { 0, 0, 0 };
    float worst = 0.0f;
    for (int z = 0; z < N; z++)
        for (int y = 0; y < N; y++)
            for (int x = 0; x < N; x++) {
                const float at[3] = { (float)x / (N - 1), (float)y / (N - 1), (float)z / (N - 1) };
                probe *a = &grid[z][y][x], *full = &full_grid[z][y][x];
                full->order = SH_L2;
                full->c = full_pool + ((z * N + y) * N + x) * SH_COUNT(SH_L2);
                bake(at, full->c);
                a->order = sh_order_needed(full->c, tolerance);
                a->c = pool + used;
                sh_truncate(SH_L2, 1, full->c, a->order, a->c);
                used += SH_COUNT(a->order);
                count[a->order]++;
            }
    for (uint32_t i = 0; i < 10000; i++) {
        float n[3], p[3];
        sh_direction_sequence(i, 1, n);
        sh_direction_sequence(i, 2, p);
        for (int k = 0; k < 3; k++)
            p[k] = 0.5f * (N - 1) * (1.0f + p[k]);
        const float error = fabsf(irradiance(grid, p, n) - irradiance(full_grid, p, n));
        worst = error > worst ? error : worst;
    }
    printf("%d probes: %d of L0, %d of L1, %d of L2; %d floats, not %d; largest error %.4f of 1\n", N * N * N, count[0], count[1],
           count[2], used, N * N * N * 9, (double)worst);
    return worst <= tolerance * 1.001f && used < N * N * N * 9 ? 0 : 1;
}
