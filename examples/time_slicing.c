/* time_slicing - projects a panorama over several frames, 16 rows in each, and compares the result with projecting it at once.
 *
 * What a game does when the time of day moves the sky: a probe may be a few frames late, but no frame pays for all of it. Between
 * two frames there is one sh_accum a channel, plain numbers, and the row to go on from. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sh.h"

enum { WIDTH = 256, HEIGHT = 128, ROWS_PER_FRAME = 16, CHANNELS = 3, COUNT = SH_COUNT(SH_L2) };

static float pixels[HEIGHT][WIDTH][CHANNELS];

/* A sky that brightens and pales towards the horizon, a sun, and dark ground. */
static void paint(void) {
    static const double zenith[CHANNELS] = { 0.2, 0.4, 1.0 }, haze[CHANNELS] = { 0.9, 1.0, 1.1 }, beam[CHANNELS] = { 40, 35, 28 };
    const double pi = acos(-1.0), sun[3] = { 0.48, 0.64, 0.6 };
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const double polar = pi * (row + 0.5) / (int)HEIGHT, azimuth = 2 * pi * (column + 0.5) / (int)WIDTH, z = cos(polar);
            const double to_sun = sin(polar) * (cos(azimuth) * sun[0] + sin(azimuth) * sun[1]) + z * sun[2];
            for (int k = 0; k < CHANNELS; k++) {
                const double sky = z > 0 ? haze[k] + (zenith[k] - haze[k]) * sqrt(z) : 0.1;
                pixels[row][column][k] = (float)(sky + beam[k] * exp(400 * (to_sun - 1)));
            }
        }
}

/* What is kept from frame to frame. */
typedef struct probe_update {
    sh_accum accum[CHANNELS];
    sh_report report;
    int next_row;
} probe_update;

/* The work of one frame. Returns SH_OK or an error. */
static int update(probe_update *u, const sh_image *image) {
    const int left = image->height - u->next_row, rows = left < ROWS_PER_FRAME ? left : ROWS_PER_FRAME;
    const int status = sh_project_equirect_rows(SH_L2, image, 0, u->next_row, rows, u->accum, &u->report);
    u->next_row += rows;
    return status;
}

/* The largest difference of two sets, relative to the largest R0. */
static double difference(const float *a, const float *b) {
    double largest = 0, mean = 0;
    for (int i = 0; i < CHANNELS * COUNT; i++)
        largest = fmax(largest, fabs((double)a[i] - (double)b[i]));
    for (int k = 0; k < CHANNELS; k++)
        mean = fmax(mean, (double)b[k * COUNT]);
    return largest / mean;
}

int main(void) {
    const sh_image image = { pixels, WIDTH, HEIGHT, 0, CHANNELS, SH_F32 };
    const float up[3] = { 0, 0, 1 };
    float sliced[CHANNELS * COUNT], whole[CHANNELS * COUNT];
    probe_update u;
    int frames = 0;
    paint();
    memset(&u, 0, sizeof u);
    for (; u.next_row < HEIGHT; frames++)
        if (update(&u, &image) != SH_OK)
            return 1;
    sh_accum_total(SH_L2, CHANNELS, u.accum, sliced);
    if (sh_project_equirect(SH_L2, &image, 0, whole, NULL) != SH_OK)
        return 1;
    const double error = difference(sliced, whole);
    printf("%d frames of %d rows, %llu texels\n", frames, ROWS_PER_FRAME, (unsigned long long)u.report.texels);
    for (int k = 0; k < CHANNELS; k++)
        printf("irradiance / pi of a surface facing up, channel %d: %.6f\n", k,
               (double)sh_irradiance(SH_L2, sliced + k * COUNT, up));
    printf("largest difference from the whole: %.1e of R0\n", error);
    return error <= 1e-7 && u.report.texels == (uint64_t)WIDTH * HEIGHT ? 0 : 1;
}
