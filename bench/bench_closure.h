/* bench_closure.h - closures and the other models of irradiance, analysis, and what is skipped under a tolerance. The baseline of a model
 * is the linear reconstruction of its order; of something that skips, doing all of it. */
#ifndef BENCH_CLOSURE_H
#define BENCH_CLOSURE_H

#include "bench_eval.h"

/* ---- eval/{closure,geomerics,zh3}/L{1,2}/rgb/soa/1024 ---- */

enum { CLOSURE_CLOSURE, CLOSURE_GEOMERICS, CLOSURE_ZH3 };

static inline void closure_run(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    if (test->kind == CLOSURE_GEOMERICS)
        sh_irradiance_geomerics_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items);
    else if (test->kind == CLOSURE_ZH3)
        sh_irradiance_zh3_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items);
    else if (test->order == SH_L1)
        sh_irradiance_closure_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items);
    else
        sh_irradiance_closure_batch(SH_L2, 3, d->c, d->x, d->y, d->z, d->out, test->items);
}

static inline void closure_linear(bench_case *test) {
    const eval_data *d = (const eval_data *)test->data;
    if (test->order == SH_L1)
        sh_irradiance_batch(SH_L1, 3, d->c, d->x, d->y, d->z, d->out, test->items);
    else
        sh_irradiance_batch(SH_L2, 3, d->c, d->x, d->y, d->z, d->out, test->items);
}

static inline float closure_scalar(int kind, int order, const float *c, const float n[3]) {
    return kind == CLOSURE_GEOMERICS ? sh_irradiance_geomerics(c, n)
           : kind == CLOSURE_ZH3     ? sh_irradiance_zh3(c, n)
           : order == SH_L1          ? sh_irradiance_closure(SH_L1, c, n)
                                     : sh_irradiance_closure(SH_L2, c, n);
}

/* Of the batch against the scalar function; of the baseline against the scalar model, which is the price of being linear. */
static inline double closure_error(bench_case *test, int of_baseline) {
    const eval_data *d = (const eval_data *)test->data;
    double error = 0;
    (void)of_baseline;
    for (size_t i = 0; i < test->items; i = eval_next(i, test->items))
        for (size_t k = 0; k < 3; k++) {
            const float n[3] = { d->x[i], d->y[i], d->z[i] }, *c = d->c + k * (size_t)SH_COUNT(test->order);
            const double expected = (double)closure_scalar(test->kind, test->order, c, n);
            error = bench_worse(error, fabs((double)d->out[k * test->items + i] - expected) / (double)c[SH_R0]);
        }
    return error;
}

/* One sun and little else: the upper bound is within reach, and with it the square root. */
static inline void closure_prepare_bounded(bench_case *test) {
    const float sun[3] = { 0.48f, 0.36f, 0.8f };
    eval_prepare_soa(test);
    eval_data *d = (eval_data *)test->data;
    for (int k = 0; k < 3; k++) {
        float *c = d->c + k * SH_COUNT(test->order);
        for (int i = 0; i < SH_COUNT(test->order); i++)
            c[i] = 0.0f;
        c[SH_R0] = 0.02f + 0.01f * (float)k;
        sh_add_sample(test->order, sun, 1.0f, c);
    }
}

/* Operations: instructions of the arithmetic units, each as long as a multiply-add. L1: 3 + 1 + 3 + 2; bounded, 4 more. L2: 25
 * multiply-adds or products, 2 comparisons, an addition; bounded, 3 more. A square root comes on top, in a unit of its own. */
static inline void closure_add(bench_list *list, const char *name, int kind, int order, int bounded, size_t operations) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "eval/%s/L%d%s/rgb/soa/1024", name, order, bounded ? "/bounded" : "");
    test->items = 1024;
    test->order = order;
    test->kind = kind;
    test->prepare = bounded ? closure_prepare_bounded : eval_prepare_soa;
    test->run = closure_run;
    test->baseline = "linear";
    test->run_baseline = closure_linear;
    test->limit.kind = BENCH_FMA;
    test->limit.fma = 3 * operations;
    test->error = closure_error;
}

