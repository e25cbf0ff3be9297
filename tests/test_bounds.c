/* sh_irradiance_bounds on random lights and normals: 10^6 pairs; SH_TEST_PAIRS=100000000 in the environment for more. */
#include "test.h"

#include "lights.h"
#include "sh.h"

enum { NORMALS = 50 };

/* A random normal, one that nearly faces or nearly faces away from a light, or one at right angles to it: there the bounds close. */
static void pick_normal(const lights_light *light, float n[3]) {
    const double *d = light->dir[test_below(light->count)];
    double v[3], length, along, keep;
    test_direction(n);
    if (test_below(2))
        return;
    for (int i = 0; i < 3; i++)
        v[i] = (double)n[i];
    along = lights_dot(v, d);
    keep = test_below(2) ? exp(test_uniform(-18.0, 0.0)) : 0.0;
    for (int i = 0; i < 3; i++)
        v[i] = test_below(3) ? v[i] - along * d[i] + keep * d[i] : d[i] + keep * v[i];
    length = sqrt(lights_dot(v, v));
    for (int i = 0; i < 3; i++)
        n[i] = (float)(v[i] / length);
}

typedef struct tally {
    double beyond;  /* worst violation of the bounds, in ulp of R0 */
    double outside; /* worst distance of a closure from its bounds */
    double negative;
    double antipodal; /* worst error of I(n) - I(-n) = 4 n.R1 by the closure */
} tally;

static void raise_to(double value, double *most) {
    if (!(value <= *most))
        *most = value;
}

static void check_pair(int order, const float *c, const float n[3], double truth, tally *worst) {
    const float opposite[3] = { -n[0], -n[1], -n[2] };
    const double unit = 1.0 / ((double)nextafterf(c[0], INFINITY) - (double)c[0]);
    float lo, hi;
    sh_irradiance_bounds(order, c, n, &lo, &hi);
    const double closure = (double)sh_irradiance_closure(order, c, n), other = (double)sh_irradiance_closure(order, c, opposite);
    raise_to(unit * ((double)lo - truth), &worst->beyond);
    raise_to(unit * (truth - (double)hi), &worst->beyond);
    raise_to(unit * ((double)lo - closure), &worst->outside);
    raise_to(unit * (closure - (double)hi), &worst->outside);
    raise_to(-closure, &worst->negative);
    if (order >= SH_L1) {
        const double m1 = (double)c[1] * (double)n[0] + (double)c[2] * (double)n[1] + (double)c[3] * (double)n[2];
        raise_to(unit * fabs(closure - other - 4.0 * m1), &worst->antipodal);
    }
}

static void test_pairs(long pairs) {
    tally worst[3] = { { 0.0, 0.0, 0.0, 0.0 } };
    lights_light light;
    float c[9], n[3];
    for (long i = 0; i < pairs / NORMALS; i++) {
        lights_random((int)(i % LIGHTS_KINDS), &light);
        lights_moments(&light, exp(test_uniform(-20.0, 20.0)), c);
        const double scale = (double)c[0];
        double total = 0.0;
        for (int k = 0; k < light.count; k++)
            total += light.value[k];
        for (int k = 0; k < NORMALS; k++) {
            pick_normal(&light, n);
            const double truth = lights_irradiance(&light, n) * scale / total;
            check_pair(SH_L0, c, n, truth, &worst[0]);
            check_pair(SH_L1, c, n, truth, &worst[1]);
            check_pair(SH_L2, c, n, truth, &worst[2]);
        }
    }
    for (int order = SH_L0; order <= SH_L2; order++) {
        test_section("%ld pairs, order %d", pairs, order);
        printf("L%d: beyond the bounds %.2f ulp, closure outside %.2f ulp, antipodal %.2f ulp\n", order, worst[order].beyond,
               worst[order].outside, worst[order].antipodal);
        CHECK(worst[order].beyond <= 8.0);
        CHECK(worst[order].outside <= 16.0);
        CHECK(worst[order].negative <= 0.0);
        CHECK(worst[order].antipodal <= 16.0);
    }
}

