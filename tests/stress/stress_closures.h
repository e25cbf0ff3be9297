/* stress_closures.h - bounded irradiance, closures and the other models of irradiance, one normal at a time and in batches. */
#ifndef STRESS_CLOSURES_H
#define STRESS_CLOSURES_H

#include "stress_analysis.h"
#include "stress_batches.h"

/* 8 ulp of <t^2>: the allowance for the coefficients' rounding in the bounds. */
static const long double stress_eight_ulp = 8.0L / 16777216.0L;

/* The models by definition: the even part of irradiance, between bounds. b: of the upper one, b R0. */
typedef struct stress_model {
    long double odd, even, lower, upper, size; /* size: R0 */
} stress_model;

/* Of a set of coefficients that light can have: the closure of L1. HG lobe of directionality |u| along u. */
static inline stress_model stress_closure_l1(const long double c[9], const long double n[3]) {
    const long double r1 = sqrtl(oracle_dot(c + 1, c + 1)), g = r1 / c[0], m1 = oracle_dot(c + 1, n),
                      t = r1 > 0.0L ? m1 / r1 : 0.0L;
    stress_model model;
    model.size = c[0];
    model.odd = 2.0L * m1;
    model.even = c[0] * (1.0L + 5.0L / 4.0L * powl(g, 2) * oracle_legendre(2, t) -
                         9.0L / 24.0L * powl(g, 4) * oracle_legendre(4, t) + 13.0L / 64.0L * powl(g, 6) * oracle_legendre(6, t));
    model.lower = 2.0L * fabsl(m1);
    model.upper = 2.0L * sqrtl(fmaxl(0.0L, c[0] * c[0] - r1 * r1 + m1 * m1));
    return model;
}

/* The closure of L2, over an ambient light of `floor`. */
static inline stress_model stress_closure_l2(const long double c[9], long double floor, const long double n[3]) {
    const long double w = fmaxl(c[0] - floor, c[0] / 1024.0L);
    long double r2[3][3], an[3], f = 0.0L;
    stress_model model;
    oracle_matrix(c, r2);
    for (int i = 0; i < 3; i++) {
        an[i] = oracle_dot(r2[i], n) / w;
        f += oracle_dot(r2[i], r2[i]) / (w * w);
    }
    const long double q = oracle_dot(an, n), a = oracle_dot(an, an), w3 = w * w * w;
    const long double det =
        (r2[0][0] * (r2[1][1] * r2[2][2] - r2[1][2] * r2[1][2]) - r2[0][1] * (r2[0][1] * r2[2][2] - r2[1][2] * r2[0][2]) +
         r2[0][2] * (r2[0][1] * r2[1][2] - r2[1][1] * r2[0][2])) /
        w3;
    const long double t4 = q * q - 4.0L / 7.0L * a + 2.0L / 35.0L * f;
    const long double t6 = q * (q * q - 12.0L / 11.0L * a + 2.0L / 11.0L * f) + 16.0L / 77.0L * det;
    const long double m2 = oracle_quadratic(c, n) + c[0] / 3.0L;
    model.size = c[0];
    model.odd = 2.0L * oracle_dot(c + 1, n);
    model.even = c[0] + w * (15.0L / 8.0L * q - 105.0L / 64.0L * t4 + 3003.0L / 1024.0L * t6);
    model.lower = fmaxl(fabsl(model.odd), 2.0L * m2);
    model.upper = 2.0L * sqrtl(fmaxl(0.0L, c[0] * m2));
    return model;
}

/* Where the smallest eigenvalue of the moments, in units of R0, is this near to -1/512, either answer is right. */
static inline int stress_undecided(long double floor) {
    return fabsl(floor + 1.0L / 512.0L) < 1e-4L;
}

/* The contract: 3e-6 R0, and where the upper bound b R0 decides, 3e-6 R0 / b; 1 is all of it. */
static inline long double stress_root_error(long double size, long double upper) {
    return 3e-6L * size * size / upper; /* where the bound is nearly 0, all of it is rounding */
}

