/* Batches against long double and against one direction at a time: every length, layout and overlap that is allowed; nothing beside
 * the results is written, and no result depends on its place. */
#include <float.h>

#include "oracle.h"
#include "sh.h"
#include "test.h"

enum { MOST = 5000, CHANNELS = 5, DIRECTIONS = 512 };

/* Lengths 0 to 70, and some about the size of a block. */
static const size_t long_lengths[] = { 1023, 1024, 1025, 1026, MOST };
enum { SHORT = 71, LENGTHS = SHORT + sizeof long_lengths / sizeof long_lengths[0] };

static size_t length_of(int i) {
    return i < SHORT ? (size_t)i : long_lengths[i - SHORT];
}

static float coordinates[3 * MOST];
static float *x, *y, *z;

static float sets[MOST * CHANNELS * 9]; /* a probe per direction, and coefficients of the other batches */

/* ---- The batches, with one signature ---- */

typedef void (*planar_batch)(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                             size_t count);
typedef void (*aos_batch)(int order, int channels, const float *c, const float *dir, size_t dir_stride, float *out, size_t out_stride,
                          size_t count);

static void radiance(int order, int channels, const float *c, const float *px, const float *py, const float *pz, float *out,
                     size_t count) {
    sh_radiance_batch(order, channels, c, px, py, pz, out, count);
}

static void irradiance(int order, int channels, const float *c, const float *px, const float *py, const float *pz, float *out,
                       size_t count) {
    sh_irradiance_batch(order, channels, c, px, py, pz, out, count);
}

static void probes(int order, int channels, const float *c, const float *px, const float *py, const float *pz, float *out,
                   size_t count) {
    sh_irradiance_probes_batch(order, channels, c, px, py, pz, out, count);
}

static void radiance_aos(int order, int channels, const float *c, const float *dir, size_t dir_stride, float *out, size_t out_stride,
                         size_t count) {
    sh_radiance_batch_aos(order, channels, c, dir, dir_stride, out, out_stride, count);
}

static void irradiance_aos(int order, int channels, const float *c, const float *dir, size_t dir_stride, float *out,
                           size_t out_stride, size_t count) {
    sh_irradiance_batch_aos(order, channels, c, dir, dir_stride, out, out_stride, count);
}

static float one_radiance(int order, const float *c, const float dir[3]) {
    return sh_radiance(order, c, dir);
}

static float one_irradiance(int order, const float *c, const float dir[3]) {
    return sh_irradiance(order, c, dir);
}

typedef struct batch {
    const char *name;
    planar_batch planar; /* or */
    aos_batch aos;
    int per_item; /* a probe for each direction */
    float (*single)(int order, const float *c, const float dir[3]);
    long double kernel[3];
} batch;

static const batch batches[] = {
    { "radiance", radiance, NULL, 0, one_radiance, { 1.0L, 1.0L, 1.0L } },
    { "irradiance", irradiance, NULL, 0, one_irradiance, { 1.0L, 2.0L / 3.0L, 0.25L } },
    { "probes", probes, NULL, 1, one_irradiance, { 1.0L, 2.0L / 3.0L, 0.25L } },
    { "radiance_aos", NULL, radiance_aos, 0, one_radiance, { 1.0L, 1.0L, 1.0L } },
    { "irradiance_aos", NULL, irradiance_aos, 0, one_irradiance, { 1.0L, 2.0L / 3.0L, 0.25L } },
};
enum { BATCHES = sizeof batches / sizeof batches[0] };

/* Coefficients of direction i. */
static const float *set_of(const batch *b, int order, int channels, size_t i) {
    return sets + (b->per_item ? i * (size_t)(channels * SH_COUNT(order)) : 0);
}

/* One direction, by the batch itself: what every longer batch must repeat bit for bit. */
static void alone(const batch *b, int order, int channels, size_t i, float *out) {
    const float dir[3] = { x[i], y[i], z[i] };
    if (b->planar)
        b->planar(order, channels, set_of(b, order, channels, i), dir, dir + 1, dir + 2, out, 1);
    else
        b->aos(order, channels, set_of(b, order, channels, i), dir, 0, out, 0, 1);
}

/* Channel k of direction i is result[i * CHANNELS + k]. */
static float result[MOST * CHANNELS];

static void evaluate_alone(const batch *b, int order, int channels) {
    for (size_t i = 0; i < MOST; i++)
        alone(b, order, channels, i, result + i * CHANNELS);
}

