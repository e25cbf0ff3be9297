/* Lights against quadrature over what they cover, and their units. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static long double unit_light(const long double dir[3], const void *user) {
    (void)dir;
    (void)user;
    return 1.0L;
}

static long double vmf_light(const long double dir[3], const void *user) {
    const long double *lobe = (const long double *)user; /* axis, sharpness */
    return expl(lobe[3] * (oracle_dot(lobe, dir) - 1.0L));
}

static void wide_unit(const float dir[3], long double wide[3]) {
    oracle_widen(dir, 3, wide);
    const long double length = sqrtl(oracle_dot(wide, wide));
    for (int i = 0; i < 3; i++)
        wide[i] /= length;
}

/* Each order and 1 to 4 channels must hold the first coefficients of `expected`, times the channel's value, on top of what was there. */
typedef void (*add_light)(int order, int channels, const float *value, float *c, const void *light);

static void check_light(add_light add, const void *light, const long double expected[9], long double tolerance) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int channels = 1; channels <= 4; channels++) {
            const int n = SH_COUNT(order);
            float c[4 * 9 + 1], before[4 * 9 + 1], value[4];
            test_fill(c, 37, -0.5, 0.5);
            memcpy(before, c, sizeof c);
            test_fill(value, 4, 0.0, 2.0);
            add(order, channels, value, c, light);
            for (int k = 0; k < channels; k++)
                for (int i = 0; i < n; i++) {
                    const long double mean = (long double)value[k] * expected[i];
                    NEAR(c[k * n + i], (long double)before[k * n + i] + mean,
                         tolerance * (long double)value[k] * expected[0] + 6e-8L * (1.0L + fabsl(mean)));
                }
            CHECK(c[channels * n] == before[channels * n]);
            /* Alone, the light keeps its relative accuracy. */
            memset(c, 0, sizeof c);
            add(order, channels, value, c, light);
            for (int k = 0; k < channels; k++)
                for (int i = 0; i < n; i++)
                    NEAR(c[k * n + i], (long double)value[k] * expected[i], tolerance * (long double)value[k] * expected[0]);
        }
}

typedef struct zonal_light {
    float dir[3], size;
    sh_unit unit;
} zonal_light;

static void add_cap(int order, int channels, const float *value, float *c, const void *user) {
    const zonal_light *light = (const zonal_light *)user;
    sh_add_cap(order, channels, light->dir, light->size, light->unit, value, c);
}

static void add_vmf(int order, int channels, const float *value, float *c, const void *user) {
    const zonal_light *light = (const zonal_light *)user;
    sh_add_vmf(order, channels, light->dir, light->size, light->unit, value, c);
}

static void add_sphere(int order, int channels, const float *value, float *c, const void *user) {
    const zonal_light *light = (const zonal_light *)user;
    sh_add_sphere(order, channels, light->dir, light->size, light->unit, value, c);
}

static void add_directional(int order, int channels, const float *value, float *c, const void *user) {
    sh_add_directional(order, channels, (const float *)user, value, c);
}

/* Moments of radiance 1 in w.axis > cosine, and 1 - cosine given without cancellation. */
static void cap_moments(const long double axis[3], long double h, long double c[9]) {
    oracle_rule rule = oracle_rule_zone(axis, 1.0L - h, 1.0L, 4);
    oracle_moments(&rule, unit_light, NULL, c);
    oracle_rule_free(&rule);
}

static void scale_all(long double c[9], long double factor) {
    for (int i = 0; i < 9; i++)
        c[i] *= factor;
}

static void directional(void) {
    for (int i = 0; i < 50; i++) {
        float dir[3], c[9] = { 0 };
        const float one = 1.0f;
        oracle_source source;
        long double expected[9];
        test_section("directional");
        test_direction(dir);
        oracle_widen(dir, 3, source.dir);
        source.mean = 0.25L;
        oracle_moments_sources(&source, 1, expected);
        check_light(add_directional, dir, expected, 1e-6L);
        sh_add_directional(SH_L2, 1, dir, &one, c);
        NEAR(oracle_irradiance_sources(&source, 1, source.dir), 1, 1e-6);
        float found[3], intensity, ambient;
        sh_dominant_light(SH_L2, 1, c, found, &intensity, &ambient);
        NEAR(intensity, 1, 1e-6);
    }
}

