/* bench_operators.h - rotation, products, convolution, lights and packing. An item is a set, a probe or a light. */
#ifndef BENCH_OPERATORS_H
#define BENCH_OPERATORS_H

#include "bench_engine.h"
#include "bench_eval.h"

enum { OP_RGB = 27, OP_PROBES = 4 };

typedef enum operator_kind {
    OP_ROTATE,
    OP_ROTATE_SINGLE,
    OP_PRODUCT,
    OP_PRODUCT_BATCH,
    OP_CONVOLVE,
    OP_DIRECTIONAL,
    OP_CAP,
    OP_SPHERE,
    OP_POLYGON,
    OP_HALF,
    OP_UNORM8
} operator_kind;

typedef struct operator_data {
    const float *in, *dirs, *rgbs; /* sets of 27; directions; colours */
    float *out;                    /* sets of 27; planes for OP_PRODUCT_BATCH; OP_PROBES probes that lights are added to in turn */
    float m[9], zonal[3];
    double wide_m[5][5], gaunt[9][9][9]; /* of orthonormal coefficients */
    engine_rgb *engine_in, *engine_out;  /* [items][9] */
    uint16_t *half;
    uint8_t *code;
    float *r0;
} operator_data;

static const float operator_radius = 0.2f;

/* Half-angles differ, so that no compiler computes their sines beforehand. */
static inline float operator_cap(const float dir[3]) {
    return 0.2f + 0.01f * dir[2];
}

/* <Y_i Y_j Y_k> integrated, and the 5x5 matrix of a rotation in the second band: Y_i(m d) as a sum of Y_j(d). */
static inline void operator_tables(operator_data *d) {
    oracle_rule rule = oracle_rule_sphere(6);
    for (size_t n = 0; n < rule.count; n++) {
        const long double *dir = rule.node[n].dir;
        long double turned[3], y[9], z[9];
        for (int k = 0; k < 3; k++)
            turned[k] = (long double)d->m[3 * k] * dir[0] + (long double)d->m[3 * k + 1] * dir[1] + (long double)d->m[3 * k + 2] * dir[2];
        for (int l = 0, i = 0; l <= 2; l++)
            for (int m = -l; m <= l; m++, i++) {
                y[i] = oracle_y(l, m, dir, 0);
                z[i] = oracle_y(l, m, turned, 0);
            }
        const double w = 4.0 * (double)(oracle_pi * rule.node[n].weight);
        for (int i = 0; i < 9; i++)
            for (int j = 0; j < 9; j++) {
                for (int k = 0; k < 9; k++)
                    d->gaunt[i][j][k] += w * (double)(y[i] * y[j] * y[k]);
                if (i >= 4 && j >= 4)
                    d->wide_m[i - 4][j - 4] += w * (double)(z[i] * y[j]);
            }
    }
    oracle_rule_free(&rule);
}

static inline void operator_prepare(bench_case *test) {
    static const float m[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f };
    static const double all[3] = { 1, 1, 1 };
    const size_t n = test->items;
    operator_data *d = (operator_data *)bench_alloc(sizeof *d);
    float *in = bench_alloc_floats((n + 1) * OP_RGB), *dirs = bench_alloc_floats(3 * n), *rgbs = bench_alloc_floats(3 * n);
    memcpy(d->m, m, sizeof m);
    sh_zonal_lambert(d->zonal);
    operator_tables(d);
    d->engine_in = (engine_rgb *)bench_alloc((n + 1) * 9 * sizeof(engine_rgb));
    d->engine_out = (engine_rgb *)bench_alloc((n + 1) * 9 * sizeof(engine_rgb));
    for (size_t i = 0; i < n; i++) {
        sh_direction_sequence((uint32_t)i, 3, dirs + 3 * i);
        for (size_t k = 0; k < 3; k++)
            rgbs[3 * i + k] = 1.0f + (float)k;
    }
    for (size_t i = 0; i <= n; i++) {
        float *c = in + i * OP_RGB;
        for (size_t k = 0; k < 3; k++)
            sh_add_sample(SH_L2, dirs + 3 * ((i + k) % n), 1.0f, c + 9 * k);
        for (int k = 0; k < 3; k++)
            c[9 * k] += 0.5f;
        engine_from_moments(SH_L2, c, all, d->engine_in + 9 * i);
    }
    d->in = in;
    d->dirs = dirs;
    d->rgbs = rgbs;
    d->out = bench_alloc_floats((n + 1) * OP_RGB);
    d->half = (uint16_t *)bench_alloc(n * 28 * sizeof(uint16_t));
    d->code = (uint8_t *)bench_alloc(n * 24);
    d->r0 = bench_alloc_floats(3 * n);
    test->data = d;
    test->limit.in = in;
    test->limit.out = d->out;
}

