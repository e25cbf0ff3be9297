/* square.h - cube maps and octahedral maps: their moments by definition, in long double, and the tests that both must pass. */
#ifndef TEST_SQUARE_H
#define TEST_SQUARE_H

#include <limits.h>

#include "images.h"

enum { SQUARE_IMAGES = 6 };

/* A map of `images` square images, u and v in [-1, 1] from their left and upper edges. */
typedef struct square_map {
    const char *name;
    int images;
    int (*project)(int order, const sh_image *image, unsigned flags, float *c, sh_report *report);
    int (*rows)(int order, const sh_image *image, unsigned flags, int first, int count, sh_accum *accum, sh_report *report);
    void (*point)(int image, long double u, long double v, long double at[3]);            /* of any length */
    long double (*share)(long double u0, long double u1, long double v0, long double v1); /* of the sphere, of a rectangle */
    long double weight_tolerance;                                                         /* of a weight itself */
    int even;                                                                             /* all three axes are alike */
} square_map;

/* ---- By definition ---- */

/* Of the mean of |radiance|, with some to spare below the contract's 1e-6. */
static const long double square_tolerance = 3e-7L;

/* Of one row of thousands of equal texels: where vectors have few lanes, each adds up many of them in float. */
static const long double square_row_tolerance = 2e-6L;

/* Errors of the weights average out, but not those of the few texels of a map whose axes differ. */
static inline long double square_sum_tolerance(const square_map *map, int size) {
    return size > 8 || map->even ? square_tolerance : square_tolerance + map->weight_tolerance;
}

