/* The basis and the arithmetic on coefficients. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static const char *const names[9] = { "1", "x", "y", "z", "xx", "xy", "xz", "yy", "yz" };

/* The sum of the three roundings of x * x - 1/3 is at most half an ulp of 1 (2^-23) and a little: 7e-8. */
static const long double basis_tolerance = 8e-8L;

static void values(void) {
    test_section("basis values");
    for (int i = 0; i < 2000; i++) {
        float dir[3], basis[9];
        long double wide[3], expected[9];
        test_direction(dir);
        sh_basis(SH_L2, dir, basis);
        oracle_widen(dir, 3, wide);
        oracle_basis(wide, expected);
        NEAR_ALL(basis, expected, 9, basis_tolerance);
    }
}

/* A light of mean 1 from one direction has R = basis and f_i = integral L Y_i = 4 pi Y_i: the conversion between them. */
static void orthonormal(void) {
    for (int phase = 0; phase <= 1; phase++)
        for (int i = 0; i < 500; i++) {
            float dir[3], b[9];
            long double wide[3], f[9];
            test_section("orthonormal Y_lm, phase %d", phase);
            test_direction(dir);
            sh_basis(SH_L2, dir, b);
            oracle_widen(dir, 3, wide);
            const long double length = sqrtl(oracle_dot(wide, wide));
            for (int k = 0; k < 3; k++)
                wide[k] /= length; /* Y_20 and Y_22 take |dir| = 1 for granted, xx and yy do not */
            for (int l = 0, n = 0; l <= 2; l++)
                for (int m = -l; m <= l; m++, n++)
                    f[n] = (phase && m % 2 ? -1 : 1) * 4.0L * oracle_pi * oracle_y(l, m, wide, phase);
            const long double pi = oracle_pi, xx = (long double)b[SH_XX], yy = (long double)b[SH_YY];
            const long double second = 2.0L * sqrtl(15.0L * pi);
            const long double expected[9] = { 2.0L * sqrtl(pi) * (long double)b[SH_R0],
                                              sqrtl(12.0L * pi) * (long double)b[SH_Y],
                                              sqrtl(12.0L * pi) * (long double)b[SH_Z],
                                              sqrtl(12.0L * pi) * (long double)b[SH_X],
                                              second * (long double)b[SH_XY],
                                              second * (long double)b[SH_YZ],
                                              3.0L * sqrtl(5.0L * pi) * -(xx + yy),
                                              second * (long double)b[SH_XZ],
                                              sqrtl(15.0L * pi) * (xx - yy) };
            /* constants up to 14, times an error of the basis and of the length of dir */
            NEAR_ALL(expected, f, 9, 14 * 3 * basis_tolerance);
        }
}

/* <B_i B_j> in 45ths: 1, 1/3, 4/45, 1/15, and -2/45 for xx with yy. */
static int gram45(int i, int j) {
    static const int diagonal[9] = { 45, 15, 15, 15, 4, 3, 3, 4, 3 };
    if (i == j)
        return diagonal[i];
    return (i == SH_XX && j == SH_YY) || (i == SH_YY && j == SH_XX) ? -2 : 0;
}

static void inner_products(void) {
    oracle_rule rule = oracle_rule_sphere(12);
    long double gram[9][9];
    memset(gram, 0, sizeof gram);
    for (size_t n = 0; n < rule.count; n++) {
        float basis[9], dir[3];
        for (int k = 0; k < 3; k++)
            dir[k] = (float)rule.node[n].dir[k];
        sh_basis(SH_L2, dir, basis);
        for (int i = 0; i < 9; i++)
            for (int j = 0; j < 9; j++)
                gram[i][j] += rule.node[n].weight * (long double)basis[i] * (long double)basis[j];
    }
    oracle_rule_free(&rule);
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            test_section("inner product of %s and %s", names[i], names[j]);
            NEAR(gram[i][j], gram45(i, j) / 45.0L, 3e-8); /* roundings of 91 directions, averaged; 1e-8 was measured */
        }
}

/* The reconstructions whose mean product is sh_dot are the dual basis: its matrix is the inverse of the inner products'. */
static void dot_of_units(void) {
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            float sum = 0.0f;
            test_section("sh_dot, row %s, column %s", names[i], names[j]);
            for (int k = 0; k < 9; k++) {
                float a[9] = { 0 }, b[9] = { 0 };
                a[i] = b[k] = 1.0f;
                sum += sh_dot(SH_L2, a, b) * (float)gram45(k, j);
            }
            NEAR(sum, i == j ? 45 : 0, 0);
        }
}

static void dot(void) {
    static const long double radiance[3] = { 1.0L, 1.0L, 1.0L };
    oracle_rule rule = oracle_rule_sphere(4);
    test_section("sh_dot is the mean of the product");
    for (int i = 0; i < 100; i++) {
        float a[9], b[9];
        long double wide_a[9], wide_b[9], mean = 0.0L, magnitude = 0.0L;
        test_fill(a, 9, -1.0, 1.0);
        test_fill(b, 9, -1.0, 1.0);
        oracle_widen(a, 9, wide_a);
        oracle_widen(b, 9, wide_b);
        for (size_t n = 0; n < rule.count; n++)
            mean += rule.node[n].weight * oracle_expand(wide_a, radiance, rule.node[n].dir) *
                    oracle_expand(wide_b, radiance, rule.node[n].dir);
        for (int k = 0; k < 9; k++)
            magnitude += 15.0L * fabsl(wide_a[k] * wide_b[k]);
        NEAR(sh_dot(SH_L2, a, b), mean, 1e-7L * magnitude);
        CHECK(sh_dot(SH_L2, a, b) == sh_dot(SH_L2, b, a));
        CHECK(sh_dot(SH_L2, a, a) > 0.0f);
    }
    oracle_rule_free(&rule);
}