/* ---- Accuracy ---- */

/* The contract's bound is 8 ulp of this: the absolute terms of the polynomial with z^2 = 1 - x^2 - y^2 taken out, and those with z^2. */
static long double absolute_terms(const long double c[9], const long double kernel[3], const long double dir[3]) {
    const long double zz = -(c[4] + c[7]), w1 = 3.0L * kernel[1], w2 = 7.5L * kernel[2];
    const long double product[3] = { dir[0] * dir[1], dir[0] * dir[2], dir[1] * dir[2] };
    long double first = 0.0L;
    for (int i = 0; i < 3; i++)
        first += fabsl(c[1 + i] * dir[i]);
    const long double mixed = fabsl(c[5] * product[0]) + fabsl(c[6] * product[1]) + fabsl(c[8] * product[2]);
    const long double diagonal = fabsl(zz) + fabsl(c[4] - zz) * dir[0] * dir[0] + fabsl(c[7] - zz) * dir[1] * dir[1];
    return fabsl(kernel[0] * c[0]) + w1 * first + w2 * (2.0L * mixed + diagonal);
}

/* result against the definition and against the function of one direction. The least terms are those of subnormal products. */
static void check_accuracy(const batch *b, int order, int channels) {
    const size_t count = (size_t)SH_COUNT(order);
    for (size_t i = 0; i < DIRECTIONS; i++)
        for (size_t k = 0; k < (size_t)channels; k++) {
            const float *set = set_of(b, order, channels, i) + k * count, dir[3] = { x[i], y[i], z[i] };
            long double c[9] = { 0.0L }, wide[3];
            oracle_widen(set, (int)count, c);
            oracle_widen(dir, 3, wide);
            const long double ulp = (long double)FLT_EPSILON * absolute_terms(c, b->kernel, wide) + 16.0L * (long double)FLT_MIN;
            NEAR(result[i * CHANNELS + k], oracle_expand(c, b->kernel, wide), 8.0L * ulp);
            NEAR(result[i * CHANNELS + k], b->single(order, set, dir), 12.0L * ulp);
        }
}

/* ---- Places ---- */

/* Memory with guard bytes before and after; the content is at a multiple of four bytes. */
enum { GUARD = 64, GUARD_BYTE = 0xa5 };

typedef struct guarded {
    unsigned char *memory, *content;
    size_t size;
} guarded;

static guarded guarded_create(size_t size, size_t offset) {
    guarded g;
    g.size = size + offset + 2 * GUARD;
    g.memory = (unsigned char *)test_allocate(g.size);
    memset(g.memory, GUARD_BYTE, g.size);
    g.content = g.memory + GUARD + offset;
    return g;
}

/* All bytes, of which those that should have changed are marked as guards again. */
static void guarded_check_and_free(guarded *g) {
    size_t changed = 0;
    for (size_t i = 0; i < g->size; i++)
        changed += g->memory[i] != GUARD_BYTE;
    EQUAL(changed, 0);
    free(g->memory);
}

/* Compares a value in memory with the result, and makes it a guard. */
static int take(unsigned char *at, float expected) {
    const int equal = memcmp(at, &expected, sizeof expected) == 0;
    memset(at, GUARD_BYTE, sizeof expected);
    return equal;
}

static void check_planar(const batch *b, int order, int channels, size_t count, size_t offset) {
    guarded g = guarded_create((size_t)channels * count * sizeof(float), offset);
    float *out = (float *)(void *)g.content;
    size_t equal = 0;
    b->planar(order, channels, sets, x, y, z, out, count);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < (size_t)channels; k++)
            equal += (size_t)take(g.content + (k * count + i) * sizeof(float), result[i * CHANNELS + k]);
    EQUAL(equal, (size_t)channels * count);
    guarded_check_and_free(&g);
}

/* From any first direction on: the position within the batch, and of the inputs in memory, changes. */
static void check_shifted(const batch *b, int order, int channels, size_t first, size_t count) {
    guarded g = guarded_create((size_t)channels * count * sizeof(float), 4);
    float *out = (float *)(void *)g.content;
    size_t equal = 0;
    test_section("%s, order %d, %d channels, %d from %d on", b->name, order, channels, (int)count, (int)first);
    b->planar(order, channels, set_of(b, order, channels, first), x + first, y + first, z + first, out, count);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < (size_t)channels; k++)
            equal += (size_t)take(g.content + (k * count + i) * sizeof(float), result[(first + i) * CHANNELS + k]);
    EQUAL(equal, (size_t)channels * count);
    guarded_check_and_free(&g);
}

