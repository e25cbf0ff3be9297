/* Zonal kernels against their integrals, windows against their formulas, convolution, and lobes about any direction. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

/* Relative: four roundings of half an ulp, 2^-24. */
static const long double kernel_tolerance = 2.4e-7L;

static long double lambert(long double t, const void *user) {
    (void)user;
    return 4.0L * t;
}

static long double half_lambert(long double t, const void *user) {
    (void)user;
    return 1.0L + t;
}

static long double one(long double t, const void *user) {
    (void)t;
    (void)user;
    return 1.0L;
}

/* exp(K t) K / sinh K: von Mises-Fisher of mean 1, for K that does not overflow it. */
static long double vmf(long double t, const void *user) {
    const long double sharpness = *(const long double *)user;
    return sharpness > 0.0L ? expl(sharpness * t) * sharpness / sinhl(sharpness) : 1.0L;
}

/* Compares with the moments on [from, 1] of k, each to a relative error; the oracle's own is all there is where they are 0. */
static void check_kernel(const float zonal[3], oracle_kernel k, const void *user, long double from) {
    for (int l = 0; l < 3; l++) {
        const long double expected = oracle_zonal_moment(l, k, user, from, 1.0L);
        NEAR(zonal[l], expected, kernel_tolerance * fabsl(expected) + 1e-18L);
    }
}

static void fixed(void) {
    float zonal[3];
    test_section("Lambert");
    sh_zonal_lambert(zonal);
    check_kernel(zonal, lambert, NULL, 0.0L);
    NEAR(zonal[2], 0.25, 0);
    test_section("half Lambert");
    sh_zonal_half_lambert(zonal);
    check_kernel(zonal, half_lambert, NULL, -1.0L);
    test_section("hemisphere");
    sh_zonal_cap(0.0f, zonal);
    NEAR(zonal[0], 0.5, 0);
    NEAR(zonal[1], 0.25, 0);
    NEAR(zonal[2], 0.0, 0);
}

static void cones(void) {
    float zonal[3];
    for (int i = 0; i <= 250; i++) {
        const float c = (float)i / 250.0f;
        test_section("Lambert within a cone of cosine %g", (double)c);
        sh_zonal_ao(c, zonal);
        check_kernel(zonal, lambert, NULL, (long double)c);
    }
    for (int i = -250; i <= 250; i++) {
        const float c = (float)i / 250.0f;
        test_section("cap of cosine %g", (double)c);
        sh_zonal_cap(c, zonal);
        check_kernel(zonal, one, NULL, (long double)c);
    }
    test_section("cones as narrow as a float can say");
    for (int bits = 1; bits <= 24; bits++) {
        const float c = 1.0f - ldexpf(1.0f, -bits);
        const long double gap = 1.0L - (long double)c; /* 1 - P_l(t) is of order gap */
        sh_zonal_cap(c, zonal);
        for (int l = 0; l < 3; l++)
            RELATIVE(zonal[l], oracle_zonal_moment(l, one, NULL, 1.0L - gap, 1.0L), kernel_tolerance);
        sh_zonal_ao(c, zonal);
        for (int l = 0; l < 3; l++)
            RELATIVE(zonal[l], oracle_zonal_moment(l, lambert, NULL, 1.0L - gap, 1.0L), kernel_tolerance);
    }
    test_section("limits of a cone, and a cosine rounded beyond them");
    for (float limit = 1.0f; limit < 1.2f; limit += 0.1f) {
        sh_zonal_ao(limit, zonal);
        NEAR(zonal[0] + zonal[1] + zonal[2], 0.0, 0);
        sh_zonal_cap(limit, zonal);
        NEAR(zonal[0] + zonal[1] + zonal[2], 0.0, 0);
        sh_zonal_cap(-limit, zonal);
        NEAR(zonal[0], 1.0, 0);
        NEAR(fabsf(zonal[1]) + fabsf(zonal[2]), 0.0, 0);
    }
}

