/* images.h - images for the tests: random ones of every format and layout, in memory of exactly their size. */
#ifndef TEST_IMAGES_H
#define TEST_IMAGES_H

#include "oracle_image.h"
#include "test.h"

enum { TEST_FORMATS = 5 };

static const char *const test_format_names[TEST_FORMATS] = { "F32", "F16", "RGBE8", "RGB9E5", "sRGB8" };

static inline int test_format_has(sh_format format, int channels) {
    return channels >= 3 || (format != SH_RGBE8 && format != SH_RGB9E5);
}

/* How an image lies in memory: bytes before the first texel, and between rows. */
typedef struct test_layout {
    size_t offset, padding;
} test_layout;

static const test_layout test_tight = { 0, 0 };

/* An image, and the memory to free. Row strides are explicit unless the layout is tight. */
typedef struct test_image {
    sh_image image;
    unsigned char *memory;
} test_image;

static inline unsigned char *test_texel(const test_image *of, int x, int y) {
    return of->memory + (oracle_texel_address(&of->image, x, y) - of->memory);
}

/* All bytes are 0xff: NaN in every float format, so that reading anything but the texels shows. */
static inline test_image test_image_create(int width, int height, int channels, sh_format format, test_layout layout) {
    test_image of;
    of.image.width = width;
    of.image.height = height;
    of.image.channels = channels;
    of.image.format = format;
    const size_t row = oracle_texel_size(&of.image) * (size_t)width, stride = row + layout.padding;
    const size_t size = layout.offset + stride * (size_t)(height - 1) + row;
    of.memory = (unsigned char *)test_allocate(size);
    memset(of.memory, 0xff, size);
    of.image.pixels = of.memory + layout.offset;
    of.image.row_stride = layout.padding ? stride : 0;
    return of;
}

static inline void test_image_free(test_image *of) {
    free(of->memory);
    of->memory = NULL;
    of->image.pixels = NULL;
}

/* Colour k of a texel of an F32 image. */
static inline void test_image_set(const test_image *of, int x, int y, int k, float value) {
    memcpy(test_texel(of, x, y) + 4 * k, &value, sizeof value);
}

/* Random colours, all finite. F32 is uniform in [low, high); the others have random mantissas and a few exponents about 1. Alpha
 * stays 0xff. */
static inline void test_image_fill(const test_image *of, double low, double high) {
    for (int y = 0; y < of->image.height; y++)
        for (int x = 0; x < of->image.width; x++) {
            unsigned char *texel = test_texel(of, x, y);
            const uint64_t bits = test_bits();
            const uint32_t shared = ((uint32_t)bits & 0x07ffffffu) | (14u + (uint32_t)(bits >> 32) % 4u) << 27;
            switch (of->image.format) {
            case SH_F32:
                for (int k = 0; k < oracle_colours(&of->image); k++)
                    test_image_set(of, x, y, k, (float)test_uniform(low, high));
                break;
            case SH_F16:
                for (int k = 0; k < oracle_colours(&of->image); k++) {
                    const uint32_t part = (uint32_t)(bits >> 16 * k), exponent = 12u + part % 5u;
                    const uint16_t half = (uint16_t)((part & 0x83ffu) | exponent << 10);
                    memcpy(texel + 2 * k, &half, sizeof half);
                }
                break;
            case SH_RGBE8:
                memcpy(texel, &bits, 3);
                texel[3] = (unsigned char)(126u + (bits >> 32) % 5u);
                break;
            case SH_RGB9E5:
                memcpy(texel, &shared, sizeof shared);
                break;
            case SH_SRGB8:
                memcpy(texel, &bits, (size_t)oracle_colours(&of->image));
                break;
            }
        }
}

/* The contract of a projection: its error by the mean of |radiance| of the channel. */
static const long double test_projection_tolerance = 1e-6L;

/* Compares a projection by sh.h with the oracle's. */
static inline void test_projection_near(int order, int channels, const float *c, const oracle_projection *expected) {
    for (int k = 0; k < channels; k++)
        NEAR_ALL(c + k * SH_COUNT(order), expected->c[k], SH_COUNT(order), test_projection_tolerance * expected->magnitude[k]);
}

#endif /* TEST_IMAGES_H */
