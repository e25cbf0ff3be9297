/* Equirectangular panoramas against long double, at every awkward size, layout and format; what they recover, and how errors fall. */
#include "images.h"

static const unsigned all_flags[] = { 0, SH_POINT_TEXELS, SH_CLOCKWISE, SH_POINT_TEXELS | SH_CLOCKWISE };

/* Projects at L2, with a report that must agree with the oracle's counts, and compares. */
static void check_against_oracle(const sh_image *image, unsigned flags) {
    const oracle_projection expected = oracle_project_equirect(image, flags);
    float c[3 * SH_COUNT(SH_L2)];
    sh_report report = { 9, 9, 9 };
    test_dirty_stack();
    EQUAL(sh_project_equirect(SH_L2, image, flags, c, &report), SH_OK);
    test_projection_near(SH_L2, sh_image_channels(image), c, &expected);
    EQUAL(report.texels, expected.texels);
    EQUAL(report.nonfinite, expected.nonfinite);
    EQUAL(report.negative, expected.negative);
}

/* Point texels need three columns and three rows to tell the bands of one texel apart. */
static int allowed(int width, int height, unsigned flags) {
    return !(flags & SH_POINT_TEXELS) || (width >= 3 && height >= 3);
}

static void check_size(int width, int height, int channels, double low) {
    test_image of = test_image_create(width, height, channels, SH_F32, test_tight);
    test_image_fill(&of, low, 1.0);
    for (size_t f = 0; f < sizeof all_flags / sizeof all_flags[0]; f++)
        if (allowed(width, height, all_flags[f])) {
            test_section("%d x %d, %d channels, flags %u, values from %g", width, height, channels, all_flags[f], low);
            check_against_oracle(&of.image, all_flags[f]);
        }
    test_image_free(&of);
}

/* Widths of every remainder by any number of lanes, odd and even, and a few that no power of two divides. */
static void sizes(void) {
    static const int more[][2] = { { 1, 1 },     { 1, 300 },  { 2, 1 },    { 4, 2 },    { 16, 8 },   { 37, 19 },
                                   { 63, 32 },   { 64, 33 },  { 100, 50 }, { 127, 64 }, { 129, 65 }, { 255, 12 },
                                   { 257, 128 }, { 1000, 3 }, { 1023, 4 }, { 2, 700 } };
    static const int channels[] = { 1, 3, 4 };
    for (int width = 1; width <= 72; width++)
        for (int k = 0; k < 3; k++)
            check_size(width, 1 + (width * 5 + k) % 9, channels[k], k == 0 ? -1.0 : 0.0);
    for (size_t i = 0; i < sizeof more / sizeof more[0]; i++)
        check_size(more[i][0], more[i][1], channels[i % 3], i % 2 ? -0.5 : 0.0);
    check_size(2048, 64, 3, 0.0);
    check_size(20000, 2, 1, 0.0);
}

/* Nothing but the mean of a constant image is left, to 1e-7 of it: at any size for areas, at any width for three rows of points. */
static void check_constant(int width, int height, float value, unsigned flags) {
    test_image of = test_image_create(width, height, 1, SH_F32, test_tight);
    float c[SH_COUNT(SH_L2)];
    test_section("a constant of %g, %d x %d, flags %u", (double)value, width, height, flags);
    for (int i = 0; i < width * height; i++)
        test_image_set(&of, i % width, i / width, 0, value);
    EQUAL(sh_project_equirect(SH_L2, &of.image, flags, c, NULL), SH_OK);
    RELATIVE(c[0], value, test_projection_tolerance);
    for (int i = 1; i < SH_COUNT(SH_L2); i++)
        NEAR(c[i], 0.0, 1e-7L * (long double)value);
    test_image_free(&of);
}

static void constants(void) {
    for (int width = 1; width <= 130; width += width < 20 ? 1 : 11)
        for (int height = 1; height <= 66; height += height < 9 ? 1 : 19)
            for (size_t f = 0; f < 2; f++)
                if (height >= 3 || all_flags[f] == 0)
                    check_constant(width, height, 0.7f, all_flags[f]);
    check_constant(1024, 512, 1.0f, 0);
    check_constant(1000, 333, 3.3f, SH_POINT_TEXELS);
    check_constant(5813, 2, 123.4f, 0);
    check_constant(1, 100000, 1.0f, 0);
    check_constant(100000, 1, 0.1f, 0);
    check_constant(64, 32, 3e38f, 0);
    check_constant(64, 32, 1e-30f, 0);
}

