/* stress_coefficients.h - coefficients, linear reconstruction, zonal kernels. */
#ifndef STRESS_COEFFICIENTS_H
#define STRESS_COEFFICIENTS_H

#include "stress.h"

/* ---- Reconstruction ------------------------------------------------------------------------------------------------------------- */

static const long double stress_radiance_kernel[3] = { 1.0L, 1.0L, 1.0L };
static const long double stress_lambert_kernel[3] = { 1.0L, 2.0L / 3.0L, 0.25L };

/* The absolute terms of band 2, zz's two among them. */
static inline long double stress_second_terms(const long double c[9], const long double n[3]) {
    const long double xx = n[0] * n[0], yy = n[1] * n[1], zz = n[2] * n[2];
    return fabsl(c[4]) * (xx + zz) + fabsl(c[7]) * (yy + zz) +
           2.0L * (fabsl(c[5] * n[0] * n[1]) + fabsl(c[6] * n[0] * n[2]) + fabsl(c[8] * n[1] * n[2]));
}

/* The sum of the absolute terms of a reconstruction. */
static inline long double stress_terms(const long double c[9], const long double kernel[3], const long double n[3]) {
    const long double first = fabsl(c[1] * n[0]) + fabsl(c[2] * n[1]) + fabsl(c[3] * n[2]);
    return fabsl(kernel[0] * c[0]) + 3.0L * fabsl(kernel[1]) * first + 7.5L * fabsl(kernel[2]) * stress_second_terms(c, n);
}

/* The first bands of a set; 0 beyond. */
static inline void stress_widen_set(int order, const float *set, long double c[9]) {
    for (int i = 0; i < 9; i++)
        c[i] = i < SH_COUNT(order) ? (long double)set[i] : 0.0L;
}

static inline void stress_compare_expansion(stress_measure *m, int order, const float *set, const long double kernel[3],
                                            const float *dir, float actual) {
    long double c[9], n[3];
    stress_widen_set(order, set, c);
    oracle_widen(dir, 3, n);
    stress_compare(m, actual, oracle_expand(c, kernel, n), stress_terms(c, kernel, n));
}

static inline void stress_radiance(const float *in, stress_measure *m) {
    for (int order = SH_L0; order <= SH_L2; order++)
        stress_compare_expansion(m, order, in, stress_radiance_kernel, in + 9, sh_radiance(order, in, in + 9));
}

static inline void stress_irradiance(const float *in, stress_measure *m) {
    for (int order = SH_L0; order <= SH_L2; order++)
        stress_compare_expansion(m, order, in, stress_lambert_kernel, in + 9, sh_irradiance(order, in, in + 9));
}

static inline void stress_opposite(const float *in, stress_measure *m) {
    long double c[9], n[3], terms = fabsl((long double)in[12]);
    stress_widen_set(SH_L1, in, c);
    oracle_widen(in + 9, 3, n);
    for (int i = 0; i < 3; i++)
        terms += 4.0L * fabsl(c[1 + i] * n[i]);
    stress_compare(m, sh_irradiance_opposite(SH_L1, in, in + 9, in[12]), (long double)in[12] - 4.0L * oracle_dot(c + 1, n), terms);
}

/* Factors of the bands of 4 t, t > c. */
static inline void stress_ao_kernel(long double c, long double kernel[3]) {
    const long double rest = 1.0L - c;
    kernel[0] = rest * (1.0L + c);
    kernel[1] = 2.0L / 3.0L * rest * (1.0L + c + c * c);
    kernel[2] = 0.25L * kernel[0] * (1.0L + 3.0L * c * c);
}

static inline void stress_ao(const float *in, stress_measure *m) {
    long double kernel[3];
    stress_ao_kernel((long double)in[12], kernel);
    for (int order = SH_L0; order <= SH_L2; order++)
        stress_compare_expansion(m, order, in, kernel, in + 9, sh_irradiance_ao(order, in, in + 9, in[12]));
}

static inline void stress_radiance_zonal(const float *in, stress_measure *m) {
    long double kernel[3];
    oracle_widen(in + 12, 3, kernel);
    stress_compare_expansion(m, SH_L2, in, kernel, in + 9, sh_radiance_zonal(SH_L2, in, in + 12, in + 9));
}

/* ---- Coefficients --------------------------------------------------------------------------------------------------------------- */

static inline void stress_basis(const float *in, stress_measure *m) {
    long double dir[3], expected[9];
    float basis[9];
    oracle_widen(in, 3, dir);
    oracle_basis(dir, expected);
    sh_basis(SH_L2, in, basis);
    stress_compare_all(m, basis, expected, 9, 1.0L);
}

