/* shlight_reference.h - irradiance by brute force, from a panorama's texels and nothing else: the truth that shlight measures
 * reconstructions against.
 *
 * The panorama is cut into 256 x 128 blocks, whatever its size, and a block is kept as its first moment: the integral of radiance
 * times direction over its texels' exact areas, also where an edge cuts a texel. Irradiance / pi at n is the sum of
 * 4 max(0, n . moment). That is exact for every block wholly on one side of the horizon of n, whatever its texels are; only the ring
 * of blocks that the horizon cuts is approximate. Against the moments of all 1024 x 512 texels of the built-in sky, whose sun is the
 * hardest case: RMS 1e-4 of R0, at most 1e-3. A constant sky: at most 1e-4.
 * The blocks are kept in tiles of 8 x 8. A tile wholly above the horizon counts as one moment and one below it not at all: the
 * same sum with less work.
 */
#ifndef SHLIGHT_REFERENCE_H
#define SHLIGHT_REFERENCE_H

#include "shlight_resample.h"

enum {
    SHLIGHT_COLUMNS = 256,
    SHLIGHT_ROWS = 128,
    SHLIGHT_TILE = 8, /* blocks along its side */
    SHLIGHT_TILE_COLUMNS = SHLIGHT_COLUMNS / SHLIGHT_TILE,
    SHLIGHT_TILES = SHLIGHT_TILE_COLUMNS * SHLIGHT_ROWS / SHLIGHT_TILE
};

/* Moments are four times those of the mean over the sphere, and scaled. */
typedef struct shlight_tile {
    float center[3], sine;                          /* the tile lies within an angle of this sine about its centre */
    float total[3][3];                              /* [channel][axis] */
    float moment[3][3][SHLIGHT_TILE][SHLIGHT_TILE]; /* [channel][axis][row][column] */
} shlight_tile;

typedef struct shlight_blocks {
    int channels;
    double total[3][3]; /* [channel][axis] */
    shlight_tile tile[SHLIGHT_TILES];
} shlight_blocks;

/* Sums over azimuth of one row of texels, per column of blocks: radiance times cos, sin and 1. */
typedef double shlight_row_sum[SHLIGHT_COLUMNS][3];

/* Makes the image's light what a projection with SH_CLAMP_NEGATIVE reads: no non-finite texels, no negative values. */
static void shlight_clean(shlight_image *image) {
    const size_t texels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < texels; i++) {
        float *texel = image->pixels + i * (size_t)image->channels;
        int finite = 1;
        for (int k = 0; k < image->channels; k++)
            finite &= isfinite(texel[k]) != 0;
        for (int k = 0; k < image->channels; k++)
            texel[k] = finite && texel[k] > 0.0f ? texel[k] : 0.0f;
    }
}

/* Integrals of cos, sin and 1 over the azimuths of each piece of a row; columns run clockwise from +x. */
static void shlight_integrate_columns(const shlight_piece *column, int columns, double (*integral)[3]) {
    const double pi = acos(-1.0);
    for (int i = 0; i < columns; i++) {
        const double middle = -pi * (column[i].begin + column[i].end), half = pi * (column[i].end - column[i].begin);
        integral[i][0] = 2.0 * sin(half) * cos(middle);
        integral[i][1] = 2.0 * sin(half) * sin(middle);
        integral[i][2] = 2.0 * half;
    }
}

static void shlight_sum_row(const float *texels, int channels, int k, const shlight_piece *column, int columns,
                            const double (*integral)[3], shlight_row_sum sum) {
    memset(sum, 0, sizeof(shlight_row_sum));
    for (int i = 0; i < columns; i++) {
        const double value = (double)texels[column[i].source * channels + k];
        double *s = sum[column[i].target];
        for (int axis = 0; axis < 3; axis++)
            s[axis] += value * integral[i][axis];
    }
}

/* Adds one piece of a row to the moments. weight is 4 times the scale over the sphere's 4 pi. */
static void shlight_add_row(const shlight_piece *row, double weight, const shlight_row_sum sum, int k, shlight_blocks *blocks) {
    const double pi = acos(-1.0), a = pi * row->begin, b = pi * row->end;
    const double across = weight * ((b - a) / 2.0 - (sin(2.0 * b) - sin(2.0 * a)) / 4.0); /* integral of sin^2 */
    const double along = weight * sin(b - a) * sin(b + a) / 2.0;                          /* integral of sin cos */
    shlight_tile *tiles = blocks->tile + row->target / SHLIGHT_TILE * SHLIGHT_TILE_COLUMNS;
    for (int i = 0; i < SHLIGHT_COLUMNS; i++) {
        shlight_tile *tile = tiles + i / SHLIGHT_TILE;
        for (int axis = 0; axis < 3; axis++) {
            const double moment = sum[i][axis] * (axis < 2 ? across : along);
            tile->moment[k][axis][row->target % SHLIGHT_TILE][i % SHLIGHT_TILE] += (float)moment;
            tile->total[k][axis] += (float)moment;
            blocks->total[k][axis] += moment;
        }
    }
}

