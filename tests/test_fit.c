/* Least squares against a long double solution by Gaussian elimination, and what it is for. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

enum { MOST = 200 };
static float x[MOST], y[MOST], z[MOST], value[4 * MOST], weight[MOST];

/* count directions within the cone w.z > from; measurements of c through the kernel. */
static void measure(int order, int channels, size_t count, double from, const long double kernel[3], const float *c) {
    for (size_t i = 0; i < count; i++) {
        float dir[3];
        do
            test_direction(dir);
        while ((double)dir[2] < from);
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
        weight[i] = (float)test_uniform(0.1, 2.0);
        for (int k = 0; k < channels; k++) {
            long double wide[9] = { 0 }, wide_dir[3];
            oracle_widen(c + k * SH_COUNT(order), SH_COUNT(order), wide);
            oracle_widen(dir, 3, wide_dir);
            value[(size_t)k * count + i] = (float)oracle_expand(wide, kernel, wide_dir);
        }
    }
}

static const long double radiance[3] = { 1.0L, 1.0L, 1.0L }, lambert[3] = { 1.0L, 2.0L / 3.0L, 0.25L };

/* Light of the order is given back, for each order and number of channels, however uneven the samples. */
static void recovery(void) {
    for (int order = SH_L0; order <= SH_L2; order++)
        for (int channels = 1; channels <= 4; channels++)
            for (int measured = 0; measured <= 1; measured++) {
                float c[36], out[37], kernel[3];
                const size_t count = (size_t)(20 + test_below(60));
                test_section("recovery, order %d, %d channels, %s", order, channels, measured ? "irradiance" : "radiance");
                test_fill(c, 36, -1.0, 1.0);
                out[channels * SH_COUNT(order)] = 7.0f;
                sh_zonal_lambert(kernel);
                measure(order, channels, count, -0.3, measured ? lambert : radiance, c);
                EQUAL(sh_fit_samples(order, channels, x, y, z, value, measured ? weight : NULL, count, measured ? kernel : NULL, 0.0f, out),
                      SH_OK);
                NEAR_ALL(out, c, channels * SH_COUNT(order), 3e-6);
                NEAR(out[channels * SH_COUNT(order)], 7, 0);
            }
}

/* The minimum of the documented sum, from its normal equations in moments: basis b_i of the reconstruction, penalty as sh_dot's matrix. */
static void minimum(void) {
    for (int round = 0; round < 30; round++) {
        const size_t count = 40;
        const float lambda = round % 3 ? 0.02f * (float)(round % 3) : 0.0f;
        long double m[9][10] = { { 0 } }, total = 0.0L;
        float c[9], out[9];
        test_section("minimum, lambda %g", (double)lambda);
        test_fill(c, 9, -1.0, 1.0);
        measure(SH_L2, 1, count, -0.5, radiance, c);
        for (size_t i = 0; i < count; i++)
            value[i] += (float)test_uniform(-0.5, 0.5);
        EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, weight, count, NULL, lambda, out), SH_OK);
        for (size_t i = 0; i < count; i++) {
            const long double dir[3] = { (long double)x[i], (long double)y[i], (long double)z[i] };
            long double b[9];
            for (int j = 0; j < 9; j++) {
                long double unit[9] = { 0 };
                unit[j] = 1.0L;
                b[j] = oracle_expand(unit, radiance, dir);
            }
            total += (long double)weight[i];
            for (int j = 0; j < 9; j++) {
                for (int k = 0; k < 9; k++)
                    m[j][k] += (long double)weight[i] * b[j] * b[k];
                m[j][9] += (long double)weight[i] * b[j] * (long double)value[i];
            }
        }
        for (int j = 0; j < 9; j++)
            for (int k = 0; k < 10; k++) {
                m[j][k] /= total;
                if (k < 9 && (j < 1 ? 0 : j < 4 ? 1 : 2) == (k < 1 ? 0 : k < 4 ? 1 : 2)) {
                    float a[9] = { 0 }, b[9] = { 0 };
                    a[j] = b[k] = 1.0f;
                    m[j][k] += (long double)lambda * (j < 1 ? 0 : j < 4 ? 4 : 36) * (long double)sh_dot(SH_L2, a, b);
                }
            }
        for (int p = 0; p < 9; p++)
            for (int j = 0; j < 9; j++)
                if (j != p) {
                    const long double factor = m[j][p] / m[p][p];
                    for (int k = p; k < 10; k++)
                        m[j][k] -= factor * m[p][k];
                }
        for (int j = 0; j < 9; j++)
            NEAR(out[j], m[j][9] / m[j][j], 2e-6);
    }
}

