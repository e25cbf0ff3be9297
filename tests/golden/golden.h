/* golden.h - results of sh.h for fixed input: what tests/golden/generate.c writes down and tests/test_golden.c compares.
 *
 * The same bits come from every compiler and target whose float arithmetic is IEEE's and whose compiler fuses nothing by itself
 * (-ffp-contract=off), but for two things: whether the vocabulary's multiply-add fuses, as on AVX2, AVX-512 and NEON with FMA, which is
 * why there are two files of golden values; and the cases below that have a tolerance, since they call functions of the C library that
 * are not correctly rounded (cos, tanh, powf ...) or add up in an order that depends on the number of lanes. */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "sh.h"

enum { GOLDEN_CASES = 80, GOLDEN_VALUES = 48, GOLDEN_ITEMS = 21 };

/* tolerance: 0: bit for bit; otherwise relative to the case's largest value */
typedef struct golden_case {
    const char *name;
    double tolerance;
    int count;
    float value[GOLDEN_VALUES];
} golden_case;

static golden_case golden[GOLDEN_CASES];
static int golden_count;

static inline void golden_put(const char *name, double tolerance, const float *value, int count) {
    golden_case *c = &golden[golden_count++];
    c->name = name;
    c->tolerance = tolerance;
    c->count = count;
    memcpy(c->value, value, (size_t)count * sizeof *value);
}

static inline void golden_put1(const char *name, double tolerance, float value) {
    golden_put(name, tolerance, &value, 1);
}

/* ---- Input that no arithmetic can round differently ---- */

/* Multiples of 1/256 in [-1, 1). */
static inline float golden_number(void) {
    static uint32_t state = 12345u;
    state = (state * 1664525u + 1013904223u) & 0xffffffffu;
    return (float)(int)(state >> 23) / 256.0f - 1.0f;
}

/* Unit vectors whose components are one division each. */
static inline void golden_direction(int i, float dir[3]) {
    static const float quadruple[7][4] = { { 1, 2, 2, 3 }, { 2, 3, 6, 7 },   { 1, 4, 8, 9 },  { 6, 2, 9, 11 },
                                           { 0, 0, 1, 1 }, { 3, 4, 12, 13 }, { 8, 9, 12, 17 } };
    const float *q = quadruple[i % 7];
    for (int k = 0; k < 3; k++)
        dir[k] = (i >> k & 1 ? -q[(k + i) % 3] : q[(k + i) % 3]) / q[3];
}

/* Three sets: light that non-negative light can have, nearly one direction, and anything. */
static const float golden_sets[3 * SH_COUNT(SH_L2)] = {
    1.0f, 0.25f,  -0.375f,    0.125f, 0.0625f,  -0.125f, 0.1875f, 0.03125f, 0.09375f, /* */
    2.0f, 1.125f, 1.5f,       0.25f,  -0.0625f, 0.8125f, 0.125f,  0.4375f,  0.1875f,  /* */
    0.5f, -0.75f, 0.0078125f, 1.25f,  -0.875f,  0.3125f, -0.5f,   1.375f,   0.625f,
};

/* ---- Cases ---- */

static inline void golden_coefficients(void) {
    float dir[3], out[SH_COUNT(SH_L2)];
    const float *c = golden_sets;
    golden_direction(1, dir);
    sh_basis(SH_L2, dir, out);
    golden_put("basis", 0, out, 9);
    memcpy(out, c, sizeof out);
    sh_add_sample(SH_L2, dir, 0.375f, out);
    golden_put("add_sample", 0, out, 9);
    sh_lerp(SH_L2, c, c + 9, 0.3f, out);
    golden_put("lerp", 0, out, 9);
    golden_put1("dot", 0, sh_dot(SH_L2, c, c + 18));
    sh_product(SH_L2, c, c + 9, out);
    golden_put("product", 0, out, 9);
}

