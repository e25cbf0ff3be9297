/* Conversions against each engine's documented formulas, written out here from their definitions. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

static const int phases[2] = { 0, SH_CONDON_SHORTLEY };

/* Moments of an arbitrary light: a few directions. */
static void random_light(float c[9]) {
    for (int i = 0; i < 9; i++)
        c[i] = 0.0f;
    for (int i = 0; i < 4; i++) {
        float dir[3];
        test_direction(dir);
        sh_add_sample(SH_L2, dir, (float)test_uniform(0.1, 1.0), c);
    }
}

/* f_i = integral of L Y_i, for the light of one direction: 4 pi Y_i(dir), for each phase and order. */
static void orthonormal(void) {
    for (int i = 0; i < 400; i++) {
        const int phase = phases[i % 2], order = i / 2 % 3;
        float dir[3], c[9] = { 0 }, f[9];
        long double wide[3], expected[9];
        test_section("sh_to_orthonormal, phase %d, order %d", phase, order);
        test_direction(dir);
        oracle_widen(dir, 3, wide);
        sh_add_sample(order, dir, 1.0f, c);
        sh_to_orthonormal(order, c, phase, f);
        for (int l = 0, n = 0; l <= order; l++)
            for (int m = -l; m <= l; m++, n++)
                expected[n] = 4.0L * oracle_pi * oracle_y(l, m, wide, phase);
        NEAR_ALL(f, expected, SH_COUNT(order), 4e-6);
    }
}

/* Round trips, to 4 ulp of the band's largest coefficient; in place as well. */
typedef void (*conversion)(int order, const float *in, float *out);

static void to_plain(int order, const float *in, float *out) {
    sh_to_orthonormal(order, in, 0, out);
}
static void from_plain(int order, const float *in, float *out) {
    sh_from_orthonormal(order, in, 0, out);
}
static void to_phase(int order, const float *in, float *out) {
    sh_to_orthonormal(order, in, SH_CONDON_SHORTLEY, out);
}
static void from_phase(int order, const float *in, float *out) {
    sh_from_orthonormal(order, in, SH_CONDON_SHORTLEY, out);
}

static void check_band(const float *actual, const float *expected, int first, int last) {
    float most = 0.0f;
    for (int i = first; i < last; i++)
        most = fmaxf(most, fabsf(expected[i]));
    for (int i = first; i < last; i++)
        NEAR(actual[i], expected[i], 4.0L * 1.1920929e-7L * (long double)most);
}

static void round_trip(conversion to, conversion from, const char *name) {
    static const double scales[] = { 1.0, 1e-30, 1e18 };
    for (int i = 0; i < 300; i++)
        for (int order = SH_L0; order <= SH_L2; order++) {
            float c[9], there[9], back[9];
            test_section("round trip of %s, order %d", name, order);
            test_fill(c, 9, -scales[i % 3], scales[i % 3]);
            for (int j = 0; j < 9; j++)
                there[j] = back[j] = 7.0f;
            to(order, c, there);
            from(order, there, back);
            for (int j = SH_COUNT(order); j < 9; j++)
                CHECK(there[j] == 7.0f && back[j] == 7.0f);
            check_band(back, c, 0, 1);
            if (order >= SH_L1)
                check_band(back, c, 1, 4);
            if (order >= SH_L2)
                check_band(back, c, 4, 9);
            from(order, there, there);
            SAME_BITS(there, back, (size_t)SH_COUNT(order) * sizeof(float));
            to(order, c, there);
            to(order, c, c);
            SAME_BITS(there, c, (size_t)SH_COUNT(order) * sizeof(float));
        }
}

