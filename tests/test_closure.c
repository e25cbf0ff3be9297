/* Bounded irradiance and closures: exact cases, fallbacks, invariants, and the errors measured on panoramas. */
#include "test.h"

#include <float.h>

#include "envs.h"
#include "lights.h"
#include "oracle.h"
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

/* On a Fibonacci spiral about the y axis. */
static void panorama_normal(uint32_t i, float n[3]) {
    float dir[3];
    sh_direction_fibonacci(i, NORMALS, dir);
    n[0] = dir[0];
    n[1] = dir[2];
    n[2] = -dir[1];
}

static void panorama_errors(const envs_light *light, double mean[MODELS], double *largest) {
    float c[3][9];
    double square[3][MODELS] = { { 0 } };
    for (int k = 0; k < 3; k++)
        envs_moments(light, k, c[k]);
    for (uint32_t i = 0; i < NORMALS; i++) {
        float n[3], model[MODELS];
        double truth[3];
        panorama_normal(i, n);
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
            mean[m] += sqrt(square[k][m] / (int)NORMALS) / 18.0;
}

#ifndef SH_ENVS_DIR
#define SH_ENVS_DIR "envs"
#endif

static void test_panoramas(void) {
    static const char *const name[6] = { "city", "esplanade", "hall", "night", "studio", "sunset" };
    static const double expected[MODELS] = { 0.2063, 0.1452, 0.1479, 0.1431, 0.0370, 0.0344, 0.0226, 0.0230 };
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
        CHECK(worst[m] <= 4e-7);
}

/* Every batch of one set, against its scalar function. */
typedef void (*batch)(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count);
typedef void (*batch_aos)(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride,
                          size_t count);
typedef float (*scalar)(const float *c, const float n[3]);

enum { CHANNELS = 5 };

static void closure_l1(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count) {
    sh_irradiance_closure_batch(SH_L1, channels, c, x, y, z, out, count);
}
static void closure_l2(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count) {
    sh_irradiance_closure_batch(SH_L2, channels, c, x, y, z, out, count);
}
static void closure_floor(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count) {
    sh_closure closure[CHANNELS];
    sh_closure_prepare(SH_L2, channels, c, SH_AMBIENT_FLOOR, closure);
    sh_closure_irradiance_batch(SH_L2, channels, closure, x, y, z, out, count);
}
static void geomerics(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count) {
    sh_irradiance_geomerics_batch(SH_L1, channels, c, x, y, z, out, count);
}
static void zh3(const float *c, int channels, const float *x, const float *y, const float *z, float *out, size_t count) {
    sh_irradiance_zh3_batch(SH_L1, channels, c, x, y, z, out, count);
}
static void closure_l1_aos(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride,
                           size_t count) {
    sh_irradiance_closure_batch_aos(SH_L1, channels, c, n, n_stride, out, out_stride, count);
}
static void closure_l2_aos(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride,
                           size_t count) {
    sh_irradiance_closure_batch_aos(SH_L2, channels, c, n, n_stride, out, out_stride, count);
}
static void closure_floor_aos(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride,
                              size_t count) {
    sh_closure closure[CHANNELS];
    sh_closure_prepare(SH_L2, channels, c, SH_AMBIENT_FLOOR, closure);
    sh_closure_irradiance_batch_aos(SH_L2, channels, closure, n, n_stride, out, out_stride, count);
}
static void geomerics_aos(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride,
                          size_t count) {
    sh_irradiance_geomerics_batch_aos(SH_L1, channels, c, n, n_stride, out, out_stride, count);
}
static void zh3_aos(const float *c, int channels, const float *n, size_t n_stride, float *out, size_t out_stride, size_t count) {
    sh_irradiance_zh3_batch_aos(SH_L1, channels, c, n, n_stride, out, out_stride, count);
}
static float one_l1(const float *c, const float n[3]) {
    return sh_irradiance_closure(SH_L1, c, n);
}
static float one_l2(const float *c, const float n[3]) {
    return sh_irradiance_closure(SH_L2, c, n);
}
static float one_floor(const float *c, const float n[3]) {
    sh_closure closure;
    sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &closure);
    return sh_closure_irradiance(SH_L2, &closure, n);
}
static float one_geomerics(const float *c, const float n[3]) {
    return sh_irradiance_geomerics(c, n);
}
static float one_zh3(const float *c, const float n[3]) {
    return sh_irradiance_zh3(c, n);
}