/* ---- The library ---- */

static inline void operator_quad(const float dir[3], float center[3], float u[3], float v[3]) {
    for (int k = 0; k < 3; k++) {
        center[k] = dir[k];
        u[k] = 0.2f * dir[(k + 1) % 3];
        v[k] = 0.3f * dir[(k + 2) % 3];
    }
}

static inline void operator_light(int kind, const float dir[3], const float rgb[3], float *c) {
    float center[3], u[3], v[3];
    if (kind == OP_DIRECTIONAL)
        sh_add_directional(SH_L2, 3, dir, rgb, c);
    else if (kind == OP_CAP)
        sh_add_cap(SH_L2, 3, dir, operator_cap(dir), SH_RADIANCE, rgb, c);
    else if (kind == OP_SPHERE)
        sh_add_sphere(SH_L2, 3, dir, operator_radius, SH_RADIANCE, rgb, c);
    else {
        operator_quad(dir, center, u, v);
        sh_add_rectangle(SH_L2, 3, center, u, v, rgb, c);
    }
}

SHI_INLINE void operator_lights(int kind, const operator_data *d, size_t n) {
    const float *dirs = d->dirs, *rgbs = d->rgbs;
    float *out = d->out; /* the compiler cannot know that no light is added to *d */
    memset(out, 0, OP_PROBES * OP_RGB * sizeof(float));
    for (size_t i = 0; i < n; i++)
        operator_light(kind, dirs + 3 * i, rgbs + 3 * i, out + i % OP_PROBES * OP_RGB);
}

static inline void operator_run(bench_case *test) {
    operator_data *d = (operator_data *)test->data;
    const size_t n = test->items;
    switch (test->kind) {
    case OP_ROTATE: sh_rotate_batch(SH_L2, d->in, d->m, d->out, 3 * n); break;
    case OP_ROTATE_SINGLE:
        for (size_t i = 0; i < n; i++)
            sh_rotate_batch(SH_L2, d->in + OP_RGB * i, d->m, d->out + OP_RGB * i, 3);
        break;
    case OP_PRODUCT:
        for (size_t i = 0; i < n; i++)
            sh_product(SH_L2, d->in + 9 * i, d->in + 9 * i + 9, d->out + 9 * i);
        break;
    case OP_PRODUCT_BATCH: sh_product_batch(SH_L2, d->in, d->in + 9 * n, d->out, n); break;
    case OP_CONVOLVE:
        for (size_t i = 0; i < 3 * n; i++)
            sh_convolve(SH_L2, d->in + 9 * i, d->zonal, d->out + 9 * i);
        break;
    case OP_DIRECTIONAL: operator_lights(OP_DIRECTIONAL, d, n); break;
    case OP_CAP: operator_lights(OP_CAP, d, n); break;
    case OP_SPHERE: operator_lights(OP_SPHERE, d, n); break;
    case OP_POLYGON: operator_lights(OP_POLYGON, d, n); break;
    case OP_HALF:
        for (size_t i = 0; i < n; i++)
            sh_pack_half(SH_L2, 3, d->in + OP_RGB * i, d->half + 28 * i);
        break;
    default:
        for (size_t i = 0; i < n; i++)
            sh_pack_unorm8(SH_L2, 3, d->in + OP_RGB * i, d->r0 + 3 * i, d->code + 24 * i);
    }
}

