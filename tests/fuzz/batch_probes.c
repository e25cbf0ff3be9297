/* One probe and one normal per item, every backend: nothing touched outside the arrays; position and count do not matter; the scalar
 * function's result to rounding. The output may be x, y or z. */
#include "batch.h"

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    const int order = fuzz_below(in, 3);
    const unsigned how = fuzz_byte(in), wild = how & 2u, alias = how >> 2 & 3u;
    const int at_start = how & 1u;
    const size_t set = (size_t)SH_COUNT(order), channels = 1 + (size_t)fuzz_below(in, 5), count = fuzz_count(in, 600);

    float *c = fuzz_place_floats(0, channels * set * count, at_start), *v[4];
    for (int i = 0; i < 4; i++)
        v[i] = fuzz_place_floats(1 + i, i == 3 || i + 1 == (int)alias ? channels * count : count, at_start);
    float *out = alias ? v[alias - 1] : v[3];
    fuzz_fill_directions(in, v[0], v[1], v[2], count);
    uint64_t state = fuzz_byte(in);
    for (size_t i = 0; i < channels * set * count; i++)
        c[i] = fuzz_uniform(&state);
    const size_t at = count ? fuzz_byte(in) * 29u % count : 0, k = fuzz_byte(in) % channels;
    if (!count) {
        backend->probes(order, (int)channels, c, v[0], v[1], v[2], out, count);
        return;
    }
    float ck[9], n[3], alone;
    fuzz_coefficients(in, ck);
    if (wild)
        ck[fuzz_below(in, 9)] = fuzz_float(in);
    memcpy(c + (at * channels + k) * set, ck, set * sizeof *c);
    for (int i = 0; i < 3; i++) {
        if (wild)
            v[i][at] = fuzz_float(in);
        n[i] = v[i][at];
    }
    backend->probes(order, (int)channels, c, v[0], v[1], v[2], out, count);
    backend->probes(order, 1, ck, n, n + 1, n + 2, &alone, 1);
    FUZZ_CHECK(fuzz_same(out[k * count + at], alone));
    if (!wild)
        FUZZ_CHECK(fabs((double)alone - (double)sh_irradiance(order, ck, n)) <= batch_tolerance(FUZZ_IRRADIANCE, order, ck, n));
}
