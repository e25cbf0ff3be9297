/* Storage: shader constants, halves, 8 and 10 bits. */
#include "sh.h"
#include "test.h"

/* Sets that light can have, up to the boundary: 1 to 3 directions, with or without ambient light. */
static void random_light(int order, int kind, double scale, float *c) {
    for (int i = 0; i < SH_COUNT(order); i++)
        c[i] = 0.0f;
    for (int i = 0; i <= kind % 3; i++) {
        float dir[3];
        test_direction(dir);
        if (kind >= 3 && kind < 6) { /* an axis, or the diagonal of two */
            const int first = test_below(3), second = test_below(3);
            for (int k = 0; k < 3; k++)
                dir[k] = k != first && k != second ? 0.0f : first == second ? 1.0f : sqrtf(0.5f);
        }
        sh_add_sample(order, dir, (float)(scale * test_uniform(0.1, 1.0)), c);
    }
    if (kind >= 6)
        c[0] += (float)(scale * test_uniform(0.0, 1.0));
}

/* The smallest eigenvalue of the scaled moment matrix [[R0, sqrt3 R1'], [sqrt3 R1, R0 I + 3 R2]] over R0, by Jacobi rotations. */
static double floor_of(int order, const float *c) {
    const double r0 = (double)c[0];
    if (!(r0 > 0.0) || order == SH_L0)
        return r0 < 0.0 ? -1.0 : 0.0;
    if (order == SH_L1)
        return 1.0 - sqrt((double)c[1] * (double)c[1] + (double)c[2] * (double)c[2] + (double)c[3] * (double)c[3]) / r0;
    double m[4][4] = { { 1.0 } };
    static const int second[3][3] = { { SH_XX, SH_XY, SH_XZ }, { SH_XY, SH_YY, SH_YZ }, { SH_XZ, SH_YZ, SH_YZ } };
    for (int i = 0; i < 3; i++) {
        m[0][i + 1] = m[i + 1][0] = sqrt(3.0) * (double)c[SH_X + i] / r0;
        for (int j = 0; j < 3; j++) {
            const double r2 = i == 2 && j == 2 ? -((double)c[SH_XX] + (double)c[SH_YY]) : (double)c[second[i][j]];
            m[i + 1][j + 1] = (i == j) + 3.0 * r2 / r0;
        }
    }
    for (int sweep = 0; sweep < 20; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++) {
                const double angle = 0.5 * atan2(2.0 * m[p][q], m[p][p] - m[q][q]), cosine = cos(angle), sine = sin(angle);
                for (int k = 0; k < 4; k++) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = cosine * a + sine * b;
                    m[k][q] = cosine * b - sine * a;
                }
                for (int k = 0; k < 4; k++) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = cosine * a + sine * b;
                    m[q][k] = cosine * b - sine * a;
                }
            }
    double least = m[0][0];
    for (int i = 1; i < 4; i++)
        least = fmin(least, m[i][i]);
    return least;
}

/* The largest error of irradiance / pi over some directions, over R0. */
static double irradiance_error(int order, const float *c, const float *decoded) {
    float difference[9];
    double most = 0.0;
    for (int i = 0; i < SH_COUNT(order); i++)
        difference[i] = decoded[i] - c[i];
    for (int i = 0; i < 40; i++) {
        float n[3];
        test_direction(n);
        most = fmax(most, fabs((double)sh_irradiance(order, difference, n)));
    }
    return most / (double)c[0];
}

