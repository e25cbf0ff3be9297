/* stress_analysis.h - directionality, extrema, certificates, de-ringing, what may be skipped. */
#ifndef STRESS_ANALYSIS_H
#define STRESS_ANALYSIS_H

#include "stress_coefficients.h"

/* Eigenvalues, not sorted, and the orthonormal columns of `axis`, of a symmetric n x n matrix, n <= 4. Jacobi's rotations. */
static inline void stress_eigen(int n, long double m[4][4], long double axis[4][4]) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            axis[i][j] = i == j ? 1.0L : 0.0L;
    for (int sweep = 0; sweep < 12; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) {
                if (m[p][q] == 0.0L)
                    continue;
                const long double theta = (m[q][q] - m[p][p]) / (2.0L * m[p][q]);
                const long double t = (theta < 0.0L ? -1.0L : 1.0L) / (fabsl(theta) + sqrtl(theta * theta + 1.0L));
                const long double c = 1.0L / sqrtl(t * t + 1.0L), s = t * c;
                for (int k = 0; k < n; k++) {
                    const long double kp = m[k][p], kq = m[k][q], ap = axis[k][p], aq = axis[k][q];
                    m[k][p] = c * kp - s * kq;
                    m[k][q] = s * kp + c * kq;
                    axis[k][p] = c * ap - s * aq;
                    axis[k][q] = s * ap + c * aq;
                }
                for (int k = 0; k < n; k++) {
                    const long double pk = m[p][k], qk = m[q][k];
                    m[p][k] = c * pk - s * qk;
                    m[q][k] = s * pk + c * qk;
                }
            }
}

/* The smallest eigenvalue of [[R0, sqrt3 R1'], [sqrt3 R1, R0 I + 3 R2]]. */
static inline long double stress_floor(const long double c[9]) {
    long double r2[3][3], m[4][4], axis[4][4], least;
    oracle_matrix(c, r2);
    for (int i = 0; i < 3; i++) {
        m[0][i + 1] = m[i + 1][0] = sqrtl(3.0L) * c[1 + i];
        for (int j = 0; j < 3; j++)
            m[i + 1][j + 1] = (i == j ? c[0] : 0.0L) + 3.0L * r2[i][j];
    }
    m[0][0] = c[0];
    stress_eigen(4, m, axis);
    least = m[0][0];
    for (int i = 1; i < 4; i++)
        least = fminl(least, m[i][i]);
    return least;
}

static inline long double stress_floor_l1(const long double c[9]) {
    return c[0] - sqrtl(oracle_dot(c + 1, c + 1));
}

/* The least value over the sphere of c0 + w1 R1.n + w2 n'R2 n: that of its Lagrangian, maximal in the multiplier, which is strongly
 * dual. By bisection, in the frame of the eigenvectors. */
static inline long double stress_least(const long double c[9], long double w1, long double w2) {
    long double r2[3][3], m[4][4], axis[4][4], half[3], gap[3], lowest;
    oracle_matrix(c, r2);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = w2 * r2[i][j];
    stress_eigen(3, m, axis);
    lowest = fminl(m[0][0], fminl(m[1][1], m[2][2]));
    for (int i = 0; i < 3; i++) {
        half[i] = 0.0L;
        for (int j = 0; j < 3; j++)
            half[i] += 0.5L * w1 * axis[j][i] * c[1 + j];
        gap[i] = m[i][i] - lowest;
    }
    long double from = 0.0L, to = fabsl(half[0]) + fabsl(half[1]) + fabsl(half[2]);
    for (int step = 0; step < 120; step++) {
        const long double t = 0.5L * (from + to);
        long double norm = 0.0L;
        for (int i = 0; i < 3; i++)
            if (half[i] != 0.0L)
                norm += half[i] / (gap[i] + t) * (half[i] / (gap[i] + t));
        if (norm > 1.0L)
            from = t;
        else
            to = t;
    }
    long double value = c[0] + lowest - to;
    for (int i = 0; i < 3; i++)
        if (half[i] != 0.0L)
            value -= half[i] * half[i] / (gap[i] + to);
    return value;
}

static inline long double stress_greatest(const long double c[9], long double w1, long double w2) {
    long double minus[9];
    for (int i = 0; i < 9; i++)
        minus[i] = -c[i];
    return -stress_least(minus, w1, w2);
}

/* The largest |irradiance| anywhere. */
static inline long double stress_largest(const long double c[9]) {
    return fmaxl(fabsl(stress_least(c, 2.0L, 1.875L)), fabsl(stress_greatest(c, 2.0L, 1.875L)));
}

static inline long double stress_largest_coefficient(const long double c[9]) {
    long double largest = 0.0L;
    for (int i = 0; i < 9; i++)
        largest = fmaxl(largest, fabsl(c[i]));
    return largest;
}