/* Rows far apart, texels and rows at odd addresses: the same bits as from a tight image. */
static void check_layout(sh_format format, int channels, test_layout layout) {
    enum { WIDTH = 45, HEIGHT = 6 };
    test_image tight = test_image_create(WIDTH, HEIGHT, channels, format, test_tight);
    test_image loose = test_image_create(WIDTH, HEIGHT, channels, format, layout);
    float a[3 * SH_COUNT(SH_L2)], b[3 * SH_COUNT(SH_L2)];
    const size_t row = oracle_texel_size(&tight.image) * WIDTH;
    test_section("%s, %d channels, offset %d, padding %d", test_format_names[format], channels, (int)layout.offset,
                 (int)layout.padding);
    test_image_fill(&tight, -1.0, 1.0);
    for (int y = 0; y < HEIGHT; y++)
        memcpy(test_texel(&loose, 0, y), test_texel(&tight, 0, y), row);
    EQUAL(sh_project_equirect(SH_L2, &tight.image, 0, a, NULL), SH_OK);
    EQUAL(sh_project_equirect(SH_L2, &loose.image, 0, b, NULL), SH_OK);
    SAME_BITS(a, b, (size_t)(sh_image_channels(&tight.image) * SH_COUNT(SH_L2)) * sizeof(float));
    check_against_oracle(&loose.image, 0);
    test_image_free(&tight);
    test_image_free(&loose);
}

static void layouts(void) {
    static const test_layout list[] = { { 0, 4 }, { 0, 64 }, { 1, 0 }, { 1, 1 }, { 2, 3 }, { 3, 5 }, { 0, 1000 } };
    for (int format = 0; format < TEST_FORMATS; format++)
        for (int channels = 1; channels <= 4; channels++)
            for (size_t i = 0; channels != 2 && i < sizeof list / sizeof list[0]; i++)
                if (test_format_has((sh_format)format, channels))
                    check_layout((sh_format)format, channels, list[i]);
}

/* An image of any format, and the floats that it stands for. */
static void formats(void) {
    static const int sizes_of[][2] = { { 5, 3 }, { 16, 8 }, { 33, 17 }, { 96, 48 } };
    for (int format = SH_F16; format < TEST_FORMATS; format++)
        for (int i = 0; i < 12; i++) {
            const int width = sizes_of[i % 4][0], height = sizes_of[i % 4][1], channels = i < 4 ? 3 : i < 8 ? 4 : 1;
            if (!test_format_has((sh_format)format, channels))
                continue;
            test_image of = test_image_create(width, height, channels, (sh_format)format, test_tight);
            test_image decoded = test_image_create(width, height, channels, SH_F32, test_tight);
            float a[3 * SH_COUNT(SH_L2)], b[3 * SH_COUNT(SH_L2)];
            test_section("%s against F32, %d x %d, %d channels", test_format_names[format], width, height, channels);
            test_image_fill(&of, 0.0, 1.0);
            for (int n = 0; n < width * height; n++) {
                long double value[3];
                oracle_texel(&of.image, n % width, n / width, value);
                for (int k = 0; k < oracle_colours(&of.image); k++)
                    test_image_set(&decoded, n % width, n / width, k, (float)value[k]);
            }
            EQUAL(sh_image_channels(&of.image), oracle_colours(&of.image));
            EQUAL(sh_project_equirect(SH_L2, &of.image, 0, a, NULL), SH_OK);
            EQUAL(sh_project_equirect(SH_L2, &decoded.image, 0, b, NULL), SH_OK);
            const oracle_projection expected = oracle_project_equirect(&of.image, 0);
            for (int k = 0; k < oracle_colours(&of.image); k++)
                NEAR_ALL(a + k * 9, b + k * 9, 9, 2.0L * test_projection_tolerance * expected.magnitude[k]);
            for (size_t f = 0; f < sizeof all_flags / sizeof all_flags[0]; f++)
                check_against_oracle(&of.image, all_flags[f]);
            test_image_free(&of);
            test_image_free(&decoded);
        }
}

/* Orthonormal coefficients of a light with all bands up to some degree. */
enum { DEGREE = 5, HARMONICS = (DEGREE + 1) * (DEGREE + 1) };

static long double harmonics(const long double dir[3], const void *user) {
    const float *weight = (const float *)user;
    long double sum = 0.0L;
    for (int l = 0, i = 0; l <= DEGREE; l++)
        for (int m = -l; m <= l; m++, i++)
            sum += (long double)weight[i] * oracle_y(l, m, dir, 0);
    return sum;
}

