/* stress_operators.h - products, rotations, changes of axes; sets of other engines, and storage. */
#ifndef STRESS_OPERATORS_H
#define STRESS_OPERATORS_H

#include "stress_analysis.h"
#include "stress_batches.h"

/* |a|, where |a|^2 = <a a>. */
static inline long double stress_norm(int order, const float *set) {
    long double c[9], r2[3][3], sum;
    stress_widen_set(order, set, c);
    oracle_matrix(c, r2);
    sum = c[0] * c[0] + 3.0L * oracle_dot(c + 1, c + 1);
    for (int i = 0; i < 3; i++)
        sum += 7.5L * oracle_dot(r2[i], r2[i]);
    return sqrtl(sum);
}

/* The product's moments by quadrature of the product of the two reconstructions: a polynomial of degree 4, times the basis. */
static inline void stress_product_moments(const oracle_rule *rule, const long double a[9], const long double b[9],
                                          long double c[9]) {
    for (int k = 0; k < 9; k++)
        c[k] = 0.0L;
    for (size_t i = 0; i < rule->count; i++) {
        const long double *dir = rule->node[i].dir;
        const long double value = oracle_expand(a, stress_radiance_kernel, dir) * oracle_expand(b, stress_radiance_kernel, dir);
        long double basis[9];
        oracle_basis(dir, basis);
        for (int k = 0; k < 9; k++)
            c[k] += rule->node[i].weight * value * basis[k];
    }
}

static inline void stress_product(const float *in, stress_measure *m) {
    static oracle_rule rule = { NULL, 0 };
    float planes_a[9 * STRESS_BATCH], planes_b[9 * STRESS_BATCH], out[9 * STRESS_BATCH], product[9];
    if (!rule.node)
        rule = oracle_rule_sphere(6);
    for (int i = 0; i < 9 * STRESS_BATCH; i++) {
        planes_a[i] = in[i / STRESS_BATCH];
        planes_b[i] = in[9 + i / STRESS_BATCH];
    }
    for (int order = SH_L0; order <= SH_L2; order++) {
        long double a[9], b[9], c[9];
        const long double size = stress_norm(order, in) * stress_norm(order, in + 9);
        stress_widen_set(order, in, a);
        stress_widen_set(order, in + 9, b);
        stress_product_moments(&rule, a, b, c);
        sh_product(order, in, in + 9, product);
        stress_compare_all(m, product, c, SH_COUNT(order), size);
        sh_product_batch(order, planes_a, planes_b, out, STRESS_BATCH);
        for (int k = 0; k < SH_COUNT(order); k++)
            stress_compare(m, stress_same(m, out + k * STRESS_BATCH, 1), c[k], size);
    }
}

/* The rotation by a quaternion of any length, or its product with the reflection at the origin. */
static inline void stress_quaternion(const float q[4], long double matrix[3][3]) {
    const long double x = (long double)q[0], y = (long double)q[1], z = (long double)q[2], w = (long double)q[3];
    const long double s = 2.0L / (x * x + y * y + z * z + w * w);
    const long double rows[3][3] = { { 1.0L - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y) },
                                     { s * (x * y + w * z), 1.0L - s * (x * x + z * z), s * (y * z - w * x) },
                                     { s * (x * z - w * y), s * (y * z + w * x), 1.0L - s * (x * x + y * y) } };
    memcpy(matrix, rows, sizeof rows);
}

static inline void stress_rotation_matrix(const float *in, stress_measure *m) {
    long double expected[3][3];
    float matrix[9];
    sh_rotation_from_quaternion(in, matrix);
    if (in[0] == 0.0f && in[1] == 0.0f && in[2] == 0.0f && in[3] == 0.0f)
        return;
    stress_quaternion(in, expected);
    stress_compare_all(m, matrix, expected[0], 9, 1.0L);
}