/* The shader's line, in C. */
static void shader(void) {
    for (int i = 0; i < 200; i++) {
        float c[27], s[28], n[3];
        test_section("sh_pack_shader");
        test_fill(c, 27, -1.0, 1.0);
        test_direction(n);
        sh_pack_shader(c, s);
        const float p[4] = { n[0], n[1], n[2], 1.0f }, q[4] = { n[0] * n[1], n[1] * n[2], n[2] * n[2], n[2] * n[0] };
        for (int k = 0; k < 3; k++) {
            float e = s[24 + k] * (n[0] * n[0] - n[1] * n[1]);
            for (int j = 0; j < 4; j++)
                e += s[4 * k + j] * p[j] + s[12 + 4 * k + j] * q[j];
            NEAR(e, sh_irradiance(SH_L2, c + 9 * k, n), 3e-6);
        }
        NEAR(s[27], 1, 0);
        float in_place[28] = { 0 };
        memcpy(in_place, c, sizeof c);
        sh_pack_shader(in_place, in_place);
        SAME_BITS(in_place, s, sizeof s);
    }
}

static void halves(void) {
    static const double scales[] = { 1e-40, 1e-30, 1e-5, 1.0, 7e4, 1e18, 1e38 };
    for (int i = 0; i < 12000; i++) {
        const int order = i % 3, channels = 1 + i % 4, count = SH_COUNT(order), raised = i % 9 < 6;
        const double scale = scales[i % 7];
        float c[36], decoded[36];
        uint16_t half[38] = { 0 };
        test_section("halves, order %d, %d channels, scale %g", order, channels, scale);
        for (int k = 0; k < channels; k++)
            random_light(order, i % 9, scale * (k == 1 ? 0.01 : 0.5), c + k * count);
        half[channels * count + 1] = 0x1234;
        sh_pack_half(order, channels, c, half);
        EQUAL(half[channels * count + 1], 0x1234);
        sh_unpack_half(order, channels, half, decoded);
        for (int k = 0; k < channels; k++) {
            const double error = scale < 1e-38 ? 0.0 : irradiance_error(order, c + k * count, decoded + k * count);
            CHECK(decoded[k * count] < 3e38f);
            if (scale >= 1e-30) {
                CHECK(floor_of(order, decoded + k * count) > -3e-7);
                CHECK(error < (raised ? 0.007 : 0.003));
            }
        }
    }
    /* Sets that light cannot have: to the nearest half. */
    for (int i = 0; i < 200; i++) {
        float c[9], decoded[9];
        uint16_t half[10];
        test_section("halves of any set");
        test_fill(c, 9, -1.0, 1.0);
        c[0] *= 0.1f;
        sh_pack_half(SH_L2, 1, c, half);
        sh_unpack_half(SH_L2, 1, half, decoded);
        for (int k = 0; k < 9; k++)
            NEAR(decoded[k], c[k], 1.01 / 2048.0 * fabs((double)c[k]) + 1e-9);
    }
    float black[9] = { 0 }, decoded[9] = { 1 };
    uint16_t half[10];
    sh_pack_half(SH_L2, 1, black, half);
    sh_unpack_half(SH_L2, 1, half, decoded);
    NEAR_ALL(decoded, black, 9, 0);
    /* Exponents that packing does not make: too small or too large, and of the number's own sign. */
    test_section("halves with any exponent");
    static const uint16_t exponents[6] = { 0x7fff, 0x7000, 0x0400, 0xfc00, 0x8800, 0x8000 };
    for (int i = 0; i < 6; i++) {
        uint16_t hostile[10] = { 0x3c00, 0xbc00 };
        hostile[9] = exponents[i];
        sh_unpack_half(SH_L2, 1, hostile, decoded);
        CHECK(i < 3 ? isinf(decoded[0]) && isinf(decoded[1]) : decoded[0] == 0.0f && decoded[1] == 0.0f);
        CHECK(decoded[0] >= 0.0f && decoded[1] <= 0.0f);
    }
}

