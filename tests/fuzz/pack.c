/* Storage: nothing touched outside the arrays; a round trip is within its bounds; a set that light can have stays one; whatever the
 * stored bits are, they decode to finite numbers. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

enum { CHANNELS = 3 };

/* R0 > 0, no moments beyond a light's by more than half the slack that packing allows. */
static int is_light(int order, const float *c) {
    float dir[3];
    if (!(c[SH_R0] > 1e-30f))
        return 0;
    return order == SH_L0 || (order == SH_L1 ? c[SH_R0] - sh_average_direction(c, dir) : sh_ambient_floor(c)) >= -1e-6f * c[SH_R0];
}

static void check_channel(int order, const float *c, const float *back, double error, double error_shrunk, const float n[3]) {
    if (!is_light(order, c) || c[SH_R0] > 1e30f)
        return;
    const double r0 = (double)c[SH_R0], slack = 4e-6 * r0;
    float dir[3];
    FUZZ_CHECK(order == SH_L0 || (order == SH_L1 ? (double)back[SH_R0] - (double)sh_average_direction(back, dir)
                                                 : (double)sh_ambient_floor(back)) >= -slack);
    (void)error;
    FUZZ_CHECK(fabs((double)sh_irradiance(order, back, n) - (double)sh_irradiance(order, c, n)) <= error_shrunk * r0 + 1e-6 * r0);
}

static void half(int order, int channels, const float *c, const float n[3], int at_start) {
    const size_t set = (size_t)SH_COUNT(order), count = set * (size_t)channels;
    uint16_t *packed = (uint16_t *)(void *)fuzz_place(1, (count + 1) * sizeof *packed, at_start);
    float *back = fuzz_place_floats(2, count, at_start);
    sh_pack_half(order, channels, c, packed);
    sh_unpack_half(order, channels, packed, back);
    const float most = fuzz_largest(c, (int)count);
    FUZZ_CHECK(fuzz_all_finite(back, count));
    for (size_t i = 0; i < count; i++) {
        const double step = fabs((double)c[i]) / 2048.0 + ldexp((double)most, -38) + 1e-45;
        const double raised = i % set == 0 ? 8.0 * (fabs((double)c[i]) / 1024.0 + ldexp((double)most, -38)) : 0.0;
        FUZZ_CHECK((double)back[i] - (double)c[i] <= step + raised && (double)back[i] - (double)c[i] >= -step);
    }
    /* One exponent serves all channels: bounds relative to R0 hold for channels that are not faint beside the brightest. */
    for (int k = 0; k < channels; k++)
        if (c[(size_t)k * set] > most / 16.0f)
            check_channel(order, c + (size_t)k * set, back + (size_t)k * set, 0.003, 0.007, n);
}

static void unorm(int order, int channels, const float *c, const float n[3], int at_start, int ten) {
    const size_t set = (size_t)SH_COUNT(order), count = set * (size_t)channels;
    const size_t words = order == SH_L0 ? 0 : order == SH_L1 ? 1 : 3, size = (ten ? 4 * words : set - 1) * (size_t)channels;
    unsigned char *packed = fuzz_place(1, size, at_start);
    float *back = fuzz_place_floats(2, count, at_start), *r0 = fuzz_place_floats(3, (size_t)channels, at_start);
    void *ratio = packed;
    if (ten) {
        sh_pack_unorm10(order, channels, c, r0, (uint32_t *)ratio);
        sh_unpack_unorm10(order, channels, r0, (const uint32_t *)ratio, back);
    } else {
        sh_pack_unorm8(order, channels, c, r0, (uint8_t *)ratio);
        sh_unpack_unorm8(order, channels, r0, (const uint8_t *)ratio, back);
    }
    FUZZ_CHECK(fuzz_all_finite(back, count));
    for (int k = 0; k < channels; k++) {
        FUZZ_CHECK(back[(size_t)k * set] == c[(size_t)k * set]);
        check_channel(order, c + (size_t)k * set, back + (size_t)k * set, ten ? 0.006 : 0.024, ten ? 0.03 : 0.12, n);
    }
}

/* Bits from anywhere. */
static void decode(fuzz_input *in, int order, int channels, int at_start) {
    const size_t set = (size_t)SH_COUNT(order), count = set * (size_t)channels, words = order == SH_L0 ? 0 : order == SH_L1 ? 1 : 3;
    const size_t halves = (count + 1) * sizeof(uint16_t), tens = 4 * words * (size_t)channels;
    uint16_t *half_bits = (uint16_t *)(void *)fuzz_place(1, halves, at_start);
    uint32_t *ten_bits = (uint32_t *)(void *)fuzz_place(4, tens, at_start);
    float *back = fuzz_place_floats(2, count, at_start), *r0 = fuzz_place_floats(3, (size_t)channels, at_start);
    for (size_t i = 0; i <= count; i++)
        half_bits[i] = (uint16_t)(fuzz_byte(in) << 8 | fuzz_byte(in));
    for (size_t i = 0; i < tens / 4; i++)
        ten_bits[i] = fuzz_word(in);
    for (int k = 0; k < channels; k++)
        r0[k] = fuzz_finite(in);
    sh_unpack_half(order, channels, half_bits, back);
    sh_unpack_unorm10(order, channels, r0, ten_bits, back);
    FUZZ_CHECK(fuzz_all_finite(back, count));
}

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3), channels = 1 + fuzz_below(in, CHANNELS), at_start = fuzz_below(in, 2),
              kind = fuzz_below(in, 4);
    const size_t set = (size_t)SH_COUNT(order);
    float n[3], *c = fuzz_place_floats(0, set * (size_t)channels, at_start);
    if (kind == 3) {
        decode(in, order, channels, at_start);
        return;
    }
    for (int k = 0; k < channels; k++) {
        float whole[9];
        fuzz_coefficients(in, whole);
        memcpy(c + (size_t)k * set, whole, set * sizeof *c);
    }
    fuzz_direction(in, n);
    if (kind == 2)
        half(order, channels, c, n, at_start);
    else
        unorm(order, channels, c, n, at_start, kind);
}