static inline void square_normalize(long double v[3]) {
    const long double length = sqrtl(oracle_dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* The share of the sphere of the triangle of three directions of any length. Van Oosterom and Strackee, "The Solid Angle of a Plane
 * Triangle", eq. 8. */
static inline long double square_triangle(const long double a[3], const long double b[3], const long double c[3]) {
    const long double *from[3] = { a, b, c };
    long double v[3][3];
    for (int i = 0; i < 3; i++) {
        memcpy(v[i], from[i], sizeof v[i]);
        square_normalize(v[i]);
    }
    long double edge[2][3]; /* differences lose nothing of small triangles */
    for (int i = 0; i < 3; i++) {
        edge[0][i] = v[1][i] - v[0][i];
        edge[1][i] = v[2][i] - v[0][i];
    }
    long double triple = 0.0L;
    for (int i = 0; i < 3; i++)
        triple += v[0][i] * (edge[0][(i + 1) % 3] * edge[1][(i + 2) % 3] - edge[0][(i + 2) % 3] * edge[1][(i + 1) % 3]);
    const long double rest = 1.0L + oracle_dot(v[0], v[1]) + oracle_dot(v[1], v[2]) + oracle_dot(v[2], v[0]);
    return atan2l(fabsl(triple), rest) / (2.0L * oracle_pi);
}

/* The middle, or the left or upper edge, of a texel. */
static inline long double square_middle(int size, int x) {
    return (long double)(2 * x + 1 - size) / size;
}

static inline long double square_edge(int size, int x) {
    return (long double)(2 * x - size) / size;
}

static inline long double square_weight(const square_map *map, int size, int x, int y) {
    return map->share(square_edge(size, x), square_edge(size, x + 1), square_edge(size, y), square_edge(size, y + 1));
}

static inline void square_direction(const square_map *map, int size, int image, int x, int y, long double dir[3]) {
    map->point(image, square_middle(size, x), square_middle(size, y), dir);
    square_normalize(dir);
}

/* Weights of all texels of one image; all images have the same. Free the result. */
static inline long double *square_weights(const square_map *map, int size) {
    long double *weight = (long double *)test_allocate((size_t)size * (size_t)size * sizeof(long double));
    for (int i = 0; i < size * size; i++)
        weight[i] = square_weight(map, size, i % size, i / size);
    return weight;
}

/* Moments of rows [first, first + count) of all images. */
static inline oracle_projection square_oracle(const square_map *map, const long double *weight, const sh_image *image, unsigned flags,
                                              int first, int count) {
    const int size = image->width;
    oracle_projection projection;
    memset(&projection, 0, sizeof projection);
    for (int i = 0; i < map->images; i++)
        for (int y = first; y < first + count; y++)
            for (int x = 0; x < size; x++) {
                long double value[3], dir[3], moment[9];
                square_direction(map, size, i, x, y, dir);
                oracle_basis(dir, moment);
                for (int k = 0; k < 9; k++)
                    moment[k] *= weight[y * size + x];
                oracle_texel(&image[i], x, y, value);
                oracle_projection_add(value, oracle_colours(image), moment, flags, &projection);
            }
    return projection;
}

/* ---- Images ---- */

/* The images of a map, those of sh.h in an array of their own. */
typedef struct square_images {
    int count, size;
    test_image of[SQUARE_IMAGES];
    sh_image image[SQUARE_IMAGES];
} square_images;

static inline square_images square_create(const square_map *map, int size, int channels, sh_format format, test_layout layout) {
    square_images all;
    all.count = map->images;
    all.size = size;
    for (int i = 0; i < map->images; i++) {
        all.of[i] = test_image_create(size, size, channels, format, layout);
        all.image[i] = all.of[i].image;
    }
    return all;
}

static inline square_images square_random(const square_map *map, int size, int channels, double low, double high) {
    square_images all = square_create(map, size, channels, SH_F32, test_tight);
    for (int i = 0; i < map->images; i++)
        test_image_fill(&all.of[i], low, high);
    return all;
}

static inline void square_free(square_images *all) {
    for (int i = 0; i < all->count; i++)
        test_image_free(&all->of[i]);
}

/* Colour k of all texels. */
static inline void square_set_all(const square_images *all, int k, float value) {
    for (int i = 0; i < all->count; i++)
        for (int n = 0; n < all->size * all->size; n++)
            test_image_set(&all->of[i], n % all->size, n / all->size, k, value);
}

/* Colour k of any texel. */
static inline void square_set_any(const square_images *all, int k, float value) {
    test_image_set(&all->of[test_below(all->count)], test_below(all->size), test_below(all->size), k, value);
}

/* A light at the middle of each texel. */
static inline square_images square_render(const square_map *map, int size, oracle_light light, const void *user) {
    square_images all = square_create(map, size, 1, SH_F32, test_tight);
    for (int i = 0; i < all.count; i++)
        for (int n = 0; n < size * size; n++) {
            long double dir[3];
            square_direction(map, size, i, n % size, n / size, dir);
            test_image_set(&all.of[i], n % size, n / size, 0, (float)light(dir, user));
        }
    return all;
}

/* ---- Against the oracle ---- */

static inline void square_near(int order, int channels, const float *c, const oracle_projection *expected, long double tolerance) {
    for (int k = 0; k < channels; k++)
        NEAR_ALL(c + k * SH_COUNT(order), expected->c[k], SH_COUNT(order), tolerance * expected->magnitude[k]);
}

/* Projects with a report and without: coefficients and counts. */
static inline void square_check(const square_map *map, const long double *weight, const sh_image *image, unsigned flags) {
    const oracle_projection expected = square_oracle(map, weight, image, flags, 0, image->height);
    float c[3 * 9], again[3 * 9];
    sh_report report = { 9, 9, 9 };
    EQUAL(map->project(SH_L2, image, flags, c, &report), SH_OK);
    square_near(SH_L2, sh_image_channels(image), c, &expected, square_sum_tolerance(map, image->width));
    EQUAL(report.texels, expected.texels);
    EQUAL(report.nonfinite, expected.nonfinite);
    EQUAL(report.negative, expected.negative);
    EQUAL(map->project(SH_L2, image, flags, again, NULL), SH_OK);
    SAME_BITS(c, again, (size_t)(sh_image_channels(image) * 9) * sizeof(float));
}

/* Lower orders are the first bits of higher ones, and write nothing more. */
static inline void square_check_prefix(const square_map *map, const sh_image *image) {
    const size_t channels = (size_t)sh_image_channels(image);
    float all[3 * 9];
    EQUAL(map->project(SH_L2, image, 0, all, NULL), SH_OK);
    for (int order = SH_L0; order <= SH_L1; order++) {
        const size_t count = (size_t)SH_COUNT(order);
        float few[3 * 9 + 1], guard;
        memset(few, 0x55, sizeof few);
        memset(&guard, 0x55, sizeof guard);
        EQUAL(map->project(order, image, 0, few, NULL), SH_OK);
        for (size_t k = 0; k < channels; k++)
            SAME_BITS(few + k * count, all + k * 9, count * sizeof(float));
        SAME_BITS(&few[channels * count], &guard, sizeof guard);
    }
}

static inline void square_sizes(const square_map *map) {
    static const int sizes[] = { 1, 2, 3, 4, 5, 7, 8, 15, 16, 17, 31, 32, 33, 64, 100, 128, 129 };
    static const int channels[] = { 1, 3, 4 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s];
        long double *weight = square_weights(map, size), sum = 0.0L;
        for (int i = 0; i < size * size; i++)
            sum += map->images * weight[i];
        test_section("%s of %d: the oracle's weights", map->name, size);
        NEAR(sum, 1.0, size <= 8 ? 1e-14L : 1e-12L);
        for (int i = 0; i < (size < 64 ? 6 : 3); i++) {
            const double low = i < 3 ? 0.0 : -1.0;
            square_images all = square_random(map, size, channels[i % 3], low, 1.0);
            for (unsigned flags = 0; flags <= SH_CLAMP_NEGATIVE; flags++) {
                test_section("%s of %d, %d channels, values from %g, flags %u", map->name, size, channels[i % 3], low, flags);
                if (flags == 0 || low < 0.0)
                    square_check(map, weight, all.image, flags);
            }
            square_check_prefix(map, all.image);
            square_free(&all);
        }
        free(weight);
    }
}

/* The weight of a texel, as the sum over an image with that texel only lit; its row is projected alone. */
static inline void square_check_weight(const square_map *map, const square_images *all, int image, int x, int y) {
    const long double expected = square_weight(map, all->size, x, y);
    long double dir[3];
    sh_accum accum;
    square_direction(map, all->size, image, x, y, dir);
    test_image_set(&all->of[image], x, y, 0, 1.0f);
    sh_accum_clear(1, &accum);
    EQUAL(map->rows(SH_L2, all->image, 0, y, 1, &accum, NULL), SH_OK);
    test_image_set(&all->of[image], x, y, 0, 0.0f);
    RELATIVE(accum.sum[0], expected, map->weight_tolerance);
    for (int i = 0; i < 3; i++)
        NEAR(accum.sum[1 + i], accum.sum[0] * (double)dir[i], square_tolerance * (long double)accum.sum[0]);
}

static inline void square_all_weights(const square_map *map) {
    static const int sizes[] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 15, 16, 17, 31, 32, 33, 63, 64, 65, 96 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s];
        square_images all = square_create(map, size, 1, SH_F32, test_tight);
        test_section("%s of %d: each weight", map->name, size);
        square_set_all(&all, 0, 0.0f);
        for (int n = 0; n < size * size; n++)
            square_check_weight(map, &all, n % map->images, n % size, n / size);
        square_free(&all);
    }
}

