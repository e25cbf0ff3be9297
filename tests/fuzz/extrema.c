/* Extrema over the sphere: finite, unit where they are taken, taken there, and no value anywhere is beyond them. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

/* R0 + w1 R1.n + w2 n'R2 n in double, at n / |n|. */
static double value(int order, const float *c, double w1, double w2, const float n[3]) {
    double x = (double)n[0], y = (double)n[1], z = (double)n[2];
    const double length = sqrt(x * x + y * y + z * z);
    double d[9] = { 0 };
    for (int i = 0; i < SH_COUNT(order); i++)
        d[i] = (double)c[i];
    x /= length;
    y /= length;
    z /= length;
    return d[0] + w1 * (d[1] * x + d[2] * y + d[3] * z) + w2 * (d[4] * (x * x - z * z) + d[7] * (y * y - z * z)) +
           2.0 * w2 * (d[5] * x * y + d[6] * x * z + d[8] * y * z);
}

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3);
    float c[9], least_at[3], most_at[3], n[3];
    fuzz_coefficients(in, c);
    const int irradiance = fuzz_below(in, 2);
    const double w1 = irradiance ? 2.0 : 3.0, w2 = irradiance ? 1.875 : 7.5;
    const float least = irradiance ? sh_irradiance_min(order, c, least_at) : sh_min(order, c, least_at);
    const float most = irradiance ? sh_irradiance_max(order, c, most_at) : sh_max(order, c, most_at);
    const double tolerance = 2e-6 * (double)fuzz_largest(c, SH_COUNT(order)) + 1e-43, unit = 1e-6;
    FUZZ_CHECK(fuzz_all_finite(&least, 1) && fuzz_all_finite(&most, 1) && least <= most);
    FUZZ_CHECK(fuzz_all_finite(least_at, 3) && fuzz_all_finite(most_at, 3));
    FUZZ_CHECK(fabs((double)least_at[0] * (double)least_at[0] + (double)least_at[1] * (double)least_at[1] +
                    (double)least_at[2] * (double)least_at[2] - 1.0) < unit);
    FUZZ_CHECK(fabs((double)most_at[0] * (double)most_at[0] + (double)most_at[1] * (double)most_at[1] +
                    (double)most_at[2] * (double)most_at[2] - 1.0) < unit);
    FUZZ_CHECK(fabs(value(order, c, w1, w2, least_at) - (double)least) <= tolerance);
    FUZZ_CHECK(fabs(value(order, c, w1, w2, most_at) - (double)most) <= tolerance);
    for (int i = 0; i < 8; i++) {
        fuzz_direction(in, n);
        const double v = value(order, c, w1, w2, n);
        FUZZ_CHECK(v >= (double)least - tolerance && v <= (double)most + tolerance);
    }
    const float same = irradiance ? sh_irradiance_min(order, c, NULL) : sh_min(order, c, NULL);
    FUZZ_CHECK(fabs((double)same - (double)least) <= tolerance);
}
