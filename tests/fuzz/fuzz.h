/* fuzz.h - what a fuzz target needs: a cursor over its input, memory between guard pages, and a check that aborts. FUZZ_NO_TARGET
 * leaves out the entry.
 *
 * A target is one C file that defines fuzz_one(); it has one idea. Built with libFuzzer it explores; built with replay.c it runs
 * the inputs of files. It allocates nothing and keeps nothing from one input to the next. POSIX. */
#ifndef FUZZ_H
#define FUZZ_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FUZZ_ASAN 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define FUZZ_ASAN 1
#endif
#ifdef FUZZ_ASAN
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(begin, size) ((void)(begin), (void)(size))
#define ASAN_UNPOISON_MEMORY_REGION(begin, size) ((void)(begin), (void)(size))
#endif

#define FUZZ_CHECK(condition) ((condition) ? (void)0 : fuzz_fail(#condition, __FILE__, __LINE__))

static inline void fuzz_fail(const char *text, const char *file, int line) {
    fprintf(stderr, "%s:%d: %s\n", file, line, text);
    abort();
}

/* ---- The input: a cursor over its bytes; beyond the last one, zeros ---- */

typedef struct fuzz_input {
    const uint8_t *at, *end;
} fuzz_input;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#ifndef FUZZ_NO_TARGET
static void fuzz_one(fuzz_input *in);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_input in = { data, data + size };
    fuzz_one(&in);
    return 0;
}
#endif

static inline unsigned fuzz_byte(fuzz_input *in) {
    return in->at < in->end ? *in->at++ : 0u;
}

static inline uint32_t fuzz_word(fuzz_input *in) {
    uint32_t word = 0;
    for (int i = 0; i < 4; i++)
        word = word << 8 | fuzz_byte(in);
    return word;
}

/* Uniform in [0, count), count <= 256. */
static inline int fuzz_below(fuzz_input *in, int count) {
    return (int)fuzz_byte(in) % count;
}

/* In [0, limit], small ones much more often. */
static inline size_t fuzz_count(fuzz_input *in, size_t limit) {
    const unsigned first = fuzz_byte(in);
    const size_t count = first < 248 ? first % 72 : (size_t)fuzz_byte(in) << 8 | fuzz_byte(in);
    return count % (limit + 1);
}

/* Any 32-bit integer, the ends of ranges and powers of two and their neighbours more often. */
static inline int fuzz_int(fuzz_input *in) {
    const unsigned kind = fuzz_byte(in);
    if (kind < 128)
        return (int)kind % 80;
    if (kind < 192) {
        const uint32_t power = (uint32_t)1 << kind % 32, near_it = power + fuzz_byte(in) % 3 - 1;
        return (int)(kind & 32u ? 0u - near_it : near_it);
    }
    return (int)fuzz_word(in);
}

static inline size_t fuzz_size(fuzz_input *in) {
    const unsigned kind = fuzz_byte(in);
    if (kind < 128)
        return kind;
    return (size_t)(((uint64_t)1 << kind % 64) + fuzz_byte(in) - 128u);
}

/* ---- Numbers ---- */

static inline float fuzz_special(unsigned i) {
    static const float special[] = { 0.0f,   -0.0f,  1.0f,    -1.0f,   0.5f,        1.0f / 3.0f, 1e18f, -1e18f, 1e-30f,
                                     1e-38f, 1e-45f, -1e-45f, FLT_MIN, FLT_EPSILON, 65504.0f,    1e9f,  1e-9f,  16777216.0f };
    return special[i % (sizeof special / sizeof special[0])];
}

/* Finite, at most 1e18 in magnitude, the bound of the library's promises: plain numbers in [-2, 2] or special ones or any float
 * whatever. */
static inline float fuzz_finite(fuzz_input *in) {
    const unsigned kind = fuzz_byte(in);
    uint32_t bits;
    float value;
    if (kind < 160)
        return (float)((int)(kind << 8 | fuzz_byte(in)) - 20480) / 10240.0f;
    if (kind < 224)
        return fuzz_special(kind);
    bits = fuzz_word(in);
    memcpy(&value, &bits, sizeof value);
    return fabsf(value) <= 1e18f ? value : 1e18f;
}

