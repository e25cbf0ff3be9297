/* batch.h - what the targets for batches have in common: the scalar result of each model, and the tolerance between two. */
#ifndef BATCH_H
#define BATCH_H

#include "backend.h"
#include "fuzz.h"

/* The model's function of one normal. */
static inline float batch_scalar(int model, int order, const float *c, const float n[3]) {
    sh_closure closure;
    switch (model) {
    case FUZZ_RADIANCE:
        return sh_radiance(order, c, n);
    case FUZZ_IRRADIANCE:
        return sh_irradiance(order, c, n);
    case FUZZ_CLOSURE:
        return sh_irradiance_closure(order, c, n);
    case FUZZ_GEOMERICS:
        return sh_irradiance_geomerics(c, n);
    case FUZZ_ZH3:
        return sh_irradiance_zh3(c, n);
    default:
        sh_closure_prepare(order, 1, c, SH_AMBIENT_FLOOR, &closure);
        return sh_closure_irradiance(order, &closure, n);
    }
}

/* The sum of absolute terms of a linear reconstruction, zz among them. */
static inline double batch_terms(int model, int order, const float *c, const float n[3]) {
    const double w1 = model == FUZZ_RADIANCE ? 3.0 : 2.0, w2 = model == FUZZ_RADIANCE ? 7.5 : 1.875;
    double a[9] = { 0 }, v[3], sum;
    for (int i = 0; i < SH_COUNT(order); i++)
        a[i] = fabs((double)c[i]);
    for (int i = 0; i < 3; i++)
        v[i] = fabs((double)n[i]);
    const double zz = a[SH_XX] + a[SH_YY];
    sum = a[SH_R0] + w1 * (a[SH_X] * v[0] + a[SH_Y] * v[1] + a[SH_Z] * v[2]);
    sum += w2 * ((a[SH_XX] + zz) * v[0] * v[0] + (a[SH_YY] + zz) * v[1] * v[1] + zz * (1.0 + v[2] * v[2]));
    return sum + 2.0 * w2 * (a[SH_XY] * v[0] * v[1] + a[SH_XZ] * v[0] * v[2] + a[SH_YZ] * v[1] * v[2]);
}

/* Whether rounding may decide differently in two backends whether some light has these coefficients. */
static inline int batch_undecided(int order, const float *c) {
    float dir[3];
    const float r0 = c[SH_R0], unreal = r0 / 512.0f;
    if (fabsf(r0) < 2e-34f)
        return r0 > 0.5e-34f;
    if (order >= SH_L1 && fabsf(sh_average_direction(c, dir) - (r0 + unreal)) < 2e-3f * r0)
        return 1;
    return order >= SH_L2 && fabsf(sh_ambient_floor(c) + unreal) < 1e-4f * r0;
}

/* How far two backends may be apart at unit normal n: the sum of the bounds of both. Negative: any distance. */
static inline double batch_tolerance(int model, int order, const float *c, const float n[3]) {
    const double terms = batch_terms(model, order, c, n), linear = 12.0 * terms / 8388608.0 + 1e-43;
    if (model == FUZZ_RADIANCE || model == FUZZ_IRRADIANCE || order == SH_L0)
        return linear;
    const int read = model == FUZZ_GEOMERICS || model == FUZZ_ZH3 ? SH_L1 : order;
    if (batch_undecided(read, c))
        return -1.0;
    float lo, hi;
    const double r0 = fabs((double)c[SH_R0]);
    sh_irradiance_bounds(read, c, n, &lo, &hi);
    const double m1 = (double)c[SH_X] * (double)n[0] + (double)c[SH_Y] * (double)n[1] + (double)c[SH_Z] * (double)n[2];
    const double upper = fmax(((double)hi - 2.0 * m1) / r0, 2e-3); /* the root of 8 ulp */
    /* A tenth of what half a step of the coefficients' own rounding does to an L2 closure over its floor is in `linear`. */
    return linear + 2.0 * (2e-6 * r0 + 1e-6 * r0 / upper);
}

#endif /* BATCH_H */
