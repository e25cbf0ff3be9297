/* Interleaved batches of every backend: any stride, any alignment, nothing touched between items; a result does not depend on its
 * position or on the count, and on unit normals is the scalar function's to rounding. */
#include "batch.h"

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    const int model = fuzz_below(in, FUZZ_MODELS), l1_only = model == FUZZ_GEOMERICS || model == FUZZ_ZH3;
    const int order = l1_only ? 1 + fuzz_below(in, 2) : fuzz_below(in, 3), set = SH_COUNT(order);
    const unsigned how = fuzz_byte(in), wild = how & 2u;
    const int at_start = how & 1u, in_place = (how & 12u) == 4u;
    const size_t channels = in_place ? 3 : fuzz_count(in, 6) == 6 ? FUZZ_MAX_CHANNELS : 1 + (size_t)fuzz_below(in, 4);
    const size_t count = fuzz_count(in, 1200), item = channels * sizeof(float);
    const size_t n_stride = fuzz_below(in, 2) ? 12 + (size_t)fuzz_below(in, 40) : 0, n_step = n_stride ? n_stride : 12;
    const size_t out_stride = in_place ? n_stride : fuzz_below(in, 2) ? item + (size_t)fuzz_below(in, 40) : 0;
    const size_t out_step = out_stride ? out_stride : item;

    float *c = fuzz_place_floats(0, channels * (size_t)set, at_start);
    const size_t n_size = count ? (count - 1) * n_step + 12 : 0, out_size = count ? (count - 1) * out_step + item : 0;
    unsigned char *normals = fuzz_place(1, n_size, at_start), *out = in_place ? normals : fuzz_place(2, out_size, at_start);
    for (size_t k = 0; k < channels; k++) {
        float whole[9];
        fuzz_coefficients(in, whole);
        memcpy(c + k * (size_t)set, whole, (size_t)set * sizeof *c);
    }
    if (wild)
        c[fuzz_byte(in) % (channels * (size_t)set)] = fuzz_float(in);
    memset(out, FUZZ_CANARY, out_size);
    memset(normals, FUZZ_CANARY, n_size);
    uint64_t state = fuzz_byte(in);
    for (size_t i = 0; i < count; i++) {
        float unit[3];
        fuzz_random_direction(&state, unit);
        if (wild && i < 3)
            unit[i] = fuzz_float(in);
        memcpy(normals + i * n_step, unit, sizeof unit);
    }

    const size_t at = count ? fuzz_byte(in) * 29u % count : 0, k = fuzz_byte(in) % channels;
    const float *ck = c + k * (size_t)set;
    float n[3], result, alone;
    if (count)
        memcpy(n, normals + at * n_step, sizeof n);
    /* Pointers as they come: a stride that is no multiple of four leaves floats anywhere. */
    const void *from = normals;
    void *to = out;
    backend->aos[model](order, (int)channels, c, (const float *)from, n_stride, (float *)to, out_stride, count);
    if (!count)
        return;
    for (size_t i = 0; i + 1 < count; i++)
        for (size_t j = item; j < out_step; j++)
            FUZZ_CHECK(out[i * out_step + j] == FUZZ_CANARY);
    memcpy(&result, out + at * out_step + k * sizeof(float), sizeof result);
    backend->aos[model](order, 1, ck, n, 0, &alone, 0, 1);
    FUZZ_CHECK(fuzz_same(result, alone));
    if (wild)
        return;
    const double tolerance = batch_tolerance(model, order, ck, n);
    FUZZ_CHECK(tolerance < 0.0 || fabs((double)alone - (double)batch_scalar(model, order, ck, n)) <= tolerance);
}
