/* image.h - what the targets for images have in common: a descriptor from the input, whether it is valid by the contract, its pixels
 * between guard pages, and their values by definition. */
#ifndef IMAGE_H
#define IMAGE_H

#include "backend.h"
#include "fuzz.h"

enum { IMAGE_FACES = 6, IMAGE_MOST = 200000 /* bytes of one face's rows */, IMAGE_SIDE = 1 << 28 };

/* 0 for what the contract does not know. */
static inline size_t image_pixel_size(const sh_image *image) {
    const int n = image->channels;
    if (n != 1 && n != 3 && n != 4)
        return 0;
    switch ((int)image->format) {
    case SH_F32:
        return 4 * (size_t)n;
    case SH_F16:
        return 2 * (size_t)n;
    case SH_SRGB8:
        return (size_t)n;
    case SH_RGBE8:
    case SH_RGB9E5:
        return n == 1 ? 0 : 4;
    default:
        return 0;
    }
}

static inline uint64_t image_stride(const sh_image *image) {
    const uint64_t row = (uint64_t)(image->width > 0 ? image->width : 0) * image_pixel_size(image);
    return image->row_stride ? image->row_stride : row;
}

/* Whether an image by itself is one: sides from 1 to 2^28, a known format, a stride that holds a row, less than half the address
 * space. */
static inline int image_valid(const sh_image *image) {
    const size_t pixel = image_pixel_size(image);
    const uint64_t row = (uint64_t)(image->width > 0 ? image->width : 0) * pixel, most = (uint64_t)SIZE_MAX / 2;
    return image->pixels && pixel && image->width > 0 && image->width <= IMAGE_SIDE && image->height > 0 &&
           image->height <= IMAGE_SIDE && image_stride(image) >= row && row <= most &&
           (uint64_t)image->height <= most / image_stride(image);
}

/* A projection to be tried: rows [first, first + count) of one image or of six. */
typedef struct image_job {
    int map, order, first, count;
    unsigned flags;
    sh_image face[IMAGE_FACES];
} image_job;

static inline int image_faces(const image_job *job) {
    return job->map == FUZZ_CUBEMAP ? IMAGE_FACES : 1;
}

/* What the contract says of a job. */
static inline int image_job_valid(const image_job *job) {
    const unsigned known = job->map == FUZZ_EQUIRECT ? SH_CLAMP_NEGATIVE | SH_POINT_TEXELS | SH_CLOCKWISE : SH_CLAMP_NEGATIVE;
    const sh_image *image = job->face;
    if (job->order < SH_L0 || job->order > SH_L2 || job->flags & ~known || job->first < 0 || job->count < 0 ||
        (int64_t)job->first + job->count > image->height || (job->map != FUZZ_EQUIRECT && image->width != image->height))
        return 0;
    for (int i = 0; i < image_faces(job); i++)
        if (!image_valid(image + i) || image[i].width != image->width || image[i].height != image->height ||
            image[i].channels != image->channels || image[i].format != image->format)
            return 0;
    return 1;
}

/* Bytes of the rows that a valid job reads, of one face: the last row ends with its last texel. */
static inline uint64_t image_rows_size(const image_job *job, const sh_image *image) {
    const uint64_t row = (uint64_t)image->width * image_pixel_size(image);
    return job->count ? (uint64_t)(job->count - 1) * image_stride(image) + row : 0;
}

/* In [1, limit]: tiny as a rule, so that a run is short; beyond a block of the kernels now and then. */
static inline int image_side(fuzz_input *in, int limit) {
    const int byte = fuzz_below(in, 256), side = byte < 160 ? byte % 7 : byte < 248 ? byte % 20 : fuzz_below(in, 256) * 3;
    return 1 + side % limit;
}