static const struct {
    const char *name;
    int order;
    batch planar;
    batch_aos interleaved;
    scalar one;
} batches[] = { { "closure L1", SH_L1, closure_l1, closure_l1_aos, one_l1 },
                { "closure L2", SH_L2, closure_l2, closure_l2_aos, one_l2 },
                { "closure L2 over the floor", SH_L2, closure_floor, closure_floor_aos, one_floor },
                { "Geomerics", SH_L1, geomerics, geomerics_aos, one_geomerics },
                { "ZH3", SH_L1, zh3, zh3_aos, one_zh3 } };

/* Sets of all kinds: lights, one direction, black, no light's. */
static void pick_set(int order, int kind, float *c) {
    float full[9] = { 0 }, d[3];
    lights_light light;
    test_direction(d);
    switch (kind % 6) {
    case 0:
        sh_add_sample(SH_L2, d, 1.0f, full);
        break;
    case 1:
        test_fill(full, 9, -1.0, 1.0);
        break;
    case 2:
        break;
    default:
        lights_random(kind % LIGHTS_KINDS, &light);
        lights_moments(&light, exp(test_uniform(-3.0, 3.0)), full);
        break;
    }
    sh_truncate(SH_L2, 1, full, order, c);
}

static void test_batch(int which, size_t count, int channels) {
    enum { MOST = 1300 };
    static float n[3][MOST], out[(int)CHANNELS * MOST], shifted[(int)CHANNELS * MOST], aos_in[5 * MOST], aos_out[((int)CHANNELS + 2) * MOST];
    static float aliased[(int)CHANNELS * MOST + 3 * MOST];
    float c[CHANNELS * 9];
    const int order = batches[which].order;
    test_section("%s, %d normals, %d channels", batches[which].name, (int)count, channels);
    for (int k = 0; k < channels; k++)
        pick_set(order, test_below(24), c + k * SH_COUNT(order));
    for (size_t i = 0; i < count; i++) {
        float d[3];
        test_direction(d);
        for (int j = 0; j < 3; j++)
            n[j][i] = aos_in[5 * i + (size_t)j] = aliased[(size_t)j * count + i] = d[j];
    }
    batches[which].planar(c, channels, n[0], n[1], n[2], out, count);
    for (int k = 0; k < channels; k++)
        for (size_t i = 0; i < count; i++) {
            const float d[3] = { n[0][i], n[1][i], n[2][i] }, *ck = c + k * SH_COUNT(order);
            const double scale = fabs((double)ck[0]) + 3.0 * sqrt((double)(ck[1] * ck[1] + ck[2] * ck[2] + ck[3] * ck[3]));
            /* Where the upper bound is close to 0, its square root enlarges the rounding of what is under it. */
            const double value = (double)batches[which].one(ck, d), root = 8e-7 * scale * scale / (value + 1e-3 * scale + 1e-30);
            NEAR(out[(size_t)k * count + i], value, 1.5e-6 * scale + root);
            CHECK(out[(size_t)k * count + i] >= 0.0f);
        }
    if (count > 1) { /* not where in the batch, nor how long it is */
        batches[which].planar(c, channels, n[0] + 1, n[1] + 1, n[2] + 1, shifted, count - 1);
        for (int k = 0; k < channels; k++)
            SAME_BITS(shifted + (size_t)k * (count - 1), out + (size_t)k * count + 1, (count - 1) * sizeof *out);
    }
    batches[which].planar(c, channels, aliased, aliased + count, aliased + 2 * count, aliased, count);
    SAME_BITS(aliased, out, (size_t)channels * count * sizeof *out);
    for (size_t i = 0; i < (size_t)(channels + 2) * count; i++)
        aos_out[i] = -7.0f;
    batches[which].interleaved(c, channels, aos_in, 5 * sizeof(float), aos_out, (size_t)(channels + 2) * sizeof(float), count);
    for (size_t i = 0; i < count; i++) {
        const float *item = aos_out + (size_t)(channels + 2) * i;
        for (int k = 0; k < channels; k++)
            CHECK(item[k] == out[(size_t)k * count + i]);
        CHECK(item[channels] == -7.0f && item[channels + 1] == -7.0f);
    }
}

