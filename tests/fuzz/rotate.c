/* Rotations: any quaternion makes an orthogonal matrix; a set turned there and back is itself; what came from d comes from m d; axes
 * swapped are turned. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void transpose(const float m[9], float out[9]) {
    for (int i = 0; i < 9; i++)
        out[i] = m[i % 3 * 3 + i / 3];
}

static void near(const float *a, const float *b, int count, double tolerance) {
    for (int i = 0; i < count; i++)
        FUZZ_CHECK(fabs((double)a[i] - (double)b[i]) <= tolerance);
}

static void fuzz_one(fuzz_input *in) {
    static const int axes[6][3] = { { 1, 2, 3 }, { 1, 3, 2 }, { 2, 1, 3 }, { 2, 3, 1 }, { 3, 1, 2 }, { 3, 2, 1 } };
    const int order = fuzz_below(in, 3), set = SH_COUNT(order);
    float q[4], m[9], back[9], c[9], turned[9], again[9], d[3], md[3];
    for (int i = 0; i < 4; i++)
        q[i] = fuzz_finite(in);
    fuzz_coefficients(in, c);
    fuzz_direction(in, d);
    sh_rotation_from_quaternion(q, m);
    transpose(m, back);
    for (int i = 0; i < 9; i++) {
        double dot = 0.0;
        for (int j = 0; j < 3; j++)
            dot += (double)m[i / 3 * 3 + j] * (double)m[i % 3 * 3 + j];
        FUZZ_CHECK(fabs(dot - (i % 4 == 0)) <= 4e-7);
    }
    const double most = (double)fuzz_largest(c, set), tolerance = 1e-5 * most + 1e-43;
    sh_rotate(order, c, m, turned);
    sh_rotate(order, turned, back, again);
    near(again, c, set, tolerance);
    for (int i = 0; i < 3; i++)
        md[i] =
            (float)((double)m[3 * i] * (double)d[0] + (double)m[3 * i + 1] * (double)d[1] + (double)m[3 * i + 2] * (double)d[2]);
    FUZZ_CHECK(fabs((double)sh_radiance(order, turned, md) - (double)sh_radiance(order, c, d)) <= 5.0 * tolerance);

    int axis[3];
    float swap[9] = { 0 }, swapped[9];
    const unsigned which = fuzz_byte(in);
    for (int i = 0; i < 3; i++) {
        axis[i] = axes[which % 6][i];
        swap[3 * i + axis[i] - 1] = which >> (i + 3) & 1u ? -1.0f : 1.0f;
        axis[i] = which >> (i + 3) & 1u ? -axis[i] : axis[i];
    }
    sh_swap_axes(order, c, axis, swapped);
    sh_rotate(order, c, swap, turned);
    near(swapped, turned, set, tolerance);
    memcpy(again, c, sizeof again);
    sh_rotate(order, again, m, again);
    sh_rotate(order, c, m, turned);
    near(again, turned, set, 0.0);
}
