/* The kernels of specular and adjustable probes against quadrature, and what a probe shows. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

typedef struct parameter {
    long double value;
} parameter;

static long double cosine_power(long double t, const void *user) {
    return powl(t, ((const parameter *)user)->value);
}

/* D(h) n.l for the light l at l.n = t, the view along the normal; without constant factors. */
static long double ggx(long double t, const void *user) {
    const long double a = ((const parameter *)user)->value, cos_h2 = (1.0L + t) / 2.0L;
    const long double d = cos_h2 * (a * a - 1.0L) + 1.0L;
    return t / (d * d);
}

/* In pieces that shrink towards t = 1, where sharp lobes are. */
static long double moment(int l, oracle_kernel k, const void *user) {
    long double sum = 0.0L, from = 0.0L, width = 0.5L;
    for (int i = 0; i < 40; i++, from += width, width /= 2.0L)
        sum += oracle_zonal_moment(l, k, user, from, from + width);
    return sum;
}

static void against_quadrature(const float zonal[3], oracle_kernel k, const void *user) {
    const long double mean = moment(0, k, user);
    for (int l = 0; l < 3; l++)
        NEAR(zonal[l], moment(l, k, user) / mean, 1.5e-7);
}

static void kernels(void) {
    static const double exponents[] = { 0, 1, 2, 3, 8, 32, 100 };
    static const double alphas[] = { 1e-3, 0.01, 0.1, 0.3, 0.5, 0.577, 0.578, 0.7, 0.9, 0.999, 1 };
    float zonal[3], lambert[3];
    sh_zonal_lambert(lambert);
    for (int i = 0; i < 7; i++) {
        const parameter s = { (long double)exponents[i] };
        test_section("cosine power %g", exponents[i]);
        sh_zonal_cosine_power((float)exponents[i], zonal);
        against_quadrature(zonal, cosine_power, &s);
    }
    for (int i = 0; i < 12; i++) {
        const float exponent = (float)pow(10.0, i - 8);
        test_section("cosine power %g, relative", (double)exponent);
        sh_zonal_cosine_power(exponent, zonal);
        RELATIVE(zonal[1], (1.0L + (long double)exponent) / (2.0L + (long double)exponent), 2e-7);
        RELATIVE(zonal[2], (long double)exponent / (3.0L + (long double)exponent), 2e-7);
    }
    for (int i = 0; i < 11; i++) {
        const parameter a = { (long double)(float)alphas[i] };
        test_section("GGX, alpha %g", alphas[i]);
        sh_zonal_ggx((float)alphas[i], zonal);
        against_quadrature(zonal, ggx, &a);
    }
    test_section("limits");
    NEAR_ALL(zonal, lambert, 3, 1e-7);
    sh_zonal_cosine_power(1.0f, zonal);
    NEAR_ALL(zonal, lambert, 3, 1e-7);
    sh_zonal_cosine_power(1e18f, zonal);
    NEAR(zonal[2], 1, 1e-7);
    static const float mirrors[] = { -1.0f, 0.0f, 1e-12f, 1e-9f, 1e-6f };
    for (int i = 0; i < 5; i++) {
        sh_zonal_ggx(mirrors[i], zonal);
        for (int l = 0; l < 3; l++)
            NEAR(zonal[l], 1, 1e-7);
    }
}

/* A mirror shows the radiance reconstruction, alpha 1 the irradiance; between, monotonically duller. */
static void probe(void) {
    const float light[3] = { 0, 0, 1 }, one = 1.0f, n[3] = { 0.6f, 0, 0.8f }, view[3] = { 0.96f, 0, 0.28f };
    float c[9] = { 0 }, zonal[3], r[3], before = 1e9f;
    test_section("specular probe");
    sh_add_directional(SH_L2, 1, light, &one, c);
    sh_reflect(view, n, r);
    NEAR(r[0], 0, 1e-6);
    NEAR(r[2], 1, 1e-6);
    for (int i = 0; i <= 10; i++) {
        sh_zonal_ggx(0.1f * (float)i, zonal);
        const float seen = sh_radiance_zonal(SH_L2, c, zonal, r);
        if (i == 0)
            NEAR(seen, sh_radiance(SH_L2, c, r), 1e-6);
        if (i == 10)
            NEAR(seen, sh_irradiance(SH_L2, c, r), 1e-6);
        CHECK(seen < before);
        before = seen;
    }
    /* Convolved first or looked at through the kernel: the same. */
    for (int order = SH_L0; order <= SH_L2; order++) {
        float set[9], convolved[9], dir[3];
        test_fill(set, 9, -1.0, 1.0);
        test_direction(dir);
        sh_convolve(order, set, zonal, convolved);
        NEAR(sh_radiance_zonal(order, set, zonal, dir), sh_radiance(order, convolved, dir), 3e-6);
    }
}

/* What comes from the mirror and what goes to the eye add up along the normal. */
static void reflection(void) {
    test_section("reflection");
    for (int repeat = 0; repeat < 100; repeat++) {
        float view[3], n[3], r[3];
        test_direction(view);
        test_direction(n);
        sh_reflect(view, n, r);
        for (int i = 0; i < 3; i++)
            NEAR(r[i] + view[i], 2 * (n[0] * view[0] + n[1] * view[1] + n[2] * view[2]) * n[i], 5e-7);
    }
}

static void run_tests(void) {
    kernels();
    reflection();
    probe();
}