/* ---- closure/prepare, analysis: an item is a probe ---- */

enum { ANALYSIS_PREPARE, ANALYSIS_PREPARE_FLOOR, ANALYSIS_MIN, ANALYSIS_DERING };
enum { ANALYSIS_PROBES = 256, ANALYSIS_NORMALS = 256 };

typedef struct analysis_data {
    const float *c, *normals; /* in, limit */
    float *out;               /* of the limit */
    sh_closure *closure;      /* out */
    float *value, *searched;
} analysis_data;

static inline void analysis_prepare(bench_case *test) {
    const size_t set = 3 * (size_t)SH_COUNT(test->order);
    analysis_data *data = (analysis_data *)bench_alloc(sizeof *data);
    float *c = bench_alloc_floats(ANALYSIS_PROBES * set);
    for (size_t i = 0; i < ANALYSIS_PROBES; i++)
        eval_light(test->order, (uint32_t)i, c + set * i);
    data->c = c;
    data->out = bench_alloc_floats(ANALYSIS_PROBES * set);
    data->closure = (sh_closure *)bench_alloc(3 * ANALYSIS_PROBES * sizeof *data->closure);
    data->value = bench_alloc_floats(4 * ANALYSIS_PROBES);
    data->searched = bench_alloc_floats(ANALYSIS_PROBES);
    data->normals = eval_directions(ANALYSIS_NORMALS);
    test->data = data;
    test->limit.in = c;
    test->limit.out = data->out;
}

static inline void analysis_run(bench_case *test) {
    const analysis_data *d = (const analysis_data *)test->data;
    for (size_t i = 0; i < ANALYSIS_PROBES; i++) {
        const float *c = d->c + 3 * (size_t)SH_COUNT(test->order) * i;
        switch (test->kind) {
        case ANALYSIS_PREPARE:
            if (test->order == SH_L1)
                sh_closure_prepare(SH_L1, 3, c, 0, d->closure + 3 * i);
            else
                sh_closure_prepare(SH_L2, 3, c, 0, d->closure + 3 * i);
            break;
        case ANALYSIS_PREPARE_FLOOR:
            sh_closure_prepare(SH_L2, 3, c, SH_AMBIENT_FLOOR, d->closure + 3 * i);
            break;
        case ANALYSIS_MIN:
            d->value[4 * i] = sh_min(SH_L2, c, d->value + 4 * i + 1);
            break;
        default:
            d->value[4 * i] = sh_dering(SH_L2, 3, c, SH_WINDOW_HANN, d->out + 27 * i);
            break;
        }
    }
}

/* Of an analysis, the least of 256 directions (one channel, no window tried); of preparing, evaluating the linear model at one normal. */
static inline void analysis_baseline(bench_case *test) {
    const analysis_data *d = (const analysis_data *)test->data;
    const float up[3] = { 0.0f, 0.6f, 0.8f }, *n = d->normals;
    for (size_t i = 0; i < ANALYSIS_PROBES; i++) {
        const float *c = d->c + 3 * (size_t)SH_COUNT(test->order) * i;
        float least = 1e30f, value[ANALYSIS_NORMALS];
        if (test->kind < ANALYSIS_MIN)
            for (int k = 0; k < 3; k++)
                d->out[3 * i + (size_t)k] = sh_irradiance(test->order, c + k * SH_COUNT(test->order), up);
        else {
            sh_radiance_batch(SH_L2, 1, c, n, n + ANALYSIS_NORMALS, n + 2 * ANALYSIS_NORMALS, value, ANALYSIS_NORMALS);
            for (int k = 0; k < ANALYSIS_NORMALS; k++)
                least = value[k] < least ? value[k] : least;
            d->searched[i] = least;
        }
    }
}