/* What decides whether the bounds and closures take a set for a light's. */
typedef struct stress_nature {
    long double floor; /* of an L2 set */
    int light, undecided;
} stress_nature;

static inline stress_nature stress_nature_of(int order, const float *set, const long double *c) {
    stress_nature nature = { 0.0L, 0, 0 };
    if (!(set[0] > 1e-34f))
        return nature;
    const long double excess = oracle_dot(c + 1, c + 1) / (c[0] * c[0]) - 1.0L;
    nature.floor = order == SH_L1 ? 0.0L : stress_floor(c);
    nature.light = order == SH_L1 ? excess <= 1.0L / 512.0L : nature.floor >= -c[0] / 512.0L;
    nature.undecided = stress_undecided(order == SH_L1 ? -excess : nature.floor / c[0]);
    return nature;
}

static inline void stress_compare_closure(stress_measure *m, int order, const float *set, const float *dir, int over_floor,
                                          float actual) {
    long double c[9], n[3];
    stress_widen_set(order, set, c);
    oracle_widen(dir, 3, n);
    const stress_nature nature = stress_nature_of(order, set, c);
    if (nature.undecided)
        return;
    if (!nature.light) {
        stress_compare(m, actual, fmaxl(0.0L, oracle_expand(c, stress_lambert_kernel, n)),
                       3e-6L * stress_terms(c, stress_lambert_kernel, n));
        return;
    }
    const stress_model model =
        order == SH_L1 ? stress_closure_l1(c, n) : stress_closure_l2(c, over_floor ? fmaxl(nature.floor, 0.0L) : 0.0L, n);
    const long double root = stress_root_error(model.size, model.upper);
    const long double even = fmaxl(model.lower, fminl(model.even, model.upper));
    stress_compare(m, actual, even + model.odd, 3e-6L * model.size + (model.even >= model.upper - root ? root : 0.0L));
}

static inline void stress_closure_order(stress_measure *m, int order, const float *set, const float *dir, unsigned flags) {
    const float *x = dir, *y = dir + 1, *z = dir + 2;
    sh_closure closure;
    float batch[STRESS_BATCH], xs[STRESS_BATCH], ys[STRESS_BATCH], zs[STRESS_BATCH];
    sh_closure_prepare(order, 1, set, flags, &closure);
    stress_compare_closure(m, order, set, dir, flags == SH_AMBIENT_FLOOR, sh_closure_irradiance(order, &closure, dir));
    stress_repeat(*x, *y, *z, xs, ys, zs);
    sh_closure_irradiance_batch(order, 1, &closure, xs, ys, zs, batch, STRESS_BATCH);
    stress_compare_closure(m, order, set, dir, flags == SH_AMBIENT_FLOOR, stress_same(m, batch, 1));
    if (flags)
        return;
    stress_compare_closure(m, order, set, dir, 0, sh_irradiance_closure(order, set, dir));
    sh_irradiance_closure_batch(order, 1, set, xs, ys, zs, batch, STRESS_BATCH);
    stress_compare_closure(m, order, set, dir, 0, stress_same(m, batch, 1));
}

static inline void stress_closure(const float *in, stress_measure *m) {
    stress_closure_order(m, SH_L1, in, in + 9, 0);
    stress_closure_order(m, SH_L2, in, in + 9, 0);
}

static inline void stress_closure_over_floor(const float *in, stress_measure *m) {
    stress_closure_order(m, SH_L2, in, in + 9, SH_AMBIENT_FLOOR);
}

/* I(n) - I(-n) = 4 n.R1, and never negative, for sets that light can have. */
static inline void stress_antipodal(const float *in, stress_measure *m) {
    const float back[3] = { -in[9], -in[10], -in[11] };
    long double c[9], n[3];
    stress_widen_set(SH_L2, in, c);
    oracle_widen(in + 9, 3, n);
    for (int order = SH_L1; order <= SH_L2; order++) {
        const float here = sh_irradiance_closure(order, in, in + 9), there = sh_irradiance_closure(order, in, back);
        stress_require(m, here >= -1e-6f * in[0] && there >= -1e-6f * in[0]);
        if (in[0] > 1e-34f)
            stress_error(m, fabsl((long double)here - (long double)there - 4.0L * oracle_dot(c + 1, n)), c[0]);
    }
}

