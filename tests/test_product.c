/* Products against the projected product of the reconstructions, and what they are used for. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static const long double radiance_kernel[3] = { 1.0L, 1.0L, 1.0L };

/* Root mean square of the radiance reconstruction. */
static long double norm(const long double c[9]) {
    long double second = 2.0L * (c[5] * c[5] + c[6] * c[6] + c[8] * c[8]) + c[4] * c[4] + c[7] * c[7] + (c[4] + c[7]) * (c[4] + c[7]);
    return sqrtl(c[0] * c[0] + 3.0L * oracle_dot(&c[1], &c[1]) + 7.5L * second);
}

/* One channel, with what lies above `order` zero. */
static void widen_order(int order, const float *c, long double wide[9]) {
    for (int i = 0; i < 9; i++)
        wide[i] = 0.0L;
    oracle_widen(c, SH_COUNT(order), wide);
}

static void project_product(const oracle_rule *rule, const long double a[9], const long double b[9], long double out[9]) {
    for (int i = 0; i < 9; i++)
        out[i] = 0.0L;
    for (size_t n = 0; n < rule->count; n++) {
        const long double *dir = rule->node[n].dir;
        const long double value = oracle_expand(a, radiance_kernel, dir) * oracle_expand(b, radiance_kernel, dir);
        long double basis[9];
        oracle_basis(dir, basis);
        for (int i = 0; i < 9; i++)
            out[i] += rule->node[n].weight * value * basis[i];
    }
}

static void against_projection(void) {
    oracle_rule rule = oracle_rule_sphere(6);
    static const double scales[] = { 1e-12, 1.0, 1e9 };
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int i = 0; i < 300; i++) {
            const double scale = scales[i % 3];
            const int count = SH_COUNT(order);
            float a[9], b[9], out[9], swapped[9];
            long double wide_a[9], wide_b[9], expected[9];
            test_section("sh_product, order %d, scale %g", order, scale);
            test_fill(a, 9, -scale, scale);
            test_fill(b, 9, -1.0, 1.0);
            widen_order(order, a, wide_a);
            widen_order(order, b, wide_b);
            project_product(&rule, wide_a, wide_b, expected);
            sh_product(order, a, b, out);
            NEAR_ALL(out, expected, count, 1e-6L * norm(wide_a) * norm(wide_b));
            sh_product(order, b, a, swapped);
            NEAR_ALL(swapped, out, count, 1e-6L * norm(wide_a) * norm(wide_b));
        }
    oracle_rule_free(&rule);
}

static void in_place(void) {
    for (int order = SH_L0; order <= SH_L2; order++) {
        const size_t bytes = (size_t)SH_COUNT(order) * sizeof(float);
        float a[9], b[9], out[9], again[9];
        test_section("in place, order %d", order);
        test_fill(a, 9, -1.0, 1.0);
        test_fill(b, 9, -1.0, 1.0);
        sh_product(order, a, b, out);
        memcpy(again, a, sizeof again);
        sh_product(order, again, b, again);
        NEAR_ALL(again, out, SH_COUNT(order), 1e-6);
        memcpy(again, b, sizeof again);
        sh_product(order, a, again, again);
        NEAR_ALL(again, out, SH_COUNT(order), 1e-6);
        for (int i = SH_COUNT(order); i < 9; i++)
            CHECK(again[i] == b[i]);
        CHECK(bytes <= sizeof again);
    }
}

/* Planes of exactly `count` floats, every length over several vectors, in place and not. */
static void batches(void) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (size_t count = 0; count <= 70; count++) {
            const size_t n = (size_t)SH_COUNT(order) * count;
            float *a = (float *)test_allocate(n * sizeof(float)), *b = (float *)test_allocate(n * sizeof(float));
            float *out = (float *)test_allocate(n * sizeof(float));
            test_section("sh_product_batch, order %d, %d pairs", order, (int)count);
            test_fill(a, n, -1.0, 1.0);
            test_fill(b, n, -1.0, 1.0);
            sh_product_batch(order, a, b, out, count);
            for (size_t p = 0; p < count; p++) {
                float single_a[9], single_b[9], single[9], lane[9];
                for (int i = 0; i < SH_COUNT(order); i++) {
                    single_a[i] = a[(size_t)i * count + p];
                    single_b[i] = b[(size_t)i * count + p];
                    lane[i] = out[(size_t)i * count + p];
                }
                sh_product(order, single_a, single_b, single);
                NEAR_ALL(lane, single, SH_COUNT(order), 2e-5);
            }
            sh_product_batch(order, a, b, b, count);
            SAME_BITS(b, out, n * sizeof(float));
            free(a);
            free(b);
            free(out);
        }
}