static inline void golden_operators(void) {
    static const float q[4] = { 1, 2, 3, 4 };
    static const int axis[3] = { 1, 3, -2 };
    float m[9], zonal[3], out[SH_COUNT(SH_L2)], dir[3];
    const float *c = golden_sets;
    golden_direction(2, dir);
    sh_rotation_from_quaternion(q, m);
    golden_put("rotation_from_quaternion", 0, m, 9);
    sh_rotate(SH_L2, c, m, out);
    golden_put("rotate", 0, out, 9);
    sh_swap_axes(SH_L2, c, axis, out);
    golden_put("swap_axes", 0, out, 9);
    sh_zonal_cap(0.7f, zonal);
    sh_convolve(SH_L2, c, zonal, out);
    golden_put("convolve", 0, out, 9);
    sh_zonal_ao(0.3f, zonal);
    memcpy(out, c, sizeof out);
    sh_zonal_add(SH_L2, zonal, dir, 1.7f, out);
    golden_put("zonal_add", 0, out, 9);
}

static inline void golden_zonal(void) {
    float z[3];
    sh_zonal_laplacian(0.1f, z);
    golden_put("zonal_laplacian", 0, z, 3);
    sh_zonal_cosine_power(7.5f, z);
    golden_put("zonal_cosine_power", 0, z, 3);
    sh_zonal_vmf(6.0f, z);
    golden_put("zonal_vmf", 1e-6, z, 3);
    sh_zonal_hann(4.5f, z);
    golden_put("zonal_hann", 1e-6, z, 3);
    sh_zonal_lanczos(4.5f, z);
    golden_put("zonal_lanczos", 1e-6, z, 3);
    sh_zonal_ggx(0.3f, z);
    golden_put("zonal_ggx", 1e-6, z, 3);
}

static inline void golden_reconstruction(int set) {
    static const char *const name[3] = { "reconstruction, light", "reconstruction, one direction", "reconstruction, anything" };
    const float *c = golden_sets + set * SH_COUNT(SH_L2);
    float out[16], dir[3];
    for (int i = 0; i < 2; i++) {
        float *o = out + 8 * i;
        golden_direction(3 * i + set, dir);
        o[0] = sh_radiance(SH_L2, c, dir);
        o[1] = sh_irradiance(SH_L2, c, dir);
        o[2] = sh_irradiance_ao(SH_L2, c, dir, 0.25f);
        sh_irradiance_bounds(SH_L1, c, dir, o + 3, o + 4);
        sh_irradiance_bounds(SH_L2, c, dir, o + 5, o + 6);
        o[7] = sh_irradiance_zh3(c, dir);
    }
    golden_put(name[set], 0, out, 16);
}

static inline void golden_closures(int set) {
    static const char *const name[3] = { "closure, light", "closure, one direction", "closure, anything" };
    static const char *const other[3] = { "geomerics, light", "geomerics, one direction", "geomerics, anything" };
    const float *c = golden_sets + set * SH_COUNT(SH_L2);
    float out[12], geomerics[4], dir[3];
    sh_closure closure;
    sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &closure);
    for (int i = 0; i < 4; i++) {
        golden_direction(5 * i + set, dir);
        out[3 * i] = sh_irradiance_closure(SH_L1, c, dir);
        out[3 * i + 1] = sh_irradiance_closure(SH_L2, c, dir);
        out[3 * i + 2] = sh_closure_irradiance(SH_L2, &closure, dir);
        geomerics[i] = sh_irradiance_geomerics(c, dir);
    }
    golden_put(name[set], 0, out, 12);
    golden_put(other[set], 1e-6, geomerics, 4);
}

static inline void golden_analysis(int set) {
    static const char *const name[3] = { "analysis, light", "analysis, one direction", "analysis, anything" };
    const float *c = golden_sets + set * SH_COUNT(SH_L2);
    float out[16], window[SH_COUNT(SH_L2)];
    out[0] = sh_directionality(c);
    out[1] = sh_ambient_floor(c);
    out[2] = sh_min(SH_L2, c, out + 3);
    out[6] = sh_irradiance_max(SH_L2, c, out + 7);
    sh_dominant_light(SH_L2, 1, c, out + 10, out + 13, out + 14);
    out[15] = sh_dering(SH_L2, 1, c, SH_WINDOW_LAPLACIAN, window);
    golden_put(name[set], 0, out, 16);
}