/* ---- Baselines: orthonormal, interleaved ---- */

static inline void operator_rotate_engine(const operator_data *d, const engine_rgb *in, engine_rgb *out) {
    static const int axis[3] = { 1, 2, 0 }; /* y, z, x */
    out[0] = in[0];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            float sum = 0;
            for (int j = 0; j < 3; j++)
                sum += d->m[3 * axis[i] + axis[j]] * in[1 + j].v[k];
            out[1 + i].v[k] = sum;
        }
        for (int i = 0; i < 5; i++) {
            float sum = 0;
            for (int j = 0; j < 5; j++)
                sum += (float)d->wide_m[i][j] * in[4 + j].v[k];
            out[4 + i].v[k] = sum;
        }
    }
}

static inline void operator_product_engine(const operator_data *d, const engine_rgb *a, const engine_rgb *b, engine_rgb *out) {
    for (int k = 0; k < 9; k++) {
        float sum = 0;
        for (int i = 0; i < 9; i++)
            for (int j = 0; j < 9; j++)
                sum += (float)d->gaunt[i][j][k] * a[i].v[0] * b[j].v[0];
        out[k].v[0] = sum;
    }
}

/* Lobes by the basis, a band at a time; an area light by 64 samples. */
static inline void operator_light_engine(int kind, const operator_data *d, size_t i, engine_rgb *out) {
    static const float one[3] = { 1, 1, 1 };
    const float *dir = d->dirs + 3 * i, *rgb = d->rgbs + 3 * i, pi = 3.14159265f;
    if (kind == OP_DIRECTIONAL) {
        engine_add(SH_L2, dir, rgb, pi, out);
        return;
    }
    if (kind == OP_POLYGON) {
        float center[3], u[3], v[3], p[3];
        operator_quad(dir, center, u, v);
        for (int k = 0; k < 64; k++) {
            const float s = ((float)(k % 8) - 3.5f) / 4.0f, t = ((float)(k / 8) - 3.5f) / 4.0f;
            float normal[3], square = 0.0f, flux = 0.0f;
            for (int j = 0; j < 3; j++) {
                p[j] = center[j] + s * u[j] + t * v[j];
                normal[j] = u[(j + 1) % 3] * v[(j + 2) % 3] - u[(j + 2) % 3] * v[(j + 1) % 3];
                square += p[j] * p[j];
            }
            const float length = sqrtf(square);
            for (int j = 0; j < 3; j++) {
                flux += p[j] * normal[j];
                p[j] /= length;
            }
            engine_add(SH_L2, p, rgb, fabsf(flux) / (16.0f * square * length), out);
        }
        return;
    }
    const float cosine = kind == OP_CAP ? cosf(operator_cap(dir)) : sqrtf(1.0f - operator_radius * operator_radius);
    const float band[3] = { 2 * pi * (1 - cosine), pi * (1 - cosine * cosine), pi * cosine * (1 - cosine * cosine) };
    engine_rgb lobe[9] = { { { 0 } } };
    engine_add(SH_L2, dir, one, 1.0f, lobe);
    for (int j = 0; j < 9; j++)
        for (int k = 0; k < 3; k++)
            out[j].v[k] += rgb[k] * band[j < 1 ? 0 : j < 4 ? 1 : 2] * lobe[j].v[k];
}

