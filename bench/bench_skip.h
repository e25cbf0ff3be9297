/* bench_skip.h - what is skipped under a tolerance; the baseline does all of it, and the error is the difference between the two. */
#ifndef BENCH_SKIP_H
#define BENCH_SKIP_H

#include "../tests/envs.h"
#include "bench_eval.h"
#include "bench_project.h"

/* ---- skip/bands, grey, lights --------------------------------------------------------------------------------------------------
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

/* Only lights below a thousandth of the budget are offered for skipping: the order is random, and bright ones would spend it. */
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

/* ---- skip/texels: an item is a texel of the whole panorama ---------------------------------------------------------------------
 * A panorama of 32 areas of different brightness with noise on every texel, and a sun of 8 x 8 texels that is as bright as all the rest.
 * mip: its mip levels are there, and the smallest that is enough for a tolerance of 5e-2 R0 is read. sky: the ground is black, and the
 * rows above the horizon are read. dirty: in each frame one of 16 bands of rows changes; each has a sum of its own. */

enum { TEXELS_WIDTH = 2048, TEXELS_HEIGHT = 1024, TEXELS_BANDS = 16, TEXELS_BAND = TEXELS_HEIGHT / TEXELS_BANDS };
enum { TEXELS_MIP, TEXELS_SKY, TEXELS_DIRTY };

static const float texels_tolerance = 5e-2f;

typedef struct texels_data {
    sh_image full, level;
    int frame;
    sh_accum band[TEXELS_BANDS][3];
    float some[27], all[27];
} texels_data;

/* Half the size, by averages over equal angles: rows count by their share of the sphere. */
static inline sh_image texels_half(const sh_image *image) {
    const int width = image->width / 2, height = image->height / 2;
    const float *from = (const float *)image->pixels;
    float *to = bench_alloc_floats(3 * (size_t)width * (size_t)height);
    for (int y = 0; y < height; y++) {
        const double upper = envs_area(2 * y, image->width, image->height),
                     lower = envs_area(2 * y + 1, image->width, image->height);
        for (int x = 0; x < 3 * width; x++) {
            const float *texel = from + 12 * (size_t)width * (size_t)y + 6 * (size_t)(x / 3) + x % 3, *below = texel + 6 * width;
            const double sum = upper * ((double)texel[0] + (double)texel[3]) + lower * ((double)below[0] + (double)below[3]);
            to[3 * (size_t)width * (size_t)y + (size_t)x] = (float)(sum / (2.0 * (upper + lower)));
        }
    }
    const sh_image half = { to, width, height, 0, 3, SH_F32 };
    return half;
}

static inline void texels_prepare(bench_case *test) {
    texels_data *data = (texels_data *)bench_alloc(sizeof *data);
    float *pixels = bench_alloc_floats(3 * TEXELS_WIDTH * TEXELS_HEIGHT);
    data->full = project_image(SH_F32, TEXELS_WIDTH, TEXELS_HEIGHT, 0, (unsigned char *)pixels);
    for (int i = 0; i < 64; i++)
        for (int k = 0; k < 3; k++)
            pixels[3 * ((TEXELS_HEIGHT / 3 + i / 8) * TEXELS_WIDTH + 700 + i % 8) + k] = 3e4f;
    if (test->kind == TEXELS_SKY)
        memset(pixels + 3 * TEXELS_WIDTH * TEXELS_HEIGHT / 2, 0, 3 * TEXELS_WIDTH * TEXELS_HEIGHT / 2 * sizeof *pixels);
    data->level = data->full;
    while (data->level.height > sh_equirect_size_for(SH_L2, texels_tolerance))
        data->level = texels_half(&data->level);
    for (int i = 0; i < TEXELS_BANDS; i++) {
        sh_accum_clear(3, data->band[i]);
        sh_project_equirect_rows(SH_L2, &data->full, 0, i * TEXELS_BAND, TEXELS_BAND, data->band[i], NULL);
    }
    test->data = data;
    test->limit.in = pixels;
}

static inline void texels_run(bench_case *test) {
    texels_data *d = (texels_data *)test->data;
    sh_accum sum[3];
    sh_accum_clear(3, sum);
    if (test->kind == TEXELS_MIP) {
        sh_project_equirect(SH_L2, &d->level, 0, d->some, NULL);
        return;
    }
    if (test->kind == TEXELS_SKY) {
        sh_project_equirect_rows(SH_L2, &d->full, 0, 0, TEXELS_HEIGHT / 2, sum, NULL);
    } else {
        const int dirty = d->frame++ % TEXELS_BANDS;
        sh_accum_clear(3, d->band[dirty]);
        sh_project_equirect_rows(SH_L2, &d->full, 0, dirty * TEXELS_BAND, TEXELS_BAND, d->band[dirty], NULL);
        for (int i = 0; i < TEXELS_BANDS; i++)
            sh_accum_merge(3, d->band[i], sum);
    }
    sh_accum_total(SH_L2, 3, sum, d->some);
}

static inline void texels_all(bench_case *test) {
    texels_data *d = (texels_data *)test->data;
    sh_project_equirect(SH_L2, &d->full, 0, d->all, NULL);
}

/* The largest difference of the irradiance anywhere, of R0. */
static inline double texels_error(bench_case *test, int of_baseline) {
    const texels_data *d = (const texels_data *)test->data;
    double error = 0;
    texels_all(test);
    for (int k = 0; k < 27 && !of_baseline; k += 9) {
        float difference[9];
        for (int i = 0; i < 9; i++)
            difference[i] = d->some[k + i] - d->all[k + i];
        error = bench_worse(error, fabs((double)(sh_irradiance_max(SH_L2, difference, NULL) / d->all[k])));
        error = bench_worse(error, fabs((double)(sh_irradiance_min(SH_L2, difference, NULL) / d->all[k])));
    }
    return error;
}

static inline void texels_add(bench_list *list, const char *name, int kind, double tolerance) {
    bench_case *test = bench_add(list);
    snprintf(test->name, sizeof test->name, "skip/texels/%s/L2/2048x1024", name);
    test->items = (size_t)TEXELS_WIDTH * TEXELS_HEIGHT;
    test->kind = kind;
    test->prepare = texels_prepare;
    test->run = texels_run;
    test->baseline = "all texels";
    test->run_baseline = texels_all;
    test->limit.kind = BENCH_READ;
    test->limit.read = 3 * sizeof(float);
    test->error = texels_error;
    test->error_bound = tolerance;
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

static inline void bench_skip_cases(bench_list *list) {
    skip_add(list, "bands/building/4096", "all L2", SKIP_PROBES, 1e-2, bands_prepare, bands_run, bands_all, bands_error);
    skip_add(list, "grey/L2/1024", "all channels", SKIP_NORMALS, 1e-3, grey_prepare, grey_run, grey_all, grey_error);
    skip_add(list, "lights/L2/4096", "all lights", SKIP_LIGHTS, 1e-2, lights_prepare, lights_run, lights_all, lights_error);
    texels_add(list, "mip", TEXELS_MIP, (double)texels_tolerance);
    texels_add(list, "sky", TEXELS_SKY, 1e-6);
    texels_add(list, "dirty", TEXELS_DIRTY, 1e-6);
}

#endif /* BENCH_SKIP_H */
