/* Radiance and irradiance from coefficients: values, the antipodal identity, cones, and what they are exact for. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static const long double radiance_kernel[3] = { 1.0L, 1.0L, 1.0L };
static const long double lambert_kernel[3] = { 1.0L, 2.0L / 3.0L, 0.25L };

/* The sum of the absolute terms of a reconstruction: what its rounding error is measured by. */
static long double magnitude(const long double c[9], const long double kernel[3], const long double n[3]) {
    const long double first = fabsl(c[1] * n[0]) + fabsl(c[2] * n[1]) + fabsl(c[3] * n[2]);
    const long double xx = n[0] * n[0], yy = n[1] * n[1], zz = n[2] * n[2];
    const long double second = fabsl(c[4]) * (xx + zz) + fabsl(c[7]) * (yy + zz) +
                               2.0L * (fabsl(c[5] * n[0] * n[1]) + fabsl(c[6] * n[0] * n[2]) + fabsl(c[8] * n[1] * n[2]));
    return fabsl(kernel[0] * c[0]) + 3.0L * fabsl(kernel[1]) * first + 7.5L * fabsl(kernel[2]) * second;
}

/* The contract: 4 ulp of the sum of absolute terms; an ulp is at most 2^-23 of it. */
static const long double four_ulp = 4.0L / 8388608.0L;

static void values(void) {
    static const double scales[] = { 1e-30, 1e-6, 1.0, 1e6, 1e18 };
    for (size_t s = 0; s < sizeof scales / sizeof scales[0]; s++)
        for (int i = 0; i < 1000; i++) {
            float c[9], n[3];
            long double wide[9], dir[3];
            test_section("reconstruction, scale %g", scales[s]);
            test_fill(c, 9, -scales[s], scales[s]);
            test_direction(n);
            oracle_widen(c, 9, wide);
            oracle_widen(n, 3, dir);
            NEAR(sh_radiance(SH_L2, c, n), oracle_expand(wide, radiance_kernel, dir),
                 four_ulp * magnitude(wide, radiance_kernel, dir));
            NEAR(sh_irradiance(SH_L2, c, n), oracle_expand(wide, lambert_kernel, dir),
                 four_ulp * magnitude(wide, lambert_kernel, dir));
        }
}

/* Each band alone: irradiance is 1, 2/3, 1/4 of radiance. */
static void bands(void) {
    for (int i = 0; i < 300; i++) {
        float c[9], n[3];
        test_fill(c, 9, -1.0, 1.0);
        test_direction(n);
        for (int l = 0; l < 3; l++) {
            float band[9] = { 0 };
            for (int k = l * l; k < (l + 1) * (l + 1); k++)
                band[k] = c[k];
            test_section("band %d", l);
            NEAR(sh_irradiance(SH_L2, band, n), lambert_kernel[l] * (long double)sh_radiance(SH_L2, band, n),
                 1e-6); /* an ulp of 8 */
        }
    }
}

static long double quadratic_light(const long double dir[3], const void *user) {
    return oracle_expand((const long double *)user, radiance_kernel, dir);
}

/* Irradiance of a light without bands above 2 is its integral against the clamped cosine. */
static void integral(void) {
    test_section("irradiance is the integral");
    for (int i = 0; i < 50; i++) {
        float c[9], n[3];
        long double wide[9], dir[3];
        test_fill(c, 9, -1.0, 1.0);
        test_direction(n);
        oracle_widen(c, 9, wide);
        oracle_widen(n, 3, dir);
        NEAR(sh_irradiance(SH_L2, c, n), oracle_irradiance(quadratic_light, wide, dir, 0.0L, 2), 1e-6); /* two ulp of 4 */
    }
}

static void cones(void) {
    for (int i = 0; i <= 100; i++) {
        const float cosine = (float)i / 100.0f;
        float c[9], n[3];
        long double wide[9], dir[3];
        test_section("irradiance within a cone of cosine %g", (double)cosine);
        test_fill(c, 9, -1.0, 1.0);
        test_direction(n);
        oracle_widen(c, 9, wide);
        oracle_widen(n, 3, dir);
        const long double t = (long double)cosine, opening = 1.0L - t * t; /* k_l / opening are between 1/4 and 1 */
        const long double kernel[3] = { opening, 2.0L / 3.0L * (1.0L - t * t * t), opening * (1.0L + 3.0L * t * t) / 4.0L };
        NEAR(sh_irradiance_ao(SH_L2, c, n, cosine), oracle_irradiance(quadratic_light, wide, dir, t, 2),
             1.5L * four_ulp * magnitude(wide, kernel, dir) + 1e-17L); /* the kernel's own rounding is half of the sum's */

        test_section("limits of a cone");
        NEAR(sh_irradiance_ao(SH_L2, c, n, 0.0f), sh_irradiance(SH_L2, c, n), 1e-6);
        NEAR(sh_irradiance_ao(SH_L2, c, n, 1.0f), 0.0, 0);
        NEAR(sh_irradiance_ao(SH_L2, c, n, -cosine), sh_irradiance_ao(SH_L2, c, n, 0.0f), 0);
        NEAR(sh_irradiance_ao(SH_L2, c, n, 1.0f + cosine), 0.0, 0);
    }
    test_section("ambient light within a cone");
    const float ambient[9] = { 1.0f }, up[3] = { 0.0f, 0.0f, 1.0f };
    NEAR(sh_irradiance_ao(SH_L2, ambient, up, 0.5f), 0.75, 0);
}