static inline void operator_baseline(bench_case *test) {
    operator_data *d = (operator_data *)test->data;
    if (test->kind >= OP_DIRECTIONAL && test->kind <= OP_POLYGON)
        memset(d->engine_out, 0, OP_PROBES * 9 * sizeof *d->engine_out);
    for (size_t i = 0; i < test->items; i++) {
        const engine_rgb *in = d->engine_in + 9 * i;
        engine_rgb *out = d->engine_out + 9 * i;
        switch (test->kind) {
        case OP_ROTATE:
        case OP_ROTATE_SINGLE: operator_rotate_engine(d, in, out); break;
        case OP_PRODUCT:
        case OP_PRODUCT_BATCH: operator_product_engine(d, in, in + 9, out); break;
        case OP_CONVOLVE:
            for (int j = 0; j < 9; j++)
                for (int k = 0; k < 3; k++)
                    out[j].v[k] = in[j].v[k] * d->zonal[j < 1 ? 0 : j < 4 ? 1 : 2];
            break;
        case OP_HALF:
            for (int j = 0; j < OP_RGB; j++)
                d->half[28 * i + (size_t)j] = shi_to_half(in[j / 3].v[j % 3]);
            break;
        case OP_UNORM8:
            for (int j = 3; j < OP_RGB; j++)
                d->code[24 * i + (size_t)j - 3] = (uint8_t)(127.5f * (in[j / 3].v[j % 3] / (4.0f * in[0].v[j % 3]) + 1.0f));
            break;
        default: operator_light_engine(test->kind, d, i, d->engine_out + i % OP_PROBES * 9);
        }
    }
}

/* ---- Errors ---- */

/* The largest difference from `expected`, as a part of `scale`. */
static inline double operator_difference(const float *c, const long double *expected, int count, long double scale) {
    double worst = 0.0;
    for (int i = 0; i < count; i++)
        worst = bench_worse(worst, (double)(fabsl((long double)c[i] - expected[i]) / scale));
    return worst;
}

/* Root mean square of the radiance reconstruction of a set. */
static inline long double operator_norm(const float *a) {
    long double c[9];
    oracle_widen(a, 9, c);
    const long double zz = -(c[SH_XX] + c[SH_YY]);
    const long double second = c[SH_XX] * c[SH_XX] + c[SH_YY] * c[SH_YY] + zz * zz;
    const long double rest = c[SH_XY] * c[SH_XY] + c[SH_XZ] * c[SH_XZ] + c[SH_YZ] * c[SH_YZ];
    return sqrtl(c[SH_R0] * c[SH_R0] + 3.0L * oracle_dot(c + SH_X, c + SH_X) + 7.5L * (second + 2.0L * rest));
}

/* One channel of `set`; inputs a, and b for products. */
static inline void operator_expected(int kind, const operator_data *d, const float *a, const float *b, long double expected[9]) {
    static const long double radiance[3] = { 1.0L, 1.0L, 1.0L };
    long double wide[9], other[9], m[3][3];
    oracle_widen(a, 9, wide);
    if (kind == OP_CONVOLVE) {
        for (int i = 0; i < 9; i++)
            expected[i] = wide[i] * (long double)d->zonal[i < 1 ? 0 : i < 4 ? 1 : 2];
        return;
    }
    if (kind == OP_ROTATE || kind == OP_ROTATE_SINGLE) {
        for (int i = 0; i < 9; i++)
            m[i / 3][i % 3] = (long double)d->m[i];
        oracle_rotate(wide, m, expected);
        return;
    }
    oracle_widen(b, 9, other);
    oracle_rule rule = oracle_rule_sphere(6);
    memset(expected, 0, 9 * sizeof *expected);
    for (size_t n = 0; n < rule.count; n++) {
        long double basis[9];
        const long double value = oracle_expand(wide, radiance, rule.node[n].dir) * oracle_expand(other, radiance, rule.node[n].dir);
        oracle_basis(rule.node[n].dir, basis);
        for (int i = 0; i < 9; i++)
            expected[i] += rule.node[n].weight * value * basis[i];
    }
    oracle_rule_free(&rule);
}