/* Two channels, whose results begin where x, y or z were; and tight items, which strides of 0 mean. */
static void test_places(int which) {
    enum { COUNT = 301 };
    static float n[3][2 * COUNT], place[3][2 * COUNT], out[2 * COUNT], tight[3 * COUNT], interleaved[2 * COUNT];
    float c[2 * 9];
    const int order = batches[which].order;
    test_section("%s, in place and tight", batches[which].name);
    pick_set(order, test_below(24), c);
    pick_set(order, test_below(24), c + SH_COUNT(order));
    for (size_t i = 0; i < COUNT; i++) {
        float d[3];
        test_direction(d);
        for (size_t j = 0; j < 3; j++)
            n[j][i] = tight[3 * i + j] = d[j];
    }
    batches[which].planar(c, 2, n[0], n[1], n[2], out, COUNT);
    for (int j = 0; j < 3; j++) {
        memcpy(place, n, sizeof n);
        batches[which].planar(c, 2, place[0], place[1], place[2], place[j], COUNT);
        SAME_BITS(place[j], out, sizeof out);
    }
    batches[which].interleaved(c, 2, tight, 0, interleaved, 0, COUNT);
    for (int i = 0; i < 2 * COUNT; i++)
        CHECK(interleaved[i] == out[i % 2 * COUNT + i / 2]);
}

static void test_batches(void) {
    for (int which = 0; which < (int)(sizeof batches / sizeof *batches); which++) {
        for (size_t count = 0; count <= 70; count++)
            for (int channels = 0; channels <= 4; channels++)
                test_batch(which, count, channels);
        test_batch(which, 511, 3);
        test_batch(which, 1300, CHANNELS);
        for (int i = 0; i < 24; i++)
            test_places(which);
    }
}

/* More channels than are prepared in advance. */
static void test_many_channels(void) {
    enum { MANY = SH_MAX_CHANNELS + 4, COUNT = 37 };
    static float c[MANY * 9], n[MANY * COUNT], out[MANY * COUNT];
    test_section("many channels");
    for (int k = 0; k < MANY; k++)
        pick_set(SH_L2, k, c + 9 * k);
    for (int i = 0; i < COUNT; i++) {
        float d[3];
        test_direction(d);
        for (int j = 0; j < 3; j++)
            n[j * COUNT + i] = d[j];
    }
    for (int k = 0; k < MANY; k++)
        sh_irradiance_closure_batch(SH_L2, 1, c + 9 * k, n, n + COUNT, n + 2 * COUNT, out + k * COUNT, COUNT);
    sh_irradiance_closure_batch(SH_L2, MANY, c, n, n + COUNT, n + 2 * COUNT, n, COUNT);
    SAME_BITS(n, out, sizeof out);
}

/* Of L0 alone: what is there, from every side; black where it is negative. */
static void test_order_zero(void) {
    const float c[3] = { 2.5f, -1.0f, 0.0f }, n[3][3] = { { 0.6f, 0, -1 }, { 0, 0.8f, 0 }, { 0.8f, 0.6f, 0 } };
    float out[9];
    test_section("closures of order 0");
    sh_irradiance_closure_batch(SH_L0, 3, c, n[0], n[1], n[2], out, 3);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            NEAR(out[3 * k + i], fmaxf(0.0f, c[k]), 0);
            NEAR(sh_irradiance_closure(SH_L0, c + k, n[i]), fmaxf(0.0f, c[k]), 0);
        }
}

static int is_fallback(const float *c, const float n[3], int order, float value) {
    const float linear = sh_irradiance(order, c, n), expected = linear < 0.0f ? 0.0f : linear;
    float most = 0.0f;
    for (int i = 0; i < SH_COUNT(order); i++)
        most = fabsf(c[i]) > most ? fabsf(c[i]) : most;
    return fabsf(value - expected) <= 2e-6f * most + 1e-43f;
}