/* Each finite half decodes to its value, and back to itself. */
static void half_values(void) {
    test_section("half values");
    for (int h = 0; h < 0x7c00; h++) {
        const int e = h >> 10, m = h & 0x3ff;
        const double expected = e ? ldexp(1024 + m, e - 25) : ldexp(m, -24);
        CHECK((double)shi_from_half((uint16_t)h) == expected);
        CHECK((double)shi_from_half((uint16_t)(h | 0x8000)) == -expected);
        CHECK(shi_to_half((float)expected) == h);
        CHECK(shi_to_half((float)-expected) == (h | 0x8000));
        if (h < 0x0800) { /* the nearest, just below and above the middle to the next */
            CHECK(shi_to_half((float)((h + 0.4999) / 16777216.0)) == h);
            CHECK(shi_to_half((float)((h + 0.5001) / 16777216.0)) == h + 1);
        }
    }
    test_section("between halves");
    for (int h = 0; h < 0x7bff; h++) {
        const float middle = 0.5f * (shi_from_half((uint16_t)h) + shi_from_half((uint16_t)(h + 1)));
        CHECK(shi_to_half(nextafterf(middle, 0.0f)) == h);
        CHECK(shi_to_half(middle) == h + h % 2);
        CHECK(shi_to_half(nextafterf(middle, 1e9f)) == h + 1);
    }
}

static void pack(int bits, int order, int channels, const float *c, float *r0, float *out) {
    if (bits == 8) {
        uint8_t code[33];
        memset(code, 0xee, sizeof code);
        sh_pack_unorm8(order, channels, c, r0, code);
        EQUAL(code[channels * (SH_COUNT(order) - 1)], 0xee);
        sh_unpack_unorm8(order, channels, r0, code, out);
    } else {
        uint32_t code[13];
        memset(code, 0xee, sizeof code);
        sh_pack_unorm10(order, channels, c, r0, code);
        EQUAL(code[channels * ((SH_COUNT(order) + 1) / 3)], 0xeeeeeeeeu);
        sh_unpack_unorm10(order, channels, r0, code, out);
    }
}

static void ratios(int bits) {
    static const double scales[] = { 1e-30, 1.0, 1e18 };
    for (int i = 0; i < 12000; i++) {
        const int order = i % 3, channels = 1 + i % 4, count = SH_COUNT(order), kind = i % 9;
        float c[36], decoded[36], r0[5] = { 0, 0, 0, 0, 7 };
        test_section("%d bits, order %d, %d channels, kind %d", bits, order, channels, kind);
        for (int k = 0; k < channels; k++)
            random_light(order, kind, scales[i % 5 % 3], c + k * count);
        pack(bits, order, channels, c, r0, decoded);
        for (int k = 0; k < channels; k++) {
            const float *ck = c + k * count, *dk = decoded + k * count;
            const double error = irradiance_error(order, ck, dk), least = floor_of(order, ck);
            CHECK(dk[0] == ck[0]);
            CHECK(floor_of(order, dk) > -3e-7);
            if (least > 0.1)
                CHECK(error < (bits == 8 ? 0.024 : 0.006));
            else
                CHECK(error < (bits == 8 ? 0.12 : 0.03));
        }
    }
    /* Ambient light is exact; black and less keep R0; what light cannot have is clamped to its range. */
    float c[9] = { 3 }, decoded[9], r0;
    pack(bits, SH_L2, 1, c, &r0, decoded);
    NEAR_ALL(decoded, c, 9, 0);
    c[0] = -1.0f;
    c[3] = 5.0f;
    pack(bits, SH_L2, 1, c, &r0, decoded);
    NEAR(decoded[0], -1, 0);
    NEAR(decoded[3], 0, 0);
    c[0] = 1.0f;
    c[SH_XX] = -9.0f;
    c[SH_YZ] = 1e18f;
    pack(bits, SH_L2, 1, c, &r0, decoded);
    NEAR(decoded[3], 1, 1e-7);
    NEAR(decoded[SH_XX], -1.0 / 3.0, 1e-7);
    NEAR(decoded[SH_YZ], 0.5, 1e-7);
}

static void run_tests(void) {
    shader();
    half_values();
    halves();
    ratios(8);
    ratios(10);
}
