/* Planar batches of every backend: nothing read or written outside the arrays, whatever they hold; a result does not depend on its
 * position or on the count; on unit normals it is the scalar function's to rounding. The output may be x, y or z. */
#include "batch.h"

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    const int model = fuzz_below(in, FUZZ_MODELS), l1_only = model == FUZZ_GEOMERICS || model == FUZZ_ZH3;
    const int order = l1_only ? 1 + fuzz_below(in, 2) : fuzz_below(in, 3), set = SH_COUNT(order);
    const unsigned how = fuzz_byte(in), at_start = how & 1u, wild = how & 2u, alias = how >> 2 & 3u;
    const size_t channels = fuzz_count(in, 6) == 6 ? FUZZ_MAX_CHANNELS : 1 + (size_t)fuzz_below(in, 4);
    const size_t count = fuzz_count(in, 2500), total = channels * count;

    float *c = fuzz_place_floats(0, channels * (size_t)set, (int)at_start), *v[4];
    for (int i = 0; i < 4; i++)
        v[i] = fuzz_place_floats(1 + i, i == 3 || i + 1 == (int)alias ? total : count, (int)at_start);
    float *out = alias ? v[alias - 1] : v[3];
    for (size_t k = 0; k < channels; k++) {
        float whole[9];
        fuzz_coefficients(in, whole);
        memcpy(c + k * (size_t)set, whole, (size_t)set * sizeof *c);
    }
    fuzz_fill_directions(in, v[0], v[1], v[2], count);
    if (wild) {
        fuzz_fill(in, v[fuzz_below(in, 3)], count);
        c[fuzz_byte(in) % (channels * (size_t)set)] = fuzz_float(in);
    }

    /* One normal, before the output may overwrite it. */
    const size_t at = count ? fuzz_byte(in) * 29u % count : 0, k = fuzz_byte(in) % channels;
    const float *ck = c + k * (size_t)set;
    float n[3], alone = 0.0f;
    for (int i = 0; i < 3 && count; i++)
        n[i] = v[i][at];
    backend->soa[model](order, (int)channels, c, v[0], v[1], v[2], out, count);
    if (!count)
        return;
    backend->soa[model](order, 1, ck, n, n + 1, n + 2, &alone, 1);
    FUZZ_CHECK(fuzz_same(out[k * count + at], alone));
    if (wild)
        return;
    const double tolerance = batch_tolerance(model, order, ck, n);
    FUZZ_CHECK(tolerance < 0.0 || fabs((double)alone - (double)batch_scalar(model, order, ck, n)) <= tolerance);
    FUZZ_CHECK(model < FUZZ_CLOSURE || alone >= 0.0f);
}