static inline void golden_storage(void) {
    float out[28], r0[3];
    uint16_t half[28];
    uint8_t byte[24];
    uint32_t word[9];
    sh_pack_shader(golden_sets, out);
    golden_put("pack_shader", 0, out, 28);
    sh_pack_half(SH_L2, 3, golden_sets, half);
    sh_unpack_half(SH_L2, 3, half, out);
    golden_put("pack_half", 0, out, 27);
    sh_pack_unorm8(SH_L2, 3, golden_sets, r0, byte);
    sh_unpack_unorm8(SH_L2, 3, r0, byte, out);
    golden_put("pack_unorm8", 0, out, 27);
    sh_pack_unorm10(SH_L2, 3, golden_sets, r0, word);
    sh_unpack_unorm10(SH_L2, 3, r0, word, out);
    golden_put("pack_unorm10", 0, out, 27);
    sh_to_orthonormal(SH_L2, golden_sets, SH_CONDON_SHORTLEY, out);
    golden_put("to_orthonormal", 0, out, 9);
    sh_to_unity(SH_L2, golden_sets, out);
    golden_put("to_unity", 0, out, 9);
    sh_to_babylon(golden_sets, out);
    golden_put("to_babylon", 0, out, 9);
}

static inline void golden_lights(void) {
    static const float one = 1.0f, vertices[12] = { -1, -1, 2, 1, -1, 2, 1, 1, 3, -1, 1, 3 };
    float c[SH_COUNT(SH_L2)] = { 0 }, dir[3];
    golden_direction(6, dir);
    sh_add_cap(SH_L2, 1, dir, 0.3f, SH_IRRADIANCE, &one, c);
    golden_put("add_cap", 1e-6, c, 9);
    memset(c, 0, sizeof c);
    sh_add_polygon(SH_L2, 1, vertices, 4, &one, c);
    golden_put("add_polygon", 1e-6, c, 9);
}

/* A polynomial of the direction, or nearly. */
static inline void golden_sky(const float dir[3], float *value, void *user) {
    (void)user;
    *value = 1.0f + dir[0] - 0.5f * dir[1] * dir[2] + dir[2] * dir[2] * dir[2];
}

static inline void golden_samples(void) {
    float x[GOLDEN_ITEMS], y[GOLDEN_ITEMS], z[GOLDEN_ITEMS], value[GOLDEN_ITEMS], weight[GOLDEN_ITEMS], c[SH_COUNT(SH_L2)];
    sh_accum accum;
    sh_accum_clear(1, &accum);
    for (int i = 0; i < GOLDEN_ITEMS; i++) {
        float dir[3];
        golden_direction(i, dir);
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
        value[i] = golden_number();
        weight[i] = 1.5f + golden_number();
        sh_accum_sample(SH_L2, dir, value[i], weight[i], &accum);
    }
    sh_accum_finish(SH_L2, 1, &accum, c);
    golden_put("accum_sample", 0, c, 9);
    sh_project_samples(SH_L2, 1, x, y, z, value, weight, GOLDEN_ITEMS, c);
    golden_put("project_samples", 1e-6, c, 9);
    sh_fit_samples(SH_L2, 1, x, y, z, value, weight, GOLDEN_ITEMS, NULL, 0.01f, c);
    golden_put("fit_samples", 1e-6, c, 9);
    sh_project_function(SH_L2, 1, golden_sky, NULL, 6, c);
    golden_put("project_function", 1e-6, c, 9);
}

/* 19 x 10 texels of each format, negative and non-finite ones among the floats. */
static inline void golden_images(void) {
    enum { WIDTH = 19, HEIGHT = 10, SIZE = 9 };
    float f32[WIDTH * HEIGHT * 3], c[3 * SH_COUNT(SH_L2)];
    unsigned char bytes[WIDTH * HEIGHT * 4];
    uint32_t word = 0x7f800000u;
    sh_image image = { f32, WIDTH, HEIGHT, 0, 3, SH_F32 };
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        f32[i] = 1.0f + 1.25f * golden_number();
    memcpy(f32 + 100, &word, sizeof word);
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++)
        bytes[i] = (unsigned char)(i % 4 == 3 ? 128 + i % 3 : i * 37 % 256);
    sh_project_equirect(SH_L2, &image, SH_CLAMP_NEGATIVE, c, NULL);
    golden_put("equirect f32", 1e-6, c, 27);
    image.pixels = bytes;
    image.format = SH_RGBE8;
    sh_project_equirect(SH_L2, &image, SH_POINT_TEXELS | SH_CLOCKWISE, c, NULL);
    golden_put("equirect rgbe8", 1e-6, c, 27);
    image.format = SH_SRGB8;
    sh_project_equirect(SH_L2, &image, 0, c, NULL);
    golden_put("equirect srgb8", 1e-6, c, 27);
    sh_image face[6];
    for (int i = 0; i < 6; i++) {
        const sh_image one = { bytes + 4 * i, 8, 8, 48, 3, SH_SRGB8 };
        face[i] = one;
    }
    sh_project_cubemap(SH_L2, face, 0, c, NULL);
    golden_put("cubemap", 1e-6, c, 27);
    image.width = image.height = SIZE;
    sh_project_octahedral(SH_L2, &image, 0, c, NULL);
    golden_put("octahedral", 1e-6, c, 27);
}