static void ambient_and_hemisphere(void) {
    const float up[3] = { 0.6f, 0.0f, 0.8f }, sky[2] = { 3, 0.5f }, ground[2] = { 1, 0.25f };
    long double axis[3], expected[9], other[9];
    float c[18] = { 0 }, even[2] = { 0, 0 };
    test_section("hemisphere");
    oracle_widen(up, 3, axis);
    cap_moments(axis, 1.0L, expected);
    cap_moments(axis, 2.0L, other);
    sh_add_hemisphere(SH_L2, 2, up, sky, ground, c);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 9; i++)
            NEAR(c[9 * k + i],
                 (long double)sky[k] * expected[i] + (long double)ground[k] * (other[i] - expected[i]), 1e-6);
    NEAR(sh_irradiance(SH_L2, c, up), 3, 1e-6); /* 1 reads 1, not 1.25 */
    sh_add_ambient(SH_L0, 2, sky, even);
    sh_add_ambient(SH_L0, 2, ground, even);
    NEAR(even[0], 4, 0);
    NEAR(even[1], 0.75, 0);
}

static void caps(void) {
    static const double angles[] = { 1e-6, 0.00465, 0.1, 0.5, 1.0, 1.5, 1.5707964, 1.6, 2.5, 3.1415927 };
    for (int i = 0; i < 10; i++)
        for (int unit = 0; unit <= 1; unit++) {
            zonal_light light;
            long double axis[3], expected[9];
            light.size = (float)angles[i];
            light.unit = unit ? SH_IRRADIANCE : SH_RADIANCE;
            test_section("cap of half-angle %g, unit %d", angles[i], unit);
            test_direction(light.dir);
            wide_unit(light.dir, axis);
            const long double half = sinl((long double)light.size / 2.0L), h = 2.0L * half * half;
            cap_moments(axis, h < 2.0L ? h : 2.0L, expected);
            if (unit)
                scale_all(expected, 1.0L / (h < 1.0L ? h * (2.0L - h) : 1.0L));
            check_light(add_cap, &light, expected, 1e-6L);
        }
    zonal_light beam = { { 0, 0, 1 }, 0.0f, SH_IRRADIANCE };
    float c[9] = { 0 }, same[9] = { 0 };
    const float one = 1.0f;
    test_section("cap without size");
    sh_add_cap(SH_L2, 1, beam.dir, 0.0f, SH_IRRADIANCE, &one, c);
    sh_add_directional(SH_L2, 1, beam.dir, &one, same);
    NEAR_ALL(c, same, 9, 1e-7);
    sh_add_cap(SH_L2, 1, beam.dir, 0.0f, SH_RADIANCE, &one, c);
    NEAR_ALL(c, same, 9, 1e-7);
}

/* sin of the half-angle is radius / distance; inside it is ambient. */
static void spheres(void) {
    static const double scales[] = { 1e-18, 1.0, 1e18 }, radii[] = { 1e-5, 0.01, 0.5, 0.99, 0.99999994, 1.0, 3.0 };
    for (int i = 0; i < 21; i++)
        for (int unit = 0; unit <= 1; unit++) {
            const double scale = scales[i / 7];
            zonal_light light;
            long double axis[3], expected[9] = { 1.0L }, wide[3];
            test_section("sphere of radius %g at distance 1, times %g, unit %d", radii[i % 7], scale, unit);
            test_direction(light.dir);
            for (int k = 0; k < 3; k++)
                light.dir[k] *= (float)(0.7 * scale);
            light.size = (float)(0.7 * scale * radii[i % 7]);
            light.unit = unit ? SH_IRRADIANCE : SH_RADIANCE;
            oracle_widen(light.dir, 3, wide);
            wide_unit(light.dir, axis);
            const long double ss = (long double)light.size * (long double)light.size / oracle_dot(wide, wide);
            if (ss < 1.0L) {
                cap_moments(axis, ss / (1.0L + sqrtl(1.0L - ss)), expected);
                if (unit)
                    scale_all(expected, 1.0L / ss);
            }
            check_light(add_sphere, &light, expected, ss < 1.0L && ss > 0.99L ? 3e-6L : 1e-6L);
        }
    const float nowhere[3] = { 0, 0, 0 }, one = 1.0f;
    float c[9] = { 0 };
    test_section("sphere at the receiver");
    sh_add_sphere(SH_L2, 1, nowhere, 0.0f, SH_RADIANCE, &one, c);
    NEAR(c[0], 0, 0);
    sh_add_sphere(SH_L2, 1, nowhere, 0.0f, SH_IRRADIANCE, &one, c);
    NEAR(c[0], 1, 0);
    CHECK(c[1] == 0 && c[4] == 0);
}