/* Minimum: against the radiance where it is said to be. De-ringing: what is still negative. Of R0. */
static inline double analysis_error(bench_case *test, int of_baseline) {
    const analysis_data *d = (const analysis_data *)test->data;
    double error = 0;
    for (size_t i = 0; i < ANALYSIS_PROBES && test->kind >= ANALYSIS_MIN; i++) {
        const float *c = d->c + 27 * i, *out = d->out + 27 * i;
        if (of_baseline)
            error = bench_worse(error, (double)((d->searched[i] - sh_min(SH_L2, c, NULL)) / c[0]));
        else if (test->kind == ANALYSIS_MIN)
            error =
                bench_worse(error, fabs((double)(d->value[4 * i] - sh_radiance(SH_L2, c, d->value + 4 * i + 1)) / (double)c[0]));
        for (size_t k = 0; k < 27 && test->kind == ANALYSIS_DERING && !of_baseline; k += 9)
            error = bench_worse(error, -(double)(sh_min(SH_L2, out + k, NULL) / out[k]));
    }
    return error;
}

static inline void analysis_add(bench_list *list, const char *name, int kind, int order) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "%s", name);
    test->items = ANALYSIS_PROBES;
    test->order = order;
    test->kind = kind;
    test->prepare = analysis_prepare;
    test->run = analysis_run;
    test->baseline = kind < ANALYSIS_MIN ? "linear at 1 normal" : "least of 256";
    test->run_baseline = analysis_baseline;
    test->limit.kind = BENCH_COPY;
    test->limit.read = test->limit.written = 3 * (size_t)SH_COUNT(order) * sizeof(float);
    test->error = analysis_error;
}

/* ---- skip/... ----------------------------------------------------------------------------------------------------------------
 * bands: a building of 4096 RGB probes, each with a normal. 70 % are indoors, lit by walls all around (ambient, with a gradient of 1e-3
 * R0); 20 % near windows (a gradient of half R0); 10 % outdoors (two suns). Tolerance 1e-2 R0 of the ambient light.
 * grey: a probe whose channels agree to 1e-4, and 1024 normals. lights: 4096 lights whose strengths fall by a factor e every 64. */

enum { SKIP_PROBES = 4096, SKIP_LIGHTS = 4096, SKIP_NORMALS = 1024 };

typedef struct skip_data {
    const float *c, *normals;     /* all probes in order; x, y, z */
    float *packed[3], *turned[3]; /* by order: sets, normals */
    size_t index[SKIP_PROBES], first[4];
    float *out, *all;   /* of the case, of the baseline */
    const float *value; /* of the lights */
    float sum[2][9];
} skip_data;

static inline skip_data *skip_new(bench_case *test, size_t normals) {
    skip_data *data = (skip_data *)bench_alloc(sizeof *data);
    data->normals = eval_directions(normals);
    data->out = bench_alloc_floats(3 * normals);
    data->all = bench_alloc_floats(3 * normals);
    test->data = data;
    test->limit.in = data->normals;
    test->limit.out = data->out;
    return data;
}

/* Groups the probes and packs each group's sets, cut to its order, with their normals. Done once for a level that is lit once. */
static inline void bands_prepare(bench_case *test) {
    skip_data *data = skip_new(test, SKIP_PROBES);
    float *c = bench_alloc_floats(27 * SKIP_PROBES);
    for (uint32_t i = 0; i < SKIP_PROBES; i++) {
        const uint32_t place = shi_hash(i) % 10;
        float dir[3];
        sh_direction_sequence(i, 3, dir);
        for (int k = 0; k < 3; k++) {
            c[27 * i + 9 * (uint32_t)k] = 1.0f;
            for (int j = 0; j < 3; j++)
                c[27 * i + 9 * (uint32_t)k + 1 + (uint32_t)j] = (place < 7 ? 1e-3f : 0.5f) * dir[j];
        }
        if (place == 9)
            eval_light(SH_L2, i, c + 27 * i);
    }
    data->c = c;
    sh_group_by_order(3, c, SKIP_PROBES, 1e-2f, data->index, data->first);
    for (int order = 0; order < 3; order++) {
        const size_t first = data->first[order], count = data->first[order + 1] - first, set = 3 * (size_t)SH_COUNT(order);
        data->packed[order] = bench_alloc_floats(set * count + 1);
        data->turned[order] = bench_alloc_floats(3 * count + 1);
        for (size_t i = 0; i < count; i++) {
            sh_truncate(SH_L2, 3, c + 27 * data->index[first + i], order, data->packed[order] + set * i);
            for (size_t j = 0; j < 3; j++)
                data->turned[order][j * count + i] = data->normals[j * SKIP_PROBES + data->index[first + i]];
        }
    }
}

