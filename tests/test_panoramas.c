/* Measured panoramas, where there are any, and a synthetic sky with a sun: coefficients against long double, the bounds that real
 * light keeps, and how far the linear reconstructions are from brute-force irradiance.
 *
 * SH_ENVS, in the environment or as a macro SH_ENVS_DIR, names a folder of .pfm files. */
#include "images.h"

static const char *const names[] = { "city", "esplanade", "hall", "night", "studio", "sunset" };
enum { PANORAMAS = sizeof names / sizeof names[0] };

/* A little-endian colour .pfm file, turned so that its top row is row 0; without memory if there is none. */
static test_image read_pfm(const char *path) {
    test_image of = { { NULL, 0, 0, 0, 3, SH_F32 }, NULL };
    int width, height;
    float scale;
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return of;
    CHECK(fscanf(file, "PF %d %d %f", &width, &height, &scale) == 3 && scale < 0.0f && fgetc(file) == '\n');
    of = test_image_create(width, height, 3, SH_F32, test_tight);
    const size_t size = 12 * (size_t)width * (size_t)height;
    unsigned char *bytes = (unsigned char *)test_allocate(size), *byte = bytes;
    CHECK(fread(bytes, 1, size, file) == size);
    for (int y = height - 1; y >= 0; y--)
        for (int i = 0; i < 3 * width; i++, byte += 4) {
            const uint32_t bits = byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 | (uint32_t)byte[3] << 24;
            memcpy(test_texel(&of, i / 3, y) + 4 * (i % 3), &bits, sizeof bits);
        }
    free(bytes);
    fclose(file);
    return of;
}

/* A blue sky, dark ground and a small sun of radiance 20000, which is most of the light. */
static test_image synthetic_sky(void) {
    enum { WIDTH = 256, HEIGHT = 128 };
    static const long double sun[3] = { 0.6L, -0.48L, 0.64L };
    static const double zenith[3] = { 0.2, 0.4, 1.0 };
    test_image of = test_image_create(WIDTH, HEIGHT, 3, SH_F32, test_tight);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        long double dir[3];
        oracle_equirect_direction(&of.image, 0, i % WIDTH, i / WIDTH, dir);
        const double above = (double)dir[2], glow = pow(0.5 + 0.5 * (double)oracle_dot(dir, sun), 8.0);
        for (int k = 0; k < 3; k++) {
            double value = above > 0.0 ? zenith[k] + (1.0 - zenith[k]) * pow(1.0 - above, 4.0) + glow : 0.1;
            if (oracle_dot(dir, sun) > 0.9995L)
                value = 20000.0;
            test_image_set(&of, i % WIDTH, i / WIDTH, k, (float)value);
        }
    }
    return of;
}

/* All meanings of the texels, to the contract, and to 1e-6 of R0 as well. */
static void check_coefficients(const char *name, const sh_image *image) {
    for (unsigned flags = 0; flags < 8; flags++) {
        const oracle_projection expected = oracle_project_equirect(image, flags);
        float c[3 * 9];
        sh_report report = { 9, 9, 9 };
        test_section("%s, flags %u", name, flags);
        EQUAL(sh_project_equirect(SH_L2, image, flags, c, &report), SH_OK);
        test_projection_near(SH_L2, 3, c, &expected);
        for (int k = 0; k < 3; k++)
            NEAR_ALL(c + 9 * k, expected.c[k], 9, 1e-6L * expected.c[k][0]);
        EQUAL(report.nonfinite, expected.nonfinite);
        EQUAL(report.negative, expected.negative);
    }
}

/* What the coefficients of non-negative light keep to: the linear lobes of its irradiance may dip below 0, these may not. */
static void check_bounds(const char *name, const sh_image *image) {
    float c[3 * 9];
    test_section("%s, bounds", name);
    EQUAL(sh_project_equirect(SH_L2, image, SH_CLAMP_NEGATIVE, c, NULL), SH_OK);
    for (int k = 0; k < 3; k++) {
        float dir[3], intensity, ambient;
        long double wide[9];
        oracle_widen(c + 9 * k, 9, wide);
        CHECK(wide[0] > 0.0L);
        CHECK(oracle_dot(wide + 1, wide + 1) <= wide[0] * wide[0]);
        NEAR(sh_directionality(c + 9 * k), sqrtl(oracle_dot(wide + 1, wide + 1)) / wide[0], 1e-7);
        sh_dominant_light(SH_L2, 1, c + 9 * k, dir, &intensity, &ambient);
        CHECK(intensity >= 0.0f && ambient >= 0.0f);
        for (uint32_t i = 0; i < 200; i++) {
            long double n[3];
            sh_direction_fibonacci(i, 200, dir);
            oracle_widen(dir, 3, n);
            CHECK(oracle_quadratic(wide, n) >= -wide[0] / 3.0L && oracle_quadratic(wide, n) <= 2.0L / 3.0L * wide[0]);
        }
    }
}