/* Rows of maps too large to look at every texel: memory is touched where it is read. */
static inline void square_large_weights(const square_map *map) {
    static const int sizes[] = { 1024, 2048, 2049, 8192 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s], rows[] = { 0, 1, size / 3, size / 2 - 1, size / 2, size - 1 };
        const int columns[] = { 0, 1, size / 4, size / 3, size / 2, size - 2, size - 1 };
        unsigned char *bytes = (unsigned char *)test_allocate((size_t)size * (size_t)size);
        sh_image image[SQUARE_IMAGES];
        for (int i = 0; i < map->images; i++) {
            const sh_image one = { bytes, size, size, 0, 1, SH_SRGB8 };
            image[i] = one;
        }
        for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
            unsigned char *row = bytes + (size_t)rows[r] * (size_t)size;
            long double share = 0.0L;
            sh_accum accum;
            test_section("%s of %d, row %d", map->name, size, rows[r]);
            for (int x = 0; x < size; x++)
                share += map->images * square_weight(map, size, x, rows[r]);
            memset(row, 255, (size_t)size);
            sh_accum_clear(1, &accum);
            EQUAL(map->rows(SH_L2, image, 0, rows[r], 1, &accum, NULL), SH_OK);
            RELATIVE(accum.weight, share, map->weight_tolerance);
            RELATIVE(accum.sum[0], accum.weight, square_row_tolerance);
            memset(row, 0, (size_t)size);
            for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++) {
                row[columns[i]] = 255;
                sh_accum_clear(1, &accum);
                EQUAL(map->rows(SH_L2, image, 0, rows[r], 1, &accum, NULL), SH_OK);
                RELATIVE(accum.sum[0], map->images * square_weight(map, size, columns[i], rows[r]), map->weight_tolerance);
                row[columns[i]] = 0;
            }
        }
        free(bytes);
    }
}

