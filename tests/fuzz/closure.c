/* Closures of one normal: finite for any finite coefficients; never negative; within the bounds; I(n) - I(-n) = 4 n.R1 where a light
 * has the coefficients; the prepared form is the direct one. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

/* What rounding may do: 2e-6 R0 and, where the upper bound b R0 decides, 1e-6 R0 / b. */
static double tolerance(const float *c, const float n[3], float hi) {
    const double m1 = (double)c[SH_X] * (double)n[0] + (double)c[SH_Y] * (double)n[1] + (double)c[SH_Z] * (double)n[2];
    const double r0 = fabs((double)c[SH_R0]), b = r0 > 0.0 ? ((double)hi - 2.0 * m1) / r0 : 0.0;
    return 2e-6 * r0 + 1e-6 * r0 / fmax(b, 1e-3) + 1e-43;
}

/* Whether the moments are a light's, by a clear margin. */
static int is_light(int order, const float *c) {
    float dir[3];
    const float r0 = c[SH_R0];
    if (!(r0 > 1e-30f && r0 < 1e18f))
        return 0;
    return order == SH_L1 ? sh_average_direction(c, dir) <= r0 : sh_ambient_floor(c) >= 0.0f;
}

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3);
    float c[9], n[3], opposite[3], lo, hi;
    sh_closure prepared[2];
    fuzz_coefficients(in, c);
    fuzz_direction(in, n);
    for (int i = 0; i < 3; i++)
        opposite[i] = -n[i];
    float *sets = fuzz_place_floats(0, (size_t)SH_COUNT(order), 0);
    memcpy(sets, c, (size_t)SH_COUNT(order) * sizeof *c);

    sh_irradiance_bounds(order, sets, n, &lo, &hi);
    const float direct = sh_irradiance_closure(order, sets, n);
    sh_closure_prepare(order, 1, sets, 0, prepared);
    sh_closure_prepare(order, 1, sets, SH_AMBIENT_FLOOR, prepared + 1);
    const float again = sh_closure_irradiance(order, prepared, n), floor = sh_closure_irradiance(order, prepared + 1, n);
    const float result[5] = { direct, again, floor, lo, hi };
    FUZZ_CHECK(fuzz_all_finite(result, 5));
    FUZZ_CHECK(direct >= 0.0f && floor >= 0.0f && lo <= hi);
    FUZZ_CHECK(fabs((double)direct - (double)again) <= 1e-6 * (double)direct + 1e-43);
    if (order == SH_L0 || !is_light(order, c))
        return;
    const double slack = tolerance(c, n, hi);
    FUZZ_CHECK((double)direct >= (double)lo - slack && (double)direct <= (double)hi + slack);
    FUZZ_CHECK((double)floor >= (double)lo - slack && (double)floor <= (double)hi + slack);
    const double odd = 4.0 * ((double)c[SH_X] * (double)n[0] + (double)c[SH_Y] * (double)n[1] + (double)c[SH_Z] * (double)n[2]);
    const double there = (double)sh_irradiance_closure(order, sets, opposite);
    FUZZ_CHECK(fabs((double)direct - there - odd) <= 2.0 * slack);
    FUZZ_CHECK(fabs((double)sh_irradiance_opposite(order, sets, n, direct) - there) <= 2.0 * slack + 1e-6 * fabs(odd));
}