/* The point of a tile that is farthest from its centre is a corner: the cosine of the distance falls with the difference in azimuth,
 * and along a meridian it is a cosine about a maximum less than a quarter turn away. */
static void shlight_bound_tiles(shlight_blocks *blocks) {
    const double pi = acos(-1.0), size = pi * SHLIGHT_TILE / SHLIGHT_ROWS, slack = 1e-6; /* for the rounding of float moments */
    for (int i = 0; i < SHLIGHT_TILES; i++) {
        shlight_tile *tile = &blocks->tile[i];
        const double polar = (i / SHLIGHT_TILE_COLUMNS + 0.5) * size, azimuth = -(i % SHLIGHT_TILE_COLUMNS + 0.5) * size;
        double cosine = 1.0;
        for (int end = -1; end <= 1; end += 2) {
            const double corner = polar + end * size / 2.0;
            cosine = fmin(cosine, cos(polar) * cos(corner) + sin(polar) * sin(corner) * cos(size / 2.0));
        }
        tile->center[0] = (float)(sin(polar) * cos(azimuth));
        tile->center[1] = (float)(sin(polar) * sin(azimuth));
        tile->center[2] = (float)cos(polar);
        tile->sine = (float)(sqrt(1.0 - cosine * cosine) + slack);
    }
}

/* Blocks of a clean image, row 0 at +z, columns clockwise from +x. Channel k counts scale[k] times. NULL: not enough memory. */
static shlight_blocks *shlight_blocks_new(const shlight_image *image, const double scale[3]) {
    const size_t pieces = (size_t)image->width + (size_t)image->height + SHLIGHT_COLUMNS + SHLIGHT_ROWS;
    shlight_blocks *blocks = (shlight_blocks *)calloc(1, sizeof *blocks);
    shlight_piece *column = (shlight_piece *)malloc(pieces * sizeof *column);
    double(*integral)[3] = (double(*)[3])malloc(pieces * sizeof *integral);
    if (blocks && column && integral) {
        const int columns = shlight_cut(image->width, SHLIGHT_COLUMNS, column);
        const shlight_piece *row = column + columns;
        const int rows = shlight_cut(image->height, SHLIGHT_ROWS, column + columns);
        blocks->channels = image->channels;
        shlight_bound_tiles(blocks);
        shlight_integrate_columns(column, columns, integral);
        for (int r = 0; r < rows; r++) {
            const float *texels = image->pixels + (size_t)row[r].source * (size_t)image->width * (size_t)image->channels;
            for (int k = 0; k < 3 && k < image->channels; k++) {
                shlight_row_sum sum;
                shlight_sum_row(texels, image->channels, k, column, columns, (const double(*)[3])integral, sum);
                shlight_add_row(row + r, scale[k] / acos(-1.0), (const double(*)[3])sum, k, blocks);
            }
        }
    } else {
        free(blocks);
        blocks = NULL;
    }
    free(integral);
    free(column);
    return blocks;
}

static float shlight_dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Channel k of a tile that the horizon of n may cut. */
static float shlight_cut_tile(const shlight_tile *tile, int k, const float n[3]) {
    const float nx = n[0], ny = n[1], nz = n[2];
    float lane[SHLIGHT_TILE] = { 0 }, sum = 0.0f;
    for (int row = 0; row < SHLIGHT_TILE; row++) {
        const float *x = tile->moment[k][0][row], *y = tile->moment[k][1][row], *z = tile->moment[k][2][row];
        for (int i = 0; i < SHLIGHT_TILE; i++) {
            const float t = nx * x[i] + ny * y[i] + nz * z[i];
            lane[i] += t > 0.0f ? t : 0.0f;
        }
    }
    for (int i = 0; i < SHLIGHT_TILE; i++)
        sum += lane[i];
    return sum;
}

/* Irradiance / pi at unit normal n, times the scale, of all channels. Float within a tile, double across them. */
static void shlight_irradiance(const shlight_blocks *blocks, const float n[3], float irradiance[3]) {
    double sum[3] = { 0.0, 0.0, 0.0 };
    for (int i = 0; i < SHLIGHT_TILES; i++) {
        const shlight_tile *tile = &blocks->tile[i];
        const float height = shlight_dot(tile->center, n);
        for (int k = 0; height > -tile->sine && k < blocks->channels; k++)
            /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): there are at most 3 channels */
            sum[k] += (double)(height >= tile->sine ? shlight_dot(tile->total[k], n) : shlight_cut_tile(tile, k, n));
    }
    for (int k = 0; k < blocks->channels; k++)
        irradiance[k] = (float)sum[k];
}

/* The same at -n, from that at n: max(0, t) - max(0, -t) = t, so that the two differ by n . (the sum of all moments). */
static void shlight_irradiance_opposite(const shlight_blocks *blocks, const float n[3], const float irradiance[3],
                                        float opposite[3]) {
    for (int k = 0; k < blocks->channels; k++) {
        const double *m = blocks->total[k];
        opposite[k] = (float)((double)irradiance[k] - (m[0] * (double)n[0] + m[1] * (double)n[1] + m[2] * (double)n[2]));
    }
}

#endif /* SHLIGHT_REFERENCE_H */