/* Texels as lights from their centres, after averaging blocks of 2 x 2 by area; negative ones as black. */
typedef struct sources {
    oracle_source *channel[3];
    size_t count;
    test_image small;
} sources;

static sources halve(const sh_image *image) {
    sources s;
    const int width = image->width / 2, height = image->height / 2;
    s.small = test_image_create(width, height, 3, SH_F32, test_tight);
    s.count = (size_t)(width * height);
    for (int k = 0; k < 3; k++)
        s.channel[k] = (oracle_source *)test_allocate(s.count * sizeof(oracle_source));
    for (int y = 0; y < height; y++) {
        const long double edge[3] = { cosl(oracle_pi * y / height), cosl(oracle_pi * (y + 0.5L) / height),
                                      cosl(oracle_pi * (y + 1) / height) };
        const long double upper = (edge[0] - edge[1]) / (edge[0] - edge[2]), area = (edge[0] - edge[2]) / (2.0L * width);
        for (int x = 0; x < width; x++) {
            long double texel[4][3], dir[3];
            for (int i = 0; i < 4; i++)
                oracle_texel(image, 2 * x + i % 2, 2 * y + i / 2, texel[i]);
            oracle_equirect_direction(&s.small.image, 0, x, y, dir);
            for (int k = 0; k < 3; k++) {
                const long double mean =
                    0.5L * (upper * (texel[0][k] + texel[1][k]) + (1.0L - upper) * (texel[2][k] + texel[3][k]));
                oracle_source *source = &s.channel[k][y * width + x];
                memcpy(source->dir, dir, sizeof dir);
                source->mean = mean > 0.0L ? mean * area : 0.0L;
                test_image_set(&s.small, x, y, k, mean > 0.0L ? (float)mean : 0.0f);
            }
        }
    }
    return s;
}

static void free_sources(sources *s) {
    for (int k = 0; k < 3; k++)
        free(s->channel[k]);
    test_image_free(&s->small);
}

/* Adds the root mean square errors, relative to R0, of the L1 and L2 reconstructions clamped at 0, of each channel. */
static void add_errors(const sh_image *image, double error[2]) {
    enum { NORMALS = 200 };
    sources s = halve(image);
    float c[3 * 9];
    EQUAL(sh_project_equirect(SH_L2, &s.small.image, 0, c, NULL), SH_OK);
    for (int k = 0; k < 3; k++) {
        double squares[2] = { 0.0, 0.0 };
        for (uint32_t i = 0; i < NORMALS; i++) {
            float n[3];
            long double wide[3];
            sh_direction_fibonacci(i, NORMALS, n);
            oracle_widen(n, 3, wide);
            const double truth = (double)oracle_irradiance_sources(s.channel[k], s.count, wide);
            for (int order = SH_L1; order <= SH_L2; order++)
                squares[order - 1] += pow(fmax((double)sh_irradiance(order, c + 9 * k, n), 0.0) - truth, 2.0);
        }
        for (int i = 0; i < 2; i++)
            error[i] += sqrt(squares[i] / (int)NORMALS) / (double)c[9 * k] / 3.0;
    }
    free_sources(&s);
}

static void check_panorama(const char *name, const sh_image *image, double error[2]) {
    check_coefficients(name, image);
    check_bounds(name, image);
    add_errors(image, error);
}

static void measured(const char *folder) {
    double error[2] = { 0.0, 0.0 };
    int found = 0;
    for (int i = 0; i < PANORAMAS; i++) {
        char path[1000];
        snprintf(path, sizeof path, "%s/%s.pfm", folder, names[i]);
        test_image of = read_pfm(path);
        if (of.memory == NULL)
            continue;
        found++;
        check_panorama(names[i], &of.image, error);
        test_image_free(&of);
    }
    if (found < PANORAMAS)
        printf("skipped: %d of %d panoramas are not in '%s'\n", PANORAMAS - found, PANORAMAS, folder);
    test_section("errors of the linear reconstructions, mean over the panoramas");
    if (found == PANORAMAS) { /* measured on their own with 1000 other normals: .2063 and .0370 */
        NEAR(error[0] / found, 0.2063, 0.001);
        NEAR(error[1] / found, 0.0370, 0.0003);
    }
}

static void run_tests(void) {
    double error[2] = { 0.0, 0.0 };
    test_image sky = synthetic_sky();
    check_panorama("synthetic sky", &sky.image, error);
    test_image_free(&sky);
    /* The bands of the Lambert kernel that one direction loses: sqrt(sum of (2l + 1) k_l^2) from l = 2 is .577, from l = 4 .144. */
    test_section("the synthetic sky's errors are most of those of a sun");
    CHECK(error[0] > 0.75 * 0.577 && error[0] < 0.577);
    CHECK(error[1] > 0.75 * 0.144 && error[1] < 0.144);

    const char *folder = getenv("SH_ENVS");
#ifdef SH_ENVS_DIR
    if (folder == NULL)
        folder = SH_ENVS_DIR;
#endif
    if (folder == NULL)
        printf("skipped: no folder of panoramas, see SH_ENVS\n");
    else
        measured(folder);
}
