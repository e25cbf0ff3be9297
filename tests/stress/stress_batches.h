/* stress_batches.h - batches of directions, probes, samples and operators, for the backend that is compiled. */
#ifndef STRESS_BATCHES_H
#define STRESS_BATCHES_H

#include "stress_coefficients.h"

/* More than a vector of any backend, and a rest. */
enum { STRESS_BATCH = 19 };

static inline void stress_repeat(float x, float y, float z, float *xs, float *ys, float *zs) {
    for (int i = 0; i < STRESS_BATCH; i++) {
        xs[i] = x;
        ys[i] = y;
        zs[i] = z;
    }
}

/* The result of equal items, `stride` floats apart: all have to have the same bits. */
static inline float stress_same(stress_measure *m, const float *out, int stride) {
    for (int i = 1; i < STRESS_BATCH; i++)
        stress_require(m, memcmp(out, out + i * stride, sizeof *out) == 0 || out[0] != out[0]);
    return out[0];
}

typedef void (*stress_batch)(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                             size_t count);
typedef void (*stress_batch_aos)(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                 size_t out_stride, size_t count);

/* With the terms that appear where z^2 = 1 - x^2 - y^2 is taken out. */
static inline void stress_compare_polynomial(stress_measure *m, int order, const float *set, const long double kernel[3],
                                             const float *dir, float actual) {
    long double c[9], n[3];
    stress_widen_set(order, set, c);
    oracle_widen(dir, 3, n);
    const long double zz = 7.5L * kernel[2] * fabsl(c[4] + c[7]) * (1.0L + n[0] * n[0] + n[1] * n[1]);
    stress_compare(m, actual, oracle_expand(c, kernel, n), stress_terms(c, kernel, n) + zz);
}

/* in: three sets and a direction */
static inline void stress_any_batch(const float *in, stress_measure *m, const long double kernel[3], stress_batch planar,
                                    stress_batch_aos aos) {
    const float *dir = in + 27;
    float xs[STRESS_BATCH], ys[STRESS_BATCH], zs[STRESS_BATCH], out[3 * STRESS_BATCH], items[3 * STRESS_BATCH];
    stress_repeat(dir[0], dir[1], dir[2], xs, ys, zs);
    for (int i = 0; i < STRESS_BATCH; i++)
        memcpy(items + 3 * i, dir, 3 * sizeof *dir);
    for (int order = SH_L0; order <= SH_L2; order++) {
        float sets[27];
        sh_truncate(SH_L2, 3, in, order, sets);
        planar(order, 3, sets, xs, ys, zs, out, STRESS_BATCH);
        for (int k = 0; k < 3; k++)
            stress_compare_polynomial(m, order, in + 9 * k, kernel, dir, stress_same(m, out + k * STRESS_BATCH, 1));
        aos(order, 3, sets, items, 0, out, 0, STRESS_BATCH);
        for (int k = 0; k < 3; k++)
            stress_compare_polynomial(m, order, in + 9 * k, kernel, dir, stress_same(m, out + k, 3));
    }
}

static inline void stress_planar_radiance(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                          float *out, size_t count) {
    sh_radiance_batch(order, channels, c, x, y, z, out, count);
}

static inline void stress_planar_irradiance(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                            float *out, size_t count) {
    sh_irradiance_batch(order, channels, c, x, y, z, out, count);
}

static inline void stress_aos_radiance(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                       size_t out_stride, size_t count) {
    sh_radiance_batch_aos(order, channels, c, n, n_stride, out, out_stride, count);
}

static inline void stress_aos_irradiance(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                         size_t out_stride, size_t count) {
    sh_irradiance_batch_aos(order, channels, c, n, n_stride, out, out_stride, count);
}

static inline void stress_radiance_batches(const float *in, stress_measure *m) {
    stress_any_batch(in, m, stress_radiance_kernel, stress_planar_radiance, stress_aos_radiance);
}

