/* The oracle itself, against numbers that can be checked by hand: what all other tests lean on. */
#include "oracle_image.h"
#include "test.h"

/* What long double rounding leaves after a sum of hundreds of terms of order 1; double where that is all a machine has. */
static const long double tiny = 50.0L * LDBL_EPSILON;

static long double power(long double t, const void *user) {
    return powl(t, *(const int *)user);
}

static void gauss(void) {
    static long double node[ORACLE_MAX_NODES], weight[ORACLE_MAX_NODES];
    const int counts[] = { 1, 2, 3, 8, 65, 1024 };
    test_section("Gauss-Legendre nodes");
    oracle_gauss(2, -1.0L, 1.0L, node, weight);
    NEAR(node[0], 1.0L / sqrtl(3.0L), 4 * LDBL_EPSILON);
    NEAR(weight[0], 1.0L, 4 * LDBL_EPSILON);
    for (size_t n = 0; n < sizeof counts / sizeof counts[0]; n++) {
        const int count = counts[n];
        oracle_gauss(count, 0.0L, 2.0L, node, weight);
        for (int degree = 0; degree < 2 * count && degree < 12; degree++) {
            long double sum = 0.0L;
            for (int i = 0; i < count; i++)
                sum += weight[i] * powl(node[i], degree);
            RELATIVE(sum, powl(2.0L, degree + 1) / (degree + 1), 2 * tiny);
        }
    }
    test_section("moments on an interval");
    for (int degree = 0; degree < 5; degree++) /* t = P1, t^3 = 3/5 P1 + 2/5 P3 */
        NEAR(oracle_zonal_moment(1, power, &degree, -1.0L, 1.0L), degree % 2 ? 1.0L / (degree + 2) : 0.0L, tiny);
}

static void legendre(void) {
    test_section("Legendre polynomials");
    for (int i = 0; i <= 20; i++) {
        const long double t = 0.1L * i - 1.0L, tt = t * t;
        NEAR(oracle_legendre(0, t), 1.0L, 0);
        NEAR(oracle_legendre(2, t), (3 * tt - 1) / 2, tiny);
        NEAR(oracle_legendre(4, t), (35 * tt * tt - 30 * tt + 3) / 8, tiny);
        NEAR(oracle_legendre(6, t), (((231 * tt - 315) * tt + 105) * tt - 5) / 16, tiny);
        NEAR(oracle_associated_legendre(3, 1, t), 1.5L * (5 * tt - 1), tiny);
        NEAR(oracle_associated_legendre(4, 3, t), 105 * t, 100 * tiny);
    }
}

static void spherical_harmonics(void) {
    enum { BANDS = 7, COUNT = BANDS * BANDS };
    oracle_rule rule = oracle_rule_sphere(2 * BANDS - 2);
    static long double gram[COUNT][COUNT];
    test_section("Y_lm are orthonormal");
    for (size_t n = 0; n < rule.count; n++) {
        long double y[COUNT];
        for (int l = 0; l < BANDS; l++)
            for (int m = -l; m <= l; m++)
                y[l * (l + 1) + m] = oracle_y(l, m, rule.node[n].dir, 0);
        for (int i = 0; i < COUNT; i++)
            for (int j = 0; j <= i; j++)
                gram[i][j] += 4.0L * oracle_pi * rule.node[n].weight * y[i] * y[j];
    }
    for (int i = 0; i < COUNT; i++)
        for (int j = 0; j <= i; j++)
            NEAR(gram[i][j], i == j ? 1.0L : 0.0L, tiny);
    oracle_rule_free(&rule);

    test_section("Y_lm, a table of Green, The Gritty Details");
    const long double dir[3] = { 0.48L, 0.6L, 0.64L };
    NEAR(oracle_y(1, -1, dir, 0), sqrtl(3.0L / (4.0L * oracle_pi)) * dir[1], tiny);
    NEAR(oracle_y(2, 1, dir, 0), sqrtl(15.0L / (4.0L * oracle_pi)) * dir[0] * dir[2], tiny);
    NEAR(oracle_y(2, 2, dir, 0), sqrtl(15.0L / (16.0L * oracle_pi)) * (dir[0] * dir[0] - dir[1] * dir[1]), tiny);
    for (int l = 0; l < 4; l++)
        for (int m = -l; m <= l; m++)
            NEAR(oracle_y(l, m, dir, 1), (m % 2 ? -1 : 1) * oracle_y(l, m, dir, 0), 0);
}