/* Nothing but the mean of a constant map is left, to 1e-7 of it where there are many texels; where not all axes are alike, to the
 * error of light from the middles of texels. All images share their memory. */
static inline void square_constants(const square_map *map) {
    static const int more[] = { 63, 64, 65, 96, 100, 127, 128, 129, 200, 255, 256, 257, 300, 511, 512, 513, 777, 1000, 1024 };
    enum { SMALL = 50, MORE = sizeof more / sizeof more[0] };
    for (int i = 0; i < SMALL + MORE; i++) {
        const int size = i < SMALL ? i + 1 : more[i - SMALL];
        const float value = i % 2 ? 0.7f : 123.4f;
        test_image of = test_image_create(size, size, 1, SH_F32, test_tight);
        sh_image image[SQUARE_IMAGES];
        float c[9];
        test_section("%s of %d: a constant", map->name, size);
        for (int n = 0; n < size * size; n++)
            test_image_set(&of, n % size, n / size, 0, value);
        for (int k = 0; k < map->images; k++)
            image[k] = of.image;
        EQUAL(map->project(SH_L2, image, 0, c, NULL), SH_OK);
        RELATIVE(c[0], value, 1e-7L);
        for (int k = 1; k < 9; k++) {
            const int exact = map->even || (k < SH_XX && size % 2 == 0);
            NEAR(c[k], 0.0, (!exact ? 1.0L / size / size : size < 9 ? square_tolerance : 1e-7L) * (long double)value);
        }
        test_image_free(&of);
    }
}

/* ---- Texels ---- */

/* Rows far apart, texels and rows at odd addresses: the same bits as from a tight image. */
static inline void square_check_layout(const square_map *map, sh_format format, int channels, test_layout layout) {
    const int size = 37;
    square_images tight = square_create(map, size, channels, format, test_tight);
    square_images loose = square_create(map, size, channels, format, layout);
    const size_t row = oracle_texel_size(tight.image) * (size_t)size;
    float a[3 * 9], b[3 * 9];
    test_section("%s, %s, %d channels, offset %d, padding %d", map->name, test_format_names[format], channels, (int)layout.offset,
                 (int)layout.padding);
    for (int i = 0; i < map->images; i++) {
        test_image_fill(&tight.of[i], -1.0, 1.0);
        for (int y = 0; y < size; y++)
            memcpy(test_texel(&loose.of[i], 0, y), test_texel(&tight.of[i], 0, y), row);
    }
    EQUAL(map->project(SH_L2, tight.image, 0, a, NULL), SH_OK);
    EQUAL(map->project(SH_L2, loose.image, 0, b, NULL), SH_OK);
    SAME_BITS(a, b, (size_t)(sh_image_channels(tight.image) * 9) * sizeof(float));
    square_free(&tight);
    square_free(&loose);
}