/* Coefficients of no light: the linear reconstruction, not below 0; and any magnitude, without NaN. */
static void test_fallbacks(void) {
    static const float scale[] = { 1.0f, 1e18f, 1e-18f, 1e-30f, 1e-38f, 1e-44f };
    float n[3], c[9];
    sh_closure floor;
    for (int i = 0; i < 20000; i++) {
        const float unit = scale[test_below(6)];
        const int kind = test_below(7);
        test_section("fallback %d, scale %g", kind, (double)unit);
        test_direction(n);
        memset(c, 0, sizeof c);
        switch (kind) {
        case 0:
            test_fill(c, 9, -1.0, 1.0);
            c[0] = -fabsf(c[0]);
            break; /* R0 < 0 */
        case 1:
            test_fill(c, 9, -1.0, 1.0);
            c[0] = 0.0f;
            break;
        case 2:
            c[0] = 1.0f;
            c[1 + test_below(3)] = 1.01f;
            break; /* |R1| > R0 */
        case 3:
            c[0] = 1.0f;
            c[4] = -0.34f;
            break; /* <x^2> < 0; at L1 ambient */
        case 4:    /* a ringing window: the moments of a direction, R2 short */
            sh_add_sample(SH_L2, n, 1.0f, c);
            for (int k = 4; k < 9; k++)
                c[k] *= 0.9f;
            test_direction(n);
            break;
        case 5: /* R2 of any magnitude, whose minors cancel: the more so where the compiler fuses */
            test_fill(c, 9, -1.0, 1.0);
            c[0] = 1.0f;
            for (int k = 4; k < 9; k++)
                if (k == 4 || test_below(3))
                    c[k] = powf(10.0f, (float)(2 + i % 17)) * (k == 4 || test_below(2) ? 1.0f : -1.0f);
            break;
        default:
            break; /* black */
        }
        for (int k = 0; k < 9; k++)
            c[k] *= unit;
        sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &floor);
        CHECK(is_fallback(c, n, SH_L2, sh_irradiance_closure(SH_L2, c, n)));
        CHECK(is_fallback(c, n, SH_L2, sh_closure_irradiance(SH_L2, &floor, n)));
        CHECK(is_fallback(c, n, SH_L0, sh_irradiance_closure(SH_L0, c, n)));
        if (kind < 3 || kind == 6) {
            CHECK(is_fallback(c, n, SH_L1, sh_irradiance_closure(SH_L1, c, n)));
            CHECK(is_fallback(c, n, SH_L1, sh_irradiance_geomerics(c, n)));
            CHECK(is_fallback(c, n, SH_L1, sh_irradiance_zh3(c, n)));
        }
    }
    test_section("magnitudes");
    for (int i = 0; i < 20000; i++) {
        lights_light light;
        float model[MODELS];
        lights_random(i % LIGHTS_KINDS, &light);
        lights_moments(&light, (double)scale[i % 6] / 100.0, c);
        test_direction(n);
        evaluate(c, n, model);
        for (int m = 0; m < MODELS; m++)
            CHECK(model[m] >= 0.0f && model[m] <= 5.0f * c[0] + 1e-43f);
    }
    test_section("not a number");
    const float nan[9] = { 1.0f, NAN, 0.0f, 0.0f, 0.1f };
    const float up[3] = { 0.6f, 0.0f, 0.8f };
    CHECK(isnan(sh_irradiance_closure(SH_L1, nan, up)));
    CHECK(isnan(sh_irradiance_closure(SH_L2, nan, up)));
}

/* Ambient light is exact; with it, sun plus ambient is exact up to L6 over the floor. */
static void test_ambient(void) {
    double worst = 0.0;
    test_section("ambient");
    for (int i = 0; i < 5000; i++) {
        const float ambient = (float)test_uniform(0.1, 2.0);
        float c[9] = { 0 }, n[3], d[3];
        sh_closure floor;
        c[0] = ambient;
        test_direction(n);
        test_direction(d);
        NEAR(sh_irradiance_closure(SH_L1, c, n), ambient, 1e-6);
        NEAR(sh_irradiance_closure(SH_L2, c, n), ambient, 1e-6);
        NEAR(sh_irradiance_geomerics(c, n), ambient, 1e-6);
        NEAR(sh_irradiance_zh3(c, n), ambient, 1e-6);
        sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &floor);
        NEAR(sh_closure_irradiance(SH_L2, &floor, n), ambient, 1e-6);
        sh_add_sample(SH_L2, d, 1.0f, c);
        sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &floor);
        /* Legendre series of 4 max(0, t) up to L6; the bounds only bring it nearer to the truth. */
        const double t = (double)d[0] * (double)n[0] + (double)d[1] * (double)n[1] + (double)d[2] * (double)n[2], t2 = t * t;
        const double p2 = (3 * t2 - 1) / 2, p4 = (35 * t2 * t2 - 30 * t2 + 3) / 8,
                     p6 = (231 * t2 * t2 * t2 - 315 * t2 * t2 + 105 * t2 - 5) / 16;
        const double series = (double)ambient + 1 + 2 * t + 5 * p2 / 4 - 9 * p4 / 24 + 13 * p6 / 64;
        const double truth = (double)ambient + (t > 0 ? 4 * t : 0), value = (double)sh_closure_irradiance(SH_L2, &floor, n);
        const double beyond = fabs(value - truth) - fabs(series - truth);
        worst = beyond > worst ? beyond : worst;
    }
    CHECK(worst <= 4e-6);
}