static inline void stress_rotate(const float *in, stress_measure *m) {
    long double turn[3][3], c[9], expected[9];
    float matrix[9], out[9], sets[9 * STRESS_BATCH];
    sh_rotation_from_quaternion(in + 9, matrix);
    if (!(in[9] * in[9] + in[10] * in[10] + in[11] * in[11] + in[12] * in[12] > 0.5f))
        return;
    stress_quaternion(in + 9, turn);
    oracle_widen(in, 9, c);
    oracle_rotate(c, turn, expected);
    sh_rotate(SH_L2, in, matrix, out);
    stress_compare_all(m, out, expected, 9, stress_norm(SH_L2, in));
    for (int i = 0; i < STRESS_BATCH; i++)
        memcpy(sets + 9 * i, in, 9 * sizeof *in);
    sh_rotate_batch(SH_L2, sets, matrix, sets, STRESS_BATCH);
    for (int k = 0; k < 9; k++)
        stress_compare(m, stress_same(m, sets + k, 9), expected[k], stress_norm(SH_L2, in));
}

static inline void stress_axes(const float *in, stress_measure *m) {
    static const int axis[4][3] = { { 1, 3, -2 }, { 3, 1, 2 }, { -2, -1, -3 }, { 1, 2, 3 } };
    for (int i = 0; i < 4; i++) {
        long double turn[3][3] = { { 0.0L } }, c[9], expected[9];
        float out[9];
        for (int row = 0; row < 3; row++)
            turn[row][abs(axis[i][row]) - 1] = axis[i][row] < 0 ? -1.0L : 1.0L;
        oracle_widen(in, 9, c);
        oracle_rotate(c, turn, expected);
        sh_swap_axes(SH_L2, in, axis[i], out);
        for (int k = 0; k < 9; k++)
            stress_compare(m, out[k], expected[k], fabsl(c[4]) + fabsl(c[7]) + fabsl(expected[k]));
    }
}

static inline void stress_reflect(const float *in, stress_measure *m) {
    long double view[3], n[3];
    float out[3];
    oracle_widen(in, 3, view);
    oracle_widen(in + 3, 3, n);
    sh_reflect(in, in + 3, out);
    for (int i = 0; i < 3; i++)
        stress_compare(m, out[i], 2.0L * oracle_dot(n, view) * n[i] - view[i], 1.0L);
}

/* ---- Other engines' sets: there, by definition, and back -------------------------------------------------------------------------- */

/* The integral of L Y_lm over the sphere, of a set: its orthonormal coefficients. */
static inline void stress_orthonormal(const long double c[9], int phase, long double f[9]) {
    static oracle_rule rule = { NULL, 0 };
    if (!rule.node)
        rule = oracle_rule_sphere(4);
    for (int l = 0; l < 3; l++) {
        const long double band[3] = { l == 0 ? 1.0L : 0.0L, l == 1 ? 1.0L : 0.0L, l == 2 ? 1.0L : 0.0L };
        for (int k = -l; k <= l; k++) {
            long double sum = 0.0L;
            for (size_t i = 0; i < rule.count; i++)
                sum += rule.node[i].weight * 4.0L * oracle_pi * oracle_y(l, k, rule.node[i].dir, phase) *
                       oracle_expand(c, band, rule.node[i].dir);
            f[l * (l + 1) + k] = sum;
        }
    }
}

/* The largest coefficient of each band, zz among them. */
static inline void stress_band_sizes(const long double c[9], long double size[3]) {
    size[0] = fabsl(c[0]);
    size[1] = fmaxl(fabsl(c[1]), fmaxl(fabsl(c[2]), fabsl(c[3])));
    size[2] = fabsl(c[4] + c[7]);
    for (int i = 4; i < 9; i++)
        size[2] = fmaxl(size[2], fabsl(c[i]));
}

static inline void stress_conventions(const float *in, stress_measure *m) {
    long double c[9], f[9], size[3];
    float out[9], back[4][9];
    oracle_widen(in, 9, c);
    stress_band_sizes(c, size);
    for (int phase = 0; phase <= SH_CONDON_SHORTLEY; phase++) {
        stress_orthonormal(c, phase, f);
        sh_to_orthonormal(SH_L2, in, phase, out);
        for (int i = 0; i < 9; i++)
            stress_compare(m, out[i], f[i],
                           (i < 1   ? 3.5L * size[0]
                            : i < 4 ? 6.1L * size[1]
                                    : 13.7L * size[2])); /* 2 sqrt(pi), ... */
        sh_from_orthonormal(SH_L2, out, phase, back[phase]);
    }
    sh_to_unity(SH_L2, in, out);
    sh_from_unity(SH_L2, out, back[2]);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 9; i++)
            stress_compare(m, back[k][i], c[i], size[i < 1 ? 0 : i < 4 ? 1 : 2]);
    sh_to_babylon(in, out); /* adds R0 to the squares */
    sh_from_babylon(out, back[3]);
    for (int i = 0; i < 9; i++)
        stress_compare(m, back[3][i], c[i], i >= 1 && i < 4 ? size[1] : fmaxl(size[0], size[2]));
}