/* in: a set, dir, value, zonal */
static inline void stress_zonal_add(const float *in, stress_measure *m) {
    const float *dir = in + 9, one[3] = { 1.0f, 1.0f, 1.0f };
    const long double value = (long double)in[12];
    long double wide[3], basis[9];
    float sum[9], sample[9];
    memcpy(sum, in, sizeof sum);
    memcpy(sample, in, sizeof sample);
    oracle_widen(dir, 3, wide);
    oracle_basis(wide, basis);
    sh_zonal_add(SH_L2, in + 13, dir, in[12], sum);
    sh_add_sample(SH_L2, dir, in[12], sample);
    for (int i = 0; i < 9; i++) {
        const long double c = (long double)in[i], zonal = (long double)in[13 + (i < 1 ? 0 : i < 4 ? 1 : 2)];
        const long double term =
            fabsl(value) * (i == SH_XX || i == SH_YY ? basis[i] + 2.0L / 3.0L : fabsl(basis[i])); /* xx + 1/3 */
        stress_compare(m, sample[i], c + value * basis[i], fabsl(c) + term);
        stress_compare(m, sum[i], c + value * zonal * basis[i], fabsl(c) + zonal * term);
    }
    memcpy(sum, in, sizeof sum);
    sh_zonal_add(SH_L2, one, dir, in[12], sum);
    stress_require(m, memcmp(sum, sample, sizeof sum) == 0 || !(fabsf(in[12]) < 1e18f));
}

/* in: a, b, t */
static inline void stress_linear(const float *in, stress_measure *m) {
    const float *a = in, *b = in + 9, t = in[18];
    const long double s = (long double)t;
    const float zonal[3] = { t, -t, 0.5f * t };
    float scaled[9], sum[9], between[9], convolved[9], ends[2][9];
    sh_scale(SH_L2, a, t, scaled);
    memcpy(sum, b, sizeof sum);
    sh_madd(SH_L2, a, t, sum);
    sh_lerp(SH_L2, a, b, t, between);
    sh_lerp(SH_L2, a, b, 0.0f, ends[0]);
    sh_lerp(SH_L2, a, b, 1.0f, ends[1]);
    sh_convolve(SH_L2, a, zonal, convolved);
    for (int i = 0; i < 9; i++) {
        const long double u = (long double)a[i], v = (long double)b[i], k = (long double)zonal[i < 1 ? 0 : i < 4 ? 1 : 2];
        stress_compare(m, scaled[i], s * u, fabsl(s * u));
        stress_compare(m, convolved[i], k * u, fabsl(k * u));
        stress_compare(m, sum[i], v + s * u, fabsl(v) + fabsl(s * u));
        stress_compare(m, between[i], (1.0L - s) * u + s * v, fabsl((1.0L - s) * u) + fabsl(s * v));
        stress_require(m, ends[0][i] == a[i] && ends[1][i] == b[i]);
    }
}

static inline void stress_dot(const float *in, stress_measure *m) {
    static const long double weight[9] = { 1.0L, 3.0L, 3.0L, 3.0L, 7.5L, 15.0L, 15.0L, 7.5L, 15.0L };
    long double a[9], b[9], sum = 0.0L, terms = 0.0L;
    oracle_widen(in, 9, a);
    oracle_widen(in + 9, 9, b);
    for (int i = 0; i < 9; i++) {
        sum += weight[i] * a[i] * b[i];
        terms += weight[i] * fabsl(a[i] * b[i]);
    }
    sum += 7.5L * (a[4] + a[7]) * (b[4] + b[7]);
    terms += 7.5L * (fabsl(a[4]) + fabsl(a[7])) * (fabsl(b[4]) + fabsl(b[7]));
    stress_compare(m, sh_dot(SH_L2, in, in + 9), sum, terms);
}

/* ---- Zonal kernels -------------------------------------------------------------------------------------------------------------- */

static inline void stress_zonal_constant(const float *in, stress_measure *m) {
    static const long double half_lambert[3] = { 1.0L, 1.0L / 3.0L, 0.0L };
    float zonal[3];
    (void)in;
    sh_zonal_lambert(zonal);
    stress_compare_all(m, zonal, stress_lambert_kernel, 3, 0.5L);
    sh_zonal_half_lambert(zonal);
    stress_compare_all(m, zonal, half_lambert, 3, 0.5L);
}

static inline void stress_zonal_ao(const float *in, stress_measure *m) {
    long double kernel[3];
    float zonal[3];
    stress_ao_kernel((long double)in[0], kernel);
    sh_zonal_ao(in[0], zonal);
    for (int l = 0; l < 3; l++)
        stress_compare(m, zonal[l], kernel[l], kernel[l]);
}