static inline void square_layouts(const square_map *map) {
    static const test_layout list[] = { { 0, 4 }, { 0, 64 }, { 1, 0 }, { 2, 3 }, { 3, 1001 } };
    for (int format = 0; format < TEST_FORMATS; format++)
        for (int channels = 1; channels <= 4; channels++)
            for (size_t i = 0; channels != 2 && i < sizeof list / sizeof list[0]; i++)
                if (test_format_has((sh_format)format, channels))
                    square_check_layout(map, (sh_format)format, channels, list[i]);
}

/* Each format against the oracle, and against the floats that it stands for. */
static inline void square_check_format(const square_map *map, const long double *weight, int size, int channels, sh_format format) {
    square_images all = square_create(map, size, channels, format, test_tight);
    square_images floats = square_create(map, size, channels, SH_F32, test_tight);
    float a[3 * 9], b[3 * 9];
    test_section("%s of %d, %s, %d channels", map->name, size, test_format_names[format], channels);
    for (int i = 0; i < map->images; i++) {
        test_image_fill(&all.of[i], 0.0, 1.0);
        for (int n = 0; n < size * size; n++) {
            long double value[3];
            oracle_texel(&all.image[i], n % size, n / size, value);
            for (int k = 0; k < oracle_colours(all.image); k++)
                test_image_set(&floats.of[i], n % size, n / size, k, (float)value[k]);
        }
    }
    square_check(map, weight, all.image, 0);
    const oracle_projection expected = square_oracle(map, weight, all.image, 0, 0, size);
    EQUAL(map->project(SH_L2, all.image, 0, a, NULL), SH_OK);
    EQUAL(map->project(SH_L2, floats.image, 0, b, NULL), SH_OK);
    for (int k = 0; k < oracle_colours(all.image); k++)
        NEAR_ALL(a + k * 9, b + k * 9, 9, 2e-7L * expected.magnitude[k]); /* two sets of roundings */
    square_free(&all);
    square_free(&floats);
}

static inline void square_formats(const square_map *map) {
    static const int sizes[] = { 6, 45 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        long double *weight = square_weights(map, sizes[s]);
        for (int format = SH_F16; format < TEST_FORMATS; format++)
            for (int channels = 1; channels <= 4; channels++)
                if (channels != 2 && test_format_has((sh_format)format, channels))
                    square_check_format(map, weight, sizes[s], channels, (sh_format)format);
        free(weight);
    }
}

/* A bad texel costs itself only, wherever it is and however many there are. */
static inline void square_not_finite(const square_map *map) {
    const float bad[] = { (float)NAN, -(float)NAN, (float)INFINITY, -(float)INFINITY };
    static const int sizes[] = { 1, 3, 8, 21 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s];
        long double *weight = square_weights(map, size);
        for (int i = 0; i < 24; i++) {
            const int channels = i % 3 == 0 ? 1 : 2 + i % 3, count = i % 6 == 0 ? 20 * size * size : 1 + test_below(5);
            square_images all = square_random(map, size, channels, i % 2 ? -1.0 : 0.0, 1.0);
            for (int n = 0; n < count; n++)
                square_set_any(&all, test_below(oracle_colours(all.image)), bad[test_below(4)]);
            for (unsigned flags = 0; flags <= SH_CLAMP_NEGATIVE; flags++) {
                test_section("%s of %d, %d channels, %d times not finite, flags %u", map->name, size, channels, count, flags);
                square_check(map, weight, all.image, flags);
            }
            square_free(&all);
        }
        free(weight);
    }
}

/* Sums that overflow a float, and values that are barely normal: the same relative accuracy. */
static inline void square_magnitudes(const square_map *map) {
    static const double scales[] = { 3.4e38, 1e30, 1e-30 };
    long double *weight = square_weights(map, 19);
    for (size_t s = 0; s < sizeof scales / sizeof scales[0]; s++)
        for (int i = 0; i < 6; i++) {
            square_images all = square_random(map, 19, i % 2 ? 3 : 4, i % 3 ? 0.5 * scales[s] : -scales[s], scales[s]);
            test_section("%s, magnitude %g", map->name, scales[s]);
            if (i == 5)
                square_set_any(&all, 0, (float)NAN);
            square_check(map, weight, all.image, i == 3 ? SH_CLAMP_NEGATIVE : 0);
            square_free(&all);
        }
    free(weight);
}

