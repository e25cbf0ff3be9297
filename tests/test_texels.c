/* Texels one by one: every value of the small formats, and those that are not numbers, negative, huge or tiny. And bad arguments. */
#include <float.h>
#include <limits.h>

#include "images.h"

/* NEON on 32-bit ARM takes subnormal floats for zero, among them 2^(e - 136) of RGBE8, which stands for up to 255 times as much: below
 * these values a texel may read as 0 there. */
static long double flushed_below(sh_format format) {
#if SH_SIMD == SH_SIMD_NEON && !defined(__aarch64__) && !defined(_M_ARM64)
    return format == SH_RGBE8 ? 128.0L * FLT_MIN : FLT_MIN;
#else
    (void)format;
    return 0.0L;
#endif
}

/* An image of one texel is a constant: its R0 is the texel's value. */
static void check_texel(const void *bytes, int channels, sh_format format) {
    const sh_image image = { bytes, 1, 1, 0, channels, format };
    long double value[3] = { 0.0L };
    float c[3] = { 0.0f };
    oracle_texel(&image, 0, 0, value);
    EQUAL(sh_project_equirect(SH_L0, &image, 0, c, NULL), SH_OK);
    for (int k = 0; k < oracle_colours(&image); k++)
        if (fabsl(value[k]) < flushed_below(format) && c[k] == 0.0f)
            CHECK(1);
        else if (value[k] - value[k] == 0.0L)
            NEAR(c[k], value[k], 6e-8L * value[k] + 6e-44L); /* half an ulp; subnormals are rounded where they are summed */
        else
            NEAR(c[k], 0.0, 0);
}

static void every_half(void) {
    for (unsigned bits = 0; bits < 65536; bits++) {
        const uint16_t half = (uint16_t)bits;
        test_section("half %04x", bits);
        check_texel(&half, 1, SH_F16);
    }
}

static void every_byte(void) {
    for (unsigned bits = 0; bits < 256; bits++) {
        const unsigned char byte = (unsigned char)bits, rgb[3] = { byte, (unsigned char)(255u - bits), 0 };
        test_section("sRGB %u", bits);
        check_texel(&byte, 1, SH_SRGB8);
        check_texel(rgb, 3, SH_SRGB8);
    }
}

/* Every exponent, with mantissas at the ends and between. */
static void shared_exponents(void) {
    for (unsigned exponent = 0; exponent < 256; exponent++)
        for (unsigned mantissa = 0; mantissa < 256; mantissa += 15) {
            const unsigned char rgbe[4] = { (unsigned char)mantissa, (unsigned char)(255u - mantissa), 128,
                                            (unsigned char)exponent };
            test_section("RGBE %u, exponent %u", mantissa, exponent);
            check_texel(rgbe, 3, SH_RGBE8);
            check_texel(rgbe, 4, SH_RGBE8);
        }
    for (unsigned exponent = 0; exponent < 32; exponent++)
        for (unsigned mantissa = 0; mantissa < 512; mantissa += 7) {
            const uint32_t word = mantissa | (511u - mantissa) << 9 | 256u << 18 | exponent << 27;
            test_section("RGB9E5 %u, exponent %u", mantissa, exponent);
            check_texel(&word, 3, SH_RGB9E5);
            check_texel(&word, 4, SH_RGB9E5);
        }
}

static test_image random_image(int width, int height, int channels, double low, double high) {
    test_image of = test_image_create(width, height, channels, SH_F32, test_tight);
    test_image_fill(&of, low, high);
    return of;
}

/* Projects with a report, and compares coefficients and counts. */
static void check(const test_image *of, unsigned flags) {
    const oracle_projection expected = oracle_project_equirect(&of->image, flags);
    float c[3 * 9];
    sh_report report = { 9, 9, 9 };
    test_dirty_stack();
    EQUAL(sh_project_equirect(SH_L2, &of->image, flags, c, &report), SH_OK);
    test_projection_near(SH_L2, sh_image_channels(&of->image), c, &expected);
    EQUAL(report.texels, expected.texels);
    EQUAL(report.nonfinite, expected.nonfinite);
    EQUAL(report.negative, expected.negative);

    float again[3 * 9];
    EQUAL(sh_project_equirect(SH_L2, &of->image, flags, again, NULL), SH_OK);
    SAME_BITS(c, again, (size_t)(sh_image_channels(&of->image) * 9) * sizeof(float)); /* a report changes nothing */
}