static void lobes(void) {
    static const double sharpness[] = { 0.0, 1e-6, 9.9e-4, 1.01e-3, 0.1, 1.0, 5.0, 30.0 };
    for (int i = 0; i < 8; i++)
        for (int unit = 0; unit <= 1; unit++) {
            zonal_light light;
            long double lobe[4], expected[9], facing;
            light.size = (float)sharpness[i];
            light.unit = unit ? SH_IRRADIANCE : SH_RADIANCE;
            test_section("vMF of sharpness %g, unit %d", sharpness[i], unit);
            test_direction(light.dir);
            wide_unit(light.dir, lobe);
            lobe[3] = (long double)light.size;
            oracle_rule rule = oracle_rule_zone(lobe, -1.0L, 1.0L, 120);
            oracle_moments(&rule, vmf_light, lobe, expected);
            oracle_rule_free(&rule);
            facing = oracle_irradiance(vmf_light, lobe, lobe, 0.0L, 120);
            if (unit)
                scale_all(expected, 1.0L / facing);
            check_light(add_vmf, &light, expected, 1e-6L);
        }
    const float z[3] = { 0, 0, 1 }, one = 1.0f;
    float c[9] = { 0 };
    test_section("vMF, endlessly sharp");
    sh_add_vmf(SH_L2, 1, z, 1e18f, SH_IRRADIANCE, &one, c);
    NEAR(c[SH_Z], 0.25, 1e-6);
    sh_add_vmf(SH_L2, 1, z, 1e18f, SH_RADIANCE, &one, c);
    NEAR(c[SH_Z], 0.25, 1e-6);
}

/* The lights left out change no irradiance by more than the tolerance, and some are left out. */
static void skipping(void) {
    enum { COUNT = 200 };
    float light[4 * COUNT], radiance[3 * COUNT];
    for (int i = 0; i < 20; i++) {
        float all[27] = { 0 }, each[27] = { 0 }, some[27] = { 0 };
        const float tolerance = (float)(1e-4 * (1 << i % 8));
        test_section("skipped spheres, tolerance %g", (double)tolerance);
        test_fill(light, 4 * COUNT, -30.0, 30.0);
        test_fill(radiance, 3 * COUNT, 0.0, 5.0);
        for (int k = 0; k < COUNT; k++)
            light[4 * k + 3] = (float)test_uniform(0.0, 0.2);
        EQUAL(sh_add_spheres(SH_L2, 3, light, radiance, COUNT, -1.0f, all), COUNT);
        for (int k = 0; k < COUNT; k++)
            sh_add_sphere(SH_L2, 3, light + 4 * k, light[4 * k + 3], SH_RADIANCE, radiance + 3 * k, each);
        for (int channel = 0; channel < 3; channel++)
            NEAR_ALL(all + 9 * channel, each + 9 * channel, 9, 1e-6 * (double)all[9 * channel]);
        const size_t added = sh_add_spheres(SH_L2, 3, light, radiance, COUNT, tolerance, some);
        CHECK(added < COUNT);
        for (int k = 0; k < 200; k++) {
            float n[3];
            test_direction(n);
            for (int channel = 0; channel < 3; channel++) {
                const float lost = sh_irradiance(SH_L2, all + 9 * channel, n) - sh_irradiance(SH_L2, some + 9 * channel, n);
                CHECK(fabsf(lost) <= tolerance * 1.0001f + 2e-6f);
            }
        }
    }
}

/* What was skipped counts against what may be: half of the tolerance, then nine tenths. */
static void skipping_budget(void) {
    const float light[8] = { 0, 0, 10, 1, 0, 10, 0, 1 }, bound = 17.0f / 1600.0f;
    const float radiance[2] = { 0.49f / bound, 0.9f / bound }, negative[2] = { 0.0f, -1.0f };
    float c[9] = { 0 };
    test_section("skipped spheres share the tolerance");
    EQUAL(sh_add_spheres(SH_L2, 1, light, radiance, 2, 1.0f, c), 1);
    EQUAL(sh_add_spheres(SH_L2, 1, light + 4, radiance + 1, 1, 1.0f, c), 0);
    test_section("skipped spheres by the magnitude of the brightest channel");
    EQUAL(sh_add_spheres(SH_L2, 2, light, negative, 1, 1.0004f * bound, c), 0);
    EQUAL(sh_add_spheres(SH_L2, 1, light, negative + 1, 1, 0.9996f * bound, c), 1);
    const float dim = 0.25f, bright_first[2] = { 100.0f, 0.9f / bound };
    EQUAL(sh_add_spheres(SH_L2, 1, light, &dim, 1, 0.26f * bound, c), 0);
    EQUAL(sh_add_spheres(SH_L2, 1, light, &dim, 1, 0.24f * bound, c), 1);
    EQUAL(sh_add_spheres(SH_L2, 1, light, bright_first, 2, 1.0f, c), 1);
}