static inline void stress_directions(const float *in, stress_measure *m) {
    long double c[9], length;
    float dir[3];
    stress_widen_set(SH_L1, in, c);
    length = sqrtl(oracle_dot(c + 1, c + 1));
    stress_compare(m, sh_average_direction(in, dir), length, length);
    for (int i = 0; i < 3; i++)
        stress_compare(m, dir[i], length > 0.0L ? c[1 + i] / length : i == 2, 1.0L);
    stress_compare(m, sh_directionality(in), c[0] > 0.0L ? fminl(1.0L, length / c[0]) : 0.0L,
                   c[0] > 0.0L ? fminl(1.0L, length / c[0]) : 0.0L);
}

/* Of three channels, about the direction that is returned. */
static inline void stress_dominant(const float *in, stress_measure *m) {
    float dir[3], intensity[3], ambient[3];
    long double n[3], c[9];
    sh_dominant_light(SH_L2, 3, in, dir, intensity, ambient);
    oracle_widen(dir, 3, n);
    stress_compare(m, (float)sqrtl(oracle_dot(n, n)), 1.0L, 1.0L);
    for (int k = 0; k < 3; k++) {
        long double terms = 0.0L;
        stress_widen_set(SH_L1, in + 9 * k, c);
        for (int i = 0; i < 3; i++)
            terms += fabsl(c[1 + i] * n[i]);
        const long double beam = fmaxl(0.0L, oracle_dot(c + 1, n));
        stress_compare(m, intensity[k], 4.0L * beam, 4.0L * terms);
        stress_compare(m, ambient[k], c[0] - beam, fabsl(c[0]) + terms);
    }
}

static inline void stress_extremum(stress_measure *m, int order, const float *in, const long double kernel[3], float value,
                                   const float at[3], int greatest) {
    long double c[9], n[3];
    const long double w1 = 3.0L * kernel[1], w2 = 7.5L * kernel[2];
    stress_widen_set(order, in, c);
    oracle_widen(at, 3, n);
    const long double expected = greatest ? stress_greatest(c, w1, w2) : stress_least(c, w1, w2),
                      size = stress_largest_coefficient(c);
    stress_compare(m, value, expected, size);
    stress_error(m, fabsl(oracle_expand(c, kernel, n) - expected), size); /* `at` has it */
    stress_error(m, fabsl(oracle_dot(n, n) - 1.0L) / 4.0L, 1.0L);
}

static inline void stress_extrema(const float *in, stress_measure *m) {
    for (int order = SH_L1; order <= SH_L2; order++) {
        float at[3] = { 0.0f, 0.0f, 0.0f };
        float value = sh_min(order, in, at);
        stress_extremum(m, order, in, stress_radiance_kernel, value, at, 0);
        value = sh_max(order, in, at);
        stress_extremum(m, order, in, stress_radiance_kernel, value, at, 1);
        value = sh_irradiance_min(order, in, at);
        stress_extremum(m, order, in, stress_lambert_kernel, value, at, 0);
        value = sh_irradiance_max(order, in, at);
        stress_extremum(m, order, in, stress_lambert_kernel, value, at, 1);
    }
}

static inline void stress_ambient_floor(const float *in, stress_measure *m) {
    long double c[9];
    stress_widen_set(SH_L2, in, c);
    stress_compare(m, sh_ambient_floor(in), stress_floor(c), stress_largest_coefficient(c));
}

static inline void stress_realizable(const float *in, stress_measure *m) {
    long double c[9];
    stress_widen_set(SH_L2, in, c);
    for (int order = SH_L1; order <= SH_L2; order++) {
        const long double floor = order == SH_L1 ? stress_floor_l1(c) : stress_floor(c);
        const int is = sh_is_realizable(order, in);
        stress_error(m, is ? fmaxl(0.0L, -floor) : in[0] >= 0.0f ? fmaxl(0.0L, floor) : 0.0L, is || in[0] > 0.0f ? c[0] : 1.0L);
    }
}

/* The window that de-ringing chose: no channel is negative; and 2e-4 weaker, one is. */
static inline void stress_dering(const float *in, stress_measure *m) {
    for (int window = SH_WINDOW_HANN; window <= SH_WINDOW_LAPLACIAN; window++) {
        float out[18], weaker[18], zonal[3];
        long double worst = 0.0L, ring = 0.0L;
        const float parameter = sh_dering(SH_L2, 2, in, (sh_window)window, out);
        const float less = window == SH_WINDOW_LAPLACIAN ? parameter * (1.0f - 4e-4f * (1.0f + parameter)) : parameter * 1.0004f;
        if (window == SH_WINDOW_HANN)
            sh_zonal_hann(less, zonal);
        else if (window == SH_WINDOW_LANCZOS)
            sh_zonal_lanczos(less, zonal);
        else
            sh_zonal_laplacian(less, zonal);
        for (int k = 0; k < 2; k++) {
            long double c[9];
            if (!(in[9 * k] > 1e-30f)) /* below, coefficients are too coarse to judge */
                continue;
            sh_convolve(SH_L2, in + 9 * k, zonal, weaker + 9 * k);
            stress_widen_set(SH_L2, out + 9 * k, c);
            worst = fmaxl(worst, -stress_least(c, 3.0L, 7.5L) / c[0]);
            stress_widen_set(SH_L2, weaker + 9 * k, c);
            ring = fmaxl(ring, -stress_least(c, 3.0L, 7.5L) / c[0]);
        }
        stress_error(m, worst, 1.0L);
        /* Lambda or the width at the ends of the families is not changed by a little. */
        if (in[0] > 1e-30f && in[9] > 1e-30f && parameter < 1e3f &&
            (window == SH_WINDOW_LAPLACIAN ? parameter > 1e-3f : parameter > 1.001f))
            stress_require(m, ring > 0.0L);
    }
}

