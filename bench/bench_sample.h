/* bench_sample.h - projecting directions with RGB values; an item is a sample. */
#ifndef BENCH_SAMPLE_H
#define BENCH_SAMPLE_H

#include "bench_engine.h"
#include "bench_eval.h"

typedef struct sample_data {
    const float *dirs, *rgbs;        /* interleaved, as a tracer produces them */
    const float *x, *y, *z, *values; /* planar, one block */
    float c[27];
    long double oracle[27]; /* moments of the sum of the samples */
    engine_rgb engine[9];
} sample_data;

static inline void sample_prepare(bench_case *test) {
    const size_t n = test->items;
    sample_data *data = (sample_data *)bench_alloc(sizeof *data);
    float *planar = bench_alloc_floats(6 * n), *dirs = bench_alloc_floats(3 * n), *rgbs = bench_alloc_floats(3 * n);
    memcpy(planar, eval_directions(n), 3 * n * sizeof *planar);
    for (size_t i = 0; i < n; i++) {
        long double dir[3], basis[9];
        for (size_t k = 0; k < 3; k++) {
            dirs[3 * i + k] = planar[k * n + i];
            rgbs[3 * i + k] = planar[(3 + k) * n + i] = 1.0f + 0.25f * (float)(k + 1) * planar[k * n + i];
        }
        oracle_widen(dirs + 3 * i, 3, dir);
        oracle_basis(dir, basis);
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < SH_COUNT(test->order); j++)
                data->oracle[k * SH_COUNT(test->order) + j] += (long double)rgbs[3 * i + (size_t)k] * basis[j];
    }
    data->x = planar;
    data->y = planar + n;
    data->z = planar + 2 * n;
    data->values = planar + 3 * n;
    data->dirs = dirs;
    data->rgbs = rgbs;
    test->data = data;
    test->limit.in = planar;
}

/* Largest difference between c * factor and the oracle's sum, of R0. */
static inline double sample_error(const bench_case *test, double factor) {
    const sample_data *d = (const sample_data *)test->data;
    double error = 0;
    for (int k = 0; k < 3; k++) {
        const float *c = d->c + k * SH_COUNT(test->order);
        const long double *expected = d->oracle + k * SH_COUNT(test->order);
        for (int i = 0; i < SH_COUNT(test->order); i++)
            error = bench_worse(error, (double)(fabsl((long double)c[i] * (long double)factor - expected[i]) / expected[0]));
    }
    return error;
}

/* ---- sample: one call adds one RGB sample to a probe ---- */

/* Three channels share the basis. */
SHI_INLINE void sample_add_rgb(int order, const float dir[3], const float rgb[3], float *c) {
    const float x[3] = { dir[0], dir[1], dir[2] };
    sh_add_sample(order, x, rgb[0], c);
    sh_add_sample(order, x, rgb[1], c + SH_COUNT(order));
    sh_add_sample(order, x, rgb[2], c + 2 * SH_COUNT(order));
}

SHI_INLINE void sample_add_all(int order, sample_data *d, size_t count) {
    memset(d->c, 0, sizeof d->c);
    for (size_t i = 0; i < count; i++)
        sample_add_rgb(order, d->dirs + 3 * i, d->rgbs + 3 * i, d->c);
}

static inline void sample_run(bench_case *test) {
    if (test->order == SH_L1)
        sample_add_all(SH_L1, (sample_data *)test->data, test->items);
    else
        sample_add_all(SH_L2, (sample_data *)test->data, test->items);
}

SHI_INLINE void sample_engine_all(int order, sample_data *d, size_t count) {
    memset(d->engine, 0, sizeof d->engine);
    for (size_t i = 0; i < count; i++)
        engine_add(order, d->dirs + 3 * i, d->rgbs + 3 * i, 1.0f, d->engine);
}

static inline void sample_baseline(bench_case *test) {
    if (test->order == SH_L1)
        sample_engine_all(SH_L1, (sample_data *)test->data, test->items);
    else
        sample_engine_all(SH_L2, (sample_data *)test->data, test->items);
}

/* Orthonormal coefficients are 4 pi times the mean of value * Y. */
static inline double sample_sum_error(bench_case *test, int of_baseline) {
    sample_data *d = (sample_data *)test->data;
    if (of_baseline)
        engine_to_moments(test->order, d->engine, 4.0 * (double)oracle_pi, d->c);
    return sample_error(test, 1.0);
}

/* ---- project/samples: all samples in one call ---- */

static inline void samples_run(bench_case *test) {
    sample_data *d = (sample_data *)test->data;
    sh_project_samples(SH_L2, 3, d->x, d->y, d->z, d->values, NULL, test->items, d->c);
}

static inline double samples_error(bench_case *test, int of_baseline) {
    sample_data *d = (sample_data *)test->data;
    if (of_baseline)
        engine_to_moments(test->order, d->engine, 4.0 * (double)oracle_pi / (double)test->items, d->c);
    return sample_error(test, (double)test->items);
}

/* ---- The cases ---- */

static inline bench_case *sample_add(bench_list *list, int order, size_t items) {
    bench_case *test = bench_add(list);
    test->items = items;
    test->order = order;
    test->prepare = sample_prepare;
    test->baseline = "basis per sample";
    test->run_baseline = sample_baseline;
    return test;
}

static inline void bench_sample_cases(bench_list *list) {
    for (int order = SH_L1; order <= SH_L2; order++) {
        bench_case *test = sample_add(list, order, 1024);
        snprintf(test->name, sizeof test->name, "sample/L%d/rgb", order);
        test->run = sample_run;
        test->limit.kind = BENCH_FMA;
        test->limit.fma = 3 * (size_t)SH_COUNT(order);
        test->error = sample_sum_error;
    }
    bench_case *test = sample_add(list, SH_L2, 65536);
    snprintf(test->name, sizeof test->name, "project/samples/L2/rgb/65536");
    test->run = samples_run;
    test->limit.kind = BENCH_READ;
    test->limit.read = 6 * sizeof(float);
    test->error = samples_error;
}

#endif /* BENCH_SAMPLE_H */