/* Any float whatever: NaN, infinities and the largest among them. */
static inline float fuzz_float(fuzz_input *in) {
    static const float wild[] = { NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 1e38f };
    const unsigned kind = fuzz_byte(in);
    uint32_t bits;
    float value;
    if (kind < 192)
        return fuzz_finite(in);
    if (kind < 224)
        return wild[kind % 6];
    bits = fuzz_word(in);
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators" (splitmix64). */
static inline uint64_t fuzz_random(uint64_t *state) {
    uint64_t bits = (*state += UINT64_C(0x9e3779b97f4a7c15));
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return bits ^ (bits >> 31);
}

/* In [-1, 1). */
static inline float fuzz_uniform(uint64_t *state) {
    return (float)(int32_t)(fuzz_random(state) >> 32) / 2147483648.0f;
}

/* v / |v|; +z where that is not a direction. */
static inline void fuzz_normalize(const float v[3], float unit[3]) {
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2], length = sqrt(x * x + y * y + z * z);
    const int valid = length > 0.0 && length < 1e300;
    unit[0] = valid ? (float)(x / length) : 0.0f;
    unit[1] = valid ? (float)(y / length) : 0.0f;
    unit[2] = valid ? (float)(z / length) : 1.0f;
}

/* A unit direction: axes and diagonals more often. */
static inline void fuzz_direction(fuzz_input *in, float dir[3]) {
    float v[3];
    const unsigned kind = fuzz_byte(in);
    for (int i = 0; i < 3; i++)
        v[i] = kind < 64 ? (float)(kind >> 2 * i & 3u) - 1.0f : fuzz_finite(in);
    fuzz_normalize(v, dir);
}

/* One channel of L2: any numbers; or, more often, moments of a few directional lights over ambient light. Finite, up to 1e18. */
static inline void fuzz_coefficients(fuzz_input *in, float c[9]) {
    const unsigned kind = fuzz_byte(in);
    if (kind < 64) {
        for (int i = 0; i < 9; i++)
            c[i] = fuzz_finite(in);
        return;
    }
    static const float scale[8] = { 1.0f, 1.0f, 1.0f, 1e-30f, 1e-20f, 1e9f, 1e15f, 1e-3f };
    double sum[9] = { 0 };
    for (unsigned light = 0; light < kind % 8; light++) {
        float dir[3];
        fuzz_direction(in, dir);
        const double x = (double)dir[0], y = (double)dir[1], z = (double)dir[2], value = fuzz_byte(in) / 16.0;
        const double basis[9] = { 1.0, x, y, z, x * x - 1.0 / 3, x * y, x * z, y * y - 1.0 / 3, y * z };
        for (int i = 0; i < 9; i++)
            sum[i] += value * basis[i];
    }
    sum[0] += fuzz_byte(in) / 64.0;
    for (int i = 0; i < 9; i++)
        c[i] = (float)(sum[i] * (double)scale[kind / 8 % 8]);
}

static inline float fuzz_largest(const float *c, int count) {
    float most = 0.0f;
    for (int i = 0; i < count; i++)
        most = fmaxf(most, fabsf(c[i]));
    return most;
}

/* Not a NaN, an infinity among them. By the bits. */
static inline int fuzz_all_finite(const float *c, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, c + i, sizeof bits);
        if ((bits & 0x7f800000u) == 0x7f800000u)
            return 0;
    }
    return 1;
}