/* A grey image of a light at the middle of each texel. */
static test_image render(int width, int height, unsigned flags, oracle_light light, const void *user) {
    test_image of = test_image_create(width, height, 1, SH_F32, test_tight);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            long double dir[3];
            oracle_equirect_direction(&of.image, flags, x, y, dir);
            test_image_set(&of, x, y, 0, (float)light(dir, user));
        }
    return of;
}

/* A light of degree 5 is recovered from 16 x 8 points, and its bands above 2 do not leak: 5 = min(16, 8) - 3. */
static void band_limited(void) {
    static const int sizes_of[][2] = {
        { 16, 8 }, { 8, 8 }, { 17, 9 }, { 30, 11 }, { 32, 16 }, { 64, 32 }, { 99, 50 }, { 128, 64 }
    };
    oracle_rule rule = oracle_rule_sphere(DEGREE + 2);
    for (size_t s = 0; s < sizeof sizes_of / sizeof sizes_of[0]; s++)
        for (unsigned sense = 0; sense <= SH_CLOCKWISE; sense += SH_CLOCKWISE) {
            float weight[HARMONICS], c[SH_COUNT(SH_L2)];
            long double expected[9];
            test_section("a light of degree %d, %d x %d, flags %u", DEGREE, sizes_of[s][0], sizes_of[s][1], sense);
            test_fill(weight, HARMONICS, -1.0, 1.0);
            oracle_moments(&rule, harmonics, weight, expected);
            test_image of = render(sizes_of[s][0], sizes_of[s][1], sense, harmonics, weight);
            EQUAL(sh_project_equirect(SH_L2, &of.image, SH_POINT_TEXELS | sense, c, NULL), SH_OK);
            NEAR_ALL(c, expected, 9, 3e-7); /* |light| is up to 3: 1e-7 of it, well below the 1e-6 that is promised */
            test_image_free(&of);
        }
    oracle_rule_free(&rule);
}

/* A lobe of sharpness 6 about a tilted axis. */
static long double lobe(const long double dir[3], const void *user) {
    return expl(6.0L * (oracle_dot(dir, (const long double *)user) - 1.0L));
}

/* Midpoints of areas: the error is that of a texel's second derivative, a quarter with each doubling. */
static void convergence(void) {
    const long double axis[3] = { 0.48L, 0.6L, 0.64L };
    oracle_rule rule = oracle_rule_sphere(60);
    long double expected[9], before = 0.0L;
    oracle_moments(&rule, lobe, axis, expected);
    oracle_rule_free(&rule);
    for (int height = 16; height <= 256; height *= 2) {
        float c[SH_COUNT(SH_L2)];
        long double error = 0.0L;
        test_image of = render(2 * height, height, 0, lobe, axis);
        test_section("a lobe, %d x %d", 2 * height, height);
        EQUAL(sh_project_equirect(SH_L2, &of.image, 0, c, NULL), SH_OK);
        for (int i = 0; i < 9; i++)
            error += ((long double)c[i] - expected[i]) * ((long double)c[i] - expected[i]);
        error = sqrtl(error);
        if (before > 0.0L)
            NEAR(before / error, 4.0, 0.08);
        before = error;

        EQUAL(sh_project_equirect(SH_L2, &of.image, SH_POINT_TEXELS, c, NULL), SH_OK);
        if (height >= 32) /* points are exact once the bands of the lobe, which fall like 6^l / l!, are resolved */
            NEAR_ALL(c, expected, 9, 1e-8); /* a tenth of the mean, which is 1/12 */
        test_image_free(&of);
    }
    CHECK(before < 1e-5L);
}