/* Moderate sharpness by quadrature, small by the leading terms of the series, large by the closed form without its exponentials:
 * from K = 45 on, coth K is 1 to long double. */
static void von_mises_fisher(void) {
    float zonal[3];
    for (int i = -60; i <= 50; i++) {
        const float sharpness = (float)exp2(i / 10.0);
        const long double k = (long double)sharpness;
        test_section("von Mises-Fisher, sharpness %g", (double)sharpness);
        sh_zonal_vmf(sharpness, zonal);
        NEAR(zonal[0], 1.0, 0);
        for (int l = 1; l < 3; l++)
            RELATIVE(zonal[l], oracle_zonal_moment(l, vmf, &k, -1.0L, 1.0L), 1e-7);
    }
    for (int i = -149; i <= -10; i++) {
        const float sharpness = ldexpf(1.0f, i);
        const long double k = (long double)sharpness;
        test_section("von Mises-Fisher, sharpness %g", (double)sharpness);
        sh_zonal_vmf(sharpness, zonal);
        NEAR(zonal[0], 1.0, 0);
        NEAR(zonal[1], k / 3.0L - k * k * k / 45.0L, 1e-7L * k + 1e-45L);
        NEAR(zonal[2], k * k / 15.0L, 1e-7L * k * k + 1e-45L);
    }
    for (int i = 60; i <= 1279; i++) {
        const float sharpness = (float)exp2(i / 10.0);
        const long double k = (long double)sharpness, first = 1.0L - 1.0L / k;
        test_section("von Mises-Fisher, sharpness %g", (double)sharpness);
        sh_zonal_vmf(sharpness, zonal);
        NEAR(zonal[0], 1.0, 0);
        NEAR(zonal[1], first, 6e-8);
        NEAR(zonal[2], 1.0L - 3.0L * first / k, 6e-8);
    }
    test_section("von Mises-Fisher, no sharpness");
    sh_zonal_vmf(0.0f, zonal);
    NEAR(zonal[0], 1.0, 0);
    NEAR(zonal[1], 0.0, 0);
    NEAR(zonal[2], 0.0, 0);
}

static void windows(void) {
    float zonal[3];
    for (int i = 1; i <= 100; i++) {
        const float width = (float)i / 10.0f, lambda = (float)i / 500.0f;
        const long double w = (long double)width;
        test_section("windows, width %g", (double)width);
        sh_zonal_hann(width, zonal);
        for (int l = 0; l < 3; l++)
            NEAR(zonal[l], (long double)l < w || l == 0 ? (1.0L + cosl(oracle_pi * l / w)) / 2.0L : 0.0L, 6e-8);
        sh_zonal_lanczos(width, zonal);
        for (int l = 0; l < 3; l++) {
            const long double t = oracle_pi * l / w;
            NEAR(zonal[l], l == 0 ? 1.0L : (long double)l < w ? sinl(t) / t : 0.0L, 6e-8);
        }
        sh_zonal_laplacian(lambda, zonal);
        for (int l = 0; l < 3; l++)
            NEAR(zonal[l], 1.0L / (1.0L + (long double)lambda * l * l * (l + 1) * (l + 1)), kernel_tolerance);
    }
    test_section("windows that change nothing");
    sh_zonal_hann(1e30f, zonal);
    NEAR(zonal[1] + zonal[2], 2.0, 0);
    sh_zonal_lanczos(1e30f, zonal);
    NEAR(zonal[1] + zonal[2], 2.0, 0);
    sh_zonal_laplacian(0.0f, zonal);
    NEAR(zonal[1] + zonal[2], 2.0, 0);
}