/* three.js, SphericalHarmonics3.getAt and getIrradianceAt, with their constants: E, not E / pi. */
static void three(void) {
    for (int i = 0; i < 100; i++) {
        float c[9], f[9], n[3];
        test_section("three.js");
        random_light(c);
        test_direction(n);
        sh_to_orthonormal(SH_L2, c, 0, f);
        const double x = (double)n[0], y = (double)n[1], z = (double)n[2];
        double k[9];
        for (int j = 0; j < 9; j++)
            k[j] = (double)f[j];
        const double radiance = k[0] * 0.282095 + k[1] * 0.488603 * y + k[2] * 0.488603 * z + k[3] * 0.488603 * x + k[4] * 1.092548 * x * y +
                                k[5] * 1.092548 * y * z + k[6] * 0.315392 * (3 * z * z - 1) + k[7] * 1.092548 * x * z +
                                k[8] * 0.546274 * (x * x - y * y);
        const double irradiance = k[0] * 0.886227 + k[1] * 2 * 0.511664 * y + k[2] * 2 * 0.511664 * z + k[3] * 2 * 0.511664 * x +
                                  k[4] * 2 * 0.429043 * x * y + k[5] * 2 * 0.429043 * y * z + k[6] * (0.743125 * z * z - 0.247708) +
                                  k[7] * 2 * 0.429043 * x * z + k[8] * 0.429043 * (x * x - y * y);
        NEAR(sh_radiance(SH_L2, c, n), radiance, 3e-5);
        NEAR(3.14159265358979 * (double)sh_irradiance(SH_L2, c, n), irradiance, 3e-5);
    }
}

/* DirectXMath's XMSHEvalDirection, order 3. */
static void directx(void) {
    for (int i = 0; i < 100; i++) {
        float c[9] = { 0 }, f[9], n[3];
        test_section("DirectXMath");
        test_direction(n);
        sh_add_sample(SH_L2, n, 1.0f, c);
        sh_to_orthonormal(SH_L2, c, SH_CONDON_SHORTLEY, f);
        const double x = (double)n[0], y = (double)n[1], z = (double)n[2];
        const double expected[9] = { 0.282094791773878140,
                                     -0.488602511902919920 * y,
                                     0.488602511902919920 * z,
                                     -0.488602511902919920 * x,
                                     1.092548430592079200 * x * y,
                                     -1.092548430592079200 * y * z,
                                     0.946174695757560080 * z * z - 0.315391565252520050,
                                     -1.092548430592079200 * x * z,
                                     0.546274215296039590 * (x * x - y * y) };
        for (int k = 0; k < 9; k++)
            NEAR(f[k], 4.0 * 3.14159265358979 * expected[k], 5e-6);
    }
}

/* Unreal's SHBasisFunction of three bands, in its left-handed axes with z up. */
static void unreal(void) {
    static const int axis[3] = { 1, -2, 3 };
    for (int i = 0; i < 100; i++) {
        float c[9] = { 0 }, f[9], dir[3];
        test_section("Unreal");
        test_direction(dir);
        sh_add_sample(SH_L2, dir, 1.0f, c);
        sh_swap_axes(SH_L2, c, axis, c);
        sh_to_orthonormal(SH_L2, c, SH_CONDON_SHORTLEY, f);
        const double x = (double)dir[0], y = -(double)dir[1], z = (double)dir[2];
        const double expected[9] = { 0.282095,
                                     -0.488603 * y,
                                     0.488603 * z,
                                     -0.488603 * x,
                                     1.092548 * x * y,
                                     -1.092548 * y * z,
                                     0.315392 * (3.0 * z * z - 1.0),
                                     -1.092548 * x * z,
                                     0.546274 * (x * x - y * y) };
        for (int k = 0; k < 9; k++)
            NEAR(f[k], 4.0 * 3.14159265358979 * expected[k], 2e-5);
    }
}

/* Unity's SphericalHarmonicsL2.Evaluate; Filament's irradiance polynomial has the same nine factors. */
static void unity(void) {
    for (int i = 0; i < 100; i++) {
        float c[9], u[9], n[3];
        test_section("Unity and Filament");
        random_light(c);
        test_direction(n);
        sh_to_unity(SH_L2, c, u);
        const float x = n[0], y = n[1], z = n[2];
        const float value = u[0] + u[1] * y + u[2] * z + u[3] * x + u[4] * x * y + u[5] * y * z + u[6] * (3 * z * z - 1) + u[7] * x * z +
                            u[8] * (x * x - y * y);
        NEAR(sh_irradiance(SH_L2, c, n), value, 6e-6);
    }
    const float white = 1.0f;
    float c[9] = { 0 }, u[9];
    sh_add_ambient(SH_L2, 1, &white, c); /* RenderSettings.ambientProbe of a white ambient light: 1 and eight zeros */
    sh_to_unity(SH_L2, c, u);
    for (int k = 0; k < 9; k++)
        NEAR(u[k], k == 0, 0);
}