/* Rows in any parts, in any order, by any number of accumulators; with reports that add up. */
static void rows(void) {
    enum { WIDTH = 50, HEIGHT = 23 };
    for (int repeat = 0; repeat < 60; repeat++) {
        const unsigned flags = all_flags[repeat % 4];
        test_image of = test_image_create(WIDTH, HEIGHT, 3, SH_F32, test_tight);
        const int cut = test_below(HEIGHT + 1), second = cut + test_below(HEIGHT + 1 - cut), bounds[4] = { 0, cut, second, HEIGHT };
        float whole[3 * 9], c[3 * 9];
        sh_accum accum[3], part[3];
        sh_report report = { 0, 0, 0 };
        test_section("rows split at %d and %d, flags %u", cut, second, flags);
        test_image_fill(&of, -0.2, 1.0);
        test_image_set(&of, 3, cut % HEIGHT, 1, (float)INFINITY);
        const oracle_projection expected = oracle_project_equirect(&of.image, flags);
        sh_accum_clear(3, accum);
        for (int i = 2; i >= 0; i--) {
            sh_accum_clear(3, part);
            EQUAL(sh_project_equirect_rows(SH_L2, &of.image, flags, bounds[i], bounds[i + 1] - bounds[i], part, &report), SH_OK);
            sh_accum_merge(3, part, accum);
        }
        sh_accum_total(SH_L2, 3, accum, c);
        test_projection_near(SH_L2, 3, c, &expected);
        EQUAL(sh_project_equirect(SH_L2, &of.image, flags, whole, NULL), SH_OK);
        for (int k = 0; k < 3; k++)
            NEAR_ALL(c + k * 9, whole + k * 9, 9, test_projection_tolerance * expected.magnitude[k]);
        NEAR(accum[0].weight, 1.0, 1e-14);
        EQUAL(report.texels, WIDTH * HEIGHT);
        EQUAL(report.nonfinite, 1);
        EQUAL(report.negative, expected.negative);

        test_section("rows %d to %d alone, flags %u", cut, second, flags);
        const oracle_projection some = oracle_project_equirect_rows(&of.image, flags, cut, second - cut);
        sh_accum_clear(3, part);
        EQUAL(sh_project_equirect_rows(SH_L2, &of.image, flags, cut, second - cut, part, NULL), SH_OK);
        sh_accum_total(SH_L2, 3, part, c);
        test_projection_near(SH_L2, 3, c, &some);
        test_image_free(&of);
    }
}

/* Rows of an order leave the sums above it as they were, at zero: accumulators are plain numbers, which others may add up. */
static void sums_above_the_order(void) {
    test_image of = test_image_create(32, 16, 3, SH_F32, test_tight);
    test_image_fill(&of, 0.0, 1.0);
    for (int order = SH_L0; order <= SH_L1; order++) {
        sh_accum accum[3];
        test_section("sums above order %d", order);
        sh_accum_clear(3, accum);
        EQUAL(sh_project_equirect_rows(order, &of.image, 0, 0, 16, accum, NULL), SH_OK);
        for (int k = 0; k < 3; k++)
            for (int i = SH_COUNT(order); i < 9; i++)
                NEAR(accum[k].sum[i], 0, 0);
    }
    test_image_free(&of);
}

/* A light at +y: to the left of the centre from inside, to the right with SH_CLOCKWISE. */
static void azimuth(void) {
    const float east[4] = { 0.0f, 4.0f, 0.0f, 0.0f };
    const sh_image image = { east, 4, 1, 0, 1, SH_F32 };
    float c[4];
    test_section("azimuth");
    EQUAL(sh_project_equirect(SH_L1, &image, 0, c, NULL), SH_OK);
    NEAR(c[SH_R0], 1.0, 0);
    CHECK(c[SH_X] < -0.1f && c[SH_Y] > 0.1f);
    EQUAL(sh_project_equirect(SH_L1, &image, SH_CLOCKWISE, c, NULL), SH_OK);
    CHECK(c[SH_X] < -0.1f && c[SH_Y] < -0.1f);
}

/* Rows whose weights are sums of fewer terms than half their number, since there are few texels in them: L = 1 + z + z^2 is exact
 * still, and a column of a million takes no minutes. */
static void narrow(void) {
    enum { HEIGHT = 1 << 16 };
    float *pixels = (float *)test_allocate(HEIGHT * sizeof *pixels);
    const sh_image image = { pixels, 1, HEIGHT, 0, 1, SH_F32 };
    const double expected[9] = { 4.0 / 3, 0, 0, 1.0 / 3, -2.0 / 45, 0, 0, -2.0 / 45, 0 };
    float c[9];
    test_section("narrow point texels");
    for (int y = 0; y < HEIGHT; y++) {
        const double z = cos((double)oracle_pi * (y + 0.5) / (double)HEIGHT);
        pixels[y] = (float)(1.0 + z + z * z);
    }
    EQUAL(sh_project_equirect(SH_L2, &image, SH_POINT_TEXELS, c, NULL), SH_OK);
    for (int i = 0; i < 9; i++)
        NEAR(c[i], expected[i], 1e-6);
    free(pixels);
}

static void run_tests(void) {
    azimuth();
    narrow();
    constants();
    sizes();
    layouts();
    formats();
    band_limited();
    convergence();
    rows();
    sums_above_the_order();
}