static long double monomial(const long double dir[3], const void *user) {
    const int *power3 = (const int *)user;
    return powl(dir[0], power3[0]) * powl(dir[1], power3[1]) * powl(dir[2], power3[2]);
}

static void means(void) {
    const long double axis[3] = { 0.48L, 0.6L, 0.64L };
    oracle_rule rule = oracle_rule_zone(axis, -1.0L, 1.0L, 8);
    test_section("monomials by quadrature about a tilted axis");
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 4; j++) {
            const int power3[3] = { i, j, 2 };
            long double c[9];
            if (i + j > 4)
                continue;
            oracle_moments(&rule, monomial, power3, c);
            NEAR(c[0], oracle_monomial(i, j, 2), tiny);
            NEAR(c[1], oracle_monomial(i + 1, j, 2), tiny);
            NEAR(c[7], oracle_monomial(i, j + 2, 2) - oracle_monomial(i, j, 2) / 3.0L, tiny);
        }
    oracle_rule_free(&rule);
    NEAR(oracle_monomial(2, 2, 0), 1.0L / 15.0L, tiny);
    NEAR(oracle_monomial(4, 0, 0), 1.0L / 5.0L, tiny);
    NEAR(oracle_monomial(2, 2, 2), 1.0L / 105.0L, tiny);

    test_section("irradiance of x, and of a sky");
    const int constant[3] = { 0, 0, 0 }, x[3] = { 1, 0, 0 };
    NEAR(oracle_irradiance(monomial, constant, axis, 0.0L, 0), 1.0L, tiny);
    NEAR(oracle_irradiance(monomial, constant, axis, 0.5L, 0), 0.75L, tiny);
    NEAR(oracle_irradiance(monomial, x, axis, 0.0L, 1), 2.0L / 3.0L * axis[0], tiny);
    const oracle_source source[2] = { { { 1.0L, 0.0L, 0.0L }, 3.0L }, { { 0.0L, 0.0L, -1.0L }, 1.0L } };
    NEAR(oracle_irradiance_sources(source, 2, axis), 12.0L * axis[0], tiny);
    long double c[9];
    oracle_moments_sources(source, 2, c);
    NEAR(oracle_quadratic(c, axis), 3.0L * axis[0] * axis[0] + axis[2] * axis[2] - 4.0L / 3.0L, tiny);
}

static void rotation(void) {
    long double turn[3][3] = { { 0.0L, -1.0L, 0.0L }, { 1.0L, 0.0L, 0.0L }, { 0.0L, 0.0L, 1.0L } }; /* x to y */
    const long double dir[3] = { 0.48L, 0.6L, 0.64L }, turned[3] = { -0.6L, 0.48L, 0.64L };
    long double a[9], b[9], rotated[9];
    test_section("rotation");
    oracle_basis(dir, a);
    oracle_basis(turned, b);
    oracle_rotate(a, turn, rotated);
    NEAR_ALL(rotated, b, 9, tiny);
}