SHI_INLINE void bands_group(int order, const skip_data *d) {
    const size_t count = d->first[order + 1] - d->first[order];
    const float *n = d->turned[order];
    sh_irradiance_probes_batch(order, 3, d->packed[order], n, n + count, n + 2 * count, d->out + 3 * d->first[order], count);
}

static inline void bands_run(bench_case *test) {
    const skip_data *d = (const skip_data *)test->data;
    bands_group(SH_L0, d);
    bands_group(SH_L1, d);
    bands_group(SH_L2, d);
}

static inline void bands_all(bench_case *test) {
    const skip_data *d = (const skip_data *)test->data;
    const float *n = d->normals;
    sh_irradiance_probes_batch(SH_L2, 3, d->c, n, n + SKIP_PROBES, n + 2 * SKIP_PROBES, d->all, SKIP_PROBES);
}

static inline double bands_error(bench_case *test, int of_baseline) {
    const skip_data *d = (const skip_data *)test->data;
    double error = 0;
    for (int order = 0; order < 3 && !of_baseline; order++) {
        const size_t first = d->first[order], count = d->first[order + 1] - first;
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 3; k++) {
                const size_t probe = d->index[first + i];
                const float n[3] = { d->normals[probe], d->normals[SKIP_PROBES + probe], d->normals[2 * SKIP_PROBES + probe] };
                const float expected = sh_irradiance(SH_L2, d->c + 27 * probe + 9 * k, n);
                error = bench_worse(error, fabs((double)(d->out[3 * first + k * count + i] - expected)));
            }
    }
    return error;
}

static inline void grey_prepare(bench_case *test) {
    skip_data *data = skip_new(test, SKIP_NORMALS);
    float *c = bench_alloc_floats(27);
    eval_light(SH_L2, 0, c);
    for (int k = 9; k < 27; k++)
        c[k] = c[k - 9] * 1.00005f;
    data->c = c;
}

static inline void grey_run(bench_case *test) {
    const skip_data *d = (const skip_data *)test->data;
    const float *n = d->normals;
    const int channels = sh_is_grey(SH_L2, 3, d->c, 1e-3f) ? 1 : 3;
    sh_irradiance_batch(SH_L2, channels, d->c, n, n + SKIP_NORMALS, n + 2 * SKIP_NORMALS, d->out, SKIP_NORMALS);
}

static inline void grey_all(bench_case *test) {
    const skip_data *d = (const skip_data *)test->data;
    const float *n = d->normals;
    sh_irradiance_batch(SH_L2, 3, d->c, n, n + SKIP_NORMALS, n + 2 * SKIP_NORMALS, d->all, SKIP_NORMALS);
}

static inline double grey_error(bench_case *test, int of_baseline) {
    const skip_data *d = (const skip_data *)test->data;
    double error = 0;
    for (size_t i = 0; i < SKIP_NORMALS && !of_baseline; i++)
        for (size_t k = 0; k < 3; k++) {
            const float n[3] = { d->normals[i], d->normals[SKIP_NORMALS + i], d->normals[2 * SKIP_NORMALS + i] };
            error = bench_worse(error, fabs((double)(d->out[i] - sh_irradiance(SH_L2, d->c + 9 * k, n))));
        }
    return error;
}

