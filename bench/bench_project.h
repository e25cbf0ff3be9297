/* bench_project.h - projecting RGB images, and equirectangular panoramas; an item is a texel. */
#ifndef BENCH_PROJECT_H
#define BENCH_PROJECT_H

#include "../tests/oracle_image.h"
#include "bench_engine.h"

enum { PROJECT_EQUIRECT, PROJECT_CUBEMAP, PROJECT_OCTAHEDRAL };
enum { PROJECT_MAX_FACES = 6 };

typedef struct project_data {
    sh_image face[PROJECT_MAX_FACES];
    int faces;
    void (*oracle)(const struct project_data *data, long double c[3][9]);
    float c[27];
    engine_rgb engine[9];
    float engine_weight; /* sum of the baseline's weights */
} project_data;

/* ---- Images: blocks of different brightness, so that no band is small, with noise on every texel ---- */

/* Pseudo-random number in [0, 1) of a counter; multiply and xor-shift, as in the finish of MurmurHash3. */
static inline float project_noise(uint32_t i) {
    i = (i ^ (i >> 16)) * 0x85ebca6bu;
    i = (i ^ (i >> 13)) * 0xc2b2ae35u;
    return (float)((i ^ (i >> 16)) >> 8) * (1.0f / 16777216.0f);
}

static inline size_t project_texel_size(int format) {
    return format == SH_F32 ? 12 : format == SH_F16 ? 6 : 4;
}

/* Stores positive colours between 2^-14 and 2^15, truncated to the format's precision. */
static inline void project_store(int format, const float rgb[3], unsigned char *to) {
    uint32_t bits[3], largest = 0;
    memcpy(bits, rgb, sizeof bits);
    for (int k = 0; k < 3; k++)
        largest = bits[k] > largest ? bits[k] : largest;
    const int exponent = (int)(largest >> 23) - 127; /* of the brightest colour: 2^exponent <= it < 2^(exponent + 1) */
    if (format == SH_F32)
        memcpy(to, rgb, 12);
    else if (format == SH_F16)
        for (int k = 0; k < 3; k++) {
            const uint16_t half = (uint16_t)((bits[k] >> 13) - (112u << 10));
            memcpy(to + 2 * k, &half, sizeof half);
        }
    else {
        const uint32_t scale_bits = (uint32_t)(127 + 7 - exponent) << 23; /* 2^(7 - exponent): mantissas of 128 to 255 */
        float scale;
        memcpy(&scale, &scale_bits, sizeof scale);
        for (int k = 0; k < 3; k++)
            to[k] = (unsigned char)(rgb[k] * scale);
        to[3] = (unsigned char)(exponent + 129);
    }
}

/* Fills `pixels` with face number `face`. */
static inline sh_image project_image(int format, int width, int height, int face, unsigned char *pixels) {
    enum { COLUMNS = 8, ROWS = 4 };
    const size_t size = project_texel_size(format);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const uint32_t i = (uint32_t)(y * width + x),
                           block = (uint32_t)(face * ROWS + y * ROWS / height) * COLUMNS + (uint32_t)(x * COLUMNS / width);
            const float bright = project_noise(7 * block), grain = 0.75f + 0.5f * project_noise(i);
            const float rgb[3] = { grain * (0.25f + bright), grain * (0.25f + bright * bright), grain * (1.25f - bright) };
            project_store(format, rgb, pixels + i * size);
        }
    const sh_image image = { pixels, width, height, 0, 3, (sh_format)format };
    return image;
}

/* ---- The oracle ---- */