/* in: four directions and their shares, a normal. The truth is between the bounds. */
static inline void stress_bounds_hold(const float *in, stress_measure *m) {
    long double c[9] = { 0.0L }, n[3], truth = 0.0L;
    float set[9], lo, hi;
    oracle_source source[4];
    oracle_widen(in + 16, 3, n);
    for (int i = 0; i < 4; i++) {
        long double length;
        oracle_widen(in + 3 * i, 3, source[i].dir);
        length = sqrtl(oracle_dot(source[i].dir, source[i].dir));
        for (int k = 0; k < 3; k++)
            source[i].dir[k] = length > 0.0L ? source[i].dir[k] / length : k == 2;
        source[i].mean = (long double)in[12 + i];
    }
    const long double length = sqrtl(oracle_dot(n, n));
    if (!(length > 0.0L))
        return;
    for (int k = 0; k < 3; k++)
        n[k] /= length;
    oracle_moments_sources(source, 4, c);
    truth = oracle_irradiance_sources(source, 4, n);
    for (int i = 0; i < 9; i++)
        set[i] = (float)c[i];
    if (!(set[0] > 1e-34f))
        return;
    for (int order = SH_L0; order <= SH_L2; order++) {
        sh_irradiance_bounds(order, set, in + 16, &lo, &hi);
        stress_error(m, fmaxl(0.0L, (long double)lo - truth), c[0]);
        stress_error(m, fmaxl(0.0L, truth - (long double)hi), c[0]);
    }
}

/* The bounds by definition; of what is no light's, the linear reconstruction. */
static inline void stress_bounds(const float *in, stress_measure *m) {
    for (int order = SH_L1; order <= SH_L2; order++) {
        long double c[9], n[3];
        stress_widen_set(order, in, c);
        oracle_widen(in + 9, 3, n);
        const stress_nature nature = stress_nature_of(order, in, c);
        if (nature.undecided)
            continue;
        float lo, hi;
        sh_irradiance_bounds(order, in, in + 9, &lo, &hi);
        if (!nature.light) {
            stress_require(m, lo == hi);
            stress_compare(m, lo, fmaxl(0.0L, oracle_expand(c, stress_lambert_kernel, n)),
                           3e-6L * stress_terms(c, stress_lambert_kernel, n));
            continue;
        }
        const long double m1 = oracle_dot(c + 1, n), m2 = oracle_quadratic(c, n) + c[0] / 3.0L * oracle_dot(n, n);
        const long double lower = order == SH_L1 ? fabsl(m1) : fmaxl(fabsl(m1), m2);
        const long double square =
            (order == SH_L1 ? c[0] * c[0] - oracle_dot(c + 1, c + 1) + m1 * m1 : c[0] * m2) + c[0] * c[0] * stress_eight_ulp;
        const long double upper = fmaxl(lower, sqrtl(fmaxl(0.0L, square)));
        stress_compare(m, lo, 2.0L * (lower + m1), 3e-6L * c[0]);
        stress_compare(m, hi, 2.0L * (upper + m1), 3e-6L * c[0] + stress_root_error(c[0], fmaxl(2.0L * upper, 1e-3L * c[0])));
    }
}