/* Babylon: the polynomial itself, and SphericalPolynomial.FromHarmonics with its constants, from its harmonics. */
static void babylon(void) {
    for (int i = 0; i < 100; i++) {
        float c[9], p[9], f[9], n[3], back[9];
        double h[9];
        test_section("Babylon");
        random_light(c);
        test_direction(n);
        sh_to_babylon(c, p);
        sh_to_orthonormal(SH_L2, c, SH_CONDON_SHORTLEY, f);
        for (int k = 0; k < 9; k++)
            h[k] = (double)f[k] / 3.14159265358979;
        const double expected[9] = { h[3] * -1.02333,
                                     h[1] * -1.02333,
                                     h[2] * 1.02333,
                                     h[0] * 0.886277 - h[6] * 0.247708 + h[8] * 0.429043,
                                     h[0] * 0.886277 - h[6] * 0.247708 - h[8] * 0.429043,
                                     h[0] * 0.886277 + h[6] * 0.495417,
                                     h[5] * -0.858086,
                                     h[7] * -0.858086,
                                     h[4] * 0.858086 };
        NEAR_ALL(p, expected, 9, 3e-4); /* its 0.886277 is sqrt(pi) / 2 = 0.886227 with two digits swapped */
        const float value = p[0] * n[0] + p[1] * n[1] + p[2] * n[2] + p[3] * n[0] * n[0] + p[4] * n[1] * n[1] + p[5] * n[2] * n[2] +
                            p[6] * n[1] * n[2] + p[7] * n[2] * n[0] + p[8] * n[0] * n[1];
        NEAR(sh_irradiance(SH_L2, c, n), value, 6e-6);
        sh_from_babylon(p, back);
        NEAR_ALL(back, c, 9, 1e-6 * (double)c[0]);
        const double rounding = 4e-7 * (double)c[0]; /* in place, -ffast-math may round differently */
        sh_to_babylon(c, c);
        NEAR_ALL(c, p, 9, rounding);
        sh_from_babylon(c, c);
        NEAR_ALL(c, back, 9, rounding);
    }
}

static void layouts(void) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int channels = 1; channels <= 4; channels++) {
            const int count = SH_COUNT(order);
            float c[36], there[36], back[36];
            test_section("interleaving %d channels, order %d", channels, order);
            test_fill(c, 36, -1.0, 1.0);
            sh_interleave(order, channels, c, there);
            for (int i = 0; i < count * channels; i++)
                CHECK(there[i] == c[i % channels * count + i / channels]);
            sh_deinterleave(order, channels, there, back);
            SAME_BITS(back, c, (size_t)(count * channels) * sizeof(float));
        }
}

/* Axes of the engines: the light from above must come from above in each. */
static void axes(void) {
    static const struct {
        const char *name;
        int axis[3], up, right;
    } engines[] = { { "right-handed y up", { 1, 3, -2 }, 1, 1 }, { "left-handed y up", { 1, 3, 2 }, 1, 0 }, { "left-handed z up", { 1, -2, 3 }, 2, 0 } };
    for (int i = 0; i < 3; i++) {
        const float above[3] = { 0, 0, 1 };
        float c[9] = { 0 }, out[9], found[3], m[9] = { 0 };
        test_section("%s", engines[i].name);
        sh_add_sample(SH_L2, above, 1.0f, c);
        sh_swap_axes(SH_L2, c, engines[i].axis, out);
        sh_average_direction(out, found);
        NEAR(found[engines[i].up], 1, 0);
        for (int k = 0; k < 3; k++)
            m[3 * k + abs(engines[i].axis[k]) - 1] = engines[i].axis[k] < 0 ? -1.0f : 1.0f;
        const float determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
        NEAR(determinant, engines[i].right ? 1 : -1, 0);
    }
}

static void run_tests(void) {
    orthonormal();
    round_trip(to_plain, from_plain, "orthonormal");
    round_trip(to_phase, from_phase, "orthonormal with Condon-Shortley phase");
    round_trip(sh_to_unity, sh_from_unity, "unity");
    three();
    directx();
    unreal();
    unity();
    babylon();
    layouts();
    axes();
}