/* Alpha may hold anything at all. */
static inline void square_alpha(const square_map *map) {
    const float values[] = { (float)NAN, (float)INFINITY, -1.0f, 3e38f };
    long double *weight = square_weights(map, 11);
    for (int i = 0; i < 4; i++) {
        square_images all = square_random(map, 11, 4, 0.0, 1.0);
        test_section("%s, alpha of %g", map->name, (double)values[i]);
        square_set_all(&all, 3, values[i]);
        square_check(map, weight, all.image, 0);
        square_free(&all);
    }
    free(weight);
}

/* ---- Rows ---- */

/* In any parts, in any order, by any number of accumulators, reports add up; parts alone are what they are by definition. */
static inline void square_rows(const square_map *map) {
    static const int sizes[] = { 1, 2, 9, 24, 37 };
    for (int repeat = 0; repeat < 60; repeat++) {
        const int size = sizes[repeat % 5], cut = test_below(size + 1), second = cut + test_below(size + 1 - cut);
        const int bounds[4] = { 0, cut, second, size };
        square_images all = square_random(map, size, 3, -0.2, 1.0);
        long double *weight = square_weights(map, size);
        float whole[3 * 9], c[3 * 9];
        sh_accum accum[3], part[3];
        sh_report report = { 0, 0, 0 };
        test_section("%s of %d, rows split at %d and %d", map->name, size, cut, second);
        if (size > 2)
            square_set_any(&all, test_below(3), (float)INFINITY);
        const oracle_projection expected = square_oracle(map, weight, all.image, 0, 0, size);
        const oracle_projection some = square_oracle(map, weight, all.image, 0, cut, second - cut);
        sh_accum_clear(3, accum);
        for (int i = 2; i >= 0; i--) {
            sh_accum_clear(3, part);
            EQUAL(map->rows(SH_L2, all.image, 0, bounds[i], bounds[i + 1] - bounds[i], part, &report), SH_OK);
            sh_accum_merge(3, part, accum);
            if (i == 1) {
                sh_accum_total(SH_L2, 3, part, c);
                square_near(SH_L2, 3, c, &some, square_tolerance + map->weight_tolerance);
            }
        }
        EQUAL(map->project(SH_L2, all.image, 0, whole, NULL), SH_OK);
        NEAR(accum[0].weight, 1.0, map->weight_tolerance);
        sh_accum_finish(SH_L2, 3, accum, c);
        square_near(SH_L2, 3, c, &expected, square_sum_tolerance(map, size));
        for (int k = 0; k < 3; k++)
            NEAR_ALL(c + k * 9, whole + k * 9, 9, 2e-7L * expected.magnitude[k]); /* two sets of roundings */
        EQUAL(report.texels, expected.texels);
        EQUAL(report.nonfinite, expected.nonfinite);
        EQUAL(report.negative, expected.negative);
        free(weight);
        square_free(&all);
    }
}

/* ---- Errors ---- */

/* An image, and what is to be projected of it. */
typedef struct square_request {
    const char *name;
    int expected;
    sh_image image;
    int order;
    unsigned flags;
    int first_row, row_count;
    int only; /* the number of the image that is so, or -1: all are */
} square_request;

enum { SQUARE_ERROR_SIZE = 8 };

