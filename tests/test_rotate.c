/* Rotations, reflections and axes against the moments of the turned light. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

/* A random orthogonal matrix; every second one reflects. */
static void random_orthogonal(int reflect, float m[9]) {
    float q[4];
    do
        test_fill(q, 4, -1.0, 1.0);
    while (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 0.01f);
    sh_rotation_from_quaternion(q, m);
    for (int i = 0; i < 9; i++)
        m[i] = reflect ? -m[i] : m[i];
}

static void wide_matrix(const float m[9], long double q[3][3]) {
    for (int i = 0; i < 9; i++)
        q[i / 3][i % 3] = (long double)m[i];
}

static long double largest(const float *c, int count) {
    long double most = 0.0L;
    for (int i = 0; i < count; i++)
        most = fabsl((long double)c[i]) > most ? fabsl((long double)c[i]) : most;
    return most;
}

/* out must be the moments of g(d) = f(m' d), f the expansion of c. */
static void against_projection(void) {
    static const long double kernel[3] = { 1.0L, 1.0L, 1.0L };
    oracle_rule rule = oracle_rule_sphere(4);
    for (int i = 0; i < 200; i++) {
        float c[9], m[9], out[9];
        long double wide[9], q[3][3], expected[9] = { 0 };
        test_section("sh_rotate, %s", i % 2 ? "reflection" : "rotation");
        test_fill(c, 9, -1.0, 1.0);
        random_orthogonal(i % 2, m);
        oracle_widen(c, 9, wide);
        wide_matrix(m, q);
        for (size_t n = 0; n < rule.count; n++) {
            long double before[3], basis[9];
            for (int k = 0; k < 3; k++)
                before[k] = q[0][k] * rule.node[n].dir[0] + q[1][k] * rule.node[n].dir[1] + q[2][k] * rule.node[n].dir[2];
            oracle_basis(rule.node[n].dir, basis);
            for (int k = 0; k < 9; k++)
                expected[k] += rule.node[n].weight * oracle_expand(wide, kernel, before) * basis[k];
        }
        sh_rotate(SH_L2, c, m, out);
        NEAR_ALL(out, expected, 9, 1e-6);
    }
    oracle_rule_free(&rule);
}

static void orders(void) {
    static const double scales[] = { 1e-20, 1.0, 1e18 };
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int i = 0; i < 300; i++) {
            const double scale = scales[i % 3];
            float c[9], m[9], out[9];
            long double wide[9], q[3][3], expected[9];
            test_section("order %d, scale %g", order, scale);
            test_fill(c, 9, -scale, scale);
            test_fill(out, 9, 0.0, 1.0);
            random_orthogonal(i % 2, m);
            oracle_widen(c, 9, wide);
            wide_matrix(m, q);
            oracle_rotate(wide, q, expected);
            const float above = out[SH_COUNT(order) % 9];
            sh_rotate(order, c, m, out);
            NEAR_ALL(out, expected, SH_COUNT(order), 5e-7L * largest(c, 9));
            if (order < SH_L2)
                CHECK(out[SH_COUNT(order)] == above);
            sh_rotate(order, c, m, c);
            NEAR_ALL(c, expected, SH_COUNT(order), 5e-7L * largest(c, 9) + 5e-7L * (long double)scale);
        }
}

/* 0 to 70 sets, out of place and in place; a set's result does not depend on its place. */
static void batches(void) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (size_t sets = 0; sets <= 70; sets++) {
            const size_t count = (size_t)SH_COUNT(order), bytes = sets * count * sizeof(float);
            float *c = (float *)test_allocate(bytes), *out = (float *)test_allocate(bytes), m[9], alone[9];
            test_section("sh_rotate_batch, order %d, %d sets", order, (int)sets);
            test_fill(c, sets * count, -1.0, 1.0);
            random_orthogonal((int)sets % 2, m);
            sh_rotate_batch(order, c, m, out, sets);
            for (size_t s = 0; s < sets; s++) {
                float single[9];
                sh_rotate(order, c + s * count, m, single);
                NEAR_ALL(out + s * count, single, SH_COUNT(order), 1e-6);
                sh_rotate_batch(order, c + s * count, m, alone, 1);
                SAME_BITS(out + s * count, alone, count * sizeof(float));
            }
            sh_rotate_batch(order, c, m, c, sets);
            SAME_BITS(c, out, bytes);
            free(c);
            free(out);
        }
}