/* The moments of a texel are linear in the functions of its column: a row's are those of the weighted sum of its columns. */
static inline void equirect_oracle_row(const sh_image *image, int y, const oracle_trig *row, const oracle_trig *columns,
                                       long double c[3][9]) {
    oracle_trig sum[3];
    memset(sum, 0, sizeof sum);
    for (int x = 0; x < image->width; x++) {
        long double value[3];
        oracle_texel(image, x, y, value);
        for (int k = 0; k < 3; k++) {
            sum[k].one += value[k] * columns[x].one;
            sum[k].c += value[k] * columns[x].c;
            sum[k].s += value[k] * columns[x].s;
            sum[k].cc += value[k] * columns[x].cc;
            sum[k].cs += value[k] * columns[x].cs;
            sum[k].ss += value[k] * columns[x].ss;
        }
    }
    for (int k = 0; k < 3; k++) {
        long double moment[9];
        oracle_texel_moments(row, &sum[k], 0, moment);
        for (int i = 0; i < 9; i++)
            c[k][i] += moment[i];
    }
}

static inline void equirect_oracle(const project_data *data, long double c[3][9]) {
    const sh_image *image = &data->face[0];
    oracle_trig *rows = oracle_axis(image->height, 1, 0), *columns = oracle_axis(image->width, 0, 0);
    for (int y = 0; y < image->height; y++)
        equirect_oracle_row(image, y, &rows[y], columns, c);
    free(rows);
    free(columns);
}

/* Moments of the images that were seen: both orders of a projection share one. */
typedef struct project_reference {
    int kind, format, width;
    long double c[3][9];
} project_reference;

static inline const project_reference *project_oracle(const bench_case *test) {
    static project_reference seen[32];
    static int count;
    const project_data *d = (const project_data *)test->data;
    for (int i = 0; i < count; i++)
        if (seen[i].kind == test->kind && seen[i].format == test->format && seen[i].width == test->width)
            return &seen[i];
    project_reference *reference = &seen[count++ % 32];
    memset(reference, 0, sizeof *reference);
    reference->kind = test->kind;
    reference->format = test->format;
    reference->width = test->width;
    d->oracle(d, reference->c);
    return reference;
}

static inline double project_error(bench_case *test, int of_baseline) {
    project_data *d = (project_data *)test->data;
    const project_reference *reference = project_oracle(test);
    double error = 0;
    if (of_baseline)
        engine_to_moments(test->order, d->engine, 4.0 * (double)oracle_pi / (double)d->engine_weight, d->c);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < SH_COUNT(test->order); i++) {
            const long double difference = (long double)d->c[k * SH_COUNT(test->order) + i] - reference->c[k][i];
            error = bench_worse(error, (double)(fabsl(difference) / reference->c[k][0]));
        }
    return error;
}

/* ---- The baselines: per texel a direction, a solid angle, the basis, and 3 x SH_COUNT float sums ---- */

/* Half to float by moving the bits and multiplying by 2^112; no infinities in these images. */
SHI_INLINE float engine_half(uint16_t half) {
    const uint32_t bits = (uint32_t)(half & 0x7fff) << 13, magic = (uint32_t)(254 - 15) << 23,
                   sign = (uint32_t)(half & 0x8000) << 16;
    float value, scale;
    memcpy(&value, &bits, sizeof value);
    memcpy(&scale, &magic, sizeof scale);
    value *= scale;
    return sign ? -value : value;
}

SHI_INLINE void engine_texel(int format, const unsigned char *from, float rgb[3]) {
    if (format == SH_F32)
        memcpy(rgb, from, 12);
    else if (format == SH_F16) {
        uint16_t half[3];
        memcpy(half, from, sizeof half);
        for (int k = 0; k < 3; k++)
            rgb[k] = engine_half(half[k]);
    } else {
        const float scale = ldexpf(1.0f, (int)from[3] - 136);
        for (int k = 0; k < 3; k++)
            rgb[k] = (float)from[k] * scale;
    }
}