/* A descriptor that is valid and small, or hostile; pixels are set later. */
static inline void image_describe(fuzz_input *in, int map, image_job *job) {
    static const unsigned char channels[4] = { 3, 1, 4, 3 };
    const unsigned kind = fuzz_byte(in);
    sh_image *image = job->face;
    memset(job, 0, sizeof *job);
    job->map = map;
    job->order = fuzz_below(in, 3);
    job->flags = fuzz_byte(in) & (map == FUZZ_EQUIRECT ? 7u : 1u);
    image->format = (sh_format)fuzz_below(in, 5);
    image->channels = channels[fuzz_below(in, image_pixel_size(image) ? 4 : 3)];
    if (image->channels == 1 && (image->format == SH_RGBE8 || image->format == SH_RGB9E5))
        image->channels = 3;
    image->width = image_side(in, map == FUZZ_EQUIRECT ? 700 : 140);
    image->height = map == FUZZ_EQUIRECT ? image_side(in, 40) : image->width;
    job->first = fuzz_below(in, 2) ? fuzz_below(in, image->height) : 0;
    job->count = job->first || fuzz_below(in, 2) ? fuzz_below(in, image->height - job->first + 1) : image->height;
    if (kind >= 200) {
        /* One or more members of any value. */
        const unsigned which = fuzz_byte(in) | fuzz_byte(in) << 8;
        if (which & 1u)
            job->order = fuzz_int(in);
        if (which & 2u)
            job->flags = (unsigned)fuzz_int(in);
        if (which & 4u)
            image->format = (sh_format)(unsigned)fuzz_int(in);
        if (which & 8u)
            image->channels = fuzz_int(in);
        if (which & 16u)
            image->width = fuzz_int(in);
        if (which & 32u)
            image->height = fuzz_int(in);
        if (which & 64u)
            job->first = fuzz_int(in);
        if (which & 128u)
            job->count = fuzz_int(in);
        if (which & 256u)
            image->height = image->width;
    }
    for (int i = 1; i < image_faces(job); i++)
        job->face[i] = *image;
    for (int i = 0; i < image_faces(job); i++) {
        const uint64_t row = image_stride(job->face + i);
        const unsigned stride = fuzz_byte(in);
        job->face[i].row_stride = stride < 128 ? 0 : stride < 240 ? (size_t)row + stride % 64 : fuzz_size(in);
    }
    if (kind >= 250) {
        image += fuzz_below(in, 6) % image_faces(job);
        image->width += fuzz_below(in, 3) - (image->width > 0);
        image->format = (sh_format)(unsigned)fuzz_below(in, 6);
    }
}

/* What texels hold: bytes of one seed as numbers that are plain for the format, some of them of the input. */
static inline void image_fill(fuzz_input *in, const sh_image *image, unsigned char *bytes, size_t size) {
    uint64_t state = fuzz_byte(in);
    const unsigned kind = fuzz_byte(in);
    for (size_t i = 0; i + 8 <= size; i += 8) {
        uint64_t random = fuzz_random(&state);
        memcpy(bytes + i, &random, 8);
    }
    for (size_t i = size / 8 * 8; i < size; i++)
        bytes[i] = (unsigned char)(i * 37);
    if (image->format == SH_F32)
        for (size_t i = 0; i + 4 <= size; i += 4) {
            uint32_t bits; /* in [1, 2): or of either sign, [-2, 2] */
            float value;
            memcpy(&bits, bytes + i, 4);
            bits = (bits & (kind & 1u ? 0x807fffffu : 0x7fffffu)) | 0x3f800000u;
            memcpy(&value, &bits, 4);
            value -= kind & 2u ? 1.0f : 0.0f;
            memcpy(bytes + i, &value, 4);
        }
    if (image->format == SH_F16 || image->format == SH_RGBE8) /* exponents near 1: not often infinite, nor of any magnitude */
        for (size_t i = image->format == SH_F16 ? 1 : 3; i < size; i += image->format == SH_F16 ? 2 : 4)
            bytes[i] = (unsigned char)(image->format == SH_F16 ? (bytes[i] & (kind & 1u ? 0x83 : 3)) | 0x38 : 126 + bytes[i] % 4);
    for (int pokes = fuzz_below(in, 5); pokes && size; pokes--) {
        const float value = fuzz_float(in);
        const size_t at = (fuzz_byte(in) * 256u + fuzz_byte(in)) % size / 4 * 4;
        if (size - at >= 4)
            memcpy(bytes + at, &value, 4);
    }
}

