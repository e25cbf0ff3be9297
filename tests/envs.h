/* envs.h - the measured panoramas that the models of irradiance are judged by: reading PFM, reducing to 128 x 64 texels with exact
 * areas, and irradiance by summing all texels. In double, by definition. */
#ifndef ENVS_H
#define ENVS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ENVS_WIDTH = 128, ENVS_HEIGHT = 64, ENVS_TEXELS = ENVS_WIDTH * ENVS_HEIGHT };

static const double envs_pi = 3.14159265358979323846;

/* Texels as directions with a share of the sphere, and their radiance by channel. */
typedef struct envs_light {
    float dir[ENVS_TEXELS][3];
    double weight[ENVS_TEXELS];
    double value[3][ENVS_TEXELS];
} envs_light;

/* An RGB PFM file, top row first, to be freed; NULL where it cannot be read. */
static inline float *envs_read_pfm(const char *path, int *width, int *height) {
    FILE *file = fopen(path, "rb");
    float scale = 0.0f, *pixels = NULL;
    if (!file)
        return NULL;
    if (fscanf(file, "PF %d %d %f", width, height, &scale) == 3 && fgetc(file) != EOF && scale < 0.0f && *width > 0 &&
        *height > 0) {
        const size_t row = 3 * (size_t)*width;
        pixels = (float *)malloc(row * (size_t)*height * sizeof *pixels);
        for (int y = *height - 1; pixels && y >= 0; y--)
            if (fread(pixels + (size_t)y * row, sizeof *pixels, row, file) != row) {
                free(pixels);
                pixels = NULL;
            }
    }
    fclose(file);
    return pixels;
}

/* The share of the sphere of a texel in row y of `height`, `width` to a row. */
static inline double envs_area(int y, int width, int height) {
    return (cos(envs_pi * y / height) - cos(envs_pi * (y + 1) / height)) / (2.0 * width);
}

/* The centre of texel i, row by row from +z. */
static inline void envs_texel_direction(int i, float dir[3]) {
    const double polar = envs_pi * (i / ENVS_WIDTH + 0.5) / (int)ENVS_HEIGHT;
    const double azimuth = 2.0 * envs_pi * (i % ENVS_WIDTH + 0.5) / (int)ENVS_WIDTH;
    dir[0] = (float)(sin(polar) * cos(azimuth));
    dir[1] = (float)(sin(polar) * sin(azimuth));
    dir[2] = (float)cos(polar);
}

/* Reduces a panorama whose sides are multiples of 128 x 64, negative values counting as 0. Returns 0 if they are not. */
static inline int envs_reduce(const float *pixels, int width, int height, envs_light *light) {
    const int nx = width / ENVS_WIDTH, ny = height / ENVS_HEIGHT;
    if (nx < 1 || ny < 1 || nx * ENVS_WIDTH != width || ny * ENVS_HEIGHT != height)
        return 0;
    memset(light, 0, sizeof *light);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int k = 0; k < 3; k++) {
                const double value = (double)pixels[((size_t)y * (size_t)width + (size_t)x) * 3 + (size_t)k];
                const int texel = y / ny * ENVS_WIDTH + x / nx;
                light->value[k][texel] += value > 0.0 ? value * envs_area(y, width, height) : 0.0;
            }
    for (int y = 0; y < ENVS_HEIGHT; y++)
        for (int x = 0; x < ENVS_WIDTH; x++) {
            const int texel = y * ENVS_WIDTH + x;
            light->weight[texel] = envs_area(y, ENVS_WIDTH, ENVS_HEIGHT);
            for (int k = 0; k < 3; k++)
                light->value[k][texel] /= light->weight[texel];
            envs_texel_direction(texel, light->dir[texel]);
        }
    return 1;
}

/* Reads and reduces; 0 if that fails. */
static inline int envs_load(const char *path, envs_light *light) {
    int width, height, done;
    float *pixels = envs_read_pfm(path, &width, &height);
    if (!pixels)
        return 0;
    done = envs_reduce(pixels, width, height, light);
    free(pixels);
    return done;
}

/* The moments of the texels as point lights, in the order of sh.h. */
static inline void envs_moments(const envs_light *light, int channel, float c[9]) {
    double sum[9] = { 0 };
    for (int i = 0; i < ENVS_TEXELS; i++) {
        const double v = light->weight[i] * light->value[channel][i];
        const double x = (double)light->dir[i][0], y = (double)light->dir[i][1], z = (double)light->dir[i][2], third = 1.0 / 3.0;
        const double basis[9] = { 1.0, x, y, z, x * x - third, x * y, x * z, y * y - third, y * z };
        for (int j = 0; j < 9; j++)
            sum[j] += v * basis[j];
    }
    for (int j = 0; j < 9; j++)
        c[j] = (float)sum[j];
}

/* Irradiance / pi of the texels as point lights. */
static inline void envs_irradiance(const envs_light *light, const float n[3], double out[3]) {
    out[0] = out[1] = out[2] = 0.0;
    for (int i = 0; i < ENVS_TEXELS; i++) {
        const float *d = light->dir[i];
        const double cosine = (double)n[0] * (double)d[0] + (double)n[1] * (double)d[1] + (double)n[2] * (double)d[2];
        if (cosine > 0.0)
            for (int k = 0; k < 3; k++)
                out[k] += 4.0 * cosine * light->weight[i] * light->value[k][i];
    }
}

#endif /* ENVS_H */