/* Too few samples, all in a plane, or a kernel without a band: a warning, and numbers that still fit. */
static void undetermined(void) {
    float c[9], out[9], kernel[3];
    test_fill(c, 9, 0.1, 1.0);
    for (size_t count = 1; count <= 8; count++) {
        test_section("%d samples of 9 unknowns", (int)count);
        measure(SH_L2, 1, count, -1.0, radiance, c);
        EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, count, NULL, 0.0f, out), SH_WARNING_UNDETERMINED);
        for (size_t i = 0; i < count; i++) {
            const float dir[3] = { x[i], y[i], z[i] };
            NEAR(sh_radiance(SH_L2, out, dir), value[i], 0.02);
        }
        EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, count, NULL, 0.1f, out), SH_OK);
    }
    test_section("samples on the equator");
    measure(SH_L2, 1, 50, -1.0, radiance, c);
    for (int i = 0; i < 50; i++) {
        x[i] = (float)cos(0.3 * i);
        y[i] = (float)sin(0.3 * i);
        z[i] = 0.0f;
    }
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 50, NULL, 0.0f, out), SH_WARNING_UNDETERMINED);
    NEAR(out[SH_Z], 0, 1e-6);
    NEAR(out[SH_XZ], 0, 1e-6);
    test_section("half Lambert shows no second band");
    sh_zonal_half_lambert(kernel);
    measure(SH_L2, 1, 50, -1.0, radiance, c);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 50, kernel, 0.0f, out), SH_WARNING_UNDETERMINED);
    NEAR(out[SH_XY], 0, 1e-6);
    EQUAL(sh_fit_samples(SH_L1, 1, x, y, z, value, NULL, 50, kernel, 0.0f, out), SH_OK);
}

/* Samples in a cone, which is narrowed until they do not determine the light: the warning comes with the least mean square, about any
 * axis, and before it what is given back is the light. */
static void cones(void) {
    static const float axes[3][3] = { { 0, 0, 1 }, { 0.6f, 0, 0.8f }, { 0.36f, 0.48f, -0.8f } };
    double last[3] = { 0.0, 0.0, 0.0 };
    for (int a = 0; a < 3; a++)
        for (double angle = 1.2; angle > 0.2; angle *= 0.98) {
            float c[9], out[9];
            long double axis[3], u[3], v[3];
            double most = 0.0;
            test_section("a cone of half-angle %g, axis %d", angle, a);
            test_fill(c, 9, -1.0, 1.0);
            oracle_widen(axes[a], 3, axis);
            oracle_frame(axis, u, v);
            for (int i = 0; i < 150; i++) {
                const double t = 1.0 - (1.0 - cos(angle)) * (i + 0.5) / 150.0, s = sqrt(1.0 - t * t), turn = 2.39996322972865332 * i;
                float dir[3];
                for (int k = 0; k < 3; k++)
                    dir[k] = (float)((long double)t * axis[k] + (long double)s * (cosl((long double)turn) * u[k] + sinl((long double)turn) * v[k]));
                x[i] = dir[0];
                y[i] = dir[1];
                z[i] = dir[2];
                value[i] = sh_radiance(SH_L2, c, dir);
            }
            if (sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 150, NULL, 0.0f, out) != SH_OK)
                break;
            last[a] = angle;
            for (int k = 0; k < 9; k++)
                most = fmax(most, fabs((double)out[k] - (double)c[k]));
            CHECK(most < 1e-4);
        }
    NEAR(last[1], last[0], 0.02 * last[0]);
    NEAR(last[2], last[0], 0.02 * last[0]);
    CHECK(last[0] > 0.5 && last[0] < 0.6);
}

static void errors(void) {
    float c[9], before[9], none[MOST] = { 0 }, indefinite[MOST] = { -5.0f, 2.0f, 2.0f, 2.0f, 2.0f };
    test_section("errors write nothing");
    test_fill(c, 9, -1.0, 1.0);
    measure(SH_L2, 1, 20, -1.0, radiance, c);
    memcpy(before, c, sizeof c);
    EQUAL(sh_fit_samples(3, 1, x, y, z, value, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 0, x, y, z, value, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, NULL, y, z, value, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, NULL, z, value, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, NULL, value, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, NULL, NULL, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 0, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, none, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, indefinite, 20, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 20, NULL, -1.0f, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 20, NULL, nanf(""), c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 20, NULL, (float)INFINITY, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_fit_samples(SH_L2, 1, x, y, z, value, NULL, 20, NULL, 0.0f, NULL), SH_ERROR_ARGUMENT);
    SAME_BITS(c, before, sizeof c);
}

static void run_tests(void) {
    recovery();
    minimum();
    undetermined();
    cones();
    errors();
}
