/* Bounded irradiance and closures: exact cases, fallbacks, invariants, and the errors measured on panoramas. */
#include "test.h"

#include <float.h>

#include "envs.h"
#include "sh.h"

enum { MODELS = 8, NORMALS = 1000 };

/* Every model of irradiance at one normal. */
static void evaluate(const float c[9], const float n[3], float out[MODELS]) {
    float lo, hi;
    sh_closure closure;
    const float l1 = sh_irradiance(SH_L1, c, n), l2 = sh_irradiance(SH_L2, c, n);
    sh_irradiance_bounds(SH_L2, c, n, &lo, &hi);
    sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &closure);
    out[0] = l1 > 0.0f ? l1 : 0.0f;
    out[1] = sh_irradiance_zh3(c, n);
    out[2] = sh_irradiance_geomerics(c, n);
    out[3] = sh_irradiance_closure(SH_L1, c, n);
    out[4] = l2 > 0.0f ? l2 : 0.0f;
    out[5] = l2 < lo ? lo : l2 > hi ? hi : l2;
    out[6] = sh_irradiance_closure(SH_L2, c, n);
    out[7] = sh_closure_irradiance(SH_L2, &closure, n);
}

static void panorama_errors(const envs_light *light, double mean[MODELS], double *largest) {
    float c[3][9];
    double square[3][MODELS] = { { 0 } };
    for (int k = 0; k < 3; k++)
        envs_moments(light, k, c[k]);
    for (uint32_t i = 0; i < NORMALS; i++) {
        float n[3], model[MODELS];
        double truth[3];
        sh_direction_fibonacci(i, NORMALS, n);
        envs_irradiance(light, n, truth);
        for (int k = 0; k < 3; k++) {
            evaluate(c[k], n, model);
            for (int m = 0; m < MODELS; m++) {
                const double error = fabs((double)model[m] - truth[k]) / (double)c[k][0];
                square[k][m] += error * error;
                largest[m] = error > largest[m] ? error : largest[m];
            }
        }
    }
    for (int k = 0; k < 3; k++)
        for (int m = 0; m < MODELS; m++)
            mean[m] += sqrt(square[k][m] / NORMALS) / 18.0;
}

#ifndef SH_ENVS_DIR
#define SH_ENVS_DIR "envs"
#endif

static void test_panoramas(void) {
    static const char *const name[6] = { "city", "esplanade", "hall", "night", "studio", "sunset" };
    static const double expected[MODELS] = { 0.2063, 0.1452, 0.1479, 0.1431, 0.0370, 0.0344, 0.0226, 0.02305 };
    static envs_light light;
    const char *dir = getenv("SH_ENVS") ? getenv("SH_ENVS") : SH_ENVS_DIR;
    double mean[MODELS] = { 0 }, largest[MODELS] = { 0 };
    test_section("six panoramas");
    for (int i = 0; i < 6; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s.pfm", dir, name[i]);
        if (!envs_load(path, &light)) {
            printf("skipped: no panorama %s\n", path);
            return;
        }
        panorama_errors(&light, mean, largest);
    }
    printf("RMS error by model:");
    for (int m = 0; m < MODELS; m++)
        printf(" %.5f", mean[m]);
    printf("\nlargest error:");
    for (int m = 0; m < MODELS; m++)
        printf(" %.4f", largest[m]);
    printf("\n");
    NEAR_ALL(mean, expected, MODELS, 5e-5);
    CHECK(largest[7] < largest[6]);
}

/* A single direction is exact: the bounds close on it. */
static void test_directional(void) {
    double worst[3] = { 0 };
    sh_closure floor;
    test_section("one direction");
    for (int i = 0; i < 200000; i++) {
        float d[3], n[3], c[9] = { 0 };
        test_direction(d);
        test_direction(n);
        if (i % 4 == 0)
            for (int k = 0; k < 3; k++)
                n[k] = i % 8 ? d[k] : -d[k];
        sh_add_sample(SH_L2, d, 1.0f, c);
        sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &floor);
        const double cosine = (double)d[0] * (double)n[0] + (double)d[1] * (double)n[1] + (double)d[2] * (double)n[2];
        const double truth = cosine > 0.0 ? 4.0 * cosine : 0.0;
        const float value[3] = { sh_irradiance_closure(SH_L1, c, n), sh_irradiance_closure(SH_L2, c, n),
                                 sh_closure_irradiance(SH_L2, &floor, n) };
        for (int m = 0; m < 3; m++) {
            const double error = fabs((double)value[m] - truth);
            worst[m] = error > worst[m] ? error : worst[m];
        }
    }
    printf("one direction: error of the closures %.3g %.3g %.3g\n", worst[0], worst[1], worst[2]);
    for (int m = 0; m < 3; m++)
        CHECK(worst[m] <= 1e-6);
}

static void run_tests(void) {
    test_directional();
    test_panoramas();
}