static inline void stress_zonal_cap(const float *in, stress_measure *m) {
    const long double c = (long double)in[0];
    const long double kernel[3] = { (1.0L - c) / 2.0L, (1.0L - c) * (1.0L + c) / 4.0L, c * (1.0L - c) * (1.0L + c) / 4.0L };
    float zonal[3];
    sh_zonal_cap(in[0], zonal);
    for (int l = 0; l < 3; l++)
        stress_compare(m, zonal[l], kernel[l], fabsl(kernel[l]));
}

/* I_(l + 1/2)(k) / I_(l - 1/2)(k), by Gauss's continued fraction k / (2l + 1 + k^2 / (2l + 3 + ...)): for k < 1, no digit is lost. */
static inline long double stress_bessel_ratio(int l, long double k) {
    long double fraction = 0.0L;
    for (int n = l + 16; n >= l; n--)
        fraction = k * k / (2 * n + 1 + fraction);
    return k > 0.0L ? fraction / k : 0.0L;
}

/* A von Mises-Fisher lobe: z1 and z2 for a mean of 1; and for a peak of 1, its mean and its facing irradiance / pi. */
static inline void stress_vmf(long double k, long double zonal[3], long double *mean, long double *facing) {
    zonal[0] = 1.0L;
    *mean = k > 0.0L ? -expm1l(-2.0L * k) / (2.0L * k) : 1.0L;
    *facing = 2.0L * (k + expm1l(-k)) / (k * k);
    zonal[1] = 1.0L / tanhl(k) - 1.0L / k;
    zonal[2] = 1.0L - 3.0L * zonal[1] / k;
    if (k < 1.0L) { /* where these cancel */
        long double term = 1.0L;
        zonal[1] = stress_bessel_ratio(1, k);
        zonal[2] = zonal[1] * stress_bessel_ratio(2, k);
        *facing = term;
        for (int n = 3; n < 24; n++) /* 2 (k - 1 + exp(-k)) / k^2 */
            *facing += term *= -k / n;
    }
}

static inline void stress_zonal_vmf(const float *in, stress_measure *m) {
    long double kernel[3], mean, facing;
    float zonal[3];
    stress_vmf((long double)in[0], kernel, &mean, &facing);
    sh_zonal_vmf(in[0], zonal);
    for (int l = 0; l < 3; l++)
        stress_compare(m, zonal[l], kernel[l], kernel[l]);
}

static inline void stress_zonal_window(const float *in, stress_measure *m) {
    float hann[3], lanczos[3], laplacian[3];
    const long double width = (long double)in[0], lambda = (long double)in[1];
    sh_zonal_hann(in[0], hann);
    sh_zonal_lanczos(in[0], lanczos);
    sh_zonal_laplacian(in[1], laplacian);
    for (int l = 0; l < 3; l++) {
        const long double angle = l > 0 ? oracle_pi * l / width : 0.0L, ll = l * l * (l + 1) * (l + 1);
        const long double sinc = angle > 1e-9L ? sinl(angle) / angle : 1.0L;
        stress_compare(m, hann[l], l == 0 || l < width ? 0.5L + 0.5L * cosl(angle) : 0.0L, 1.0L);
        stress_compare(m, lanczos[l], l == 0 || l < width ? sinc : 0.0L, 1.0L);
        stress_compare(m, laplacian[l], 1.0L / (1.0L + lambda * ll), 1.0L / (1.0L + lambda * ll));
    }
}

/* t^2 / (1 - q t)^2 integrated against P_l, by parts of [0, 1] that halve towards 1. */
typedef struct stress_ggx_lobe {
    long double q, rest;
} stress_ggx_lobe;

static inline long double stress_ggx_value(long double s, const void *user) { /* s = 1 - t, t > 0 */
    const stress_ggx_lobe *lobe = (const stress_ggx_lobe *)user;
    const long double below = lobe->rest + lobe->q * s;
    return (1.0L - s) / (below * below);
}

/* Moments of the GGX lobe seen along the normal, weighted by the cosine: h.n^2 = (1 + t) / 2. */
static inline void stress_ggx(long double alpha, long double kernel[3]) {
    enum { NODES = 24 };
    static long double node[NODES], weight[NODES];
    static int ready = 0;
    const long double aa = alpha * alpha;
    const stress_ggx_lobe lobe = { (1.0L - aa) / (1.0L + aa), 2.0L * aa / (1.0L + aa) };
    long double sum[3] = { 0.0L, 0.0L, 0.0L };
    if (!ready)
        oracle_gauss(NODES, 0.0L, 1.0L, node, weight);
    ready = 1;
    for (long double to = 1.0L; to > 1e-22L; to *= 0.5L) {
        const long double from = to > 2e-22L ? 0.5L * to : 0.0L;
        for (int i = 0; i < NODES; i++) {
            const long double s = from + (to - from) * node[i], value = (to - from) * weight[i] * stress_ggx_value(s, &lobe);
            sum[0] += value;
            sum[1] += value * (1.0L - s);
            sum[2] += value * (1.0L - s * (3.0L - 1.5L * s)); /* P2(1 - s) */
        }
    }
    kernel[0] = 1.0L;
    kernel[1] = sum[1] / sum[0];
    kernel[2] = sum[2] / sum[0];
}