/* What a rotated light shows in a rotated direction is what it showed. */
static void invariance(void) {
    for (int i = 0; i < 200; i++) {
        float c[9], m[9], out[9], dir[3], turned[3];
        test_section("invariance");
        test_fill(c, 9, -1.0, 1.0);
        random_orthogonal(i % 2, m);
        test_direction(dir);
        for (int k = 0; k < 3; k++)
            turned[k] = m[3 * k] * dir[0] + m[3 * k + 1] * dir[1] + m[3 * k + 2] * dir[2];
        sh_rotate(SH_L2, c, m, out);
        NEAR(sh_irradiance(SH_L2, out, turned), sh_irradiance(SH_L2, c, dir), 6e-6);
        NEAR(sh_dot(SH_L2, out, out), sh_dot(SH_L2, c, c), 6e-5);
    }
}

static void quaternions(void) {
    const float half = 0.70710678f, none[4] = { 0, 0, 0, 0 }, quarter_z[4] = { 0, 0, 5 * half, 5 * half };
    const float identity[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, expected[9] = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
    float m[9], far_quaternion[4] = { 1e18f, -1e18f, 2e17f, 3e17f };
    test_section("quaternions");
    sh_rotation_from_quaternion(none, m);
    NEAR_ALL(m, identity, 9, 0);
    sh_rotation_from_quaternion(quarter_z, m); /* x to y: counterclockwise about z */
    NEAR_ALL(m, expected, 9, 1e-7);
    for (int i = 0; i < 200; i++) {
        if (i > 0)
            test_fill(far_quaternion, 4, -1.0, 1.0);
        sh_rotation_from_quaternion(far_quaternion, m);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                NEAR(m[3 * a] * m[3 * b] + m[3 * a + 1] * m[3 * b + 1] + m[3 * a + 2] * m[3 * b + 2], a == b, 4e-7);
    }
}

/* All 48 signed permutations equal the rotation by their matrix; the two named ones turn z up to y up, and back. */
static void axes(void) {
    static const int permutations[6][3] = { { 1, 2, 3 }, { 2, 3, 1 }, { 3, 1, 2 }, { 2, 1, 3 }, { 1, 3, 2 }, { 3, 2, 1 } };
    for (int p = 0; p < 48; p++)
        for (int order = SH_L0; order <= SH_L2; order++) {
            int axis[3];
            float m[9] = { 0 }, c[9], out[9], expected[9];
            for (int i = 0; i < 3; i++) {
                axis[i] = permutations[p / 8][i] * (p >> i & 1 ? -1 : 1);
                m[3 * i + permutations[p / 8][i] - 1] = axis[i] < 0 ? -1.0f : 1.0f;
            }
            test_section("axes %d %d %d, order %d", axis[0], axis[1], axis[2], order);
            test_fill(c, 9, -1.0, 1.0);
            sh_rotate(order, c, m, expected);
            sh_swap_axes(order, c, axis, out);
            NEAR_ALL(out, expected, SH_COUNT(order), 1.2e-7);
            sh_swap_axes(order, c, axis, c);
            SAME_BITS(c, out, (size_t)SH_COUNT(order) * sizeof(float));
        }
    test_section("z up and y up");
    for (int i = 0; i < 20; i++) {
        float dir[3], c[9] = { 0 }, out[9], back[9], expected[9] = { 0 };
        test_direction(dir);
        const float turned[3] = { dir[0], dir[2], -dir[1] };
        sh_add_sample(SH_L2, dir, 1.0f, c);
        sh_add_sample(SH_L2, turned, 1.0f, expected);
        sh_z_up_to_y_up(SH_L2, c, out);
        NEAR_ALL(out, expected, 9, 2.4e-7);
        sh_y_up_to_z_up(SH_L2, out, back);
        NEAR_ALL(back, c, 9, 2.4e-7);
    }
}

static void run_tests(void) {
    against_projection();
    orders();
    batches();
    invariance();
    quaternions();
    axes();
}