/* Geomerics' model and ZH3 hallucination. The ratio r = |R1| / R0 counts as 1 up to a little above. */
static inline void stress_other_models(const float *in, stress_measure *m) {
    long double c[9], n[3], sets[2];
    float xs[STRESS_BATCH], ys[STRESS_BATCH], zs[STRESS_BATCH], batch[STRESS_BATCH];
    stress_widen_set(SH_L1, in, c);
    oracle_widen(in + 9, 3, n);
    const long double r1 = sqrtl(oracle_dot(c + 1, c + 1)), ratio = c[0] > 0.0L ? r1 / c[0] : 2.0L;
    if (fabsl(ratio - 1.0L - 1.0L / 512.0L) < 1e-5L)
        return;
    const int real = in[0] > 1e-34f && ratio <= 1.0L + 1.0L / 512.0L;
    const long double scale = real ? c[0] : stress_terms(c, stress_lambert_kernel, n);
    if (!real) {
        sets[0] = sets[1] = fmaxl(0.0L, oracle_expand(c, stress_lambert_kernel, n));
    } else {
        const long double r = fminl(ratio, 1.0L), t = r1 > 0.0L ? oracle_dot(c + 1, n) / r1 : n[2];
        const long double p = 1.0L + 2.0L * r, a = (1.0L - r) / (1.0L + r), q = fminl(1.0L, fmaxl(0.0L, 0.5L + 0.5L * t));
        const long double second = 0.0619677L * r + 0.804984L * r * r;
        sets[0] = c[0] * (a + (1.0L - a) * (p + 1.0L) * powl(q, p));
        sets[1] = fmaxl(0.0L, c[0] * (1.0L + 2.0L * r * t + 1.875L * second * (t * t - 1.0L / 3.0L)));
    }
    stress_repeat(in[9], in[10], in[11], xs, ys, zs);
    stress_compare(m, sh_irradiance_geomerics(in, in + 9), sets[0], scale);
    stress_compare(m, sh_irradiance_zh3(in, in + 9), sets[1], scale);
    sh_irradiance_geomerics_batch(SH_L1, 1, in, xs, ys, zs, batch, STRESS_BATCH);
    stress_compare(m, stress_same(m, batch, 1), sets[0], scale);
    sh_irradiance_zh3_batch(SH_L1, 1, in, xs, ys, zs, batch, STRESS_BATCH);
    stress_compare(m, stress_same(m, batch, 1), sets[1], scale);
}

static const stress_case stress_closure_cases[] = {
    { "sh_irradiance_bounds, by definition", "3e-6 R0, upper + 3e-6 R0 / b",
      STRESS_SHARE, 1.0, { LIGHT(1), DIRECTION }, stress_bounds, 2 },
    { "sh_irradiance_bounds, of any set", "the same, or the linear one", STRESS_SHARE, 1.0, { SET(9), DIRECTION }, stress_bounds, 2 },
    { "sh_irradiance_bounds, against light", "the truth is inside, to 2e-6 R0",
      STRESS_RELATIVE, 2e-6, { DIRECTIONS(4), NUMBERS(4, 0.0, 1.0), DIRECTION }, stress_bounds_hold, 4 },
    { "sh_irradiance_closure, sh_closure_irradiance, batches", "3e-6 R0, + 3e-6 R0 / b at the upper bound",
      STRESS_SHARE, 1.0, { LIGHT(1), DIRECTION }, stress_closure, 16 },
    { "sh_irradiance_closure, of any set", "3e-6 of the sum of absolute terms",
      STRESS_SHARE, 1.0, { SET(9), DIRECTION }, stress_closure, 16 },
    { "sh_closure_prepare with SH_AMBIENT_FLOOR, batches", "3e-6 R0, + 3e-6 R0 / b at the upper bound",
      STRESS_SHARE, 1.0, { LIGHT(1), DIRECTION }, stress_closure_over_floor, 16 },
    { "sh_irradiance_closure, I(n) - I(-n) = 4 n.R1", "2e-6 R0",
      STRESS_RELATIVE, 2e-6, { LIGHT(1), DIRECTION }, stress_antipodal, 2 },
    { "sh_irradiance_geomerics, _zh3, batches", "4e-6 R0", STRESS_RELATIVE, 4e-6, { LIGHT(1), DIRECTION }, stress_other_models, 8 },
    { "sh_irradiance_geomerics, _zh3, of any set", "4e-6 R0, or of the linear terms",
      STRESS_RELATIVE, 4e-6, { SET(9), DIRECTION }, stress_other_models, 8 },
};

#endif /* STRESS_CLOSURES_H */