/* A result must not depend on its place in the batch or on the batch's length. */
static void position(void) {
    enum { MOST = 40 };
    float a[9 * MOST], b[9 * MOST], out[9 * MOST], first[9];
    test_section("position in the batch");
    for (size_t count = 1; count <= MOST; count++) {
        for (int i = 0; i < 9; i++)
            for (size_t p = 0; p < count; p++) {
                a[(size_t)i * count + p] = 0.3f * (float)(i + 1);
                b[(size_t)i * count + p] = 1.0f / (float)(i + 2);
            }
        sh_product_batch(SH_L2, a, b, out, count);
        for (size_t p = 0; p < count; p++)
            for (int i = 0; i < 9; i++) {
                if (count == 1)
                    first[i] = out[i];
                CHECK(out[(size_t)i * count + p] == first[i]);
            }
    }
}

/* Ambient 1 is the identity; up to 1e18 each, nothing is NaN. */
static void extremes(void) {
    float one[9] = { 1 }, a[9], out[9];
    test_section("identity and extremes");
    test_fill(a, 9, -1.0, 1.0);
    sh_product(SH_L2, one, a, out);
    NEAR_ALL(out, a, 9, 0);
    for (int i = 0; i < 9; i++)
        a[i] = i % 2 ? -1e18f : 1e18f;
    sh_product(SH_L2, a, a, out);
    for (int i = 0; i < 9; i++)
        CHECK(out[i] == out[i]);
}

/* Shadowed ambient: irradiance of a polynomial sky through a polynomial visibility, where the product of degree 2 is exact. */
static void shadowed_ambient(void) {
    oracle_rule rule = oracle_rule_sphere(4);
    test_section("sky times visibility");
    for (int i = 0; i < 50; i++) {
        float sky[9] = { 0 }, visibility[9] = { 0 }, shadowed[9];
        long double wide_sky[9], wide_visibility[9], n[3] = { 0, 0, 1 }, sum = 0.0L;
        float up[3] = { 0, 0, 1 };
        test_fill(sky, 4, -1.0, 1.0);
        test_fill(visibility, 4, -1.0, 1.0);
        sh_product(SH_L2, sky, visibility, shadowed);
        oracle_widen(sky, 9, wide_sky);
        oracle_widen(visibility, 9, wide_visibility);
        oracle_rule half = oracle_rule_zone(n, 0.0L, 1.0L, 4);
        for (size_t k = 0; k < half.count; k++)
            sum += 4.0L * half.node[k].weight * half.node[k].dir[2] * oracle_expand(wide_sky, radiance_kernel, half.node[k].dir) *
                   oracle_expand(wide_visibility, radiance_kernel, half.node[k].dir);
        oracle_rule_free(&half);
        NEAR(sh_irradiance(SH_L2, shadowed, up), sum, 4e-6);
    }
    oracle_rule_free(&rule);
}

/* Precomputed transfer: a vertex's transfer vector t is visibility times cosine, projected; its light is <L t>. The same by the matrix of
 * the receiver, which multiplies by visibility first, then convolves and looks along the normal. */
static void transfer(void) {
    static const float n[3] = { 0.48f, -0.6f, 0.64f };
    float lobe[9] = { 0 }, lambert[3];
    test_section("radiance transfer");
    sh_zonal_lambert(lambert);
    sh_zonal_add(SH_L2, lambert, n, 1.0f, lobe); /* 4 max(0, n.w), kept to L2 */
    for (int i = 0; i < 50; i++) {
        float visibility[9], vector[9], light[3 * 9], matrix[9][9];
        test_fill(visibility, 9, -0.2, 0.2);
        test_fill(light, 27, -1.0, 1.0);
        sh_product(SH_L2, visibility, lobe, vector);
        for (int j = 0; j < 9; j++) {
            float unit[9] = { 0 }, column[9];
            unit[j] = 1.0f;
            sh_product(SH_L2, visibility, unit, column);
            for (int k = 0; k < 9; k++)
                matrix[k][j] = column[k];
        }
        for (int channel = 0; channel < 3; channel++) {
            const float *c = light + 9 * channel;
            float seen[9] = { 0 };
            for (int k = 0; k < 9; k++)
                for (int j = 0; j < 9; j++)
                    seen[k] += matrix[k][j] * c[j];
            NEAR(sh_dot(SH_L2, c, vector), sh_irradiance(SH_L2, seen, n), 2e-5);
        }
    }
}

static void run_tests(void) {
    against_projection();
    in_place();
    batches();
    position();
    extremes();
    shadowed_ambient();
    transfer();
}