/* Where the bounds close: a single direction. Where they are known: ambient light, and what no light has. */
static void test_cases(void) {
    const float ambient[9] = { 2.0f }, black[9] = { 0 }, negative[9] = { -1.0f, 0.9f }, more[9] = { 1.0f, 3.0f };
    float lo, hi, n[3], c[9];
    test_section("cases");
    for (int i = 0; i < 1000; i++) {
        test_direction(n);
        sh_irradiance_bounds(SH_L2, ambient, n, &lo, &hi);
        NEAR(lo, 2.0 * 2.0 / 3.0, 1e-6);
        NEAR(hi, 2.0 * 2.0 / sqrt(3.0), 3e-6);
        sh_irradiance_bounds(SH_L1, ambient, n, &lo, &hi);
        NEAR(lo, 0.0, 0.0);
        NEAR(hi, 4.0, 1e-5);
        sh_irradiance_bounds(SH_L0, ambient, n, &lo, &hi);
        NEAR(lo, 0.0, 0.0);
        NEAR(hi, 8.0, 1e-6);
        for (int order = SH_L0; order <= SH_L2; order++) {
            sh_irradiance_bounds(order, black, n, &lo, &hi);
            CHECK(lo == 0.0f && hi == 0.0f);
            sh_irradiance_bounds(order, negative, n, &lo, &hi);
            CHECK(lo == hi && lo == fmaxf(0.0f, sh_irradiance(order, negative, n)));
            sh_irradiance_bounds(order, more, n, &lo, &hi);
            CHECK(lo <= hi && lo >= 0.0f);
        }
        /* <t^2> is negative along x, where n'R2 n is below -1/3 R0. */
        const float impossible[9] = { 1.0f, 0, 0, 0, -0.6f, 0, 0, 0.2f, 0 }, x[3] = { 1, 0, 0 };
        sh_irradiance_bounds(SH_L2, impossible, x, &lo, &hi);
        CHECK(lo == hi);
        float d[3];
        test_direction(d);
        memset(c, 0, sizeof c);
        sh_add_sample(SH_L2, d, 1.0f, c);
        const double cosine = (double)d[0] * (double)n[0] + (double)d[1] * (double)n[1] + (double)d[2] * (double)n[2];
        for (int order = SH_L1; order <= SH_L2; order++) {
            sh_irradiance_bounds(order, c, n, &lo, &hi);
            NEAR(lo, cosine > 0.0 ? 4.0 * cosine : 0.0, 1e-6);
            CHECK((double)(hi - lo) <= 2.5e-6 / (fabs(cosine) + 1e-3));
        }
    }
}

static float as_half(float a) {
    return shi_from_half(shi_to_half(a));
}

/* A sun whose coefficients were stored with six decimals, or as plain halves: no light has them, but for that rounding. */
static void test_rounded_suns(void) {
    for (int i = 0; i < 20000; i++) {
        float d[3], n[3], c[9] = { 0 }, lo, hi;
        const int halves = i % 2;
        test_section("a sun as %s", halves ? "halves" : "decimals");
        test_direction(d);
        sh_add_sample(SH_L2, d, 1.0f, c);
        for (int k = 0; k < 9; k++)
            c[k] = halves ? as_half(c[k]) : roundf(1e6f * c[k]) / 1e6f;
        test_direction(n);
        const double cosine = (double)d[0] * (double)n[0] + (double)d[1] * (double)n[1] + (double)d[2] * (double)n[2];
        const double truth = 4.0 * fmax(0.0, cosine), near = halves ? 0.15 : 5e-3; /* square roots of the rounding */
        for (int order = SH_L1; order <= SH_L2; order++) {
            const float *at[2] = { d, n };
            for (int k = 0; k < 2; k++) {
                const double expected = k ? truth : 4.0, closure = (double)sh_irradiance_closure(order, c, at[k]);
                sh_irradiance_bounds(order, c, at[k], &lo, &hi);
                NEAR(lo, expected, near);
                CHECK((double)hi >= expected - near);
                CHECK(closure >= (double)lo - 2e-6 && closure <= (double)hi + 2e-6);
            }
        }
    }
}

static void run_tests(void) {
    const char *pairs = getenv("SH_TEST_PAIRS");
    test_pairs(pairs ? atol(pairs) : 1000000);
    test_cases();
    test_rounded_suns();
}
