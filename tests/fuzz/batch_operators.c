/* Batches of rotations and products, every backend: nothing touched outside the arrays, also where the output is an input; the scalar
 * operator's results to rounding. */
#include "backend.h"
#include "fuzz.h"

static void rotate(fuzz_input *in, const fuzz_backend *backend, int order, size_t count, int at_start, int in_place) {
    const size_t set = (size_t)SH_COUNT(order), total = set * count;
    float q[4], *m = fuzz_place_floats(0, 9, at_start), *c = fuzz_place_floats(1, total, at_start);
    float *out = in_place ? c : fuzz_place_floats(2, total, at_start);
    for (int i = 0; i < 4; i++)
        q[i] = fuzz_finite(in);
    sh_rotation_from_quaternion(q, m);
    fuzz_fill(in, c, total);
    const size_t at = count ? fuzz_byte(in) % count : 0;
    float one[9] = { 0 }, turned[9];
    if (count)
        memcpy(one, c + at * set, set * sizeof *c);
    backend->rotate_batch(order, c, m, out, count);
    if (!count || !(fuzz_largest(one, (int)set) <= 1e18f) || !fuzz_all_finite(one, set))
        return;
    sh_rotate(order, one, m, turned);
    const double tolerance = 8e-7 * sqrt((double)sh_dot(order, one, one)) + 1e-36 * (double)fuzz_largest(one, (int)set) + 1e-43;
    for (size_t i = 0; i < set; i++)
        FUZZ_CHECK(fabs((double)out[at * set + i] - (double)turned[i]) <= tolerance);
}

static void product(fuzz_input *in, const fuzz_backend *backend, int order, size_t count, int at_start, int alias) {
    const size_t set = (size_t)SH_COUNT(order), total = set * count;
    float *p[3];
    for (int i = 0; i < 3; i++)
        p[i] = fuzz_place_floats(i, total, at_start);
    float *a = p[0], *b = alias == 3 ? a : p[1], *out = alias == 0 ? p[2] : p[alias == 2];
    fuzz_fill(in, a, total);
    fuzz_fill(in, b, total);
    const size_t at = count ? fuzz_byte(in) % count : 0;
    float one[2][9] = { { 0 } }, expected[9];
    for (size_t i = 0; i < set && count; i++) {
        one[0][i] = a[i * count + at];
        one[1][i] = b[i * count + at];
    }
    if (alias == 3)
        out = a;
    backend->product_batch(order, a, b, out, count);
    const float most_a = fuzz_largest(one[0], (int)set), most_b = fuzz_largest(one[1], (int)set);
    if (!count || !(most_a <= 1e17f && most_b <= 1e17f) || !fuzz_all_finite(one[0], set) || !fuzz_all_finite(one[1], set))
        return;
    sh_product(order, one[0], one[1], expected);
    const double aa = (double)sh_dot(order, one[0], one[0]), bb = (double)sh_dot(order, one[1], one[1]);
    const double tolerance = 2e-6 * sqrt(aa * bb) + 1e-36 * (double)(most_a + most_b) + 1e-42; /* underflow of a factor's square */
    for (size_t i = 0; i < set; i++)
        FUZZ_CHECK(fabs((double)out[i * count + at] - (double)expected[i]) <= tolerance);
}

/* A light on the last set of an array: its neighbours are not touched. */
static void add(fuzz_input *in, const fuzz_backend *backend, int order, size_t channels, int at_start) {
    const size_t set = (size_t)SH_COUNT(order);
    float *c = fuzz_place_floats(0, channels * set, at_start), *value = fuzz_place_floats(1, channels, at_start);
    float *dir = fuzz_place_floats(2, 3, at_start), expected[9] = { 0 };
    fuzz_direction(in, dir);
    fuzz_fill(in, value, channels);
    memset(c, 0, channels * set * sizeof *c);
    backend->add_directional(order, (int)channels, dir, value, c);
    for (size_t k = 0; k < channels; k++) {
        memset(expected, 0, sizeof expected);
        sh_add_sample(order, dir, 0.25f * value[k], expected);
        const double most = fabs((double)value[k]);
        for (size_t i = 0; i < set && most <= 1e18; i++)
            FUZZ_CHECK(fabs((double)c[k * set + i] - (double)expected[i]) <= 3e-7 * most + 1e-43);
    }
}

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    const int order = fuzz_below(in, 3), at_start = fuzz_below(in, 2), alias = fuzz_below(in, 4);
    const size_t count = fuzz_count(in, 300);
    switch (fuzz_below(in, 3)) {
    case 0:
        rotate(in, backend, order, count, at_start, alias & 1);
        break;
    case 1:
        product(in, backend, order, count, at_start, alias);
        break;
    default:
        add(in, backend, order, 1 + count % 20, at_start);
        break;
    }
}