static inline void stress_irradiance_batches(const float *in, stress_measure *m) {
    stress_any_batch(in, m, stress_lambert_kernel, stress_planar_irradiance, stress_aos_irradiance);
}

static inline void stress_probes(const float *in, stress_measure *m) {
    float sets[9 * STRESS_BATCH], xs[STRESS_BATCH], ys[STRESS_BATCH], zs[STRESS_BATCH], out[STRESS_BATCH];
    stress_repeat(in[9], in[10], in[11], xs, ys, zs);
    for (int order = SH_L0; order <= SH_L2; order++) {
        for (int i = 0; i < STRESS_BATCH; i++)
            memcpy(sets + i * SH_COUNT(order), in, (size_t)SH_COUNT(order) * sizeof *in);
        sh_irradiance_probes_batch(order, 1, sets, xs, ys, zs, out, STRESS_BATCH);
        stress_compare_expansion(m, order, in, stress_lambert_kernel, in + 9, stress_same(m, out, 1));
    }
}

/* in: STRESS_BATCH directions, values, weights */
static inline void stress_samples(const float *in, stress_measure *m) {
    enum { N = STRESS_BATCH };
    const float *value = in + 3 * N, *weight = value + N;
    float xs[N], ys[N], zs[N], c[9];
    for (int i = 0; i < N; i++) {
        xs[i] = in[3 * i];
        ys[i] = in[3 * i + 1];
        zs[i] = in[3 * i + 2];
    }
    for (int weighted = 0; weighted < 2; weighted++) {
        long double sum[9] = { 0.0L }, total = 0.0L, size = 0.0L;
        sh_accum one;
        float mean[9];
        sh_accum_clear(1, &one);
        for (int i = 0; i < N; i++) {
            long double dir[3], basis[9];
            const long double w = weighted ? (long double)weight[i] : 1.0L, v = w * (long double)value[i];
            oracle_widen(in + 3 * i, 3, dir);
            oracle_basis(dir, basis);
            for (int k = 0; k < 9; k++)
                sum[k] += v * basis[k];
            total += w;
            size += fabsl(v);
            sh_accum_sample(SH_L2, in + 3 * i, value[i], weighted ? weight[i] : 1.0f, &one);
        }
        if (!(total > 1e-30L))
            return;
        for (int k = 0; k < 9; k++)
            sum[k] /= total;
        m->allowance += ldexpl(N, -149) / total; /* products of weight and value that underflow */
        sh_accum_finish(SH_L2, 1, &one, mean);
        stress_compare_all(m, mean, sum, 9, size / total);
        sh_project_samples(SH_L2, 1, xs, ys, zs, value, weighted ? weight : NULL, N, c);
        stress_compare_all(m, c, sum, 9, size / total);
    }
}

static const stress_case stress_batch_cases[] = {
    { "sh_radiance_batch, _batch_aos", "8 ulp of the sum of absolute terms, zz among them; the same at any place",
      STRESS_ULP, 8.0, { SET(27), DIRECTION }, stress_radiance_batches, 16 },
    { "sh_irradiance_batch, _batch_aos", "8 ulp of the sum of absolute terms, zz among them; the same at any place",
      STRESS_ULP, 8.0, { SET(27), DIRECTION }, stress_irradiance_batches, 16 },
    { "sh_irradiance_probes_batch", "8 ulp of the sum of absolute terms; the same at any place",
      STRESS_ULP, 8.0, { SET(9), DIRECTION }, stress_probes, 4 },
    { "sh_project_samples, sh_accum_sample, _finish", "5e-7 of the weighted mean of |value|",
      STRESS_RELATIVE, 5e-7, { DIRECTIONS(STRESS_BATCH), SET(STRESS_BATCH), NUMBERS(STRESS_BATCH, 0.0, 1.0) }, stress_samples, 8 },
};

#endif /* STRESS_BATCHES_H */