/* Gives the job its pixels: of rows that it reads, every byte that it may and none besides. */
static inline void image_place(fuzz_input *in, image_job *job, unsigned char *bytes[IMAGE_FACES]) {
    const int at_start = fuzz_below(in, 2);
    for (int i = 0; i < image_faces(job); i++) {
        sh_image *image = job->face + i;
        const size_t size = (size_t)image_rows_size(job, image);
        bytes[i] = fuzz_place(i, size, at_start);
        image->pixels = (const void *)((uintptr_t)bytes[i] - (uintptr_t)job->first * (uintptr_t)image_stride(image));
        if (i == 0 || size != (size_t)image_rows_size(job, job->face))
            image_fill(in, image, bytes[i], size);
        else
            memcpy(bytes[i], bytes[0], size);
        if (i && size)
            bytes[i][0] ^= (unsigned char)(1 << i);
    }
}

static inline float image_half(unsigned bits) {
    const int exponent = (int)(bits >> 10 & 31u), mantissa = (int)(bits & 1023u);
    const float sign = bits >> 15 ? -1.0f : 1.0f;
    if (exponent == 31)
        return mantissa ? NAN : sign * INFINITY;
    return sign * ldexpf((float)(exponent ? 1024 + mantissa : mantissa), exponent ? exponent - 25 : -24);
}

/* The colours of the texel at p. */
static inline void image_texel(const sh_image *image, const unsigned char *p, float value[3]) {
    uint32_t word;
    uint16_t half;
    memset(value, 0, 3 * sizeof *value);
    for (int k = 0; k < (image->channels == 1 ? 1 : 3); k++)
        switch (image->format) {
        case SH_F32:
            memcpy(value + k, p + 4 * k, 4);
            break;
        case SH_F16:
            memcpy(&half, p + 2 * k, 2);
            value[k] = image_half(half);
            break;
        case SH_RGBE8:
            value[k] = p[3] ? ldexpf((float)p[k], (p[3] < 255 ? p[3] : 254) - 136) : 0.0f;
            break;
        case SH_RGB9E5:
            memcpy(&word, p, 4);
            value[k] = ldexpf((float)(word >> 9 * k & 511u), (int)(word >> 27) - 24);
            break;
        default:
            value[k] = p[k] <= 10 ? (float)p[k] / 255.0f / 12.92f : powf(((float)p[k] / 255.0f + 0.055f) / 1.055f, 2.4f);
            break;
        }
}

/* What a valid job's rows say: the report, the largest magnitude, and in clean[] the texels as tight float RGB, as the flags want. */
static inline float image_decode(const image_job *job, unsigned char *const bytes[IMAGE_FACES], float *const clean[IMAGE_FACES],
                                 sh_report *report) {
    float most = 0.0f;
    memset(report, 0, sizeof *report);
    for (int i = 0; i < image_faces(job); i++) {
        const sh_image *image = job->face + i;
        float *out = clean[i];
        for (int row = 0; row < job->count; row++)
            for (int x = 0; x < image->width; x++, out += 3) {
                float value[3];
                image_texel(image, bytes[i] + (size_t)row * (size_t)image_stride(image) + (size_t)x * image_pixel_size(image),
                            value);
                const int finite = fuzz_all_finite(value, 3), negative = finite && (value[0] < 0 || value[1] < 0 || value[2] < 0);
                for (int k = 0; k < 3; k++) {
                    out[k] = finite && !(value[k] < 0.0f && (job->flags & SH_CLAMP_NEGATIVE)) ? value[k] : 0.0f;
                    most = fmaxf(most, fabsf(out[k]));
                }
                report->texels++;
                report->nonfinite += !finite;
                report->negative += (uint64_t)negative;
            }
    }
    return most;
}