static void arithmetic(void) {
    test_section("arithmetic");
    for (int i = 0; i < 100; i++) {
        float a[9], b[9], out[9], dir[3], basis[9];
        const float s = (float)test_uniform(-2.0, 2.0), t = (float)test_uniform(0.0, 1.0);
        test_fill(a, 9, -1.0, 1.0);
        test_fill(b, 9, -1.0, 1.0);
        test_direction(dir);
        sh_basis(SH_L2, dir, basis);

        sh_scale(SH_L2, a, s, out);
        for (int k = 0; k < 9; k++)
            NEAR(out[k], (long double)s * (long double)a[k], 1.2e-7); /* half an ulp below 2 */
        memcpy(out, b, sizeof out);
        sh_madd(SH_L2, a, s, out);
        for (int k = 0; k < 9; k++)
            NEAR(out[k], (long double)b[k] + (long double)s * (long double)a[k], 2.4e-7); /* an ulp below 4 */
        sh_lerp(SH_L2, a, b, t, out);
        for (int k = 0; k < 9; k++)
            NEAR(out[k], (long double)a[k] + (long double)t * ((long double)b[k] - (long double)a[k]), 1.8e-7);
        sh_lerp(SH_L2, a, b, 0.0f, out);
        SAME_BITS(out, a, sizeof out);
        sh_lerp(SH_L2, a, b, 1.0f, out);
        SAME_BITS(out, b, sizeof out);
        memcpy(out, b, sizeof out);
        sh_add_sample(SH_L2, dir, s, out);
        for (int k = 0; k < 9; k++)
            NEAR(out[k], (long double)b[k] + (long double)s * (long double)basis[k], 2.4e-7);
    }
}

/* Wherever the set begins, sh_add_sample gives the same, to where the compiler fuses, and touches nothing else. */
static void alignments(void) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int at = 1; at <= 8; at++) {
            float memory[20], before[20], c[9], dir[3];
            const size_t size = (size_t)SH_COUNT(order) * sizeof(float);
            test_section("a sample of order %d, %d floats into an array", order, at);
            test_fill(memory, 20, -1.0, 1.0);
            test_direction(dir);
            memcpy(before, memory, sizeof memory);
            memcpy(c, memory + at, sizeof c);
            sh_add_sample(order, dir, 0.7f, c);
            sh_add_sample(order, dir, 0.7f, memory + at);
            NEAR_ALL(memory + at, c, SH_COUNT(order), 2.4e-7); /* an ulp below 4 */
            memcpy(before + at, memory + at, size);
            SAME_BITS(memory, before, sizeof memory);
        }
}

static void in_place(void) {
    float a[9], b[9], out[9];
    test_section("outputs may be inputs");
    test_fill(a, 9, -1.0, 1.0);
    test_fill(b, 9, -1.0, 1.0);
    sh_scale(SH_L2, a, 0.3f, out);
    memcpy(b, a, sizeof b);
    sh_scale(SH_L2, b, 0.3f, b);
    SAME_BITS(b, out, sizeof b);

    test_fill(b, 9, -1.0, 1.0);
    sh_lerp(SH_L2, a, b, 0.3f, out);
    sh_lerp(SH_L2, a, b, 0.3f, b);
    SAME_BITS(b, out, sizeof b);

    memcpy(b, a, sizeof b);
    sh_madd(SH_L2, b, 1.0f, b);
    sh_scale(SH_L2, a, 2.0f, out);
    SAME_BITS(b, out, sizeof b);
}

/* Each pair of orders, of several channels, out of place and in place. */
static void truncation(void) {
    enum { CHANNELS = 3 };
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int lower = SH_L0; lower <= order; lower++) {
            const size_t in = (size_t)(CHANNELS * SH_COUNT(order)), out = (size_t)(CHANNELS * SH_COUNT(lower));
            float *c = (float *)test_allocate(in * sizeof(float)), *shorter = (float *)test_allocate(out * sizeof(float));
            test_section("sh_truncate from %d to %d", order, lower);
            test_fill(c, in, -1.0, 1.0);
            sh_truncate(order, CHANNELS, c, lower, shorter);
            for (int k = 0; k < CHANNELS; k++)
                SAME_BITS(shorter + k * SH_COUNT(lower), c + k * SH_COUNT(order), (size_t)SH_COUNT(lower) * sizeof(float));
            sh_truncate(order, CHANNELS, c, lower, c);
            SAME_BITS(shorter, c, out * sizeof(float));
            free(c);
            free(shorter);
        }
}

static void run_tests(void) {
    values();
    orthonormal();
    inner_products();
    dot_of_units();
    dot();
    arithmetic();
    alignments();
    in_place();
    truncation();
}