/* The first sets of a map from sets to sets; relative to the norms of what it maps. */
static inline double operator_map_error(bench_case *test, int of_baseline) {
    operator_data *d = (operator_data *)test->data;
    const int product = test->kind == OP_PRODUCT || test->kind == OP_PRODUCT_BATCH;
    const size_t n = test->items, stride = product ? 9 : OP_RGB;
    double worst = 0.0;
    for (size_t p = 0; p < 16; p++) {
        const float *a = d->in + stride * p, *b = a + 9, *out = d->out + stride * p;
        float c[OP_RGB], lane[3][9];
        long double expected[9];
        if (of_baseline) { /* its products are of the probes' first channels */
            a = d->in + OP_RGB * p;
            b = a + OP_RGB;
            engine_to_moments(SH_L2, d->engine_out + 9 * p, 1.0, c);
            out = c;
        } else if (test->kind == OP_PRODUCT_BATCH) {
            for (size_t i = 0; i < 9; i++) {
                lane[0][i] = d->in[i * n + p];
                lane[1][i] = d->in[(9 + i) * n + p];
                lane[2][i] = d->out[i * n + p];
            }
            a = lane[0];
            b = lane[1];
            out = lane[2];
        }
        operator_expected(test->kind, d, a, b, expected);
        const long double scale = operator_norm(a) * (product ? operator_norm(b) : 1.0L);
        worst = bench_worse(worst, operator_difference(out, expected, 9, scale));
    }
    return worst;
}

/* The moments of a light of radiance 1, or irradiance / pi 1 for a directional one. */
static inline void operator_expected_lobe(int kind, const float *light, long double c[9]) {
    const long double r = (long double)operator_radius;
    long double dir[3], k[3] = { 0.25L, 0.25L, 0.25L };
    if (kind != OP_DIRECTIONAL) {
        const long double angle = (long double)operator_cap(light), cosine = kind == OP_CAP ? cosl(angle) : sqrtl(1.0L - r * r);
        k[0] = (1.0L - cosine) / 2.0L;
        k[1] = (1.0L - cosine * cosine) / 4.0L;
        k[2] = cosine * k[1];
    }
    oracle_widen(light, 3, dir);
    oracle_basis(dir, c);
    for (int j = 0; j < 9; j++)
        c[j] *= k[j < 1 ? 0 : j < 4 ? 1 : 2];
}

/* The same of a rectangle, by Gauss-Legendre quadrature over its area. */
static inline void operator_expected_quad(const float *dir, long double c[9]) {
    enum { NODES = 24 };
    long double node[NODES], weight[NODES], wide[3][3], n[3];
    float quad[3][3];
    operator_quad(dir, quad[0], quad[1], quad[2]);
    for (int i = 0; i < 3; i++)
        oracle_widen(quad[i], 3, wide[i]);
    for (int j = 0; j < 3; j++)
        n[j] = wide[1][(j + 1) % 3] * wide[2][(j + 2) % 3] - wide[1][(j + 2) % 3] * wide[2][(j + 1) % 3];
    oracle_gauss(NODES, -1.0L, 1.0L, node, weight);
    memset(c, 0, 9 * sizeof *c);
    for (int s = 0; s < NODES; s++)
        for (int t = 0; t < NODES; t++) {
            long double p[3], basis[9];
            for (int j = 0; j < 3; j++)
                p[j] = wide[0][j] + node[s] * wide[1][j] + node[t] * wide[2][j];
            const long double length = sqrtl(oracle_dot(p, p));
            const long double mean = weight[s] * weight[t] * fabsl(oracle_dot(p, n)) / (4.0L * oracle_pi * length * length * length);
            for (int j = 0; j < 3; j++)
                p[j] /= length;
            oracle_basis(p, basis);
            for (int j = 0; j < 9; j++)
                c[j] += mean * basis[j];
        }
}

