/* bench_closure.h - closures and the other models of irradiance, and analysis. The baseline of a model is the linear reconstruction of its
 * order. */
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
}

#endif /* BENCH_CLOSURE_H */
