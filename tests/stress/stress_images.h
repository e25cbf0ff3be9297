/* stress_images.h - projection of small images, texel by texel: every float of them is searched. */
#ifndef STRESS_IMAGES_H
#define STRESS_IMAGES_H

#include "../square_maps.h"
#include "stress.h"

/* A layout, with its texels' moments once they are known. */
typedef struct stress_image {
    int width, height, channels;
    unsigned flags;
    long double *moment; /* nine per texel */
} stress_image;

static inline void stress_image_compare(stress_measure *m, const stress_image *map, int texels, const float *in, const float *c) {
    m->allowance += ldexpl(texels, -149); /* of weights times texels */
    for (int k = 0; k < map->channels; k++) {
        long double sum[9] = { 0.0L }, size = 0.0L;
        for (int i = 0; i < texels; i++) {
            const float texel = in[i * map->channels + k];
            const long double value = map->flags & SH_CLAMP_NEGATIVE && texel < 0.0f ? 0.0L : (long double)texel;
            size += map->moment[9 * i] * fabsl(value);
            for (int j = 0; j < 9; j++)
                sum[j] += map->moment[9 * i + j] * value;
        }
        stress_compare_all(m, c + 9 * k, sum, 9, size);
    }
}

static inline void stress_panorama(const float *in, stress_measure *m, stress_image *map) {
    const sh_image image = { in, map->width, map->height, 0, map->channels, SH_F32 };
    const int texels = map->width * map->height;
    float c[27];
    if (!map->moment) {
        oracle_trig *rows = oracle_axis(map->height, 1, map->flags), *columns = oracle_axis(map->width, 0, map->flags);
        map->moment = (long double *)test_allocate((size_t)texels * 9 * sizeof *map->moment);
        for (int i = 0; i < texels; i++)
            oracle_texel_moments(&rows[i / map->width], &columns[i % map->width], map->flags, map->moment + 9 * i);
        free(rows);
        free(columns);
    }
    stress_require(m, sh_project_equirect(SH_L2, &image, map->flags, c, NULL) == SH_OK);
    stress_image_compare(m, map, texels, in, c);
}

/* A map of `faces` square images. */
static inline void stress_square(const float *in, stress_measure *m, const square_map *square, stress_image *map) {
    const int size = map->width, texels = square->images * size * size;
    sh_image face[6];
    float c[27];
    for (int i = 0; i < square->images; i++) {
        const sh_image one = { in + i * size * size * map->channels, size, size, 0, map->channels, SH_F32 };
        face[i] = one;
    }
    if (!map->moment) {
        map->moment = (long double *)test_allocate((size_t)texels * 9 * sizeof *map->moment);
        for (int i = 0; i < texels; i++) {
            const int x = i % size, y = i / size % size;
            const long double weight = square_weight(square, size, x, y);
            long double dir[3];
            square_direction(square, size, i / (size * size), x, y, dir);
            oracle_basis(dir, map->moment + 9 * i);
            for (int j = 0; j < 9; j++)
                map->moment[9 * i + j] *= weight;
        }
    }
    stress_require(m, (square->images == 6 ? sh_project_cubemap(SH_L2, face, map->flags, c, NULL)
                                           : sh_project_octahedral(SH_L2, face, map->flags, c, NULL)) == SH_OK);
    stress_image_compare(m, map, texels, in, c);
}

static inline void stress_equirect(const float *in, stress_measure *m) {
    static stress_image map = { 32, 16, 1, 0, NULL };
    stress_panorama(in, m, &map);
}

static inline void stress_equirect_odd(const float *in, stress_measure *m) {
    static stress_image map = { 17, 9, 1, SH_CLAMP_NEGATIVE | SH_CLOCKWISE, NULL };
    stress_panorama(in, m, &map);
}

static inline void stress_equirect_rgb(const float *in, stress_measure *m) {
    static stress_image map = { 16, 9, 3, 0, NULL };
    stress_panorama(in, m, &map);
}

static inline void stress_equirect_points(const float *in, stress_measure *m) {
    static stress_image map = { 24, 12, 1, SH_POINT_TEXELS, NULL };
    stress_panorama(in, m, &map);
}

static const square_map stress_cube_map = { "cube map", 6, NULL, NULL, cube_point, cube_share, 0.0L, 1 };
static const square_map stress_octahedron_map = { "octahedral map", 1, NULL, NULL, octahedron_point, octahedron_share, 0.0L, 0 };

static inline void stress_cubemap(const float *in, stress_measure *m) {
    static stress_image map = { 8, 8, 1, 0, NULL };
    stress_square(in, m, &stress_cube_map, &map);
}

static inline void stress_cubemap_rgb(const float *in, stress_measure *m) {
    static stress_image map = { 3, 3, 3, 0, NULL };
    stress_square(in, m, &stress_cube_map, &map);
}

static inline void stress_octahedral(const float *in, stress_measure *m) {
    static stress_image map = { 16, 16, 1, 0, NULL };
    stress_square(in, m, &stress_octahedron_map, &map);
}

static inline void stress_octahedral_rgb(const float *in, stress_measure *m) {
    static stress_image map = { 7, 7, 3, SH_CLAMP_NEGATIVE, NULL };
    stress_square(in, m, &stress_octahedron_map, &map);
}

static const stress_case stress_image_cases[] = {
    { "sh_project_equirect, 32 x 16", "1e-6 of the mean of |radiance|",
      STRESS_RELATIVE, 1e-6, { TEXELS(512) }, stress_equirect, 60 },
    { "sh_project_equirect, 17 x 9, clamped, clockwise", "1e-6 of the mean of |radiance|",
      STRESS_RELATIVE, 1e-6, { TEXELS(153) }, stress_equirect_odd, 20 },
    { "sh_project_equirect, RGB 16 x 9", "1e-6 of the mean of |radiance|",
      STRESS_RELATIVE, 1e-6, { TEXELS(432) }, stress_equirect_rgb, 50 },
    { "sh_project_equirect, 24 x 12, SH_POINT_TEXELS", "1e-6 of the mean of |radiance|",
      STRESS_RELATIVE, 1e-6, { TEXELS(288) }, stress_equirect_points, 40 },
    { "sh_project_cubemap, 8 x 8 x 6", "2e-6 of the mean of |radiance|: weights and sums",
      STRESS_RELATIVE, 2e-6, { TEXELS(384) }, stress_cubemap, 50 },
    { "sh_project_cubemap, RGB 3 x 3 x 6", "2e-6 of the mean of |radiance|: weights and sums",
      STRESS_RELATIVE, 2e-6, { TEXELS(162) }, stress_cubemap_rgb, 40 },
    { "sh_project_octahedral, 16 x 16", "6e-6 of the mean of |radiance|: weights and sums",
      STRESS_RELATIVE, 6e-6, { TEXELS(256) }, stress_octahedral, 40 },
    { "sh_project_octahedral, RGB 7 x 7, clamped", "6e-6 of the mean of |radiance|: weights and sums",
      STRESS_RELATIVE, 6e-6, { TEXELS(147) }, stress_octahedral_rgb, 40 },
};

#endif /* STRESS_IMAGES_H */
