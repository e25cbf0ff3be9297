/* bench_eval.h - radiance and irradiance of RGB probes in many directions; an item is a direction. */
#ifndef BENCH_EVAL_H
#define BENCH_EVAL_H

#include "bench_engine.h"

enum { EVAL_IRRADIANCE, EVAL_RADIANCE };
enum { EVAL_SOA, EVAL_AOS };

/* Interleaved: a vertex of 32 bytes is float position[3], normal[3], uv[2]; a colour of 16 bytes is float red, green, blue and one
 * unused. */
enum { EVAL_VERTEX = 8, EVAL_NORMAL = 3, EVAL_COLOUR = 4 };

typedef struct eval_data {
    float c[27];
    engine_rgb engine[9];
    const float *x, *y, *z, *vertices; /* SoA: one block, x then y then z */
    float *out;                        /* of the case, the baseline and the limit */
} eval_data;

/* A sky of two suns over ambient light, different in each channel; R0 is about 1. `seed` moves the suns. */
static inline void eval_light(int order, uint32_t seed, float *c) {
    for (int k = 0; k < 3; k++) {
        float *ck = c + k * SH_COUNT(order);
        for (int i = 0; i < SH_COUNT(order); i++)
            ck[i] = 0.0f;
        ck[SH_R0] = 0.4f + 0.1f * (float)k;
        for (uint32_t sun = 0; sun < 2; sun++) {
            float dir[3];
            sh_direction_sequence(2 * seed + sun, 1, dir);
            sh_add_sample(order, dir, sun ? 0.3f : 0.4f - 0.1f * (float)k, ck);
        }
    }
}

static inline const double *eval_zonal(int kind) {
    static const double irradiance[3] = { 1.0, 2.0 / 3.0, 0.25 }, radiance[3] = { 1.0, 1.0, 1.0 };
    return kind == EVAL_IRRADIANCE ? irradiance : radiance;
}

/* Planar: x, then y, then z. */
static inline float *eval_directions(size_t count) {
    float *x = bench_alloc_floats(3 * count);
    for (size_t i = 0; i < count; i++) {
        float dir[3];
        sh_direction_sequence((uint32_t)i, 7, dir);
        for (size_t k = 0; k < 3; k++)
            x[k * count + i] = dir[k];
    }
    return x;
}

static inline eval_data *eval_prepare(bench_case *test, size_t out_floats) {
    eval_data *data = (eval_data *)bench_alloc(sizeof *data);
    eval_light(test->order, 0, data->c);
    engine_from_moments(test->order, data->c, eval_zonal(test->kind), data->engine);
    data->x = eval_directions(test->items);
    data->y = data->x + test->items;
    data->z = data->y + test->items;
    data->out = bench_alloc_floats(out_floats * test->items);
    test->data = data;
    test->limit.in = data->x;
    test->limit.out = data->out;
    return data;
}

/* The error of RGB results at one direction, of each channel's R0. */
static inline double eval_item_error(int order, int kind, const float *c, const float dir[3], const float *rgb, size_t rgb_step) {
    const double *zonal = eval_zonal(kind);
    const long double kernel[3] = { 1.0L, kind == EVAL_IRRADIANCE ? 2.0L / 3.0L : 1.0L, (long double)zonal[2] };
    long double n[3];
    double error = 0;
    oracle_widen(dir, 3, n);
    for (size_t k = 0; k < 3; k++) {
        long double m[9] = { 0 };
        oracle_widen(c + k * (size_t)SH_COUNT(order), SH_COUNT(order), m);
        const long double difference = (long double)rgb[k * rgb_step] - oracle_expand(m, kernel, n);
        error = bench_worse(error, (double)(fabsl(difference) / m[0]));
    }
    return error;
}

/* Of up to 2^16 items evenly, every lane among them, and of the last. */
static inline size_t eval_next(size_t i, size_t count) {
    const size_t step = count / 65536 + 1;
    return i + step < count || i + 1 == count ? i + step : count - 1;
}

/* ---- eval/{irradiance,radiance}/.../soa ---- */

static inline void eval_prepare_soa(bench_case *test) {
    eval_prepare(test, 3);
}

