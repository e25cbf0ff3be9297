/* The first-order toolbox: four numbers, a and v, that mean a + v.d in direction d; a = R0, v = 3 R1. Its identities, as they hold for
 * this library's functions. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static void random_light(float c[4]) {
    for (int i = 0; i < 4; i++)
        c[i] = 0.0f;
    for (int i = 0; i < 3; i++) {
        float dir[3];
        test_direction(dir);
        sh_add_sample(SH_L1, dir, (float)test_uniform(0.1, 1.0), c);
    }
}

static float along(const float v[3], const float d[3]) {
    return v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
}

/* Ambient a: (a, 0). Directional of irradiance / pi E: E (1, 3 d) / 4. Hemispheres: ((s + g) / 2, 3/4 (s - g) up). */
static void lights(void) {
    for (int i = 0; i < 50; i++) {
        float d[3], ambient[4] = { 0 }, sun[4] = { 0 }, half[4] = { 0 };
        const float one = 1.0f, sky = 3.0f, ground = 1.0f;
        test_section("lights");
        test_direction(d);
        sh_add_ambient(SH_L1, 1, &one, ambient);
        sh_add_directional(SH_L1, 1, d, &one, sun);
        sh_add_hemisphere(SH_L1, 1, d, &sky, &ground, half);
        NEAR(ambient[0], 1, 0);
        NEAR(sun[0], 0.25, 0);
        NEAR(half[0], 2, 0);
        for (int k = 0; k < 3; k++) {
            NEAR(3.0f * ambient[1 + k], 0, 0);
            NEAR(3.0f * sun[1 + k], 0.75f * d[k], 1e-7);
            NEAR(3.0f * half[1 + k], 1.5f * d[k], 2e-7);
        }
    }
}

/* A light of solid angle S is a cap of c = 1 - S / (2 pi). The notes' cos(S / 4) is the half-angle's, not the solid angle's: their full
 * sphere, S = 4 pi, is right only because both are -1 there. */
static void solid_angle(void) {
    const float z[3] = { 0, 0, 1 }, one = 1.0f;
    test_section("solid angle");
    for (int i = 0; i <= 20; i++) {
        const double s = 4.0 * 3.14159265358979 * i / 20.0, cosine = 1.0 - s / (2.0 * 3.14159265358979), mistaken = cos(s / 4.0);
        float c[4] = { 0 }, zonal[3], wrong[3];
        sh_add_cap(SH_L1, 1, z, (float)acos(fmax(-1.0, cosine)), SH_RADIANCE, &one, c);
        sh_zonal_cap((float)cosine, zonal);
        sh_zonal_cap((float)mistaken, wrong);
        NEAR(4.0 * 3.14159265358979 * (double)c[0], s, 4e-6);
        NEAR(c[0], zonal[0], 2e-7);
        NEAR(c[SH_Z], zonal[1], 2e-7);
        if (i > 0 && i != 10 && i < 20)
            CHECK(fabs(4.0 * 3.14159265358979 * (double)wrong[0] - s) > 0.01 * s);
    }
}

/* Probes at a direction: average a; half Lambert a + v.d / 3; Lambert's linear part a + 2/3 v.d; radiance a + v.d. */
static void probing(void) {
    static const float sharpness[4] = { 0, 1, 2, 3 };
    for (int i = 0; i < 100; i++) {
        float c[4], n[3], half[3], zonal[3];
        test_section("probing");
        random_light(c);
        test_direction(n);
        const float a = c[0], v = 3.0f * along(c + 1, n);
        for (int k = 0; k < 4; k++) {
            sh_zonal_sharpness(sharpness[k], zonal);
            NEAR(sh_radiance_zonal(SH_L1, c, zonal, n), a + sharpness[k] / 3.0f * v, 2e-6);
        }
        NEAR(sh_radiance(SH_L1, c, n), a + v, 2e-6);
        NEAR(sh_irradiance(SH_L1, c, n), a + 2.0f / 3.0f * v, 2e-6);
        sh_zonal_half_lambert(half);
        NEAR(sh_radiance_zonal(SH_L1, c, half, n), a + v / 3.0f, 2e-6);
        CHECK(a + v / 3.0f >= -1e-6f); /* no light makes half Lambert negative */
    }
}

/* <f g> = a b + u.v / 3. */
static void dots(void) {
    for (int i = 0; i < 100; i++) {
        float a[4], b[4];
        test_section("dot");
        test_fill(a, 4, -1.0, 1.0);
        test_fill(b, 4, -1.0, 1.0);
        NEAR(sh_dot(SH_L1, a, b), a[0] * b[0] + 9.0f * along(a + 1, b + 1) / 3.0f, 2e-6);
    }
}

/* Delayed normalisation: the sum of lights points along the sum of their unnormalised vectors, whatever the order and the weights. */
static void delayed_normalisation(void) {
    for (int i = 0; i < 50; i++) {
        float sum[4] = { 0 }, vector[3] = { 0 }, dir[3];
        test_section("delayed normalisation");
        for (int k = 0; k < 5; k++) {
            float c[4];
            random_light(c);
            const float scale = (float)test_uniform(0.1, 10.0);
            sh_madd(SH_L1, c, scale, sum);
            for (int j = 0; j < 3; j++)
                vector[j] += scale * c[1 + j];
        }
        const float length = sh_average_direction(sum, dir);
        for (int j = 0; j < 3; j++)
            NEAR(dir[j] * length, vector[j], 1e-5);
        NEAR(sh_directionality(sum), length / sum[0], 1e-6);
    }
}

/* Light propagation: what leaves a cell through faces that tile the sphere is what is in the cell, and a face's share by its polygon
 * is the inner product of the light with the polygon's set. Re-emitted as lobes around the faces, energy stays. */
static void propagation(void) {
    static const float axes[6][3] = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } };
    for (int i = 0; i < 50; i++) {
        float c[4], moved[4] = { 0 }, total = 0.0f, lobe[3];
        test_section("propagation");
        random_light(c);
        sh_zonal_cosine_power(1.0f, lobe);
        for (int face = 0; face < 6; face++) {
            const float *n = axes[face], u[3] = { n[1], n[2], n[0] }, v[3] = { n[2], n[0], n[1] }, one = 1.0f;
            float seen[4] = { 0 };
            sh_add_rectangle(SH_L1, 1, n, u, v, &one, seen);
            NEAR(seen[0], 1.0 / 6.0, 1e-7);
            const float flux = sh_dot(SH_L1, c, seen);
            total += flux;
            sh_zonal_add(SH_L1, lobe, n, flux, moved);
        }
        NEAR(total, c[0], 2e-6);
        NEAR(moved[0], c[0], 2e-6);
        float before[3], after[3];
        sh_average_direction(c, before);
        sh_average_direction(moved, after);
        NEAR(along(before, after), 1, 1e-5); /* the cube's symmetry keeps the direction */
    }
}

static void run_tests(void) {
    lights();
    solid_angle();
    probing();
    dots();
    delayed_normalisation();
    propagation();
}
