/* Conversions: there and back to 4 ulp of the largest coefficient of a band, also in place; the shader's form and Unity's are the same
 * irradiance; nothing touched outside the arrays. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void near_by_band(int order, const float *a, const float *b) {
    for (int band = 0; band <= order; band++) {
        const int first = band * band, count = 2 * band + 1;
        const double tolerance = 4.0 * (double)FLT_EPSILON * (double)fuzz_largest(b + first, count) + 1e-44;
        for (int i = first; i < first + count; i++)
            FUZZ_CHECK(fabs((double)a[i] - (double)b[i]) <= tolerance);
    }
}

static void shader(const float *c, const float n[3], int at_start) {
    float *s = fuzz_place_floats(2, 28, at_start);
    const double x = (double)n[0], y = (double)n[1], z = (double)n[2];
    const double p[4] = { x, y, z, 1.0 }, q[4] = { x * y, y * z, z * z, z * x };
    sh_pack_shader(c, s);
    for (int k = 0; k < 3; k++) {
        double e = (double)s[24 + k] * (x * x - y * y);
        for (int i = 0; i < 4; i++)
            e += (double)s[4 * k + i] * p[i] + (double)s[12 + 4 * k + i] * q[i];
        FUZZ_CHECK(fabs(e - (double)sh_irradiance(SH_L2, c + 9 * k, n)) <= 4e-6 * (double)fuzz_largest(c + 9 * k, 9) + 1e-43);
    }
}

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3), at_start = fuzz_below(in, 2), phase = fuzz_below(in, 2), in_place = fuzz_below(in, 2);
    const size_t set = (size_t)SH_COUNT(order);
    float c[27], n[3], back[27];
    for (int k = 0; k < 3; k++)
        fuzz_coefficients(in, c + 9 * k);
    fuzz_direction(in, n);

    float *from = fuzz_place_floats(0, set, at_start), *to = in_place ? from : fuzz_place_floats(1, set, at_start);
    memcpy(from, c, set * sizeof *c);
    sh_to_orthonormal(order, from, phase, to);
    sh_from_orthonormal(order, to, phase, to);
    near_by_band(order, to, c);
    memcpy(from, c, set * sizeof *c);
    sh_to_unity(order, from, to);
    sh_from_unity(order, to, to);
    near_by_band(order, to, c);

    if (order == SH_L2) {
        memcpy(from, c, set * sizeof *c);
        sh_to_babylon(from, to);
        sh_from_babylon(to, to);
        const double most = (double)fuzz_largest(c, 9); /* R0 and R2 share Babylon's squares */
        for (size_t i = 0; i < set; i++)
            FUZZ_CHECK(fabs((double)to[i] - (double)c[i]) <= 1e-6 * most + 1e-44);
    }
    float *sets = fuzz_place_floats(3, 3 * set, at_start), *side = fuzz_place_floats(4, 3 * set, at_start);
    for (size_t k = 0; k < 3; k++)
        memcpy(sets + k * set, c + 9 * k, set * sizeof *c);
    sh_interleave(order, 3, sets, side);
    sh_deinterleave(order, 3, side, back);
    FUZZ_CHECK(memcmp(sets, back, 3 * set * sizeof *sets) == 0);
    const int lower = fuzz_below(in, order + 1);
    sh_truncate(order, 3, sets, lower, sets);
    for (int k = 0; k < 3; k++)
        FUZZ_CHECK(memcmp(sets + k * SH_COUNT(lower), c + 9 * k, (size_t)SH_COUNT(lower) * sizeof *c) == 0);
    float *three = fuzz_place_floats(5, 27, at_start);
    memcpy(three, c, sizeof c);
    shader(three, n, at_start);
}