static void convolution(void) {
    float c[9], zonal[3], out[9];
    test_section("convolution multiplies each band");
    test_fill(c, 9, -1.0, 1.0);
    test_fill(zonal, 3, -1.0, 1.0);
    sh_convolve(SH_L2, c, zonal, out);
    for (int i = 0; i < 9; i++)
        CHECK(out[i] == c[i] * zonal[i == 0 ? 0 : i < 4 ? 1 : 2]);
    sh_convolve(SH_L2, c, zonal, c);
    SAME_BITS(c, out, sizeof c);

    test_section("radiance of the convolution with a clamped cosine is irradiance");
    sh_zonal_lambert(zonal);
    sh_convolve(SH_L2, c, zonal, out);
    for (int i = 0; i < 100; i++) {
        float n[3];
        test_direction(n);
        NEAR(sh_radiance(SH_L2, out, n), sh_irradiance(SH_L2, c, n), 1e-6); /* two ulp of terms that sum to less than 5 */
    }
}

/* A light that depends on w.axis alone. */
typedef struct lobe {
    long double axis[3], cosine, sharpness;
} lobe;

static long double lobe_vmf(const long double dir[3], const void *user) {
    const lobe *of = (const lobe *)user;
    return vmf(oracle_dot(dir, of->axis), &of->sharpness);
}

static long double lobe_lambert(const long double dir[3], const void *user) {
    return lambert(oracle_dot(dir, ((const lobe *)user)->axis), NULL);
}

static long double lobe_one(const long double dir[3], const void *user) {
    (void)dir;
    (void)user;
    return 1.0L;
}

/* Adds the lobe by its zonal coefficients, and compares with its moments by quadrature over the zone that it covers. */
static void check_lobe(const float zonal[3], const lobe *of, const float dir[3], oracle_light light) {
    oracle_rule rule = oracle_rule_zone(of->axis, of->cosine, 1.0L, 40);
    long double expected[9];
    float c[9];
    for (int i = 0; i < 9; i++)
        c[i] = 0.5f;
    oracle_moments(&rule, light, of, expected);
    for (int i = 0; i < 9; i++)
        expected[i] = 0.5L + 3.0L * expected[i];
    sh_zonal_add(SH_L2, zonal, dir, 3.0f, c);
    NEAR_ALL(c, expected, 9, 5e-7); /* an ulp of 3.5, and three times the basis' own error */
    oracle_rule_free(&rule);
}

static void lobes(void) {
    for (int i = 0; i < 60; i++) {
        float dir[3], zonal[3];
        lobe of;
        test_direction(dir);
        oracle_widen(dir, 3, of.axis);
        const long double length = sqrtl(oracle_dot(of.axis, of.axis));
        for (int k = 0; k < 3; k++)
            of.axis[k] /= length;
        const float sharpness = (float)test_uniform(0.0, 12.0), cosine = (float)test_uniform(-1.0, 1.0);

        test_section("a cap of cosine %g about a direction", (double)cosine);
        of.cosine = (long double)cosine;
        sh_zonal_cap(cosine, zonal);
        check_lobe(zonal, &of, dir, lobe_one);

        test_section("a cosine lobe within cosine %g about a direction", (double)fabsf(cosine));
        of.cosine = fabsl(of.cosine);
        sh_zonal_ao(fabsf(cosine), zonal);
        check_lobe(zonal, &of, dir, lobe_lambert);

        test_section("von Mises-Fisher, sharpness %g, about a direction", (double)sharpness);
        of.cosine = -1.0L;
        of.sharpness = (long double)sharpness;
        sh_zonal_vmf(sharpness, zonal);
        check_lobe(zonal, &of, dir, lobe_vmf);
    }
}

/* A lobe with all factors 1 is a light from one direction. */
static void delta(void) {
    const float ones[3] = { 1.0f, 1.0f, 1.0f };
    test_section("a lobe of factors 1 is sh_add_sample");
    for (int i = 0; i < 100; i++) {
        float dir[3], a[9], b[9];
        test_direction(dir);
        test_fill(a, 9, -1.0, 1.0);
        memcpy(b, a, sizeof b);
        sh_zonal_add(SH_L2, ones, dir, 1.7f, a);
        sh_add_sample(SH_L2, dir, 1.7f, b);
        SAME_BITS(a, b, sizeof a);
    }
}

static void run_tests(void) {
    fixed();
    cones();
    von_mises_fisher();
    windows();
    convolution();
    lobes();
    delta();
}
