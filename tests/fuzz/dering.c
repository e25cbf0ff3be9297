/* De-ringing: ends, leaves nothing negative but what rounding makes, keeps R0, and its parameter is of the window. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3), channels = 1 + fuzz_below(in, 3), set = SH_COUNT(order);
    const sh_window window = (sh_window)fuzz_below(in, 3);
    float c[3][9], *sets = fuzz_place_floats(0, (size_t)(channels * set), 0), *out = sets;
    for (int k = 0; k < channels; k++) {
        fuzz_coefficients(in, c[k]);
        memcpy(sets + k * set, c[k], (size_t)set * sizeof(float));
    }
    if (fuzz_below(in, 2))
        out = fuzz_place_floats(1, (size_t)(channels * set), 1);
    const float parameter = sh_dering(order, channels, sets, window, out);
    FUZZ_CHECK(parameter >= 0.0f);
    for (int k = 0; k < channels; k++) {
        const float *result = out + k * set, most = fuzz_largest(c[k], set);
        FUZZ_CHECK(fuzz_all_finite(result, (size_t)set) && result[SH_R0] == c[k][SH_R0]);
        for (int i = 0; i < set; i++)
            FUZZ_CHECK(fabsf(result[i]) <= fabsf(c[k][i]));
        /* sh_min's own error is relative to the largest coefficient that is left. */
        const double slack = 1e-6 * (double)c[k][SH_R0] + 2e-6 * (double)fuzz_largest(result, set) + 1e-43;
        if (c[k][SH_R0] >= 0.0f && most < 1e18f)
            FUZZ_CHECK((double)sh_min(order, result, NULL) >= -slack);
    }
}