/* Where out begins among copies of [x|y|z|...], or in a copy of directions. */
static void check_planar_in_place(const batch *b, int order, int channels, size_t count, size_t at) {
    const size_t arrays = at + (size_t)channels > 3 ? at + (size_t)channels : 3;
    guarded g = guarded_create(arrays * count * sizeof(float), 0);
    float *in = (float *)(void *)g.content, *out = in + at * count;
    size_t equal = 0;
    test_section("%s, order %d, %d channels, %d in place of array %d", b->name, order, channels, (int)count, (int)at);
    memcpy(in, x, count * sizeof *in);
    memcpy(in + count, y, count * sizeof *in);
    memcpy(in + 2 * count, z, count * sizeof *in);
    b->planar(order, channels, sets, in, in + count, in + 2 * count, out, count);
    for (size_t i = 0; i < count; i++) {
        const float dir[3] = { x[i], y[i], z[i] };
        for (size_t k = 0; k < arrays; k++) {
            const float expected = k < at || k >= at + (size_t)channels ? dir[k] : result[i * CHANNELS + k - at];
            equal += (size_t)take(g.content + (k * count + i) * sizeof(float), expected);
        }
    }
    EQUAL(equal, arrays * count);
    guarded_check_and_free(&g);
}

/* Bytes from item to item beyond the item itself. */
typedef struct gaps {
    size_t in, out;
} gaps;

static const size_t direction_size = 3 * sizeof(float);

static void check_aos(const batch *b, int order, int channels, size_t count, gaps gap) {
    const size_t item = (size_t)channels * sizeof(float), in_stride = direction_size + gap.in, out_stride = item + gap.out;
    unsigned char *in = (unsigned char *)test_allocate(count ? (count - 1) * in_stride + direction_size : 1); /* ends with the last */
    guarded g = guarded_create(count ? (count - 1) * out_stride + item : 0, 0);
    size_t equal = 0;
    for (size_t i = 0; i < count; i++) {
        const float dir[3] = { x[i], y[i], z[i] };
        memcpy(in + i * in_stride, dir, sizeof dir);
        memset(in + i * in_stride + direction_size, 0xff, i + 1 < count ? gap.in : 0); /* NaN */
    }
    b->aos(order, channels, sets, (const float *)(const void *)in, gap.in ? in_stride : 0, (float *)(void *)g.content,
           gap.out ? out_stride : 0, count);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < (size_t)channels; k++)
            equal += (size_t)take(g.content + i * out_stride + k * sizeof(float), result[i * CHANNELS + k]);
    EQUAL(equal, (size_t)channels * count);
    guarded_check_and_free(&g);
    free(in);
}

/* Equal strides, results in place of directions; what follows an item stays as it is. */
static void check_aos_in_place(const batch *b, int order, int channels, size_t count, size_t gap) {
    const size_t item = (size_t)channels * sizeof(float), larger = item > direction_size ? item : direction_size, stride = larger + gap;
    guarded g = guarded_create(count ? (count - 1) * stride + larger : 0, 0);
    float *data = (float *)(void *)g.content;
    size_t equal = 0;
    test_section("%s, order %d, %d channels, %d in place, stride %d", b->name, order, channels, (int)count, (int)stride);
    for (size_t i = 0; i < count; i++) {
        const float dir[3] = { x[i], y[i], z[i] };
        memcpy(g.content + i * stride, dir, sizeof dir);
    }
    b->aos(order, channels, sets, data, stride, data, stride, count);
    for (size_t i = 0; i < count; i++) {
        const float dir[3] = { x[i], y[i], z[i] };
        for (size_t k = 0; k < larger / sizeof(float); k++)
            equal += (size_t)take(g.content + i * stride + k * sizeof(float),
                                  k < (size_t)channels ? result[i * CHANNELS + k] : dir[k < 3 ? k : 0]);
    }
    EQUAL(equal, count * (larger / sizeof(float)));
    guarded_check_and_free(&g);
}

