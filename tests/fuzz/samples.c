/* Projection of samples, every backend: nothing touched outside the arrays, whatever they hold; finite samples give the plain sum in
 * double; bad arguments give an error and write nothing. */
#include "backend.h"
#include "fuzz.h"

static void bad_arguments(fuzz_input *in, const fuzz_backend *backend) {
    float x[4] = { 0 }, c[36];
    sh_accum accum;
    memset(c, FUZZ_CANARY, sizeof c);
    memset(&accum, FUZZ_CANARY, sizeof accum);
    const sh_accum accum_before = accum;
    const unsigned null = fuzz_byte(in);
    const int order = null & 1u ? 3 + (fuzz_int(in) & 0x7fffff) : null & 2u ? -1 - (fuzz_int(in) & 0x7fffff) : fuzz_below(in, 3);
    const int channels = null & 4u ? -(fuzz_int(in) & 0x7fffff) : 1;
    if (!(null & 7u) && !(null & 0x78u))
        return;
    const float *px = null & 8u ? NULL : x, *py = null & 16u ? NULL : x, *pz = null & 32u ? NULL : x,
                *value = null & 64u ? NULL : x;
    FUZZ_CHECK(backend->project_samples(order, channels, px, py, pz, value, NULL, 4, c) == SH_ERROR_ARGUMENT);
    FUZZ_CHECK(backend->accum_samples(order, channels, px, py, pz, value, NULL, 4, &accum) == SH_ERROR_ARGUMENT);
    for (size_t i = 0; i < sizeof c; i++)
        FUZZ_CHECK(((const unsigned char *)c)[i] == FUZZ_CANARY);
    FUZZ_CHECK(memcmp(&accum, &accum_before, sizeof accum) == 0);
}

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    const unsigned how = fuzz_byte(in), weighted = how & 2u, wild = how & 4u;
    const int at_start = how & 1u, order = fuzz_below(in, 3);
    if (how >= 250) {
        bad_arguments(in, backend);
        return;
    }
    const size_t channels = 1 + (size_t)fuzz_below(in, 4), count = fuzz_count(in, 5000), set = (size_t)SH_COUNT(order);
    float *v[3], *value = fuzz_place_floats(3, channels * count, at_start);
    float *weight = weighted ? fuzz_place_floats(4, count, at_start) : NULL, *c = fuzz_place_floats(5, channels * set, at_start);
    for (int i = 0; i < 3; i++)
        v[i] = fuzz_place_floats(i, count, at_start);
    fuzz_fill_directions(in, v[0], v[1], v[2], count);
    fuzz_fill(in, value, channels * count);
    if (weighted)
        fuzz_fill(in, weight, count);
    for (size_t i = 0; i < count && weighted; i++)
        weight[i] = fabsf(weight[i]);
    if (wild && count)
        v[how % 3][fuzz_byte(in) % count] = fuzz_float(in);
    FUZZ_CHECK(backend->project_samples(order, (int)channels, v[0], v[1], v[2], value, weight, count, c) == SH_OK);

    const size_t k = fuzz_byte(in) % channels;
    double sum[9] = { 0 }, total = 0.0, absolute = 0.0;
    for (size_t i = 0; i < count; i++) {
        float dir[3] = { v[0][i], v[1][i], v[2][i] }, basis[9] = { 0 };
        const double w = weighted ? (double)weight[i] : 1.0, f = (double)value[k * count + i];
        sh_basis(order, dir, basis);
        total += w;
        absolute += w * fabs(f);
        for (size_t j = 0; j < set; j++)
            sum[j] += w * f * (double)basis[j];
    }
    if (wild || !(absolute < 1e30) || !(total < 1e30))
        return;
    const double underflow = 1e-43 + (total > 0.0 ? 2e-45 * (double)count / total : 0.0); /* of weight times value */
    for (size_t j = 0; j < set; j++)
        FUZZ_CHECK(total == 0.0 ? c[k * set + j] == 0.0f
                                : fabs((double)c[k * set + j] - sum[j] / total) <= 1e-6 * absolute / total + underflow);
}
