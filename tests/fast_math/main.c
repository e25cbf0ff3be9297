/* What holds where sh.h was compiled with -ffast-math (unit.c): results as golden values have them, to 1e-6; a texel that is not
 * finite is left out and counted, whatever its format and place; values whose sum overflows are projected. This file is compiled
 * without, since such a compiler may take any comparison with NaN for true. */
#include "unit.h"

#include "../test.h"

static void golden_values(void) {
    static golden_case actual[GOLDEN_CASES];
    golden_compute();
    EQUAL(unit_golden(actual), golden_count);
    for (int i = 0; i < golden_count; i++) {
        double largest = 0.0;
        test_section("%s", golden[i].name);
        for (int j = 0; j < golden[i].count; j++)
            largest = fmax(largest, fabs((double)golden[i].value[j]));
        NEAR_ALL(actual[i].value, golden[i].value, golden[i].count, 2e-6 * largest);
    }
}

enum { SIZE = 13 };

static void compare(int kind, const sh_image *image, const sh_image *clean, uint64_t nonfinite) {
    static const unsigned flags[] = { 0, SH_CLAMP_NEGATIVE };
    for (int f = 0; f < 2; f++) {
        float actual[3 * SH_COUNT(SH_L2)], expected[3 * SH_COUNT(SH_L2)], most = 0.0f;
        sh_report report = { 0, 0, 0 }, unreported = report;
        EQUAL(unit_project(kind, image, flags[f], actual, &report), SH_OK);
        const sh_image face[6] = { *clean, *clean, *clean, *clean, *clean, *clean };
        EQUAL(kind == 0   ? sh_project_equirect(SH_L2, clean, flags[f], expected, &unreported)
              : kind == 1 ? sh_project_cubemap(SH_L2, face, flags[f], expected, &unreported)
                          : sh_project_octahedral(SH_L2, clean, flags[f], expected, &unreported),
              SH_OK);
        EQUAL(report.nonfinite, nonfinite * (kind == 1 ? 6 : 1));
        EQUAL(report.negative, unreported.negative);
        for (int i = 0; i < 3 * SH_COUNT(SH_L2); i++)
            most = fabsf(expected[i]) > most ? fabsf(expected[i]) : most;
        NEAR_ALL(actual, expected, 3 * SH_COUNT(SH_L2), 1e-6L * (long double)most);
    }
}

/* One bad channel of one texel of floats, and of halves. */
static void bad_texels(void) {
    static const uint32_t words[] = { 0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00001u, 0x7f800001u, 0x7fffffffu };
    static const uint16_t halves[] = { 0x7c00u, 0xfc00u, 0x7e00u, 0xfe01u, 0x7c01u, 0x7fffu };
    for (int repeat = 0; repeat < 180; repeat++) {
        float f32[2][SIZE * SIZE * 3];
        uint16_t f16[2][SIZE * SIZE * 3];
        const int kind = repeat % 3, at = test_below(SIZE * SIZE), channel = test_below(3), bad = repeat / 3 % 6;
        for (int i = 0; i < SIZE * SIZE * 3; i++) {
            f16[0][i] = f16[1][i] = (uint16_t)(0x3000 + test_below(0x1000) + (test_below(8) == 0 ? 0x8000 : 0));
            f32[0][i] = f32[1][i] = (float)test_uniform(-0.25, 2.0);
        }
        for (int k = 0; k < 3; k++) {
            f16[1][3 * at + k] = 0;
            f32[1][3 * at + k] = 0.0f;
        }
        f16[0][3 * at + channel] = halves[bad];
        memcpy(&f32[0][3 * at + channel], &words[bad], sizeof words[bad]);
        test_section("kind %d, texel %d, channel %d, %08lx", kind, at, channel, (unsigned long)words[bad]);
        const sh_image floats[2] = { { f32[0], SIZE, SIZE, 0, 3, SH_F32 }, { f32[1], SIZE, SIZE, 0, 3, SH_F32 } };
        const sh_image shorts[2] = { { f16[0], SIZE, SIZE, 0, 3, SH_F16 }, { f16[1], SIZE, SIZE, 0, 3, SH_F16 } };
        compare(kind, &floats[0], &floats[1], 1);
        compare(kind, &shorts[0], &shorts[1], 1);
    }
}

/* Finite, but not their sums. */
static void overflow(void) {
    float f32[SIZE * SIZE * 3];
    const sh_image image = { f32, SIZE, SIZE, 0, 3, SH_F32 };
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        f32[i] = (float)test_uniform(1e37, 3e38);
    for (int kind = 0; kind < 3; kind++) {
        test_section("kind %d, overflow", kind);
        compare(kind, &image, &image, 0);
    }
}

static void run_tests(void) {
    golden_values();
    bad_texels();
    overflow();
}
