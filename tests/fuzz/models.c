/* The other reconstructions of one normal: finite for any finite coefficients, where they promise it not negative, and exact where
 * they are. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3);
    float c[9], n[3], dir[3], result[8];
    fuzz_coefficients(in, c);
    fuzz_direction(in, n);
    const float cosine = fuzz_finite(in), sum = fuzz_largest(c, SH_COUNT(order));
    result[0] = sh_radiance(order, c, n);
    result[1] = sh_irradiance(order, c, n);
    result[2] = sh_irradiance_ao(order, c, n, cosine);
    result[3] = sh_irradiance_geomerics(c, n);
    result[4] = sh_irradiance_zh3(c, n);
    result[5] = sh_irradiance_opposite(order, c, n, result[1]);
    result[6] = sh_directionality(c);
    result[7] = sh_average_direction(c, dir);
    FUZZ_CHECK(fuzz_all_finite(result, 8));
    FUZZ_CHECK(result[3] >= 0.0f && result[4] >= 0.0f && result[6] >= 0.0f && result[6] <= 1.0f && result[7] >= 0.0f);
    FUZZ_CHECK(fabs((double)dir[0] * (double)dir[0] + (double)dir[1] * (double)dir[1] + (double)dir[2] * (double)dir[2] - 1.0) <
               1e-6);
    FUZZ_CHECK(fabs((double)result[2]) <= 40.0 * (double)sum + 1e-43);
    if (cosine >= 1.0f)
        FUZZ_CHECK(result[2] == 0.0f);
    if (cosine <= 0.0f)
        FUZZ_CHECK(fabs((double)result[2] - (double)result[1]) <= 1e-5 * (double)sum + 1e-43);

    float intensity[1], ambient[1];
    sh_dominant_light(SH_L2, 1, c, dir, intensity, ambient);
    FUZZ_CHECK(fuzz_all_finite(intensity, 1) && fuzz_all_finite(ambient, 1) && intensity[0] >= 0.0f);
    FUZZ_CHECK(fabs((double)ambient[0] + (double)intensity[0] / 4.0 - (double)c[SH_R0]) <=
               1e-6 * (double)fuzz_largest(c, 4) + 1e-43);
}
