/* shlight_scene.h - one panorama, and how well models of irradiance describe its light. */
#ifndef SHLIGHT_SCENE_H
#define SHLIGHT_SCENE_H

#include "sh.h"

#include "shlight_image.h"
#include "shlight_reference.h"

/* What a model prepares of one channel's coefficients, once for many normals. */
typedef union model_state {
    float c[SH_COUNT(SH_L2)];
    sh_closure closure;
} model_state;

typedef struct model {
    const char *name, *formula;
    int order;                                                     /* reads SH_COUNT(order) coefficients a channel */
    void (*prepare)(const float *c, model_state *state);           /* NULL: copies the coefficients */
    float (*evaluate)(const model_state *state, const float n[3]); /* irradiance / pi */
} model;

enum { NORMALS = 4096 };

/* Errors over all normals and channels, relative to R0 of the channel; lowest: the least irradiance, relative likewise. */
typedef struct model_error {
    double rms, max, lowest;
} model_error;

/* Of the bounds of one order, over all normals and channels, relative likewise: their mean distance, and by how much the truth is beyond
 * one of them at most. */
typedef struct bounds_error {
    double width, beyond;
} bounds_error;

enum { MAX_MODELS = 16 };

/* Everything that is known of one panorama. Irradiance, and coefficients for the models, are in units of their channel's R0: errors
 * are then relative to it, and no magnitude of radiance is too much for float arithmetic. */
typedef struct scene {
    const char *name;
    int order;
    shlight_image image;
    sh_report report;
    float c[3 * SH_COUNT(SH_L2)];        /* as projected */
    double unit[3];                      /* R0 of each channel; 1 for a black one */
    float relative[3 * SH_COUNT(SH_L2)]; /* c / unit */
    float weight[3];                     /* R0 of each channel over the greatest: from units to what is seen */
    shlight_blocks *blocks;              /* the brute force */
    float (*normal)[3];                  /* NORMALS, evenly spread */
    float (*truth)[3];                   /* of each normal, all channels */
    float brightest;                     /* the largest truth, weighted */
    const model *models[MAX_MODELS];     /* those to compare, of this order or less */
    model_error error[MAX_MODELS];       /* of each */
    int model_count;
    bounds_error bounds[3]; /* [order] */
    int show_bounds;
} scene;

static void scene_free(scene *s) {
    free(s->image.pixels);
    free(s->blocks);
    free(s->normal);
    free(s->truth);
}

/* Channel k as a model wants it. */
static void scene_prepare(const scene *s, const model *m, int k, model_state *state) {
    const float *c = s->relative + k * SH_COUNT(s->order);
    if (m->prepare)
        m->prepare(c, state);
    else
        memcpy(state->c, c, sizeof(float) * (size_t)SH_COUNT(m->order));
}

static model_error measure_model(const scene *s, const model *m) {
    model_error e = { 0.0, 0.0, 1e30 };
    for (int k = 0; k < s->image.channels; k++) {
        model_state state;
        scene_prepare(s, m, k, &state);
        for (int i = 0; i < NORMALS; i++) {
            const double estimate = (double)m->evaluate(&state, s->normal[i]);
            const double error = estimate - (double)s->truth[i][k];
            e.rms += error * error;
            e.max = fmax(e.max, fabs(error));
            e.lowest = fmin(e.lowest, estimate);
        }
    }
    e.rms = sqrt(e.rms / (NORMALS * s->image.channels));
    return e;
}

static bounds_error measure_bounds(const scene *s, int order) {
    bounds_error e = { 0.0, 0.0 };
    for (int k = 0; k < s->image.channels; k++)
        for (int i = 0; i < NORMALS; i++) {
            const float truth = s->truth[i][k];
            float lo, hi;
            sh_irradiance_bounds(order, s->relative + k * SH_COUNT(s->order), s->normal[i], &lo, &hi);
            e.width += (double)(hi - lo) / (NORMALS * s->image.channels);
            e.beyond = fmax(e.beyond, (double)fmaxf(lo - truth, truth - hi));
        }
    return e;
}