/* Every kind of bad number, anywhere, in any channel, one or many. */
static void not_finite(void) {
    const float bad[] = { (float)NAN, -(float)NAN, (float)INFINITY, -(float)INFINITY };
    static const int sizes[][2] = { { 1, 1 }, { 7, 3 }, { 16, 8 }, { 130, 9 } };
    for (int i = 0; i < 200; i++) {
        const int width = sizes[i % 4][0], height = sizes[i % 4][1], channels = i % 3 == 0 ? 1 : 2 + i % 3;
        test_image of = random_image(width, height, channels, i % 2 ? -1.0 : 0.0, 1.0);
        const int count = i % 5 == 0 ? width * height * 3 : 1 + test_below(5);
        for (int n = 0; n < count; n++)
            test_image_set(&of, test_below(width), test_below(height), test_below(oracle_colours(&of.image)), bad[test_below(4)]);
        for (unsigned flags = 0; flags < 8; flags++) {
            test_section("%d not finite in %d x %d, %d channels, flags %u", count, width, height, channels, flags);
            if (!(flags & SH_POINT_TEXELS) || (width >= 3 && height >= 3))
                check(&of, flags);
        }
        test_image_free(&of);
    }
}

/* Infinite and NaN halves likewise. */
static void not_finite_halves(void) {
    static const uint16_t bad[] = { 0x7c00, 0xfc00, 0x7e00, 0xfe01, 0x7c01 };
    for (int i = 0; i < 40; i++) {
        const int channels = i % 2 ? 3 : 4;
        test_image of = test_image_create(19, 7, channels, SH_F16, test_tight);
        test_section("halves that are not finite, %d channels", channels);
        test_image_fill(&of, 0.0, 1.0);
        for (int n = 0; n < 4; n++)
            memcpy(test_texel(&of, test_below(19), test_below(7)) + 2 * test_below(3), &bad[test_below(5)], 2);
        check(&of, i % 4 < 2 ? 0 : SH_CLAMP_NEGATIVE);
        test_image_free(&of);
    }
}

/* Nothing but bad texels: black. */
static void nothing_left(void) {
    test_image of = test_image_create(33, 5, 3, SH_F32, test_tight); /* all NaN as it is created */
    float c[3 * 9];
    sh_report report = { 9, 9, 9 };
    test_section("all NaN");
    EQUAL(sh_project_equirect(SH_L2, &of.image, 0, c, &report), SH_OK);
    for (int i = 0; i < 3 * 9; i++)
        NEAR(c[i], 0.0, 0);
    EQUAL(report.nonfinite, 33 * 5);
    EQUAL(report.negative, 0);
    test_image_free(&of);
}

/* Alpha may hold anything at all. */
static void alpha(void) {
    const float values[] = { (float)NAN, (float)INFINITY, -1.0f, 3e38f };
    for (int i = 0; i < 4; i++) {
        test_image of = random_image(21, 6, 4, 0.0, 1.0), opaque = test_image_create(21, 6, 3, SH_F32, test_tight);
        float a[3 * 9], b[3 * 9];
        sh_report report = { 9, 9, 9 };
        test_section("alpha of %g", (double)values[i]);
        for (int n = 0; n < 21 * 6; n++) {
            memcpy(test_texel(&opaque, n % 21, n / 21), test_texel(&of, n % 21, n / 21), 12);
            test_image_set(&of, n % 21, n / 21, 3, values[i]);
        }
        EQUAL(sh_project_equirect(SH_L2, &of.image, 0, a, &report), SH_OK);
        EQUAL(sh_project_equirect(SH_L2, &opaque.image, 0, b, NULL), SH_OK);
        NEAR_ALL(a, b, 3 * 9, test_projection_tolerance); /* twice that of the mean, 1/2 */
        EQUAL(report.nonfinite, 0);
        EQUAL(report.negative, 0);
        test_image_free(&of);
        test_image_free(&opaque);
    }
}

static void negatives(void) {
    for (int i = 0; i < 60; i++) {
        test_image of = random_image(40 + i, 8, i % 2 ? 3 : 1, -1.0, 1.0);
        for (unsigned flags = 0; flags < 8; flags++) {
            test_section("negative texels, flags %u", flags);
            check(&of, flags);
        }
        test_image_free(&of);
    }
    test_section("one negative channel");
    const float one[6] = { 1.0f, -0.5f, 2.0f, 1.0f, 1.0f, 1.0f };
    const sh_image image = { one, 2, 1, 0, 3, SH_F32 };
    float c[3];
    sh_report report = { 9, 9, 9 };
    EQUAL(sh_project_equirect(SH_L0, &image, SH_CLAMP_NEGATIVE, c, &report), SH_OK);
    EQUAL(report.negative, 1);
    NEAR(c[0], 1.0, 0);
    NEAR(c[1], 0.5, 6e-8);
    NEAR(c[2], 1.5, 1.2e-7);
    test_section("minus zero is not negative");
    const float zeros[4] = { -0.0f, 0.0f, -0.0f, -0.0f };
    const sh_image black = { zeros, 2, 2, 0, 1, SH_F32 };
    for (unsigned flags = 0; flags < 2; flags++) {
        EQUAL(sh_project_equirect(SH_L0, &black, flags, c, &report), SH_OK);
        NEAR(c[0], 0.0, 0);
        EQUAL(report.negative, 0);
    }
}