/* The first GOLDEN_ITEMS results of a batch of two channels, whose length is no multiple of any vector's. */
static inline void golden_batches(void) {
    float n[3][GOLDEN_ITEMS], aos[3 * GOLDEN_ITEMS], out[2 * GOLDEN_ITEMS], probes[GOLDEN_ITEMS * SH_COUNT(SH_L2)];
    for (int i = 0; i < GOLDEN_ITEMS; i++) {
        golden_direction(i, aos + 3 * i);
        for (int k = 0; k < 3; k++)
            n[k][i] = aos[3 * i + k];
        for (int j = 0; j < SH_COUNT(SH_L2); j++)
            probes[i * SH_COUNT(SH_L2) + j] = golden_number();
    }
    sh_radiance_batch(SH_L2, 2, golden_sets, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("radiance_batch", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_batch_aos(SH_L2, 2, golden_sets, aos, 0, out, 0, GOLDEN_ITEMS);
    golden_put("irradiance_batch_aos", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_closure_batch(SH_L1, 2, golden_sets + 9, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("closure_batch L1", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_closure_batch(SH_L2, 2, golden_sets + 9, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("closure_batch L2", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_geomerics_batch(SH_L1, 2, golden_sets, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("geomerics_batch", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_zh3_batch(SH_L1, 2, golden_sets, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("zh3_batch", 0, out, 2 * GOLDEN_ITEMS);
    sh_irradiance_probes_batch(SH_L2, 1, probes, n[0], n[1], n[2], out, GOLDEN_ITEMS);
    golden_put("irradiance_probes_batch", 0, out, GOLDEN_ITEMS);
}

static inline void golden_operator_batches(void) {
    enum { PAIRS = 5 };
    static const float quaternion[4] = { 1, -2, 3, -4 };
    float a[PAIRS * SH_COUNT(SH_L2)], b[PAIRS * SH_COUNT(SH_L2)], out[PAIRS * SH_COUNT(SH_L2)], m[9];
    for (int i = 0; i < PAIRS * SH_COUNT(SH_L2); i++) {
        a[i] = golden_number();
        b[i] = golden_number();
    }
    sh_product_batch(SH_L2, a, b, out, PAIRS);
    golden_put("product_batch", 0, out, PAIRS * SH_COUNT(SH_L2));
    sh_rotation_from_quaternion(quaternion, m);
    sh_rotate_batch(SH_L2, a, m, out, PAIRS); /* one lane takes sh_rotate */
    golden_put("rotate_batch", 1e-6, out, PAIRS * SH_COUNT(SH_L2));
}

static inline void golden_compute(void) {
    golden_coefficients();
    golden_operators();
    golden_zonal();
    for (int set = 0; set < 3; set++) {
        golden_reconstruction(set);
        golden_closures(set);
        golden_analysis(set);
    }
    golden_storage();
    golden_lights();
    golden_samples();
    golden_images();
    golden_batches();
    golden_operator_batches();
}

/* ---- Arithmetic ---- */

/* Whether the vocabulary's multiply-add fuses: the square of 1 + 2^-12 has a bit more than a float. */
static inline int golden_fuses(void) {
    volatile float a = 1.0f + 1.0f / 4096, c = -(1.0f + 1.0f / 2048); /* volatile: nothing is known to the compiler */
    float out[SHI_LANES];
    shi_store(out, shi_madd(shi_splat(a), shi_splat(a), shi_splat(c)));
    return out[0] != 0.0f;
}

#endif /* GOLDEN_H */