/* A channel without any R0 is black: clamped radiance has no other way to a mean of 0. */
static void scene_units(scene *s) {
    const int stride = SH_COUNT(s->order);
    double greatest = 0.0;
    for (int k = 0; k < s->image.channels; k++) {
        const double r0 = (double)s->c[k * stride];
        greatest = fmax(greatest, r0);
        s->unit[k] = r0 > 0.0 ? r0 : 1.0;
        for (int i = 0; i < stride; i++)
            s->relative[k * stride + i] = (float)((double)s->c[k * stride + i] / s->unit[k]);
    }
    for (int k = 0; k < s->image.channels; k++)
        s->weight[k] = greatest > 0.0 ? (float)((double)s->c[k * stride] / greatest) : 0.0f;
}

/* Where most light comes from, all channels together, by the moments of the brute force; returns 0 if from nowhere in particular. */
static int scene_main_direction(const scene *s, float dir[3]) {
    double sum[3] = { 0.0, 0.0, 0.0 };
    for (int k = 0; k < s->image.channels; k++)
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += (double)s->weight[k] * s->blocks->total[k][axis];
    const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int axis = 0; axis < 3; axis++)
        dir[axis] = length > 1e-6 ? (float)(sum[axis] / length) : 0.0f;
    return length > 1e-6;
}

/* Projects the image and cleans it. NULL, or what is wrong with it. */
static const char *scene_project(scene *s) {
    const sh_image image = { s->image.pixels, s->image.width, s->image.height, 0, s->image.channels, SH_F32 };
    const int count = SH_COUNT(s->order) * s->image.channels;
    if (sh_project_equirect(s->order, &image, SH_CLAMP_NEGATIVE | SH_CLOCKWISE, s->c, &s->report) != SH_OK)
        return "cannot be projected";
    for (int i = 0; i < count; i++)
        if (!isfinite(s->c[i]))
            return "its radiance is too large to add up";
    scene_units(s);
    shlight_clean(&s->image);
    return NULL;
}

/* Half of the normals and their irradiance; the other half are the opposites. */
static void scene_true_irradiance(scene *s) {
    const int half = NORMALS / 2;
    for (int i = 0; i < half; i++) {
        sh_direction_fibonacci((uint32_t)i, (uint32_t)half, s->normal[i]);
        for (int axis = 0; axis < 3; axis++)
            s->normal[half + i][axis] = -s->normal[i][axis];
        shlight_irradiance(s->blocks, s->normal[i], s->truth[i]);
        shlight_irradiance_opposite(s->blocks, s->normal[i], s->truth[i], s->truth[half + i]);
    }
}

/* Compares the models with brute force. -1: not enough memory. */
static int scene_measure(scene *s) {
    const double scale[3] = { 1.0 / s->unit[0], 1.0 / s->unit[1], 1.0 / s->unit[2] };
    s->blocks = shlight_blocks_new(&s->image, scale);
    s->normal = (float(*)[3])malloc(NORMALS * sizeof *s->normal);
    s->truth = (float(*)[3])malloc(NORMALS * sizeof *s->truth);
    if (!s->blocks || !s->normal || !s->truth)
        return -1;
    scene_true_irradiance(s);
    s->brightest = 0.0f;
    for (int i = 0; i < NORMALS; i++)
        for (int k = 0; k < s->image.channels; k++)
            s->brightest = fmaxf(s->brightest, s->weight[k] * s->truth[i][k]);
    for (int i = 0; i < s->model_count; i++)
        s->error[i] = measure_model(s, s->models[i]);
    for (int order = SH_L1; order <= s->order; order++)
        s->bounds[order] = measure_bounds(s, order);
    return 0;
}

#endif /* SHLIGHT_SCENE_H */