/* Irradiance from a panorama averaged to ENVS_HEIGHT rows and, with exact areas, to fewer, as the sizes for a tolerance promise. */
static void test_sizes(void) {
    static const char *const name[3] = { "city", "night", "sunset" };
    static envs_light light;
    static float level[3 * ENVS_TEXELS];
    const char *dir = getenv("SH_ENVS") ? getenv("SH_ENVS") : SH_ENVS_DIR;
    test_section("sizes for a tolerance");
    EQUAL(sh_equirect_size_for(SH_L0, 0.0f), 1);
    EQUAL(sh_cubemap_size_for(SH_L0, 0.0f), 1);
    for (int order = SH_L1; order <= SH_L2; order++)
        for (float tolerance = 1.0f; tolerance > 1e-4f; tolerance *= 0.5f) {
            CHECK(sh_equirect_size_for(order, tolerance) >= sh_cubemap_size_for(order, tolerance));
            CHECK(sh_equirect_size_for(order, 0.5f * tolerance) == 2 * sh_equirect_size_for(order, tolerance));
        }
    for (int i = 0; i < 3; i++) {
        char path[1024];
        float fine[27];
        snprintf(path, sizeof path, "%s/%s.pfm", dir, name[i]);
        if (!envs_load(path, &light)) {
            printf("skipped: no panorama %s\n", path);
            return;
        }
        for (int height = ENVS_HEIGHT; height >= 4; height /= 2) {
            const int step = ENVS_HEIGHT / height, width = 2 * height;
            sh_image image = { level, 0, 0, 0, 3, SH_F32 };
            float c[27], n[3];
            image.width = width;
            image.height = height;
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++)
                    for (int k = 0; k < 3; k++) {
                        double sum = 0.0, area = 0.0;
                        for (int j = 0; j < step * step; j++) {
                            const int texel = (y * step + j / step) * ENVS_WIDTH + x * step + j % step;
                            sum += light.weight[texel] * light.value[k][texel];
                            area += light.weight[texel];
                        }
                        level[3 * (y * width + x) + k] = (float)(sum / area);
                    }
            EQUAL(sh_project_equirect(SH_L2, &image, 0, c, NULL), SH_OK);
            if (height == ENVS_HEIGHT)
                memcpy(fine, c, sizeof fine);
            for (int order = SH_L1; order <= SH_L2; order++) {
                double worst = 0.0;
                for (uint32_t j = 0; j < NORMALS; j++)
                    for (int k = 0; k < 27; k += 9) {
                        sh_direction_fibonacci(j, NORMALS, n);
                        const double error = fabs((double)(sh_irradiance(order, c + k, n) - sh_irradiance(order, fine + k, n)));
                        worst = error / (double)fine[k] > worst ? error / (double)fine[k] : worst;
                    }
                for (float tolerance = 2.0f; sh_equirect_size_for(order, tolerance) <= height; tolerance *= 0.9f)
                    CHECK(worst <= (double)tolerance);
            }
        }
    }
}

/* ---- The models by their definitions, in long double, of light that is not negative ---- */

static long double geomerics_of(const long double c[9], const long double n[3]) {
    const long double length = sqrtl(oracle_dot(c + SH_X, c + SH_X)), r = length / c[0], a = (1 - r) / (1 + r), p = 1 + 2 * r;
    return c[0] * (a + (1 - a) * (p + 1) * powl((1 + oracle_dot(c + SH_X, n) / length) / 2, p));
}

static long double zh3_of(const long double c[9], const long double n[3]) {
    const long double length = sqrtl(oracle_dot(c + SH_X, c + SH_X)), r = length / c[0], t = oracle_dot(c + SH_X, n) / length;
    return fmaxl(0, c[0] * (1 + 2 * r * t + 15 / 8.0L * (0.0619677L * r + 0.804984L * r * r) * (t * t - 1 / 3.0L)));
}

/* Bands 0, 2, 4 and 6 of the cosine kernel, as factors under convolution. */
static const long double even_factor[4] = { 1.0L, 1 / 4.0L, -1 / 24.0L, 1 / 64.0L };