/* Compares sums over rows with those of the same texels as tight float RGB, by the scalar kernels. most: the largest magnitude. */
static inline void image_compare(const image_job *job, float *const clean[IMAGE_FACES], float most, const sh_accum *accum) {
    image_job plain = *job;
    sh_accum expected[3];
    double total = 0.0;
    memset(expected, 0, sizeof expected);
    for (int i = 0; i < image_faces(job); i++) {
        sh_image *image = plain.face + i;
        image->format = SH_F32;
        image->channels = 3;
        image->row_stride = 0;
        image->pixels = (const void *)((uintptr_t)clean[i] - (uintptr_t)job->first * (uintptr_t)image->width * 12);
    }
    plain.flags &= ~(unsigned)SH_CLAMP_NEGATIVE;
    FUZZ_CHECK(fuzz_backend_scalar.rows[job->map](job->order, plain.face, plain.flags, job->first, job->count, expected, NULL) ==
               SH_OK);
    for (int k = 0; k < (job->face->channels == 1 ? 1 : 3); k++) {
        FUZZ_CHECK(fabs(accum[k].weight - expected[k].weight) <= 2e-6 * expected[k].weight + 1e-12);
        total = (double)most * fmax(expected[k].weight, 0.0);
        for (int i = 0; i < SH_COUNT(job->order); i++)
            FUZZ_CHECK(fabs(accum[k].sum[i] - expected[k].sum[i]) <= 4e-6 * total + 1e-43);
    }
}

/* One job: an error and nothing written, or what the rows say. */
static inline void image_run(fuzz_input *in, int map) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    static float clean_rows[IMAGE_FACES][3 * IMAGE_MOST / 4];
    float *clean[IMAGE_FACES];
    unsigned char *bytes[IMAGE_FACES];
    image_job job;
    sh_accum accum[3], before[3];
    sh_report report, report_before, expected;

    image_describe(in, map, &job);
    for (int i = 0; i < IMAGE_FACES; i++) {
        clean[i] = clean_rows[i];
        job.face[i].pixels = fuzz_place(i, 0, 0); /* nothing may be read there */
    }
    if (fuzz_byte(in) == 255)
        job.face[fuzz_below(in, 6) % image_faces(&job)].pixels = NULL;
    int valid = image_job_valid(&job);
    for (int i = 0; valid && i < image_faces(&job); i++)
        if (image_rows_size(&job, job.face + i) > IMAGE_MOST || (uint64_t)job.count * (uint64_t)job.face->width * 4 > IMAGE_MOST ||
            (job.first && image_stride(job.face + i) > 0x10000000u / (uint64_t)job.first))
            job.count = 0; /* too large for this machine, or for today; or row 0 would be below address 0 */
    if (valid)
        image_place(in, &job, bytes);

    memset(before, FUZZ_CANARY, sizeof before);
    memset(&report_before, FUZZ_CANARY, sizeof report_before);
    if (valid) {
        memset(before, 0, sizeof before);
        memset(&report_before, 0, sizeof report_before);
    }
    memcpy(accum, before, sizeof before);
    report = report_before;
    const int counted = fuzz_below(in, 2);
    const int status = backend->rows[map](job.order, job.face, job.flags, job.first, job.count, accum, counted ? &report : NULL);
    if (!valid) {
        FUZZ_CHECK(status < 0 && memcmp(accum, before, sizeof before) == 0 && memcmp(&report, &report_before, sizeof report) == 0);
        return;
    }
    FUZZ_CHECK(status == SH_OK);
    if (!job.count) {
        FUZZ_CHECK(memcmp(accum, before, sizeof before) == 0);
        return;
    }
    const float most = image_decode(&job, bytes, clean, &expected);
    if (counted)
        FUZZ_CHECK(report.texels == expected.texels && report.nonfinite == expected.nonfinite &&
                   report.negative == expected.negative);
    if (most <= 1e38f)
        image_compare(&job, clean, most, accum);

    /* The whole image in one call. */
    if (job.first == 0 && job.count == job.face->height) {
        const size_t floats = (size_t)(sh_image_channels(job.face) * SH_COUNT(job.order));
        float *c = fuzz_place_floats(6, floats, fuzz_below(in, 2));
        FUZZ_CHECK(backend->image[map](job.order, job.face, job.flags, c, counted ? &report : NULL) == SH_OK);
        for (size_t i = 0; i < floats && most <= 1e38f; i++) {
            const sh_accum *a = accum + i / (size_t)SH_COUNT(job.order);
            FUZZ_CHECK(fabs((double)c[i] - a->sum[i % (size_t)SH_COUNT(job.order)] / a->weight) <= 1e-6 * (double)most + 1e-43);
        }
        FUZZ_CHECK(!counted || report.texels == expected.texels);
    }
}

#endif /* IMAGE_H */