static void decoders(void) {
    test_section("decoders");
    NEAR(oracle_half(0x3c00), 1.0L, 0);
    NEAR(oracle_half(0xc100), -2.5L, 0);
    NEAR(oracle_half(0x7bff), 65504.0L, 0);
    NEAR(oracle_half(0x0001), ldexpl(1.0L, -24), 0);
    CHECK(oracle_half(0xfc00) < -1e30L);
    CHECK(!(oracle_half(0x7e00) >= 0.0L) && !(oracle_half(0x7e00) < 0.0L));
    NEAR(oracle_srgb(0), 0.0L, 0);
    NEAR(oracle_srgb(10), 10 / 255.0L / 12.92L, 0);
    NEAR(oracle_srgb(128), 0.21586050011389926L, 1e-15);
    NEAR(oracle_srgb(255), 1.0L, tiny);

    const unsigned char rgbe[4] = { 128, 64, 0, 129 };
    const sh_image radiance = { rgbe, 1, 1, 0, 3, SH_RGBE8 };
    const long double expected_radiance[3] = { 1.0L, 0.5L, 0.0L };
    const uint32_t word = 256u | 1u << 9 | 511u << 18 | 16u << 27;
    const sh_image shared = { &word, 1, 1, 0, 3, SH_RGB9E5 };
    const long double expected_shared[3] = { 1.0L, 1.0L / 256.0L, 511.0L / 256.0L };
    long double value[3];
    oracle_texel(&radiance, 0, 0, value);
    NEAR_ALL(value, expected_radiance, 3, 0);
    oracle_texel(&shared, 0, 0, value);
    NEAR_ALL(value, expected_shared, 3, 0);
}

static void fejer(void) {
    static long double weight[ORACLE_MAX_NODES];
    test_section("Fejer weights");
    oracle_fejer(2, weight);
    NEAR(weight[0], 0.5L, tiny);
    oracle_fejer(3, weight); /* 4/9, 10/9, 4/9 on [-1, 1] */
    NEAR(weight[0], 2.0L / 9.0L, tiny);
    NEAR(weight[1], 5.0L / 9.0L, tiny);
    for (int count = 1; count < 200; count += 13) {
        long double sum[4] = { 0.0L, 0.0L, 0.0L, 0.0L };
        oracle_fejer(count, weight);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 4; k++)
                sum[k] += weight[i] * powl(cosl(oracle_pi * (i + 0.5L) / count), 2 * k);
        for (int k = 0; k < 4 && 2 * k < count; k++)
            NEAR(sum[k], 1.0L / (2 * k + 1), tiny);
    }
}

static void panorama(void) {
    const float octants[8] = { 1, 2, 3, 4, 5, 6, 7, 8 };
    const sh_image image = { octants, 4, 2, 0, 1, SH_F32 };
    test_section("an image of octants");
    /* <x> over an octant is 1/16 of the sphere's, <xy> is 1/(12 pi); by hand */
    const oracle_projection p = oracle_project_equirect(&image, 0), q = oracle_project_equirect(&image, SH_CLOCKWISE);
    NEAR(p.c[0][0], 4.5L, tiny);
    NEAR(p.c[0][1], (1 - 2 - 3 + 4 + 5 - 6 - 7 + 8) / 16.0L, tiny);
    NEAR(p.c[0][2], (1 + 2 - 3 - 4 + 5 + 6 - 7 - 8) / 16.0L, tiny);
    NEAR(p.c[0][3], (1 + 2 + 3 + 4 - 5 - 6 - 7 - 8) / 16.0L, tiny);
    NEAR(p.c[0][5], (1 - 2 + 3 - 4 + 5 - 6 + 7 - 8) / (12.0L * oracle_pi), tiny);
    NEAR(p.c[0][6], (1 - 2 - 3 + 4 - 5 + 6 + 7 - 8) / (12.0L * oracle_pi), tiny);
    NEAR(p.c[0][8], (1 + 2 - 3 - 4 - 5 - 6 + 7 + 8) / (12.0L * oracle_pi), tiny);
    NEAR(p.magnitude[0], 4.5L, tiny);
    NEAR(q.c[0][1], p.c[0][1], tiny);
    NEAR(q.c[0][2], -p.c[0][2], tiny);
    NEAR(q.c[0][3], p.c[0][3], tiny);
}

static void run_tests(void) {
    gauss();
    legendre();
    spherical_harmonics();
    means();
    rotation();
    decoders();
    fejer();
    panorama();
}
