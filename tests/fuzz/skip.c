/* What may be skipped under a tolerance: bands, channels, lights, texels; and what is kept of it is within the tolerance. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

enum { PROBES = 6 };

static void fuzz_one(fuzz_input *in) {
    float c[2][9], n[3], tolerance = fuzz_float(in), budget = fuzz_finite(in), light = fuzz_float(in);
    const float before = budget;
    fuzz_coefficients(in, c[0]);
    fuzz_coefficients(in, c[1]);
    fuzz_direction(in, n);
    const int order = sh_order_needed(c[0], tolerance), radiance_order = sh_radiance_order_needed(c[0], tolerance);
    FUZZ_CHECK(order >= SH_L0 && order <= SH_L2 && radiance_order >= order && radiance_order <= SH_L2);
    const double slack = 2e-5 * (double)fuzz_largest(c[0], 9) + 1e-43;
    if (tolerance <= 1e30f) {
        FUZZ_CHECK(order == SH_L2 || fabs((double)sh_irradiance(SH_L2, c[0], n) - (double)sh_irradiance(order, c[0], n)) <=
                                         (double)tolerance + slack);
        FUZZ_CHECK(radiance_order == SH_L2 || fabs((double)sh_radiance(SH_L2, c[0], n) -
                                                   (double)sh_radiance(radiance_order, c[0], n)) <= (double)tolerance + slack);
    }
    if (sh_is_grey(SH_L2, 2, c[0], tolerance))
        FUZZ_CHECK(fabs((double)sh_irradiance(SH_L2, c[0], n) - (double)sh_irradiance(SH_L2, c[1], n)) <=
                   (double)tolerance + slack + 2e-5 * (double)fuzz_largest(c[1], 9));
    FUZZ_CHECK(sh_skip_light(light, &budget) ? before - budget >= 0.0f && budget >= 0.0f : budget == before);

    float *probes = fuzz_place_floats(0, 9 * PROBES, 0);
    size_t *index = (size_t *)(void *)fuzz_place(1, PROBES * sizeof *index, 0), first[4],
           count = (size_t)fuzz_below(in, PROBES + 1);
    for (size_t i = 0; i < PROBES; i++)
        memcpy(probes + 9 * i, c[fuzz_below(in, 2)], 9 * sizeof(float));
    unsigned seen = 0;
    sh_group_by_order(1, probes, count, tolerance, index, first);
    FUZZ_CHECK(first[0] == 0 && first[3] == count && first[1] <= first[2] && first[2] <= count);
    for (size_t i = 0; i < count; i++) {
        FUZZ_CHECK(index[i] < count && !(seen >> index[i] & 1u));
        seen |= 1u << index[i];
        const int group = i < first[1] ? 0 : i < first[2] ? 1 : 2;
        FUZZ_CHECK(sh_order_needed(probes + 9 * index[i], tolerance) == group);
    }
    for (int o = 0; o < 3; o++) {
        const int height = sh_equirect_size_for(o, tolerance), side = sh_cubemap_size_for(o, tolerance);
        FUZZ_CHECK(height >= 1 && height <= 1 << 24 && (height & (height - 1)) == 0 && side >= 1 && side <= height);
    }
}