/* From sums that overflow a float, to values that are barely normal: the same relative accuracy. A sun of 3e38 in a sky of 1 too. */
static void magnitudes(void) {
    static const double scales[] = { 3.4e38, 1e38, 1e30, 1e18, 1e-18, 1e-30, 1e-33 };
    for (size_t s = 0; s < sizeof scales / sizeof scales[0]; s++)
        for (int i = 0; i < 12; i++) {
            test_image of = random_image(60 + 5 * i, 11, i % 2 ? 3 : 4, i % 3 ? 0.5 * scales[s] : -scales[s], scales[s]);
            test_section("magnitude %g", scales[s]);
            check(&of, i % 4 == 3 ? SH_CLAMP_NEGATIVE : 0);
            test_image_free(&of);
        }
    for (int i = 0; i < 20; i++) {
        test_image of = random_image(64, 32, 3, 0.0, 1.0);
        test_section("suns of 3e38");
        for (int n = 0; n <= i; n++)
            test_image_set(&of, test_below(64), test_below(32), test_below(3), n % 2 ? 3e38f : FLT_MAX);
        if (i % 3 == 0)
            test_image_set(&of, test_below(64), test_below(32), 0, (float)NAN);
        check(&of, i % 2 ? SH_CLAMP_NEGATIVE : 0);
        test_image_free(&of);
    }
}

/* Everywhere the brightest that a shared exponent has: every map gives that back, although float sums of it overflow. */
static void brightest(void) {
    static unsigned char bytes[64 * 64][4];
    const sh_image wide = { bytes, 64, 32, 0, 3, SH_RGBE8 }, square = { bytes, 64, 64, 0, 3, SH_RGBE8 };
    const sh_image face[6] = { square, square, square, square, square, square };
    const double most = ldexp(255.0, 254 - 136);
    float c[3][3 * 9];
    memset(bytes, 255, sizeof bytes);
    test_section("brightest RGBE8");
    EQUAL(sh_project_equirect(SH_L2, &wide, 0, c[0], NULL), SH_OK);
    EQUAL(sh_project_cubemap(SH_L2, face, 0, c[1], NULL), SH_OK);
    EQUAL(sh_project_octahedral(SH_L2, &square, 0, c[2], NULL), SH_OK);
    for (int map = 0; map < 3; map++)
        for (int i = 0; i < 27; i++)
            NEAR(c[map][i], i % 9 ? 0.0 : most, (i % 9 ? 1e-4 : 1e-6) * most); /* cells: 1 / size^2 */
}

/* An image, and what is to be projected of it. */
typedef struct request {
    const char *name;
    int expected;
    sh_image image;
    int order;
    unsigned flags;
    int first_row, row_count;
} request;

/* Each call fails with the expected error, and writes to none of its outputs. */
static void check_error(const request *r) {
    float c[3 * 9], c_before[3 * 9];
    sh_accum accum[3], accum_before[3];
    sh_report report, report_before;
    memset(c, 0x55, sizeof c);
    memset(accum, 0x55, sizeof accum);
    memset(&report, 0x55, sizeof report);
    memcpy(c_before, c, sizeof c);
    memcpy(accum_before, accum, sizeof accum);
    memcpy(&report_before, &report, sizeof report);
    test_section("%s", r->name);
    if (r->first_row == 0 && r->row_count == 8)
        EQUAL(sh_project_equirect(r->order, &r->image, r->flags, c, &report), r->expected);
    EQUAL(sh_project_equirect_rows(r->order, &r->image, r->flags, r->first_row, r->row_count, accum, &report), r->expected);
    SAME_BITS(c, c_before, sizeof c);
    SAME_BITS(accum, accum_before, sizeof accum);
    SAME_BITS(&report, &report_before, sizeof report);
}

