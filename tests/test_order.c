/* An order is a prefix: a lower order gives the first bits of a higher one, and neither reads nor writes beyond its coefficients. */
#include "sh.h"
#include "test.h"

static const float zonal[3] = { 0.9f, -0.7f, 0.3f };

/* What the functions below work on. */
typedef struct inputs {
    const float *a, *b; /* SH_COUNT(order) coefficients */
    const float *dir;
    float value;
} inputs;

/* Writes SH_COUNT(order) coefficients to out, which hold a's values before. */
typedef void (*writer)(int order, const inputs *in, float *out);

static void write_basis(int order, const inputs *in, float *out) {
    sh_basis(order, in->dir, out);
}

static void write_add_sample(int order, const inputs *in, float *out) {
    sh_add_sample(order, in->dir, in->value, out);
}

static void write_scale(int order, const inputs *in, float *out) {
    sh_scale(order, in->a, in->value, out);
}

static void write_madd(int order, const inputs *in, float *out) {
    sh_madd(order, in->b, in->value, out);
}

static void write_lerp(int order, const inputs *in, float *out) {
    sh_lerp(order, in->a, in->b, in->value, out);
}

static void write_truncate(int order, const inputs *in, float *out) {
    sh_truncate(order, 1, in->a, order, out);
}

static void write_convolve(int order, const inputs *in, float *out) {
    sh_convolve(order, in->a, zonal, out);
}

static void write_zonal_add(int order, const inputs *in, float *out) {
    sh_zonal_add(order, zonal, in->dir, in->value, out);
}

static void write_accum(int order, const inputs *in, float *out) {
    sh_accum accum;
    sh_accum_clear(1, &accum);
    sh_accum_sample(order, in->dir, in->value, 0.4f, &accum);
    sh_accum_sample(order, in->a, in->value, 0.7f, &accum);
    sh_accum_finish(order, 1, &accum, out);
}

static void write_accum_total(int order, const inputs *in, float *out) {
    sh_accum accum;
    sh_accum_clear(1, &accum);
    sh_accum_samples(order, 1, in->dir, in->dir + 1, in->dir + 2, in->a, NULL, 1, &accum);
    sh_accum_total(order, 1, &accum, out);
}

static void write_project_samples(int order, const inputs *in, float *out) {
    enum { COUNT = 37 };
    float x[COUNT], y[COUNT], z[COUNT], value[COUNT];
    for (int i = 0; i < COUNT; i++) {
        const float t = (float)(i * i % 19) / 19.0f;
        x[i] = t * in->dir[0];
        y[i] = (1.0f - t) * in->dir[1];
        z[i] = in->dir[2];
        value[i] = in->value + t;
    }
    CHECK(sh_project_samples(order, 1, x, y, z, value, NULL, COUNT, out) == SH_OK);
}

/* The image is 5 x 2 so that no folding of columns has an even count to work on. */
static void write_equirect(int order, const inputs *in, float *out) {
    float pixels[10];
    for (int i = 0; i < 10; i++)
        pixels[i] = in->value * (float)(i * i % 7);
    const sh_image image = { pixels, 5, 2, 0, 1, SH_F32 };
    CHECK(sh_project_equirect(order, &image, 0, out, NULL) == SH_OK);
}

static void write_equirect_points(int order, const inputs *in, float *out) {
    float pixels[3 * 16 * 4], c[3 * SH_COUNT(SH_L2)];
    for (int i = 0; i < 3 * 16 * 4; i++)
        pixels[i] = in->value * (float)(i * i % 101);
    const sh_image image = { pixels, 16, 4, 0, 3, SH_F32 };
    CHECK(sh_project_equirect(order, &image, SH_POINT_TEXELS, c, NULL) == SH_OK);
    memcpy(out, c + 2 * SH_COUNT(order), (size_t)SH_COUNT(order) * sizeof(float));
}