/* What dropping bands costs, by the tolerance that allowed it. */
static inline void stress_order(const float *in, stress_measure *m) {
    const float tolerance = in[9];
    for (int radiance = 0; radiance < 2; radiance++) {
        const int order = radiance ? sh_radiance_order_needed(in, tolerance) : sh_order_needed(in, tolerance);
        const long double w1 = radiance ? 3.0L : 2.0L, w2 = radiance ? 7.5L : 1.875L;
        long double c[9];
        stress_widen_set(SH_L2, in, c);
        for (int i = 0; i < SH_COUNT(order); i++)
            c[i] = 0.0L;
        if (order < SH_L2)
            stress_error(m, fmaxl(-stress_least(c, w1, w2), stress_greatest(c, w1, w2)), (long double)tolerance);
    }
}

static inline void stress_grey(const float *in, stress_measure *m) {
    const float tolerance = in[18];
    float sets[18];
    long double c[9], d[9];
    memcpy(sets, in, sizeof sets);
    for (int i = 0; i < 9; i++) /* channel 1 is nearly channel 0 */
        sets[9 + i] = in[i] + 0.1f * tolerance * in[9 + i];
    oracle_widen(sets, 9, c);
    oracle_widen(sets + 9, 9, d);
    for (int i = 0; i < 9; i++)
        d[i] -= c[i];
    if (sh_is_grey(SH_L2, 2, sets, tolerance))
        stress_error(m, stress_largest(d), (long double)tolerance);
}

/* in: eight values of lights that come from one direction, a budget. */
static inline void stress_skip(const float *in, stress_measure *m) {
    float budget = in[8];
    long double spent = 0.0L;
    for (int i = 0; i < 8; i++)
        if (sh_skip_light(in[i], &budget))
            spent += 4.25L * fabsl((long double)in[i]);
    if (spent > 0.0L)
        stress_error(m, spent, (long double)in[8]);
    stress_require(m, budget >= 0.0f);
}

static const stress_case stress_analysis_cases[] = {
    { "sh_directionality, sh_average_direction", "1 ulp of each (directions: of 1)",
      STRESS_ULP, 1.0, { SET(9) }, stress_directions, 1 },
    { "sh_dominant_light", "4 ulp of the sum of absolute terms, about its own direction",
      STRESS_ULP, 4.0, { SET(27) }, stress_dominant, 1 },
    { "sh_min, sh_max, sh_irradiance_min, _max", "2e-6 of the largest coefficient; so is the value at `at`",
      STRESS_RELATIVE, 2e-6, { SET(9) }, stress_extrema, 60 },
    { "sh_min, sh_max, sh_irradiance_min, _max, of light", "2e-6 of the largest coefficient; so is the value at `at`",
      STRESS_RELATIVE, 2e-6, { LIGHT(1) }, stress_extrema, 60 },
    { "sh_ambient_floor, of light", "1e-6 R0", STRESS_RELATIVE, 1e-6, { LIGHT(1) }, stress_ambient_floor, 10 },
    { "sh_ambient_floor, of any set", "1e-6 of the largest coefficient",
      STRESS_RELATIVE, 1e-6, { SET(9) }, stress_ambient_floor, 10 },
    { "sh_is_realizable, of light", "right to 2e-6 R0", STRESS_RELATIVE, 2e-6, { LIGHT(1) }, stress_realizable, 10 },
    { "sh_is_realizable, of any set", "right to 2e-6 R0", STRESS_RELATIVE, 2e-6, { SET(9) }, stress_realizable, 10 },
    { "sh_dering", "no radiance below -1e-6 R0; a weaker window leaves some",
      STRESS_RELATIVE, 1e-6, { LIGHT(2) }, stress_dering, 400 },
    { "sh_order_needed, sh_radiance_order_needed", "no change above the tolerance",
      STRESS_SHARE, 1.0 + 1e-6, { SET(9), NUMBER(0.0, 10.0) }, stress_order, 30 },
    { "sh_is_grey", "no difference above the tolerance",
      STRESS_SHARE, 1.0 + 1e-6, { SET(18), NUMBER(1e-6, 1e18) }, stress_grey, 30 },
    { "sh_skip_light", "no more than the budget is spent",
      STRESS_SHARE, 1.0 + 1e-6, { SET(8), NUMBER(0.0, 1e18) }, stress_skip, 1 },
};

#endif /* STRESS_ANALYSIS_H */