/* Whether the origin is so near to the segment from a to b, for its size, that rounding decides on which side of it. */
static inline int fuzz_on_edge(const float a[3], const float b[3]) {
    double aa = 0.0, ae = 0.0, ee = 0.0, bb = 0.0, square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double p = (double)a[i], e = (double)b[i] - p;
        aa += p * p;
        bb += (double)b[i] * (double)b[i];
        ae += p * e;
        ee += e * e;
    }
    const double t = ee > 0.0 ? fmin(1.0, fmax(0.0, -ae / ee)) : 0.0;
    for (int i = 0; i < 3; i++) {
        const double p = (double)a[i] + t * ((double)b[i] - (double)a[i]);
        square += p * p;
    }
    return square <= 1e-10 * fmax(aa, bb);
}

/* ---- Memory between guard pages ---- */

enum { FUZZ_BUFFERS = 12, FUZZ_CAPACITY = 1 << 19, FUZZ_FENCE = 1024, FUZZ_CANARY = 0xa5 };

typedef struct fuzz_buffer {
    unsigned char *begin, *fence; /* fence: FUZZ_FENCE poisoned bytes, or NULL */
} fuzz_buffer;

static inline void fuzz_buffer_map(fuzz_buffer *buffer) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    unsigned char *map = (unsigned char *)mmap(NULL, FUZZ_CAPACITY + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (map == MAP_FAILED || mprotect(map + page, FUZZ_CAPACITY, PROT_READ | PROT_WRITE) != 0) {
        perror("guard pages");
        exit(1);
    }
    buffer->begin = map + page;
}

/* `size` bytes of buffer number `which` with a page that cannot be touched right after them or, if at_start, right before them; on
 * the other side, for the address sanitizer, a fence. They have what an earlier use left. */
static inline unsigned char *fuzz_place(int which, size_t size, int at_start) {
    static fuzz_buffer buffers[FUZZ_BUFFERS];
    fuzz_buffer *buffer = &buffers[which];
    FUZZ_CHECK(which < FUZZ_BUFFERS && size + FUZZ_FENCE + 8 <= FUZZ_CAPACITY);
    if (!buffer->begin)
        fuzz_buffer_map(buffer);
    if (buffer->fence)
        ASAN_UNPOISON_MEMORY_REGION(buffer->fence, FUZZ_FENCE);
    unsigned char *place = at_start ? buffer->begin : buffer->begin + FUZZ_CAPACITY - size;
    /* A fence starts and ends at a multiple of 8, as the sanitizer has it. */
    buffer->fence = at_start ? place + (size + 7) / 8 * 8 : buffer->begin + (FUZZ_CAPACITY - size) / 8 * 8 - FUZZ_FENCE;
    ASAN_POISON_MEMORY_REGION(buffer->fence, FUZZ_FENCE);
    return place;
}

static inline float *fuzz_place_floats(int which, size_t count, int at_start) {
    return (float *)(void *)fuzz_place(which, count * sizeof(float), at_start);
}

/* `count` floats in [-1, 1) from one seed, some of them replaced by floats of the input. */
static inline void fuzz_fill(fuzz_input *in, float *out, size_t count) {
    uint64_t state = fuzz_byte(in);
    for (size_t i = 0; i < count; i++)
        out[i] = fuzz_uniform(&state);
    for (int pokes = fuzz_below(in, 4); pokes && count; pokes--)
        out[fuzz_byte(in) % count] = fuzz_float(in);
}

static inline void fuzz_random_direction(uint64_t *state, float unit[3]) {
    float v[3];
    for (int i = 0; i < 3; i++)
        v[i] = fuzz_uniform(state);
    fuzz_normalize(v, unit);
}

/* Unit directions from one seed. */
static inline void fuzz_fill_directions(fuzz_input *in, float *x, float *y, float *z, size_t count) {
    uint64_t state = fuzz_byte(in);
    for (size_t i = 0; i < count; i++) {
        float unit[3];
        fuzz_random_direction(&state, unit);
        x[i] = unit[0];
        y[i] = unit[1];
        z[i] = unit[2];
    }
    if (count)
        z[0] = z[0] < 0.0f ? -1.0f : 1.0f, x[0] = y[0] = 0.0f;
}

/* The same float, or both NaN. */
static inline int fuzz_same(float a, float b) {
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

#endif /* FUZZ_H */
