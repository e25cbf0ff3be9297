/* stress_accumulation.h - sums of very many terms: samples, large panoramas, one sun, slices in any order. */
#ifndef STRESS_ACCUMULATION_H
#define STRESS_ACCUMULATION_H

#include "stress_images.h"
#include "stress_svg.h"

/* ---- Samples -------------------------------------------------------------------------------------------------------------------- */

enum { STRESS_SAMPLES = 1 << 16 }; /* distinct ones, again and again: so the exact mean of any number of them is known */

typedef struct stress_stream {
    float x[STRESS_SAMPLES], y[STRESS_SAMPLES], z[STRESS_SAMPLES], value[STRESS_SAMPLES];
    long double whole[9]; /* sums of all */
} stress_stream;

/* A sky with a sun: values from 0.5 to 200, positive. */
static inline void stress_stream_init(stress_stream *s) {
    memset(s->whole, 0, sizeof s->whole);
    for (uint32_t i = 0; i < STRESS_SAMPLES; i++) {
        float dir[3];
        long double wide[3], basis[9];
        sh_direction_sequence(i, 1, dir);
        s->x[i] = dir[0];
        s->y[i] = dir[1];
        s->z[i] = dir[2];
        s->value[i] = 1.0f + 0.5f * dir[2] + (dir[0] > 0.98f ? 200.0f : 0.0f);
        oracle_widen(dir, 3, wide);
        oracle_basis(wide, basis);
        for (int k = 0; k < 9; k++)
            s->whole[k] += (long double)s->value[i] * basis[k];
    }
}

/* Exact sums of the first `count`, a multiple of STRESS_SAMPLES or less than it. */
static inline void stress_stream_sum(const stress_stream *s, uint64_t count, long double sum[9]) {
    for (int k = 0; k < 9; k++)
        sum[k] = s->whole[k] * (long double)(count / STRESS_SAMPLES);
    for (uint32_t i = 0; i < count % STRESS_SAMPLES; i++) {
        const long double dir[3] = { (long double)s->x[i], (long double)s->y[i], (long double)s->z[i] };
        long double basis[9];
        oracle_basis(dir, basis);
        for (int k = 0; k < 9; k++)
            sum[k] += (long double)s->value[i] * basis[k];
    }
}

/* The largest error of a coefficient by R0. */
static inline double stress_stream_error(const stress_stream *s, uint64_t count, const float c[9]) {
    long double sum[9], worst = 0.0L;
    stress_stream_sum(s, count, sum);
    for (int k = 0; k < 9; k++)
        worst = fmaxl(worst, fabsl((long double)c[k] - sum[k] / (long double)count) / (sum[0] / (long double)count));
    return (double)worst;
}

enum { STRESS_FLOATS_LOOP, STRESS_ACCUM_SAMPLE, STRESS_ACCUM_SAMPLES, STRESS_WAYS };

/* Adds samples [from, to) of the stream in the given way. */
static inline void stress_stream_add(const stress_stream *s, int way, uint64_t from, uint64_t to, float naive[9], sh_accum *accum) {
    for (uint64_t i = from; i < to;) {
        const size_t at = (size_t)(i % STRESS_SAMPLES), rest = STRESS_SAMPLES - at, count = to - i < rest ? (size_t)(to - i) : rest;
        if (way == STRESS_ACCUM_SAMPLES)
            sh_accum_samples(SH_L2, 1, s->x + at, s->y + at, s->z + at, s->value + at, NULL, count, accum);
        for (size_t j = at; j < at + count && way != STRESS_ACCUM_SAMPLES; j++) {
            const float dir[3] = { s->x[j], s->y[j], s->z[j] };
            if (way == STRESS_FLOATS_LOOP)
                sh_add_sample(SH_L2, dir, s->value[j], naive);
            else
                sh_accum_sample(SH_L2, dir, s->value[j], 1.0f, accum);
        }
        i += count;
    }
}

/* Errors of the three ways at counts 2^first, ..., 2^last. */
static inline void stress_stream_run(const stress_stream *s, int first, int last, double error[STRESS_WAYS][40]) {
    for (int way = 0; way < STRESS_WAYS; way++) {
        float naive[9] = { 0 }, c[9];
        sh_accum accum;
        uint64_t done = 0;
        sh_accum_clear(1, &accum);
        for (int bits = first; bits <= last; bits++) {
            const uint64_t count = (uint64_t)1 << bits;
            stress_stream_add(s, way, done, count, naive, &accum);
            done = count;
            sh_accum_finish(SH_L2, 1, &accum, c);
            for (int k = 0; k < 9 && way == STRESS_FLOATS_LOOP; k++)
                c[k] = naive[k] / (float)count;
            error[way][bits] = stress_stream_error(s, count, c);
        }
    }
}

static inline int stress_sum_row(const char *what, double worst, double limit) {
    printf("| %s | %.1e | %s%.2e%s |\n", what, limit, worst <= limit ? "" : "**", worst, worst <= limit ? "" : "**");
    return worst > limit;
}

static inline int stress_samples_long(int last, const char *svg) {
    enum { FIRST = 10 };
    static stress_stream stream;
    static double error[STRESS_WAYS][40];
    char text[100];
    int bad = 0;
    stress_stream_init(&stream);
    stress_stream_run(&stream, FIRST, last, error);
    snprintf(text, sizeof text, "sh_accum_sample, 2^%d samples", last);
    bad += stress_sum_row(text, error[STRESS_ACCUM_SAMPLE][last], 1e-7);
    snprintf(text, sizeof text, "sh_accum_samples in calls of 2^16, 2^%d samples", last);
    bad += stress_sum_row(text, error[STRESS_ACCUM_SAMPLES][last], 5e-7);
    printf("| a loop of sh_add_sample in float, 2^%d samples, for comparison | | %.2e |\n", last, error[STRESS_FLOATS_LOOP][last]);
    if (svg) {
        static const char *const names[STRESS_WAYS] = { "float sums (sh_add_sample)", "sh_accum_sample",
                                                        "sh_accum_samples, sh_project_samples" };
        svg_errors(svg, names, error, FIRST, last);
    }
    return bad;
}