static void check_places(const batch *b, int order, int channels) {
    static const size_t in_place[] = { 0, 1, 7, 16, 33, 1024, 1026, 2500 };
    static const gaps all_gaps[] = { { 0, 0 }, { 4, 0 }, { 20, 4 }, { 1, 1 }, { 0, 52 }, { 37, 6 } };
    for (int i = 0; i < LENGTHS; i++) {
        const size_t count = length_of(i);
        test_section("%s, order %d, %d channels, count %d", b->name, order, channels, (int)count);
        if (b->planar)
            check_planar(b, order, channels, count, (size_t)(i % 8) * sizeof(float));
        else
            check_aos(b, order, channels, count, all_gaps[i % 6]);
    }
    for (size_t i = 0; i < sizeof in_place / sizeof in_place[0]; i++)
        if (b->planar)
            for (size_t at = 0; at < 3; at++)
                check_planar_in_place(b, order, channels, in_place[i], at);
        else
            check_aos_in_place(b, order, channels, in_place[i], 5 * (i % 3));
    for (int i = 0; i < 20 && b->planar; i++)
        check_shifted(b, order, channels, (size_t)test_below(2000), (size_t)test_below(40));
    for (size_t i = 0; i < 6 && b->aos; i++) {
        test_section("%s, order %d, %d channels, gaps of %d and %d bytes", b->name, order, channels, (int)all_gaps[i].in,
                     (int)all_gaps[i].out);
        check_aos(b, order, channels, 61, all_gaps[i]);
    }
}

static void random_directions(void) {
    x = coordinates;
    y = x + MOST;
    z = y + MOST;
    for (int i = 0; i < MOST; i++) {
        float dir[3];
        test_direction(dir);
        if (i < 6)
            for (int j = 0; j < 3; j++)
                dir[j] = j != i / 2 ? 0.0f : i % 2 ? -1.0f : 1.0f;
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
    }
}

static void everything(void) {
    test_fill(sets, sizeof sets / sizeof sets[0], -1.0, 1.0);
    for (int i = 0; i < BATCHES; i++)
        for (int order = SH_L0; order <= SH_L2; order++)
            for (int channels = 1; channels <= CHANNELS; channels++) {
                test_section("%s, order %d, %d channels", batches[i].name, order, channels);
                evaluate_alone(&batches[i], order, channels);
                check_accuracy(&batches[i], order, channels);
                check_places(&batches[i], order, channels);
            }
}

/* Coefficients up to 1e18 overflow nothing, and small ones keep their relative accuracy; order by order and mixed. */
static void magnitudes(void) {
    static const double scales[] = { 1e18, 1e-30, 1e9 };
    for (int s = 0; s < 4; s++) {
        for (size_t i = 0; i < DIRECTIONS * CHANNELS * 9; i++)
            sets[i] = (float)(test_uniform(-1.0, 1.0) * (s < 3 ? scales[s] : scales[test_below(3)]));
        for (int i = 0; i < BATCHES; i++)
            for (int order = SH_L0; order <= SH_L2; order++) {
                test_section("%s, order %d, magnitude %g", batches[i].name, order, s < 3 ? scales[s] : 0.0);
                for (size_t at = 0; at < DIRECTIONS; at++)
                    alone(&batches[i], order, 3, at, result + at * CHANNELS);
                check_accuracy(&batches[i], order, 3);
            }
    }
}

/* Without its highest bands, a set gives the bits of the lower order. */
static void prefixes(void) {
    for (int i = 0; i < BATCHES; i++)
        for (int order = SH_L0; order <= SH_L1; order++)
            for (size_t at = 0; at < 200; at++) {
                const int from = SH_COUNT(order), to = SH_COUNT(order + 1);
                float low[CHANNELS], high[CHANNELS];
                test_section("%s, order %d without its last band", batches[i].name, order + 1);
                float narrow[2 * 4], wide[2 * 9] = { 0.0f };
                test_fill(narrow, 2 * 4, -1.0, 1.0);
                for (int k = 0; k < 2; k++)
                    memcpy(wide + k * to, narrow + k * from, (size_t)from * sizeof(float));
                const float dir[3] = { x[at], y[at], z[at] };
                if (batches[i].planar) {
                    batches[i].planar(order, 2, narrow, dir, dir + 1, dir + 2, low, 1);
                    batches[i].planar(order + 1, 2, wide, dir, dir + 1, dir + 2, high, 1);
                } else {
                    batches[i].aos(order, 2, narrow, dir, 0, low, 0, 1);
                    batches[i].aos(order + 1, 2, wide, dir, 0, high, 0, 1);
                }
                SAME_BITS(low, high, 2 * sizeof(float));
            }
}

static void run_tests(void) {
    printf("backend %s lanes %d\n", SH_SIMD_NAME, SHI_LANES);
    random_directions();
    everything();
    magnitudes();
    prefixes();
}
