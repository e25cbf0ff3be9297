/* openmp_rows - projects a panorama on several threads, each with its own rows and its own accumulators, and compares the result
 * with projecting it on one thread.
 *
 *     cc -O2 -fopenmp -Iinclude examples/openmp_rows.c -o openmp_rows -lm
 *
 * Without -fopenmp the same code runs on one thread. Any other kind of thread works alike: an sh_accum is plain numbers. */
#include <math.h>
#include <stdio.h>

#include "sh.h"

#ifdef _OPENMP
#include <omp.h>
#endif

enum { WIDTH = 512, HEIGHT = 256, CHANNELS = 3, MAX_SLICES = 64, COUNT = SH_COUNT(SH_L2) };

static float pixels[HEIGHT][WIDTH][CHANNELS];

/* Three wide lamps, red, green and blue, in a dim room. */
static void paint(void) {
    static const double lamp[CHANNELS][3] = { { 0.8, 0, 0.6 }, { -0.36, 0.48, 0.8 }, { -0.48, -0.64, -0.6 } };
    const double pi = acos(-1.0);
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const double polar = pi * (row + 0.5) / (int)HEIGHT, azimuth = 2 * pi * (column + 0.5) / (int)WIDTH;
            const double w[3] = { sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar) };
            for (int k = 0; k < CHANNELS; k++) {
                const double cosine = w[0] * lamp[k][0] + w[1] * lamp[k][1] + w[2] * lamp[k][2];
                pixels[row][column][k] = (float)(0.1 + 10 * exp(20 * (cosine - 1)));
            }
        }
}

static int slice_count(void) {
#ifdef _OPENMP
    const int threads = omp_get_max_threads();
    return threads < MAX_SLICES ? threads : MAX_SLICES;
#else
    return 1;
#endif
}

/* The coefficients of the image from `slices` ranges of rows, one for each thread. Returns SH_OK or an error. */
static int project(const sh_image *image, int slices, float *c) {
    sh_accum accum[MAX_SLICES][CHANNELS];
    int status[MAX_SLICES];
    int i;
#ifdef _OPENMP
#pragma omp parallel for schedule(static, 1) num_threads(slices)
#endif
    for (i = 0; i < slices; i++) {
        const int first = image->height * i / slices, end = image->height * (i + 1) / slices;
        sh_accum_clear(CHANNELS, accum[i]);
        status[i] = sh_project_equirect_rows(SH_L2, image, 0, first, end - first, accum[i], NULL);
    }
    /* In the order of the rows, so that the result does not depend on which thread was done first. */
    for (i = 0; i < slices; i++) {
        if (status[i] != SH_OK)
            return status[i];
        if (i > 0)
            sh_accum_merge(CHANNELS, accum[i], accum[0]);
    }
    sh_accum_total(SH_L2, CHANNELS, accum[0], c);
    return SH_OK;
}

int main(void) {
    const sh_image image = { pixels, WIDTH, HEIGHT, 0, CHANNELS, SH_F32 };
    const int slices = slice_count();
    float c[CHANNELS * COUNT], whole[CHANNELS * COUNT];
    double worst = 0;
    paint();
    if (project(&image, slices, c) != SH_OK || sh_project_equirect(SH_L2, &image, 0, whole, NULL) != SH_OK)
        return 1;
    for (int k = 0; k < CHANNELS; k++)
        for (int i = 0; i < COUNT; i++)
            worst = fmax(worst, fabs((double)c[k * COUNT + i] - (double)whole[k * COUNT + i]) / (double)whole[k * COUNT]);
    printf("threads: %d%s\n", slices,
#ifdef _OPENMP
           ""
#else
           " (built without OpenMP)"
#endif
    );
    printf("R0 of red, green, blue: %.6f %.6f %.6f\n", (double)c[0], (double)c[COUNT], (double)c[2 * COUNT]);
    printf("largest difference from one thread: %.1e of R0\n", worst);
    return worst <= 1e-7 ? 0 : 1;
}