/* The shader's formula, in long double, on the packed floats. */
static inline void stress_pack_shader(const float *in, stress_measure *m) {
    const float *dir = in + 27;
    float s[28];
    long double n[3];
    sh_pack_shader(in, s);
    oracle_widen(dir, 3, n);
    const long double q[4] = { n[0] * n[1], n[1] * n[2], n[2] * n[2], n[2] * n[0] };
    for (int k = 0; k < 3; k++) {
        long double sum = (long double)s[4 * k + 3] + (long double)s[24 + k] * (n[0] * n[0] - n[1] * n[1]), c[9];
        for (int i = 0; i < 3; i++)
            sum += (long double)s[4 * k + i] * n[i];
        for (int i = 0; i < 4; i++)
            sum += (long double)s[12 + 4 * k + i] * q[i];
        oracle_widen(in + 9 * k, 9, c);
        stress_error(m, fabsl(sum - oracle_expand(c, stress_lambert_kernel, n)),
                     stress_terms(c, stress_lambert_kernel, n) + 2.0L * (fabsl(c[4]) + fabsl(c[7])));
    }
}

/* ---- Compact storage: of lights, the largest error of irradiance by R0; and light stays light ------------------------------------ */

static inline void stress_storage(const float *in, const float *out, long double most, long double adjusted_most, int adjusted,
                                  stress_measure *m) {
    long double c[9], d[9];
    if (!(in[0] > 1e-30f))
        return;
    oracle_widen(in, 9, c);
    oracle_widen(out, 9, d);
    if (stress_floor(c) >= 0.0L)
        stress_error(m, fmaxl(0.0L, -stress_floor(d) / d[0]), 1e-6L); /* to 1e-6 R0 */
    for (int i = 0; i < 9; i++)
        d[i] -= c[i];
    stress_error(m, stress_largest(d) / c[0], adjusted ? adjusted_most : most);
}

static inline void stress_pack_half(const float *in, stress_measure *m) {
    uint16_t half[10];
    float out[9];
    sh_pack_half(SH_L2, 1, in, half);
    sh_unpack_half(SH_L2, 1, half, out);
    stress_storage(in, out, 0.003L, 0.007L, fabsf(out[0] - in[0]) > in[0] / 2048.0f, m);
}

/* Shrunk ratios: the sum of the changes is towards 0. */
static inline int stress_shrunk(const float *in, const float *out, float step) {
    for (int i = 1; i < 9; i++)
        if (fabsf(out[i] - in[i]) > 0.51f * step * in[0])
            return 1;
    return 0;
}

static inline void stress_pack_unorm8(const float *in, stress_measure *m) {
    uint8_t ratio[8];
    float r0, out[9];
    sh_pack_unorm8(SH_L2, 1, in, &r0, ratio);
    sh_unpack_unorm8(SH_L2, 1, &r0, ratio, out);
    stress_storage(in, out, 0.024L, 0.12L, stress_shrunk(in, out, 1.0f / 127.0f), m);
}

static inline void stress_pack_unorm10(const float *in, stress_measure *m) {
    uint32_t ratio[3];
    float r0, out[9];
    sh_pack_unorm10(SH_L2, 1, in, &r0, ratio);
    sh_unpack_unorm10(SH_L2, 1, &r0, ratio, out);
    stress_storage(in, out, 0.006L, 0.03L, stress_shrunk(in, out, 1.0f / 511.0f), m);
}

/* Any set: nothing is NaN, and a half is off by an ulp of the largest. */
static inline void stress_pack_any(const float *in, stress_measure *m) {
    uint16_t half[19];
    uint8_t ratio8[16];
    uint32_t ratio10[6];
    float r0[2], out[18];
    long double largest = 0.0L;
    sh_pack_half(SH_L2, 2, in, half);
    sh_unpack_half(SH_L2, 2, half, out);
    for (int i = 0; i < 18; i++)
        largest = fmaxl(largest, fabsl((long double)in[i]));
    for (int i = 0; i < 18; i++)
        stress_compare(m, out[i], (long double)in[i], largest);
    sh_pack_unorm8(SH_L2, 2, in, r0, ratio8);
    sh_unpack_unorm8(SH_L2, 2, r0, ratio8, out);
    for (int i = 0; i < 18; i++)
        stress_require(m, out[i] == out[i]);
    sh_pack_unorm10(SH_L2, 2, in, r0, ratio10);
    sh_unpack_unorm10(SH_L2, 2, r0, ratio10, out);
    for (int i = 0; i < 18; i++)
        stress_require(m, out[i] == out[i]);
}