/* One call over many samples. */
static inline int stress_one_call(int bits) {
    const size_t count = (size_t)1 << bits;
    static stress_stream stream;
    float *all = (float *)test_allocate(4 * count * sizeof *all), c[9];
    char text[100];
    stress_stream_init(&stream);
    for (size_t i = 0; i < count; i += STRESS_SAMPLES) {
        memcpy(all + i, stream.x, sizeof stream.x);
        memcpy(all + count + i, stream.y, sizeof stream.y);
        memcpy(all + 2 * count + i, stream.z, sizeof stream.z);
        memcpy(all + 3 * count + i, stream.value, sizeof stream.value);
    }
    sh_project_samples(SH_L2, 1, all, all + count, all + 2 * count, all + 3 * count, NULL, count, c);
    free(all);
    snprintf(text, sizeof text, "sh_project_samples, one call of 2^%d", bits);
    return stress_sum_row(text, stress_stream_error(&stream, count, c), 5e-7);
}

/* ---- Panoramas ------------------------------------------------------------------------------------------------------------------ */

/* Texels of a large panorama, by kind. */
enum { STRESS_EQUAL, STRESS_RANDOM, STRESS_SIGNS, STRESS_SUN, STRESS_RANGE, STRESS_PANORAMAS };
static const char *const stress_panorama_names[STRESS_PANORAMAS] = { "equal texels", "random", "random signs",
                                                                     "a sun of one texel, 1e9", "six decades" };

static inline void stress_panorama_fill(int kind, const sh_image *image, float *texel) {
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        const double u = test_uniform(0.0, 1.0);
        texel[i] = kind == STRESS_EQUAL    ? 0.7f
                   : kind == STRESS_RANDOM ? (float)u
                   : kind == STRESS_SIGNS  ? (float)(2.0 * u - 1.0)
                   : kind == STRESS_SUN    ? 1.0f
                                           : (float)exp(14.0 * u);
    }
    if (kind == STRESS_SUN)
        texel[test_bits() % count] = 1e9f;
}

static inline double stress_projection_error(const oracle_projection *expected, const float c[9]) {
    double worst = 0.0;
    for (int k = 0; k < 9; k++)
        worst = fmax(worst, (double)(fabsl((long double)c[k] - expected->c[0][k]) / expected->magnitude[0]));
    return worst;
}

/* Rows in slices of `slice`, each with an accumulator of its own, merged in an order that `stride` shuffles. */
static inline void stress_slices(const sh_image *image, int slice, int stride, float c[9]) {
    const int count = (image->height + slice - 1) / slice;
    sh_accum total;
    sh_accum_clear(1, &total);
    for (int i = 0; i < count; i++) {
        const int first = (int)((long long)i * stride % count) * slice,
                  rows = image->height - first < slice ? image->height - first : slice;
        sh_accum some;
        sh_accum_clear(1, &some);
        sh_project_equirect_rows(SH_L2, image, 0, first, rows, &some, NULL);
        sh_accum_merge(1, &some, &total);
    }
    sh_accum_total(SH_L2, 1, &total, c);
}

static inline int stress_panorama_rows(int width, int height, int kinds) {
    float *texel = (float *)test_allocate((size_t)width * (size_t)height * sizeof *texel);
    const sh_image image = { texel, width, height, 0, 1, SH_F32 };
    int bad = 0;
    test_seed((uint64_t)width);
    for (int kind = 0; kind < kinds; kind++) {
        static const int slices[][2] = {
            { 1, 1 }, { 7, 5 }, { 16, 3 }, { 100, 7 }
        }; /* strides that no number of slices is a multiple of */
        float c[9], part[9];
        char text[120];
        double apart = 0.0;
        stress_panorama_fill(kind, &image, texel);
        const oracle_projection expected = oracle_project_equirect(&image, 0);
        sh_project_equirect(SH_L2, &image, 0, c, NULL);
        snprintf(text, sizeof text, "sh_project_equirect, %d x %d, %s", width, height, stress_panorama_names[kind]);
        bad += stress_sum_row(text, stress_projection_error(&expected, c), 1e-6);
        for (size_t s = 0; s < sizeof slices / sizeof slices[0]; s++) {
            stress_slices(&image, slices[s][0], slices[s][1], part);
            apart = fmax(apart, stress_projection_error(&expected, part));
        }
        snprintf(text, sizeof text, "the same in slices of 1, 7, 16, 100 rows, shuffled and merged");
        bad += stress_sum_row(text, apart, 1e-6);
    }
    free(texel);
    return bad;
}

static inline int stress_accumulation(int quick, const char *svg) {
    int bad = stress_samples_long(quick ? 20 : 30, svg);
    bad += stress_one_call(quick ? 17 : 26);
    bad += quick ? stress_panorama_rows(512, 256, STRESS_PANORAMAS) : stress_panorama_rows(8192, 4096, STRESS_PANORAMAS);
    bad += quick ? stress_panorama_rows(16384, 8, 2) : stress_panorama_rows(16384, 8192, 2);
    return bad;
}

#endif /* STRESS_ACCUMULATION_H */
