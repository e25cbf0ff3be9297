/* Directionality, average direction and dominant light: exact on what they are made for, finite on everything. */
#include <float.h>

#include "oracle.h"
#include "sh.h"
#include "test.h"

/* From the smallest subnormal's neighbourhood to where one more light overflows. */
static const float magnitudes[] = { 1e-43f, 1e-40f, 1.1754944e-38f, 1e-30f, 1e-12f, 1.0f, 1e12f, 1e18f, 1e30f, 1e38f };
enum { MAGNITUDES = sizeof magnitudes / sizeof magnitudes[0] };

static long double length3(const float *v) {
    long double wide[3];
    oracle_widen(v, 3, wide);
    return sqrtl(oracle_dot(wide, wide));
}

static void check_up(const float dir[3]) {
    CHECK(dir[0] == 0.0f && dir[1] == 0.0f && dir[2] == 1.0f);
}

/* |R1| / R0 and R1 / |R1| of any coefficients, at every magnitude. Subnormal coefficients are what they are: their own rounding does
 * not matter, since they are the input. */
static void any_light(void) {
    for (int m = 0; m < MAGNITUDES; m++)
        for (int i = 0; i < 100; i++) {
            float c[4], dir[3];
            test_section("light of magnitude %g", (double)magnitudes[m]);
            test_fill(c + SH_X, 3, -0.5 * (double)magnitudes[m], 0.5 * (double)magnitudes[m]);
            c[SH_R0] = magnitudes[m];
            const long double length = length3(c + SH_X);
            RELATIVE(sh_directionality(c), length / (long double)c[SH_R0], 1.2e-7); /* an ulp */
            NEAR(sh_average_direction(c, dir), length,
                 6e-8L * length + 0.5L * ldexpl(1.0L, -149)); /* half an ulp, also subnormal */
            if (length == 0.0L)
                check_up(dir);
            else
                for (int k = 0; k < 3; k++)
                    NEAR(dir[k], (long double)c[SH_X + k] / length, 6.1e-8);
        }
}

/* One direction: directionality 1, and the light itself back. */
static void single_light(void) {
    for (int m = 0; m < MAGNITUDES; m++)
        for (int i = 0; i < 100; i++) {
            float c[9] = { 0 }, dir[3], found[3], intensity, ambient;
            const float mean = magnitudes[m];
            const long double grain = 4.0L * ldexpl(1.0L, -149) / (long double)mean; /* of subnormal coefficients, relative */
            test_section("one direction, mean %g", (double)mean);
            test_direction(dir);
            sh_add_sample(SH_L2, dir, mean, c);
            NEAR(sh_directionality(c), 1.0, 2.5e-7L + grain);
            CHECK(sh_directionality(c) <= 1.0f);
            sh_average_direction(c, found);
            NEAR_ALL(found, dir, 3, 2.5e-7L + grain);
            sh_dominant_light(SH_L2, 1, c, found, &intensity, &ambient);
            NEAR_ALL(found, dir, 3, 2.5e-7L + grain);
            if (mean < 0.25f * FLT_MAX)
                RELATIVE(intensity, 4.0L * (long double)mean, 2.5e-7L + grain);
            NEAR(ambient, 0.0, (2.5e-7L + grain) * (long double)mean);
        }
}

/* Ambient and one direction, per channel, at every order: what a dominant light is. */
static void light_and_ambient(void) {
    for (int order = SH_L1; order <= SH_L2; order++)
        for (int i = 0; i < 200; i++) {
            enum { CHANNELS = 5 };
            float c[CHANNELS * 9], dir[3], found[3], intensity[CHANNELS], ambient[CHANNELS], beam[CHANNELS], floor_of[CHANNELS];
            test_section("ambient and one direction, order %d", order);
            memset(c, 0, sizeof c);
            test_direction(dir);
            for (int k = 0; k < CHANNELS; k++) {
                beam[k] = (float)test_uniform(0.1, 2.0);
                floor_of[k] = (float)test_uniform(0.0, 2.0);
                c[k * SH_COUNT(order)] = floor_of[k];
                sh_add_sample(order, dir, beam[k], c + k * SH_COUNT(order));
            }
            sh_dominant_light(order, CHANNELS, c, found, intensity, ambient);
            NEAR_ALL(found, dir, 3, 2.5e-7);
            for (int k = 0; k < CHANNELS; k++) {
                NEAR(intensity[k], 4.0L * (long double)beam[k], 2e-6); /* 4 times an ulp of R0 < 4 */
                NEAR(ambient[k], floor_of[k], 5e-7);
            }
        }
}