static inline void stress_zonal_ggx(const float *in, stress_measure *m) {
    long double kernel[3];
    float zonal[3];
    sh_zonal_ggx(in[0], zonal);
    if (in[0] > 1e-8f)
        stress_ggx((long double)in[0], kernel);
    else
        kernel[0] = kernel[1] = kernel[2] = 1.0L;
    stress_compare_all(m, zonal, kernel, 3, 1.0L);
}

static inline void stress_zonal_power(const float *in, stress_measure *m) {
    const long double s = (long double)in[0], sharpness = (long double)in[1];
    const long double power[3] = { 1.0L, (s + 1.0L) / (s + 2.0L), s / (s + 3.0L) }, linear[3] = { 1.0L, sharpness / 3.0L, 0.0L };
    float zonal[3];
    sh_zonal_cosine_power(in[0], zonal);
    stress_compare_all(m, zonal, power, 3, 1.0L);
    sh_zonal_sharpness(in[1], zonal);
    for (int l = 0; l < 3; l++)
        stress_compare(m, zonal[l], linear[l], linear[l]);
}

static const stress_case stress_coefficient_cases[] = {
    { "sh_basis", "2 ulp of 1", STRESS_ULP, 2.0, { DIRECTION }, stress_basis, 1 },
    { "sh_add_sample, sh_zonal_add", "4 ulp of the sum of absolute terms",
      STRESS_ULP, 4.0, { SET(9), DIRECTION, SET(1), NUMBERS(3, 0.0, 1.0) }, stress_zonal_add, 2 },
    { "sh_scale, sh_madd, sh_lerp, sh_convolve", "4 ulp of the sum of absolute terms; lerp exact at 0 and 1",
      STRESS_ULP, 4.0, { SET(9), SET(9), NUMBER(0.0, 1.0) }, stress_linear, 2 },
    { "sh_dot", "4 ulp of the sum of absolute terms", STRESS_ULP, 4.0, { SET(9), SET(9) }, stress_dot, 1 },
    { "sh_radiance", "4 ulp of the sum of absolute terms", STRESS_ULP, 4.0, { SET(9), DIRECTION }, stress_radiance, 1 },
    { "sh_irradiance", "4 ulp of the sum of absolute terms", STRESS_ULP, 4.0, { SET(9), DIRECTION }, stress_irradiance, 1 },
    { "sh_irradiance_opposite", "4 ulp of the sum of absolute terms",
      STRESS_ULP, 4.0, { SET(9), DIRECTION, SET(1) }, stress_opposite, 1 },
    { "sh_irradiance_ao", "8 ulp of the sum of absolute terms",
      STRESS_ULP, 8.0, { SET(9), DIRECTION, NUMBER(0.0, 1.0) }, stress_ao, 1 },
    { "sh_radiance_zonal", "4 ulp of the sum of absolute terms",
      STRESS_ULP, 4.0, { SET(9), DIRECTION, NUMBERS(3, 0.0, 1.0) }, stress_radiance_zonal, 1 },
    { "sh_zonal_lambert, _half_lambert", "1 ulp", STRESS_ULP, 1.0, { NUMBER(0.0, 1.0) }, stress_zonal_constant, 40 },
    { "sh_zonal_ao", "4 ulp of each", STRESS_ULP, 4.0, { NUMBER(0.0, 1.0) }, stress_zonal_ao, 1 },
    { "sh_zonal_cap", "4 ulp of each", STRESS_ULP, 4.0, { NUMBER(-1.0, 1.0) }, stress_zonal_cap, 1 },
    { "sh_zonal_vmf", "1 ulp of each", STRESS_ULP, 1.0, { NUMBER(0.0, 1e18) }, stress_zonal_vmf, 1 },
    { "sh_zonal_hann, _lanczos, _laplacian", "2 ulp of 1 (laplacian: of each)",
      STRESS_ULP, 2.0, { NUMBER(1e-3, 1e18), NUMBER(0.0, 1e18) }, stress_zonal_window, 1 },
    { "sh_zonal_ggx", "1e-7", STRESS_RELATIVE, 1e-7, { NUMBER(0.0, 1.0) }, stress_zonal_ggx, 40 },
    { "sh_zonal_cosine_power, _sharpness", "2 ulp of 1 (sharpness: of each)",
      STRESS_ULP, 2.0, { NUMBER(0.0, 1e18), NUMBER(0.0, 1e18) }, stress_zonal_power, 1 },
};

#endif /* STRESS_COEFFICIENTS_H */