/* Of the sum of the probes that the lights were added to; relative to its R0. */
static inline double operator_light_error(bench_case *test, int of_baseline) {
    operator_data *d = (operator_data *)test->data;
    long double sum[9] = { 0 }, one[9];
    float c[OP_RGB];
    for (size_t i = 0; i < test->items; i++) {
        if (test->kind == OP_POLYGON)
            operator_expected_quad(d->dirs + 3 * i, one);
        else
            operator_expected_lobe(test->kind, d->dirs + 3 * i, one);
        for (int j = 0; j < 9; j++)
            sum[j] += (long double)d->rgbs[3 * i] * one[j];
    }
    for (int p = 1; p < OP_PROBES; p++)
        for (int j = 0; j < OP_RGB; j++) {
            d->out[j] += d->out[p * OP_RGB + j];
            d->engine_out[j / 3].v[j % 3] += d->engine_out[9 * p + j / 3].v[j % 3];
        }
    if (of_baseline)
        engine_to_moments(SH_L2, d->engine_out, 1.0, c);
    return operator_difference(of_baseline ? c : d->out, sum, 9, sum[0]);
}

/* Of what is decoded; the baselines' codes have no decoder. */
static inline double operator_pack_error(bench_case *test, int of_baseline) {
    operator_data *d = (operator_data *)test->data;
    double worst = 0.0;
    for (size_t i = 0; i < test->items && !of_baseline; i++) {
        long double expected[OP_RGB];
        float c[OP_RGB];
        oracle_widen(d->in + OP_RGB * i, OP_RGB, expected);
        if (test->kind == OP_HALF)
            sh_unpack_half(SH_L2, 3, d->half + 28 * i, c);
        else
            sh_unpack_unorm8(SH_L2, 3, d->r0 + 3 * i, d->code + 24 * i, c);
        for (int k = 0; k < 3; k++)
            worst = bench_worse(worst, operator_difference(c + 9 * k, expected + 9 * k, 9, expected[9 * k]));
    }
    return worst;
}

/* ---- The cases ---- */

static inline void bench_operator_cases(bench_list *list) {
    static const struct {
        operator_kind kind;
        const char *name, *baseline;
        size_t floats; /* written per item */
        double bound;
    } all[] = {
        { OP_ROTATE, "op/rotate/L2/rgb", "3x3 and 5x5 matrix", 27, 1e-6 },
        { OP_ROTATE_SINGLE, "op/rotate_one/L2/rgb", "3x3 and 5x5 matrix", 27, 1e-6 },
        { OP_PRODUCT, "op/product/L2", "729 factors", 9, 1e-6 },
        { OP_PRODUCT_BATCH, "op/product_batch/L2", "729 factors", 9, 1e-6 },
        { OP_CONVOLVE, "op/convolve/L2/rgb", "factor per coefficient", 27, 1e-6 },
        { OP_DIRECTIONAL, "light/directional/L2/rgb", "basis", 0, 1e-6 },
        { OP_CAP, "light/cap/L2/rgb", "basis times bands", 0, 1e-6 },
        { OP_SPHERE, "light/sphere/L2/rgb", "basis times bands", 0, 1e-6 },
        { OP_POLYGON, "light/polygon4/L2/rgb", "64 samples", 0, 1e-6 },
        { OP_HALF, "pack/half/L2/rgb", "round each", 14, 1e-3 },
        { OP_UNORM8, "pack/unorm8/L2/rgb", "round each", 9, 2e-2 },
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        bench_case *test = bench_add(list);
        const int light = all[i].kind >= OP_DIRECTIONAL && all[i].kind <= OP_POLYGON;
        snprintf(test->name, sizeof test->name, "%s", all[i].name);
        test->kind = (int)all[i].kind;
        test->items = all[i].kind == OP_POLYGON ? 64 : light ? 256 : 128;
        test->prepare = operator_prepare;
        test->run = operator_run;
        test->run_baseline = operator_baseline;
        test->baseline = all[i].baseline;
        test->error = light ? operator_light_error : all[i].kind >= OP_HALF ? operator_pack_error : operator_map_error;
        test->error_bound = all[i].bound;
        test->limit.kind = light ? BENCH_FMA : BENCH_COPY;
        test->limit.fma = 27;
        test->limit.read = test->limit.written = all[i].floats * sizeof(float);
    }
}

#endif /* BENCH_OPERATORS_H */