/* The bound of sh_add_spheres: a cap's reconstruction at its centre over sin^2, for each order. */
static void reconstruction_bound(void) {
    const float z[3] = { 0, 0, 1 }, one = 1.0f;
    test_section("17/16");
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int i = 0; i < 1000; i++) {
            const float angle = 1.5707963f * (float)i / 999.0f;
            float c[9] = { 0 };
            sh_add_cap(order, 1, z, angle, SH_IRRADIANCE, &one, c);
            for (int k = 0; k < 20; k++) {
                float n[3];
                test_direction(n);
                CHECK(fabsf(sh_irradiance(order, c, k ? n : z)) <= 17.0f / 16.0f * 1.000001f);
            }
        }
}

static void add_everything(int order, float *c) {
    static const float dir[3] = { 0.36f, 0.48f, -0.8f }, u[3] = { 0.3f, -0.1f, 0.2f }, v[3] = { -0.2f, 0.5f, 0.1f };
    static const float far_end[3] = { -1.0f, 0.7f, 2.0f }, value[3] = { 0.3f, 1.7f, 12.3f }, lambert[3] = { 1.0f, 2.0f / 3.0f, 0.25f };
    sh_add_ambient(order, 3, value, c);
    sh_add_directional(order, 3, dir, value, c);
    sh_add_hemisphere(order, 3, dir, value, dir, c);
    sh_add_cap(order, 3, dir, 0.7f, SH_RADIANCE, value, c);
    sh_add_sphere(order, 3, far_end, 0.4f, SH_IRRADIANCE, value, c);
    sh_add_vmf(order, 3, dir, 3.0f, SH_RADIANCE, value, c);
    sh_add_rectangle(order, 3, dir, u, v, value, c);
    sh_add_disk(order, 3, far_end, dir, 0.3f, value, c);
    sh_add_segment(order, 3, dir, far_end, 0.01f, value, c);
    for (int k = 0; k < 3; k++)
        sh_zonal_add(order, lambert, dir, value[k], c + k * SH_COUNT(order));
}

/* GCC fuses products and sums across statements unless told to follow ISO C, in one order and not in another. */
#if defined(FP_FAST_FMAF) && defined(__GNUC__) && !defined(__clang__) && (defined(__cplusplus) || !defined(__STRICT_ANSI__))
static const long double prefix_tolerance = 1e-5L;
#else
static const long double prefix_tolerance = 0.0L;
#endif

/* Whatever they are computed on, the bits of an order are the first of a higher one. Values are below 32. */
static void prefix(void) {
    float full[27], lower[27], before[27];
    test_section("an order is a prefix");
    for (int order = SH_L0; order < SH_L2; order++)
        for (int i = 0; i < 50; i++) {
            test_fill(before, 27, -1.0, 1.0);
            memcpy(full, before, sizeof full);
            sh_truncate(SH_L2, 3, before, order, lower);
            add_everything(SH_L2, full);
            add_everything(order, lower);
            sh_truncate(SH_L2, 3, full, order, full);
            NEAR_ALL(lower, full, 3 * SH_COUNT(order), prefix_tolerance);
        }
}

/* Positions of any magnitude and unit give numbers. */
static void extremes(void) {
    static const double scales[] = { 0.0, 1e-38, 1e-20, 1.0, 1e10, 1e18 };
    test_section("extremes");
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            float p[3], n[3], far_end[3], c[9] = { 0 }, value = (float)(j % 2 ? 1e18 : 1.0);
            test_direction(n);
            for (int k = 0; k < 3; k++) {
                p[k] = (float)scales[i] * n[k];
                far_end[k] = (float)scales[j] * n[2 - k];
            }
            sh_add_sphere(SH_L2, 1, p, (float)scales[j], SH_RADIANCE, &value, c);
            sh_add_sphere(SH_L2, 1, p, (float)scales[j], SH_IRRADIANCE, &value, c);
            sh_add_disk(SH_L2, 1, p, n, (float)scales[j], &value, c);
            sh_add_segment(SH_L2, 1, p, far_end, (float)scales[j], &value, c);
            sh_add_rectangle(SH_L2, 1, p, n, far_end, &value, c);
            sh_add_vmf(SH_L2, 1, n, (float)scales[j], SH_RADIANCE, &value, c);
            for (int k = 0; k < 9; k++)
                CHECK(fabsf(c[k]) < 1e20f);
        }
}

static void run_tests(void) {
    directional();
    ambient_and_hemisphere();
    caps();
    spheres();
    lobes();
    skipping();
    skipping_budget();
    reconstruction_bound();
    prefix();
    extremes();
}