/* The moments match: R0 of each channel exactly, R1 of one. */
static void moment_match(void) {
    test_section("dominant light has the moments of the light");
    for (int i = 0; i < 200; i++) {
        float c[3 * 4], dir[3], intensity[3], ambient[3], again[4] = { 0 };
        test_fill(c, 3 * 4, -0.5, 0.5);
        for (int k = 0; k < 3; k++)
            c[k * 4] = 1.0f;
        sh_dominant_light(SH_L1, 1, c, dir, intensity, ambient);
        again[SH_R0] = ambient[0];
        sh_add_sample(SH_L1, dir, intensity[0] / 4.0f, again);
        NEAR_ALL(again, c, 4, 2.5e-7);

        sh_dominant_light(SH_L1, 3, c, dir, intensity, ambient);
        long double sum[3], unit[3];
        oracle_widen(dir, 3, unit);
        for (int axis = 0; axis < 3; axis++)
            sum[axis] = (long double)c[1 + axis] + (long double)c[5 + axis] + (long double)c[9 + axis];
        const long double length = sqrtl(oracle_dot(sum, sum));
        for (int k = 0; k < 3; k++) {
            long double first[3];
            oracle_widen(c + k * 4 + SH_X, 3, first);
            const long double along = oracle_dot(first, sum) / length;
            NEAR(intensity[k], along > 0.0L ? 4.0L * along : 0.0L, 1e-6); /* 4 times an ulp of terms below 2 */
            NEAR((long double)ambient[k] + (long double)intensity[k] / 4.0L, c[k * 4], 1.2e-7);
            NEAR(unit[k] * length, sum[k], 2.5e-7);
        }
    }
}

/* No direction: black, the same from all sides, or from opposite sides; and light that cannot be. */
static void no_direction(void) {
    static const float sets[][9] = {
        { 0.0f },                                                       /* black */
        { 1.0f },                                                       /* isotropic */
        { 1e38f },                                                      /* isotropic, huge */
        { 1e-45f },                                                     /* isotropic, subnormal */
        { -1.0f },                                                      /* negative */
        { 1.0f, 0.0f, 0.0f, 0.0f, -1.0f / 3, 0.0f, 0.0f, 2.0f / 3, 0 }, /* from +y and -y */
        { -0.0f, -0.0f, 0.0f, -0.0f },
    };
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
        float dir[3], intensity = -1.0f, ambient = -1.0f;
        test_section("no direction, set %d", (int)i);
        NEAR(sh_directionality(sets[i]), 0.0, 0);
        NEAR(sh_average_direction(sets[i], dir), 0.0, 0);
        check_up(dir);
        sh_dominant_light(SH_L2, 1, sets[i], dir, &intensity, &ambient);
        check_up(dir);
        NEAR(intensity, 0.0, 0);
        NEAR(ambient, sets[i][SH_R0], 0);
    }
}

static void unphysical(void) {
    static const struct {
        float c[4], directionality;
    } cases[] = {
        { { 0.0f, 1.0f, 0.0f, 0.0f }, 0.0f },    { { -1.0f, 0.0f, 0.5f, 0.0f }, 0.0f },
        { { 1.0f, 0.0f, 0.0f, -1.5f }, 1.0f },   { { 1e-38f, 1e38f, 1e38f, 1e38f }, 1.0f },
        { { 1e-45f, 0.0f, 1.0f, 0.0f }, 1.0f },  { { 1.0f, 0.0f, 1e-45f, 0.0f }, 1e-45f },
        { { 1e38f, 1e-38f, 0.0f, 0.0f }, 0.0f }, { { 3e38f, 3e38f, 3e38f, -3e38f }, 1.0f },
        { { -1e38f, 1e38f, 0.0f, 0.0f }, 0.0f },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float dir[3];
        test_section("unphysical, case %d", (int)i);
        NEAR(sh_directionality(cases[i].c), cases[i].directionality, 0);
        sh_average_direction(cases[i].c, dir);
        NEAR(length3(dir), 1.0, 1.2e-7);
    }
    test_section("channels that cancel, and that oppose");
    const float c[2 * 4] = { 1.0f, 0.0f, 0.0f, 0.5f, 1.0f, 0.0f, 0.0f, -0.5f };
    const float d[2 * 4] = { 1.0f, 0.0f, 0.5f, 0.0f, 1.0f, 0.0f, -0.25f, 0.0f };
    const float expected_c[2][2] = { { 2.0f, 0.0f }, { 0.5f, 1.0f } }, expected_d[2][2] = { { 2.0f, 0.0f }, { 0.5f, 1.0f } };
    float dir[3], intensity[2], ambient[2];
    sh_dominant_light(SH_L1, 2, c, dir, intensity, ambient);
    check_up(dir);
    NEAR_ALL(intensity, expected_c[0], 2, 0);
    NEAR_ALL(ambient, expected_c[1], 2, 0);
    sh_dominant_light(SH_L1, 2, d, dir, intensity, ambient);
    NEAR(dir[1], 1.0, 0);
    NEAR_ALL(intensity, expected_d[0], 2, 0);
    NEAR_ALL(ambient, expected_d[1], 2, 0);
}

static void run_tests(void) {
    any_light();
    single_light();
    light_and_ambient();
    moment_match();
    no_direction();
    unphysical();
}