static inline void eval_run_soa(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    switch (test->kind * 3 + test->order) {
    case EVAL_IRRADIANCE * 3 + SH_L0: sh_irradiance_batch(SH_L0, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    case EVAL_IRRADIANCE * 3 + SH_L1: sh_irradiance_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    case EVAL_IRRADIANCE * 3 + SH_L2: sh_irradiance_batch(SH_L2, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L0: sh_radiance_batch(SH_L0, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L1: sh_radiance_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L2: sh_radiance_batch(SH_L2, 3, d->c, d->x, d->y, d->z, d->out, test->items); break;
    }
}

SHI_INLINE void eval_engine_soa(int order, const eval_data *d, size_t count) {
    for (size_t i = 0; i < count; i++) {
        float basis[9];
        engine_basis(order, d->x[i], d->y[i], d->z[i], basis);
        d->out[i] = engine_dot(order, d->engine, 0, basis);
        d->out[count + i] = engine_dot(order, d->engine, 1, basis);
        d->out[2 * count + i] = engine_dot(order, d->engine, 2, basis);
    }
}

static inline void eval_baseline_soa(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    switch (test->order) {
    case SH_L0: eval_engine_soa(SH_L0, d, test->items); break;
    case SH_L1: eval_engine_soa(SH_L1, d, test->items); break;
    case SH_L2: eval_engine_soa(SH_L2, d, test->items); break;
    }
}

static inline double eval_error_soa(bench_case *test, int of_baseline) {
    const eval_data *d = (const eval_data *)test->data;
    double error = 0;
    (void)of_baseline;
    for (size_t i = 0; i < test->items; i = eval_next(i, test->items)) {
        const float dir[3] = { d->x[i], d->y[i], d->z[i] };
        error = bench_worse(error, eval_item_error(test->order, test->kind, d->c, dir, d->out + i, test->items));
    }
    return error;
}

/* ---- eval/{irradiance,radiance}/.../aos ---- */

static inline void eval_prepare_aos(bench_case *test) {
    eval_data *data = eval_prepare(test, EVAL_COLOUR);
    float *vertices = bench_alloc_floats(EVAL_VERTEX * test->items);
    for (size_t i = 0; i < test->items; i++)
        for (size_t k = 0; k < 3; k++)
            vertices[EVAL_VERTEX * i + EVAL_NORMAL + k] = data->x[k * test->items + i];
    data->vertices = vertices;
    test->limit.in = vertices;
}

static inline void eval_run_aos(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    const size_t in = EVAL_VERTEX * sizeof(float), out = EVAL_COLOUR * sizeof(float);
    const float *n = d->vertices + EVAL_NORMAL;
    switch (test->kind * 3 + test->order) {
    case EVAL_IRRADIANCE * 3 + SH_L0: sh_irradiance_batch_aos(SH_L0, 3, d->c, n, in, d->out, out, test->items); break;
    case EVAL_IRRADIANCE * 3 + SH_L1: sh_irradiance_batch_aos(SH_L1, 3, d->c, n, in, d->out, out, test->items); break;
    case EVAL_IRRADIANCE * 3 + SH_L2: sh_irradiance_batch_aos(SH_L2, 3, d->c, n, in, d->out, out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L0: sh_radiance_batch_aos(SH_L0, 3, d->c, n, in, d->out, out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L1: sh_radiance_batch_aos(SH_L1, 3, d->c, n, in, d->out, out, test->items); break;
    case EVAL_RADIANCE * 3 + SH_L2: sh_radiance_batch_aos(SH_L2, 3, d->c, n, in, d->out, out, test->items); break;
    }
}

SHI_INLINE void eval_engine_aos(int order, const eval_data *d, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const float *n = d->vertices + EVAL_VERTEX * i + EVAL_NORMAL;
        float basis[9], *rgb = d->out + EVAL_COLOUR * i;
        engine_basis(order, n[0], n[1], n[2], basis);
        rgb[0] = engine_dot(order, d->engine, 0, basis);
        rgb[1] = engine_dot(order, d->engine, 1, basis);
        rgb[2] = engine_dot(order, d->engine, 2, basis);
    }
}

static inline void eval_baseline_aos(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    switch (test->order) {
    case SH_L0: eval_engine_aos(SH_L0, d, test->items); break;
    case SH_L1: eval_engine_aos(SH_L1, d, test->items); break;
    case SH_L2: eval_engine_aos(SH_L2, d, test->items); break;
    }
}

static inline double eval_error_aos(bench_case *test, int of_baseline) {
    const eval_data *d = (const eval_data *)test->data;
    double error = 0;
    (void)of_baseline;
    for (size_t i = 0; i < test->items; i = eval_next(i, test->items)) {
        const float *n = d->vertices + EVAL_VERTEX * i + EVAL_NORMAL;
        error = bench_worse(error, eval_item_error(test->order, test->kind, d->c, n, d->out + EVAL_COLOUR * i, 1));
    }
    return error;
}

/* ---- eval/probes: a probe and a normal per item, probes one after the other ---- */

typedef struct probes_data {
    const float *c, *x, *y, *z; /* one block: c, then x, y, z */
    const engine_rgb *engine;   /* as long, RGB interleaved */
    float *out;
} probes_data;

static inline void probes_prepare(bench_case *test) {
    const size_t n = test->items, set = 3 * (size_t)SH_COUNT(test->order);
    probes_data *data = (probes_data *)bench_alloc(sizeof *data);
    engine_rgb *engine = (engine_rgb *)bench_alloc(n * (size_t)SH_COUNT(test->order) * sizeof *engine);
    float *c = bench_alloc_floats((set + 3) * n);
    for (size_t i = 0; i < n; i++) {
        eval_light(test->order, (uint32_t)i, c + set * i);
        engine_from_moments(test->order, c + set * i, eval_zonal(EVAL_IRRADIANCE), engine + (size_t)SH_COUNT(test->order) * i);
    }
    memcpy(c + set * n, eval_directions(n), 3 * n * sizeof *c);
    data->c = c;
    data->x = c + set * n;
    data->y = data->x + n;
    data->z = data->y + n;
    data->engine = engine;
    data->out = bench_alloc_floats(3 * n);
    test->data = data;
    test->limit.in = c;
    test->limit.out = data->out;
}

static inline void probes_run(bench_case *test) {
    const probes_data *d = (const probes_data *)test->data;
    if (test->order == SH_L1)
        sh_irradiance_probes_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items);
    else
        sh_irradiance_probes_batch(SH_L2, 3, d->c, d->x, d->y, d->z, d->out, test->items);
}

SHI_INLINE void probes_engine(int order, const probes_data *d, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const engine_rgb *engine = d->engine + (size_t)SH_COUNT(order) * i;
        float basis[9];
        engine_basis(order, d->x[i], d->y[i], d->z[i], basis);
        d->out[i] = engine_dot(order, engine, 0, basis);
        d->out[count + i] = engine_dot(order, engine, 1, basis);
        d->out[2 * count + i] = engine_dot(order, engine, 2, basis);
    }
}

static inline void probes_baseline(bench_case *test) {
    if (test->order == SH_L1)
        probes_engine(SH_L1, (const probes_data *)test->data, test->items);
    else
        probes_engine(SH_L2, (const probes_data *)test->data, test->items);
}

static inline double probes_error(bench_case *test, int of_baseline) {
    const probes_data *d = (const probes_data *)test->data;
    double error = 0;
    (void)of_baseline;
    for (size_t i = 0; i < test->items; i++) {
        const float dir[3] = { d->x[i], d->y[i], d->z[i] };
        const float *c = d->c + 3 * (size_t)SH_COUNT(test->order) * i;
        error = bench_worse(error, eval_item_error(test->order, EVAL_IRRADIANCE, c, dir, d->out + i, test->items));
    }
    return error;
}

/* ---- The cases ---- */

/* Few directions stay in the first-level cache: the limit is arithmetic, one multiply-add per coefficient but the first. Many come
 * from memory: the limit is copying what is read and written. L0 only writes. Interleaved, whole vertices and colours count, since
 * memory moves whole cache lines. */
static inline bench_limit eval_limit(int order, int layout, size_t items) {
    bench_limit limit;
    memset(&limit, 0, sizeof limit);
    limit.kind = order >= SH_L1 && items == 1024 ? BENCH_FMA : BENCH_COPY;
    limit.fma = 3 * (size_t)(SH_COUNT(order) - 1);
    limit.read = order == SH_L0 ? 0 : layout == EVAL_AOS ? EVAL_VERTEX * sizeof(float) : 3 * sizeof(float);
    limit.written = layout == EVAL_AOS ? EVAL_COLOUR * sizeof(float) : 3 * sizeof(float);
    return limit;
}

static inline void eval_add(bench_list *list, int kind, int order, int layout, size_t items) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "eval/%s/L%d/rgb/%s/%d", kind == EVAL_IRRADIANCE ? "irradiance" : "radiance", order,
             layout == EVAL_AOS ? "aos" : "soa", (int)items);
    test->items = items;
    test->order = order;
    test->kind = kind;
    test->prepare = layout == EVAL_AOS ? eval_prepare_aos : eval_prepare_soa;
    test->run = layout == EVAL_AOS ? eval_run_aos : eval_run_soa;
    test->baseline = "basis per normal";
    test->run_baseline = layout == EVAL_AOS ? eval_baseline_aos : eval_baseline_soa;
    test->limit = eval_limit(order, layout, items);
    test->error = layout == EVAL_AOS ? eval_error_aos : eval_error_soa;
}

static inline void probes_add(bench_list *list, int order) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "eval/probes/L%d/rgb/4096", order);
    test->items = 4096;
    test->order = order;
    test->prepare = probes_prepare;
    test->run = probes_run;
    test->baseline = "basis per normal";
    test->run_baseline = probes_baseline;
    test->limit.kind = BENCH_COPY;
    test->limit.read = 3 * (size_t)(SH_COUNT(order) + 1) * sizeof(float);
    test->limit.written = 3 * sizeof(float);
    test->error = probes_error;
}

static inline void bench_eval_cases(bench_list *list) {
    static const size_t items[] = { 1024, 1048576 };
    for (int kind = EVAL_IRRADIANCE; kind <= EVAL_RADIANCE; kind++)
        for (int order = SH_L0; order <= SH_L2; order++)
            for (int layout = EVAL_SOA; layout <= EVAL_AOS; layout++)
                for (int i = 0; i < 2; i++)
                    eval_add(list, kind, order, layout, items[i]);
    for (int order = SH_L1; order <= SH_L2; order++)
        probes_add(list, order);
}

#endif /* BENCH_EVAL_H */