static const struct {
    const char *name;
    writer write;
} writers[] = {
    { "sh_basis", write_basis },
    { "sh_add_sample", write_add_sample },
    { "sh_scale", write_scale },
    { "sh_madd", write_madd },
    { "sh_lerp", write_lerp },
    { "sh_truncate", write_truncate },
    { "sh_convolve", write_convolve },
    { "sh_zonal_add", write_zonal_add },
    { "sh_accum_finish", write_accum },
    { "sh_accum_total", write_accum_total },
    { "sh_project_samples", write_project_samples },
    { "sh_project_equirect, areas", write_equirect },
    { "sh_project_equirect, points", write_equirect_points },
};

/* A copy of the first SH_COUNT(order) floats in memory of exactly that size. */
static float *prefix(int order, const float *c) {
    const size_t size = (size_t)SH_COUNT(order) * sizeof(float);
    float *copy = (float *)test_allocate(size);
    memcpy(copy, c, size);
    return copy;
}

static void check_writer(const char *name, writer write) {
    float a[9], b[9], dir[3], whole[9];
    test_fill(a, 9, -1.0, 1.0);
    test_fill(b, 9, -1.0, 1.0);
    test_direction(dir);
    const float value = (float)test_uniform(0.5, 2.0);
    const inputs all = { a, b, dir, value };
    memcpy(whole, a, sizeof whole);
    write(SH_L2, &all, whole);
    for (int order = SH_L0; order <= SH_L1; order++) {
        float *short_a = prefix(order, a), *short_b = prefix(order, b), *out = prefix(order, a);
        /* a's first floats also serve as a direction, which every order reads */
        const inputs few = { order == SH_L0 ? a : short_a, short_b, dir, value };
        test_section("%s, order %d", name, order);
        write(order, &few, out);
        SAME_BITS(out, whole, (size_t)SH_COUNT(order) * sizeof(float));
        free(short_a);
        free(short_b);
        free(out);
    }
}

/* One number out of coefficients. */
typedef float (*reader)(int order, const inputs *in);

static float read_dot(int order, const inputs *in) {
    return sh_dot(order, in->a, in->b);
}

static float read_radiance(int order, const inputs *in) {
    return sh_radiance(order, in->a, in->dir);
}

static float read_irradiance(int order, const inputs *in) {
    return sh_irradiance(order, in->a, in->dir);
}

static float read_opposite(int order, const inputs *in) {
    return sh_irradiance_opposite(order, in->a, in->dir, in->value);
}

static float read_ao(int order, const inputs *in) {
    return sh_irradiance_ao(order, in->a, in->dir, 0.3f);
}

static const struct {
    const char *name;
    reader read;
} readers[] = {
    { "sh_dot", read_dot },
    { "sh_radiance", read_radiance },
    { "sh_irradiance", read_irradiance },
    { "sh_irradiance_opposite", read_opposite },
    { "sh_irradiance_ao", read_ao },
};

/* An L2 set whose higher bands are 0 reads as the lower order does, to the rounding of another way to sum the same terms. */
static void check_reader(const char *name, reader read) {
    float a[9], b[9], dir[3];
    test_fill(a, 9, -1.0, 1.0);
    test_fill(b, 9, -1.0, 1.0);
    test_direction(dir);
    for (int order = SH_L1; order >= SH_L0; order--) {
        float *short_a = prefix(order, a), *short_b = prefix(order, b);
        const inputs few = { short_a, short_b, dir, 0.7f };
        const inputs padded = { a, b, dir, 0.7f };
        for (int i = SH_COUNT(order); i < 9; i++)
            a[i] = b[i] = 0.0f;
        test_section("%s, order %d", name, order);
        NEAR(read(order, &few), read(SH_L2, &padded), 1e-6); /* two ulp of a sum of absolute terms below 8 */
        free(short_a);
        free(short_b);
    }
}

static void run_tests(void) {
    for (int repeat = 0; repeat < 50; repeat++) {
        for (size_t i = 0; i < sizeof writers / sizeof writers[0]; i++)
            check_writer(writers[i].name, writers[i].write);
        for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++)
            check_reader(readers[i].name, readers[i].read);
    }
}