enum { SOURCES = 12 };

/* Random lights from up to SOURCES directions: as sources, and as coefficients. */
static int random_lights(oracle_source source[SOURCES], float c[9]) {
    const int count = 1 + test_below(SOURCES);
    memset(c, 0, 9 * sizeof(float));
    for (int i = 0; i < count; i++) {
        float dir[3];
        const float mean = (float)test_uniform(0.0, 1.0);
        test_direction(dir);
        sh_add_sample(SH_L2, dir, mean, c);
        oracle_widen(dir, 3, source[i].dir);
        source[i].mean = (long double)mean;
    }
    return count;
}

/* n.R1 = (I(n) - I(-n)) / 4 for the true irradiance of any light. */
static void antipodal(void) {
    for (int i = 0; i < 500; i++) {
        oracle_source source[SOURCES];
        float c[9], n[3], opposite[3];
        long double dir[3], back[3];
        test_section("the antipodal identity");
        const size_t count = (size_t)random_lights(source, c);
        test_direction(n);
        oracle_widen(n, 3, dir);
        for (int k = 0; k < 3; k++) {
            opposite[k] = -n[k];
            back[k] = -dir[k];
        }
        const long double front = oracle_irradiance_sources(source, count, dir);
        const long double rear = oracle_irradiance_sources(source, count, back);
        const long double slope = (long double)c[SH_X] * dir[0] + (long double)c[SH_Y] * dir[1] + (long double)c[SH_Z] * dir[2];
        /* up to 12 lights added in float to a sum below 8: an ulp of that, for roundings that rarely agree */
        NEAR(slope, (front - rear) / 4.0L, 1e-6);
        for (int order = SH_L1; order <= SH_L2; order++)
            NEAR(sh_irradiance_opposite(order, c, n, (float)front), rear, 4e-6);

        test_section("the odd part of the reconstruction");
        NEAR(sh_irradiance(SH_L2, c, n) - sh_irradiance(SH_L2, c, opposite), 4.0L * slope, 4e-6);
        NEAR(sh_irradiance(SH_L1, c, n) - sh_irradiance(SH_L1, c, opposite), 4.0L * slope, 4e-6);

        test_section("the opposite of the opposite");
        const float there = sh_irradiance_opposite(SH_L1, c, n, (float)front);
        NEAR(sh_irradiance_opposite(SH_L1, c, opposite, there), front, 2e-6);
        NEAR(sh_irradiance_opposite(SH_L0, c, n, (float)front), (float)front, 0);
    }
}

/* What L2 leaves out of irradiance: bands 4, 6, ... of the kernel, whose factors times (2l + 1) sum to the error of one direction. */
static void one_direction(void) {
    test_section("irradiance of one direction, L2");
    for (int i = -20; i <= 20; i++) {
        const float t = (float)i / 20.0f, dir[3] = { 0.0f, 0.0f, 1.0f }, n[3] = { 0.0f, sqrtf(1.0f - t * t), t };
        float c[9] = { 0 };
        const long double z = (long double)t, truth = z > 0.0L ? 4.0L * z : 0.0L;
        sh_add_sample(SH_L2, dir, 1.0f, c);
        const long double expected = 1.0L + 2.0L * z + 15.0L / 8.0L * (z * z - 1.0L / 3.0L);
        NEAR(sh_irradiance(SH_L2, c, n), expected, 1e-6);
        CHECK(fabsl((long double)sh_irradiance(SH_L2, c, n) - truth) <= 3.0L / 8.0L + 1e-6L); /* largest at t = 0 */
    }
}

static void not_a_number(void) {
    const float nan = (float)NAN, n[3] = { 0.6f, 0.0f, 0.8f };
    for (int i = 0; i < 9; i++) {
        float c[9] = { 1.0f };
        test_section("NaN in coefficient %d", i);
        c[i] = nan;
        CHECK(isnan(sh_radiance(SH_L2, c, n)) && isnan(sh_irradiance(SH_L2, c, n)) && isnan(sh_irradiance_ao(SH_L2, c, n, 0.5f)));
        CHECK(isnan(sh_irradiance(SH_L1, c, n)) == (i < 4));
        CHECK(isnan(sh_irradiance(SH_L0, c, n)) == (i < 1));
    }
}

static void run_tests(void) {
    values();
    bands();
    integral();
    cones();
    antipodal();
    one_direction();
    not_a_number();
}