/* The even part within the bounds, in units of the light without its constant part. */
typedef struct even_part {
    long double lower, upper, free;
} even_part;

static void near_closure(float actual, long double r0, long double unit, const even_part *even, long double v) {
    const int above = even->free > even->upper;
    const long double within = fmaxl(above ? even->upper : even->free, even->lower);
    NEAR(actual, unit * (within + 2 * v), above ? fmaxl(2e-6L, 1.2e-6L * r0 / (unit * even->upper)) * r0 : 2e-6L * r0);
}

/* Band l of a Henyey-Greenstein lobe of mean cosine r is r^l. */
static void near_closure_l1(float actual, const long double c[9], const long double n[3]) {
    const long double length = sqrtl(oracle_dot(c + SH_X, c + SH_X)), r = length / c[0], v = oracle_dot(c + SH_X, n) / c[0], t = v / r;
    even_part even = { 2 * fabsl(v), 2 * sqrtl(fmaxl(0, 1 - r * r + v * v)), 0 };
    for (int i = 0; i < 4; i++)
        even.free += even_factor[i] * (4 * i + 1) * powl(r, 2 * i) * oracle_legendre(2 * i, t);
    near_closure(actual, c[0], c[0], &even, v);
}

/* Bands 4 and 6 of the light but for its constant part are those of q^2 and q^3, q the form of R2, as the moments of one direction
 * would have it: (2l + 1)!! / l! times band l of the function of w is the light's. */
static void near_closure_l2(float actual, const oracle_rule *rule, const long double c[9], long double ambient, const long double n[3]) {
    const long double w = c[0] - ambient, q = oracle_quadratic(c, n) / w, v = oracle_dot(c + SH_X, n) / w;
    long double t4 = 0, t6 = 0;
    for (size_t i = 0; i < rule->count; i++) {
        const long double *to = rule->node[i].dir, form = oracle_quadratic(c, to) / w;
        const long double t = oracle_dot(n, to);
        t4 += rule->node[i].weight * 9 * form * form * oracle_legendre(4, t);
        t6 += rule->node[i].weight * 13 * form * form * form * oracle_legendre(6, t);
    }
    const long double g = c[0] / w, square = q + g / 3;
    const even_part even = { 2 * fmaxl(fabsl(v), square), 2 * sqrtl(g * fmaxl(0, square)),
                             g + 15 / 8.0L * q + even_factor[2] * 945 / 24 * t4 + even_factor[3] * 135135 / 720 * t6 };
    near_closure(actual, c[0], w, &even, v);
}

static void test_definitions(void) {
    oracle_rule rule = oracle_rule_sphere(14);
    for (int i = 0; i < 4000; i++) {
        float c[9] = { 0 }, d[3], n[3];
        long double wide[9], normal[3];
        sh_closure floor;
        /* From nearly ambient to one direction and nearly that; and scattered lights. */
        const double part = i % 3 ? test_uniform(0.0, 1.0) : exp(test_uniform(-8.0, 0.0));
        for (int k = i % 4 ? 1 : 4; k > 0; k--) {
            test_direction(d);
            sh_add_sample(SH_L2, d, (float)(1.0 - part), c);
        }
        c[0] += (float)part;
        test_direction(n);
        sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &floor);
        for (int k = 0; k < 9; k++)
            wide[k] = (long double)c[k];
        for (int k = 0; k < 3; k++)
            normal[k] = (long double)n[k];
        const long double ambient = fmaxl(0, (long double)sh_ambient_floor(c)), scale = wide[0];
        test_section("models by their definitions, %d", i);
        NEAR(sh_irradiance_geomerics(c, n), geomerics_of(wide, normal), 2e-6L * scale);
        NEAR(sh_irradiance_zh3(c, n), zh3_of(wide, normal), 2e-6L * scale);
        near_closure_l1(sh_irradiance_closure(SH_L1, c, n), wide, normal);
        near_closure_l2(sh_irradiance_closure(SH_L2, c, n), &rule, wide, 0, normal);
        if (scale - ambient > 0.01L * scale)
            near_closure_l2(sh_closure_irradiance(SH_L2, &floor, n), &rule, wide, ambient, normal);
    }
    oracle_rule_free(&rule);
}

static void run_tests(void) {
    test_definitions();
    test_directional();
    test_ambient();
    test_fallbacks();
    test_batches();
    test_many_channels();
    test_order_zero();
    test_panoramas();
    test_sizes();
}
