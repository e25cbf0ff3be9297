/* Least squares: nothing touched outside the arrays; an error writes nothing; finite where it says that it is fine; light of the order
 * comes back where the samples determine it. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void fuzz_one(fuzz_input *in) {
    const unsigned how = fuzz_byte(in);
    const int at_start = how & 1u, wild = (how & 6u) == 6u, order = fuzz_below(in, 3), set = SH_COUNT(order);
    const size_t count = fuzz_count(in, 71), channels = 1 + (size_t)fuzz_below(in, 2), floats = channels * (size_t)set;
    float *v[3], *value = fuzz_place_floats(3, channels * count, at_start), *c = fuzz_place_floats(4, floats, at_start);
    float *weight = how & 8u ? fuzz_place_floats(5, count, at_start) : NULL, light[2][9], zonal[3];
    for (int i = 0; i < 3; i++)
        v[i] = fuzz_place_floats(i, count, at_start);
    fuzz_fill_directions(in, v[0], v[1], v[2], count);
    sh_zonal_lambert(zonal);
    for (size_t k = 0; k < channels; k++) {
        fuzz_coefficients(in, light[k]);
        for (size_t i = 0; i < count; i++) {
            const float n[3] = { v[0][i], v[1][i], v[2][i] };
            value[k * count + i] = how & 16u ? sh_irradiance(order, light[k], n) : sh_radiance(order, light[k], n);
        }
    }
    for (size_t i = 0; i < count && weight; i++)
        weight[i] = 0.5f + (float)(i % 3);
    float regularization = how & 32u ? fuzz_float(in) : 0.0f;
    if (wild && count)
        (how & 8u && how & 64u ? weight : how & 128u ? value : v[how % 3])[fuzz_byte(in) % count] = fuzz_float(in);
    memset(c, FUZZ_CANARY, floats * sizeof *c);
    const int status =
        sh_fit_samples(order, (int)channels, v[0], v[1], v[2], value, weight, count, how & 16u ? zonal : NULL, regularization, c);
    FUZZ_CHECK(status == SH_OK || status == SH_WARNING_UNDETERMINED || status == SH_ERROR_ARGUMENT);
    if (status == SH_ERROR_ARGUMENT) {
        for (size_t i = 0; i < floats * sizeof *c; i++)
            FUZZ_CHECK(((const unsigned char *)c)[i] == FUZZ_CANARY);
        FUZZ_CHECK(wild || count == 0 || !(regularization >= 0.0f) || regularization > 1e18f);
        return;
    }
    if (wild)
        return;
    FUZZ_CHECK(fuzz_all_finite(c, floats));
    for (size_t k = 0; k < channels && status == SH_OK && regularization == 0.0f && count >= 40; k++)
        for (int i = 0; i < set; i++)
            FUZZ_CHECK(fabs((double)c[k * (size_t)set + (size_t)i] - (double)light[k][i]) <=
                       2e-5 * (double)fuzz_largest(light[k], set) + 1e-40);
}