static inline void lights_prepare(bench_case *test) {
    skip_data *data = skip_new(test, SKIP_LIGHTS);
    float *value = bench_alloc_floats(SKIP_LIGHTS);
    for (int i = 0; i < SKIP_LIGHTS; i++)
        value[i] = (float)exp(-(double)(shi_hash((uint32_t)i) % SKIP_LIGHTS) / 64.0) / 64.0f;
    data->value = value;
}

static inline void lights_sum(skip_data *d, float budget, float c[9]) {
    const float *n = d->normals;
    memset(c, 0, 9 * sizeof *c);
    for (int i = 0; i < SKIP_LIGHTS; i++) {
        const float dir[3] = { n[i], n[SKIP_LIGHTS + i], n[2 * SKIP_LIGHTS + i] };
        if (!(budget > 0.0f && d->value[i] < 1e-5f && sh_skip_light(d->value[i], &budget)))
            sh_add_sample(SH_L2, dir, d->value[i], c);
    }
}

static inline void lights_run(bench_case *test) {
    skip_data *d = (skip_data *)test->data;
    lights_sum(d, 1e-2f, d->sum[0]);
}

static inline void lights_all(bench_case *test) {
    skip_data *d = (skip_data *)test->data;
    lights_sum(d, 0.0f, d->sum[1]);
}

static inline double lights_error(bench_case *test, int of_baseline) {
    skip_data *d = (skip_data *)test->data;
    float difference[9];
    lights_all(test);
    for (int i = 0; i < 9; i++)
        difference[i] = d->sum[0][i] - d->sum[1][i];
    return of_baseline ? 0.0
                       : fmax(fabs((double)sh_irradiance_max(SH_L2, difference, NULL)),
                              fabs((double)sh_irradiance_min(SH_L2, difference, NULL)));
}

static inline void skip_add(bench_list *list, const char *name, const char *baseline, size_t items, double tolerance,
                            bench_run prepare, bench_run run, bench_run all, double (*error)(bench_case *, int)) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "skip/%s", name);
    test->items = items;
    test->prepare = prepare;
    test->run = run;
    test->baseline = baseline;
    test->run_baseline = all;
    test->limit.kind = BENCH_COPY;
    test->limit.read = test->limit.written = 3 * sizeof(float);
    test->error = error;
    test->error_bound = tolerance;
}

static inline void bench_closure_cases(bench_list *list) {
    closure_add(list, "closure", CLOSURE_CLOSURE, SH_L1, 0, 9);
    closure_add(list, "closure", CLOSURE_CLOSURE, SH_L1, 1, 13);
    closure_add(list, "closure", CLOSURE_CLOSURE, SH_L2, 0, 28);
    closure_add(list, "closure", CLOSURE_CLOSURE, SH_L2, 1, 31);
    closure_add(list, "geomerics", CLOSURE_GEOMERICS, SH_L1, 0, 25);
    closure_add(list, "zh3", CLOSURE_ZH3, SH_L1, 0, 7);
    analysis_add(list, "closure/prepare/L1/rgb", ANALYSIS_PREPARE, SH_L1);
    analysis_add(list, "closure/prepare/L2/rgb", ANALYSIS_PREPARE, SH_L2);
    analysis_add(list, "closure/prepare/L2/rgb/floor", ANALYSIS_PREPARE_FLOOR, SH_L2);
    analysis_add(list, "analysis/min/L2", ANALYSIS_MIN, SH_L2);
    analysis_add(list, "analysis/dering/L2/rgb", ANALYSIS_DERING, SH_L2);
    skip_add(list, "bands/building/4096", "all L2", SKIP_PROBES, 1e-2, bands_prepare, bands_run, bands_all, bands_error);
    skip_add(list, "grey/L2/1024", "all channels", SKIP_NORMALS, 1e-3, grey_prepare, grey_run, grey_all, grey_error);
    skip_add(list, "lights/L2/4096", "all lights", SKIP_LIGHTS, 1e-2, lights_prepare, lights_run, lights_all, lights_error);
}

#endif /* BENCH_CLOSURE_H */