/* ---- Fitting ---------------------------------------------------------------------------------------------------------------------- */

/* in: a set; 30 directions, of which 18 are those of a design that determines an L2 set well: three great circles. */
static inline void stress_fit(const float *in, stress_measure *m) {
    enum { N = 30 };
    float x[N], y[N], z[N], value[N], out[9];
    long double c[9], size;
    oracle_widen(in, 9, c);
    size = stress_norm(SH_L2, in);
    for (int i = 0; i < N; i++) {
        const double angle = 0.3 + 2.0 * (double)oracle_pi / 6.0 * i;
        float dir[3] = { (float)cos(angle), (float)sin(angle), 0.0f };
        x[i] = i < 18 ? dir[i / 6] : in[9 + 3 * (i - 18)];
        y[i] = i < 18 ? dir[(i / 6 + 1) % 3] : in[10 + 3 * (i - 18)];
        z[i] = i < 18 ? dir[(i / 6 + 2) % 3] : in[11 + 3 * (i - 18)];
        const long double n[3] = { (long double)x[i], (long double)y[i], (long double)z[i] };
        value[i] = (float)oracle_expand(c, stress_radiance_kernel, n);
    }
    const int status = sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, N, NULL, 0.0f, out);
    stress_require(m, status == SH_OK);
    stress_compare_all(m, out, c, 9, size);
}

static const stress_case stress_operator_cases[] = {
    { "sh_product, sh_product_batch", "1e-6 of the product of the norms",
      STRESS_RELATIVE, 1e-6, { SET(9), SET(9) }, stress_product, 40 },
    { "sh_rotate, sh_rotate_batch", "4e-7 of the norm, the matrix's own rounding among it",
      STRESS_RELATIVE, 4e-7, { SET(9), ROTATION }, stress_rotate, 4 },
    { "sh_rotation_from_quaternion", "1 ulp of 1", STRESS_ULP, 1.0, { SET(4) }, stress_rotation_matrix, 1 },
    { "sh_swap_axes, sh_z_up_to_y_up", "exact but for zz, 1 ulp", STRESS_ULP, 1.0, { SET(9) }, stress_axes, 2 },
    { "sh_reflect", "4 ulp of 1", STRESS_ULP, 4.0, { DIRECTION, DIRECTION }, stress_reflect, 1 },
    { "sh_to_orthonormal, _unity, _babylon and back", "4 ulp of the largest of the band (babylon: of R0 and the band)",
      STRESS_ULP, 4.0, { SET(9) }, stress_conventions, 60 },
    { "sh_pack_shader", "4 ulp of the sum of absolute terms", STRESS_ULP, 4.0, { SET(27), DIRECTION }, stress_pack_shader, 2 },
    { "sh_pack_half, of light", "0.003 R0, 0.007 R0 where R0 was rounded up",
      STRESS_SHARE, 1.0, { LIGHT(1) }, stress_pack_half, 30 },
    { "sh_pack_unorm8, of light", "0.024 R0, 0.12 R0 where shrunk", STRESS_SHARE, 1.0, { LIGHT(1) }, stress_pack_unorm8, 30 },
    { "sh_pack_unorm10, of light", "0.006 R0, 0.03 R0 where shrunk", STRESS_SHARE, 1.0, { LIGHT(1) }, stress_pack_unorm10, 30 },
    { "sh_pack_half, _unorm8, _unorm10, of any set", "halves: 2^-11 of the largest; no NaN",
      STRESS_RELATIVE, 1.0 / 2048.0, { SET(18) }, stress_pack_any, 20 },
    { "sh_fit_samples", "1e-6 of the norm", STRESS_RELATIVE, 1e-6, { SET(9), DIRECTIONS(12) }, stress_fit, 20 },
};

#endif /* STRESS_OPERATORS_H */