static void errors(void) {
    static const float pixels[16 * 8 * 4] = { 1.0f };
    const int argument = SH_ERROR_ARGUMENT, size = SH_ERROR_SIZE, format = SH_ERROR_FORMAT;
    const size_t huge = SIZE_MAX - 3u;
    const request requests[] = {
        { "pixels NULL", argument, { NULL, 16, 8, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "order -1", argument, { pixels, 16, 8, 0, 3, SH_F32 }, -1, 0, 0, 8 },
        { "order 3", argument, { pixels, 16, 8, 0, 3, SH_F32 }, 3, 0, 0, 8 },
        { "flag 8", argument, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 8, 0, 8 },
        { "all flags", argument, { pixels, 16, 8, 0, 3, SH_F32 }, 2, ~0u, 0, 8 },
        { "width 0", size, { pixels, 0, 8, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "width -16", size, { pixels, -16, 8, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "width INT_MIN", size, { pixels, INT_MIN, 8, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "width 2^28 + 1", size, { pixels, (1 << 28) + 1, 8, 0, 3, SH_F32 }, 2, 0, 0, 0 },
        { "height 2^28 + 1", size, { pixels, 1, (1 << 28) + 1, 0, 1, SH_SRGB8 }, 2, 0, 0, 0 },
        { "height INT_MAX", size, { pixels, 16, INT_MAX, 0, 3, SH_F32 }, 2, 0, 0, 0 },
        { "height 0", size, { pixels, 16, 0, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "height -1", size, { pixels, 16, -1, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "height INT_MIN", size, { pixels, 16, INT_MIN, 0, 3, SH_F32 }, 2, 0, 0, 8 },
        { "stride 1", size, { pixels, 16, 8, 1, 3, SH_F32 }, 2, 0, 0, 8 },
        { "stride a byte short", size, { pixels, 16, 8, 16 * 12 - 1, 3, SH_F32 }, 2, 0, 0, 8 },
        { "stride a byte short, RGBE8", size, { pixels, 16, 8, 16 * 4 - 1, 3, SH_RGBE8 }, 2, 0, 0, 8 },
        { "stride a byte short, F16", size, { pixels, 16, 8, 16 * 8 - 1, 4, SH_F16 }, 2, 0, 0, 8 },
        { "stride that overflows", size, { pixels, 16, 8, huge, 3, SH_F32 }, 2, 0, 0, 8 },
        { "stride that overflows at the end", size, { pixels, 16, 8, huge / 7, 3, SH_F32 }, 2, 0, 0, 8 },
        { "first row -1", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, -1, 4 },
        { "first row 9", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, 9, 0 },
        { "row count -1", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, 4, -1 },
        { "a row beyond", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, 1, 8 },
        { "rows that overflow", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, 1, INT_MAX },
        { "rows that underflow", size, { pixels, 16, 8, 0, 3, SH_F32 }, 2, 0, INT_MIN, INT_MIN },
        { "format 5", format, { pixels, 16, 8, 0, 3, (sh_format)5 }, 2, 0, 0, 8 },
        { "format 7", format, { pixels, 16, 8, 0, 3, (sh_format)7 }, 2, 0, 0, 8 },
        { "0 channels", format, { pixels, 16, 8, 0, 0, SH_F32 }, 2, 0, 0, 8 },
        { "2 channels", format, { pixels, 16, 8, 0, 2, SH_F32 }, 2, 0, 0, 8 },
        { "5 channels", format, { pixels, 16, 8, 0, 5, SH_F32 }, 2, 0, 0, 8 },
        { "-1 channels", format, { pixels, 16, 8, 0, -1, SH_SRGB8 }, 2, 0, 0, 8 },
        { "RGBE8 of 1 channel", format, { pixels, 16, 8, 0, 1, SH_RGBE8 }, 2, 0, 0, 8 },
        { "RGB9E5 of 1 channel", format, { pixels, 16, 8, 0, 1, SH_RGB9E5 }, 2, 0, 0, 8 },
    };
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++)
        check_error(&requests[i]);

    test_section("NULL");
    const sh_image good = { pixels, 16, 8, 0, 3, SH_F32 };
    float c[3 * 9];
    sh_accum accum[3];
    EQUAL(sh_project_equirect(SH_L2, NULL, 0, c, NULL), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_equirect(SH_L2, &good, 0, NULL, NULL), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_equirect_rows(SH_L2, NULL, 0, 0, 8, accum, NULL), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_equirect_rows(SH_L2, &good, 0, 0, 8, NULL, NULL), SH_ERROR_ARGUMENT);

    test_section("no rows are no error, and add nothing");
    memset(accum, 0, sizeof accum);
    for (int row = 0; row <= 8; row++)
        EQUAL(sh_project_equirect_rows(SH_L2, &good, 0, row, 0, accum, NULL), SH_OK);
    NEAR(accum[0].weight, 0.0, 0);
    EQUAL(sh_image_channels(&good), 3);

    test_section("the greatest sides");
    const sh_image wide = { pixels, 1 << 28, 1, 0, 1, SH_SRGB8 }, high = { pixels, 1, 1 << 28, 0, 1, SH_SRGB8 };
    EQUAL(sh_project_equirect_rows(SH_L2, &wide, 0, 1, 0, accum, NULL), SH_OK);
    EQUAL(sh_project_equirect_rows(SH_L2, &high, 0, 1 << 28, 0, accum, NULL), SH_OK);
}

static void run_tests(void) {
    every_half();
    every_byte();
    shared_exponents();
    not_finite();
    not_finite_halves();
    nothing_left();
    alpha();
    negatives();
    magnitudes();
    brightest();
    errors();
}