/* A row has one polar angle and one weight; each texel's direction is made from its angles. */
SHI_INLINE void engine_equirect(int order, int format, project_data *d) {
    const sh_image *image = &d->face[0];
    const float pi = 3.14159265f, step = 2.0f * pi / (float)image->width, row_step = pi / (float)image->height;
    const unsigned char *texel = (const unsigned char *)image->pixels;
    engine_rgb sum[9] = { { { 0 } } };
    float total = 0.0f;
    for (int y = 0; y < image->height; y++) {
        const float theta = ((float)y + 0.5f) * row_step, weight = sinf(theta) * step * row_step;
        for (int x = 0; x < image->width; x++) {
            const float phi = ((float)x + 0.5f) * step;
            const float dir[3] = { sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta) };
            float rgb[3];
            engine_texel(format, texel, rgb);
            engine_add(order, dir, rgb, weight, sum);
            total += weight;
            texel += project_texel_size(format);
        }
    }
    memcpy(d->engine, sum, sizeof sum);
    d->engine_weight = total;
}

SHI_INLINE void engine_equirect_format(int order, project_data *d) {
    switch (d->face[0].format) {
    case SH_F32: engine_equirect(order, SH_F32, d); break;
    case SH_F16: engine_equirect(order, SH_F16, d); break;
    default: engine_equirect(order, SH_RGBE8, d); break;
    }
}

static inline void equirect_baseline(bench_case *test) {
    project_data *d = (project_data *)test->data;
    if (test->order == SH_L1)
        engine_equirect_format(SH_L1, d);
    else
        engine_equirect_format(SH_L2, d);
}

/* ---- The cases ---- */

static inline project_data *project_prepare(bench_case *test, int faces) {
    project_data *data = (project_data *)bench_alloc(sizeof *data);
    const size_t face_size = test->items / (size_t)faces * project_texel_size(test->format);
    unsigned char *pixels = (unsigned char *)bench_alloc((size_t)faces * face_size);
    for (int i = 0; i < faces; i++)
        data->face[i] = project_image(test->format, test->width, test->height, i, pixels + (size_t)i * face_size);
    data->faces = faces;
    test->data = data;
    test->limit.in = (const float *)(const void *)pixels;
    return data;
}

static inline void equirect_prepare(bench_case *test) {
    project_prepare(test, 1)->oracle = equirect_oracle;
}

static inline void equirect_run(bench_case *test) {
    project_data *d = (project_data *)test->data;
    if (test->order == SH_L1)
        sh_project_equirect(SH_L1, &d->face[0], 0, d->c, NULL);
    else
        sh_project_equirect(SH_L2, &d->face[0], 0, d->c, NULL);
}

/* A case but for its name, functions and baseline: `faces` images of width x height, which are read once. */
static inline bench_case *project_add(bench_list *list, int order, int format, int faces, int width, int height) {
    bench_case *test = bench_add(list);
    test->items = (size_t)faces * (size_t)width * (size_t)height;
    test->order = order;
    test->format = format;
    test->width = width;
    test->height = height;
    test->limit.kind = BENCH_READ;
    test->limit.read = project_texel_size(format);
    test->error = project_error;
    return test;
}

static inline void equirect_add(bench_list *list, int order, int format, int width) {
    static const char *const format_name[] = { "f32", "f16", "rgbe8" };
    bench_case *test = project_add(list, order, format, 1, width, width / 2);
    snprintf(test->name, sizeof test->name, "project/equirect/L%d/rgb/%s/%dx%d", order, format_name[format], width, width / 2);
    test->kind = PROJECT_EQUIRECT;
    test->prepare = equirect_prepare;
    test->run = equirect_run;
    test->baseline = "trig per texel";
    test->run_baseline = equirect_baseline;
}

static inline void bench_equirect_cases(bench_list *list) {
    static const int widths[] = { 512, 1024, 4096 };
    for (int order = SH_L1; order <= SH_L2; order++)
        for (int format = SH_F32; format <= SH_RGBE8; format++)
            for (int i = 0; i < 3; i++)
                equirect_add(list, order, format, widths[i]);
}

#endif /* BENCH_PROJECT_H */