/* Each call fails with the expected error, and writes to none of its outputs. */
static inline void square_check_error(const square_map *map, const square_request *r, const sh_image *good) {
    float c[3 * 9], c_before[3 * 9];
    sh_accum accum[3], accum_before[3];
    sh_report report, report_before;
    sh_image image[SQUARE_IMAGES];
    for (int i = 0; i < map->images; i++)
        image[i] = r->only < 0 || r->only == i ? r->image : *good;
    memset(c, 0x55, sizeof c);
    memset(accum, 0x55, sizeof accum);
    memset(&report, 0x55, sizeof report);
    memcpy(c_before, c, sizeof c);
    memcpy(accum_before, accum, sizeof accum);
    memcpy(&report_before, &report, sizeof report);
    test_section("%s: %s", map->name, r->name);
    if (r->first_row == 0 && r->row_count == SQUARE_ERROR_SIZE)
        EQUAL(map->project(r->order, image, r->flags, c, &report), r->expected);
    EQUAL(map->rows(r->order, image, r->flags, r->first_row, r->row_count, accum, &report), r->expected);
    SAME_BITS(c, c_before, sizeof c);
    SAME_BITS(accum, accum_before, sizeof accum);
    SAME_BITS(&report, &report_before, sizeof report);
}

static inline void square_errors(const square_map *map) {
    static const float pixels[9 * 9 * 4] = { 1.0f };
    const int argument = SH_ERROR_ARGUMENT, size = SH_ERROR_SIZE, format = SH_ERROR_FORMAT, last = map->images - 1;
    const size_t huge = SIZE_MAX - 3u;
    const square_request requests[] = {
        { "pixels NULL", argument, { NULL, 8, 8, 0, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "pixels of the last NULL", argument, { NULL, 8, 8, 0, 3, SH_F32 }, 2, 0, 0, 8, last },
        { "order -1", argument, { pixels, 8, 8, 0, 3, SH_F32 }, -1, 0, 0, 8, -1 },
        { "order 3", argument, { pixels, 8, 8, 0, 3, SH_F32 }, 3, 0, 0, 8, -1 },
        { "points", argument, { pixels, 8, 8, 0, 3, SH_F32 }, 2, SH_POINT_TEXELS, 0, 8, -1 },
        { "clockwise", argument, { pixels, 8, 8, 0, 3, SH_F32 }, 2, SH_CLOCKWISE, 0, 8, -1 },
        { "all flags", argument, { pixels, 8, 8, 0, 3, SH_F32 }, 2, ~0u, 0, 8, -1 },
        { "size 0", size, { pixels, 0, 0, 0, 3, SH_F32 }, 2, 0, 0, 0, -1 },
        { "width -8", size, { pixels, -8, 8, 0, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "height -1", size, { pixels, 8, -1, 0, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "8 x 9", size, { pixels, 8, 9, 0, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "9 x 8", size, { pixels, 9, 8, 0, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "stride a byte short", size, { pixels, 8, 8, 8 * 12 - 1, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "stride of the last a byte short", size, { pixels, 8, 8, 8 * 12 - 1, 3, SH_F32 }, 2, 0, 0, 8, last },
        { "stride that overflows", size, { pixels, 8, 8, huge, 3, SH_F32 }, 2, 0, 0, 8, -1 },
        { "first row -1", size, { pixels, 8, 8, 0, 3, SH_F32 }, 2, 0, -1, 4, -1 },
        { "row count -1", size, { pixels, 8, 8, 0, 3, SH_F32 }, 2, 0, 4, -1, -1 },
        { "a row beyond", size, { pixels, 8, 8, 0, 3, SH_F32 }, 2, 0, 1, 8, -1 },
        { "rows that overflow", size, { pixels, 8, 8, 0, 3, SH_F32 }, 2, 0, 1, INT_MAX, -1 },
        { "format 5", format, { pixels, 8, 8, 0, 3, (sh_format)5 }, 2, 0, 0, 8, -1 },
        { "2 channels", format, { pixels, 8, 8, 0, 2, SH_F32 }, 2, 0, 0, 8, -1 },
        { "5 channels", format, { pixels, 8, 8, 0, 5, SH_F32 }, 2, 0, 0, 8, -1 },
        { "RGBE8 of 1 channel", format, { pixels, 8, 8, 0, 1, SH_RGBE8 }, 2, 0, 0, 8, -1 },
    };
    /* where there are several images */
    const square_request differing[] = {
        { "one is 9 x 9", size, { pixels, 9, 9, 0, 3, SH_F32 }, 2, 0, 0, 8, 1 },
        { "the last is 7 x 7", size, { pixels, 7, 7, 0, 3, SH_F32 }, 2, 0, 0, 8, 5 },
        { "one is 8 x 7", size, { pixels, 8, 7, 0, 3, SH_F32 }, 2, 0, 0, 8, 3 },
        { "one has 4 channels", format, { pixels, 8, 8, 0, 4, SH_F32 }, 2, 0, 0, 8, 2 },
        { "one is F16", format, { pixels, 8, 8, 0, 3, SH_F16 }, 2, 0, 0, 8, 4 },
    };
    const sh_image good = { pixels, 8, 8, 0, 3, SH_F32 };
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++)
        square_check_error(map, &requests[i], &good);
    for (size_t i = 0; map->images > 1 && i < sizeof differing / sizeof differing[0]; i++)
        square_check_error(map, &differing[i], &good);

    test_section("%s: NULL", map->name);
    float c[3 * 9];
    sh_accum accum[3];
    sh_image image[SQUARE_IMAGES];
    for (int i = 0; i < map->images; i++)
        image[i] = good;
    EQUAL(map->project(SH_L2, NULL, 0, c, NULL), SH_ERROR_ARGUMENT);
    EQUAL(map->project(SH_L2, image, 0, NULL, NULL), SH_ERROR_ARGUMENT);
    EQUAL(map->rows(SH_L2, NULL, 0, 0, 8, accum, NULL), SH_ERROR_ARGUMENT);
    EQUAL(map->rows(SH_L2, image, 0, 0, 8, NULL, NULL), SH_ERROR_ARGUMENT);
    test_section("%s: no rows are no error, and add nothing", map->name);
    sh_accum_clear(3, accum);
    for (int row = 0; row <= 8; row++)
        EQUAL(map->rows(SH_L2, image, 0, row, 0, accum, NULL), SH_OK);
    NEAR(accum[0].weight, 0.0, 0);
}

/* ---- Light ---- */

/* Bands up to 4, in no direction of symmetry. */
static inline long double square_light(const long double dir[3], const void *user) {
    const long double *axis = (const long double *)user, t = oracle_dot(dir, axis);
    return 1.0L + t * (0.7L + t * (0.4L + t * (0.5L + 0.8L * t))) + dir[0] * dir[1] * (0.3L + dir[2]);
}

static const long double square_axis[3] = { 0.48L, 0.6L, 0.64L };

/* Texels are light from their middles: off by 1 / size^2 of the light, a quarter with each doubling. */
static inline void square_convergence(const square_map *map) {
    oracle_rule rule = oracle_rule_sphere(8);
    long double expected[9], before = 0.0L;
    oracle_moments(&rule, square_light, square_axis, expected);
    oracle_rule_free(&rule);
    for (int size = 16; size <= 128; size *= 2) {
        square_images all = square_render(map, size, square_light, square_axis);
        float c[9];
        long double error = 0.0L;
        test_section("%s of %d: convergence", map->name, size);
        EQUAL(map->project(SH_L2, all.image, 0, c, NULL), SH_OK);
        for (int i = 0; i < 9; i++)
            error += ((long double)c[i] - expected[i]) * ((long double)c[i] - expected[i]);
        error = sqrtl(error);
        CHECK(error <= expected[0] / (size * size));
        if (before > 0.0L)
            NEAR(before / error, 4.0, 0.2);
        before = error;
        square_free(&all);
    }
}

static inline void square_run(const square_map *map) {
    square_errors(map);
    square_sizes(map);
    square_all_weights(map);
    square_large_weights(map);
    square_constants(map);
    square_layouts(map);
    square_formats(map);
    square_not_finite(map);
    square_magnitudes(map);
    square_alpha(map);
    square_rows(map);
    square_convergence(map);
}

#endif /* TEST_SQUARE_H */
