/* Projection of arrays of samples against long double sums: every length about the ends of vectors, chunks and runs, weighted or not,
 * whole, split and merged; the samples of a batch have no place either. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

enum { MOST = 100000, CHANNELS = 4, SHORT = 301 };

static float x[MOST], y[MOST], z[MOST], weight[MOST], values[CHANNELS][MOST];

/* Chunks and runs of 1 to 16 lanes end at these lengths, or one off. */
static const size_t ends[] = { 512, 1024, 2048, 3072, 4096, 8192, 12288, MOST - 1 };
enum { LENGTHS = SHORT + 3 * (int)(sizeof ends / sizeof ends[0]) };

static size_t length_of(int i) {
    return i < SHORT ? (size_t)i : ends[(i - SHORT) / 3] + (size_t)((i - SHORT) % 3) - 1;
}

/* Sums over the first samples, by definition. magnitude: the sum of |weight * value|. */
typedef struct sums {
    long double sum[9], weight, magnitude;
} sums;

static sums expected[2][CHANNELS][LENGTHS];

static void sum_up(int weighted, int channel) {
    sums s;
    size_t i = 0;
    memset(&s, 0, sizeof s);
    for (int length = 0; length < LENGTHS; length++) {
        for (; i < length_of(length); i++) {
            const long double dir[3] = { (long double)x[i], (long double)y[i], (long double)z[i] };
            const long double w = weighted ? (long double)weight[i] : 1.0L, v = w * (long double)values[channel][i];
            long double basis[9];
            oracle_basis(dir, basis);
            for (int k = 0; k < 9; k++)
                s.sum[k] += v * basis[k];
            s.weight += w;
            s.magnitude += fabsl(v);
        }
        expected[weighted][channel][length] = s;
    }
}

/* Channel 0 is positive, the others are not; the last has a few values that outweigh all others. */
static void random_samples(void) {
    for (int i = 0; i < MOST; i++) {
        float dir[3];
        test_direction(dir);
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
    }
    test_fill(weight, MOST, 0.0, 3.0);
    for (int k = 0; k < CHANNELS; k++)
        test_fill(values[k], MOST, k == 0 ? 0.0 : -1.0, 1.5);
    for (int i = 0; i < 50; i++)
        values[CHANNELS - 1][test_below(MOST)] = 1e6f;
    for (int weighted = 0; weighted <= 1; weighted++)
        for (int k = 0; k < CHANNELS; k++)
            sum_up(weighted, k);
}

/* Of the sum of absolute values. Products and sums over short runs are rounded to float: worst where one value outweighs the others. */
static const long double tolerance = 3e-7L;

/* The first `count` values of each channel, one channel after the other, in memory of exactly their size. */
static float *planar(int channels, size_t first, size_t count) {
    float *value = (float *)test_allocate(count ? (size_t)channels * count * sizeof(float) : 1);
    for (int k = 0; k < channels; k++)
        memcpy(value + (size_t)k * count, values[k] + first, count * sizeof(float));
    return value;
}

static void check_length(int length, int channels, int weighted) {
    const size_t count = length_of(length);
    float *value = planar(channels, 0, count), c[CHANNELS * 9 + 1];
    sh_accum accum[CHANNELS + 1], guard;
    test_section("%d samples, %d channels, weighted %d", (int)count, channels, weighted);
    memset(c, 0x55, sizeof c);
    memset(accum, 0x55, sizeof accum);
    memset(&guard, 0x55, sizeof guard);
    sh_accum_clear(channels, accum);
    EQUAL(sh_project_samples(SH_L2, channels, x, y, z, value, weighted ? weight : NULL, count, c), SH_OK);
    EQUAL(sh_accum_samples(SH_L2, channels, x, y, z, value, weighted ? weight : NULL, count, accum), SH_OK);
    SAME_BITS(&c[channels * 9], &guard, sizeof c[0]);
    SAME_BITS(&accum[channels], &guard, sizeof guard);
    for (int k = 0; k < channels; k++) {
        const sums *s = &expected[weighted][k][length];
        const long double total = s->weight > 0.0L ? s->weight : 1.0L;
        long double mean[9];
        for (int i = 0; i < 9; i++)
            mean[i] = s->sum[i] / total;
        NEAR_ALL(accum[k].sum, s->sum, 9, tolerance * s->magnitude);
        NEAR(accum[k].weight, s->weight, tolerance * s->weight);
        NEAR_ALL(c + k * 9, mean, 9, tolerance * s->magnitude / total);
    }
    free(value);
}

static void lengths(void) {
    for (int length = 0; length < LENGTHS; length++)
        for (int weighted = 0; weighted <= 1; weighted++)
            if (length < SHORT)
                check_length(length, 1 + length % CHANNELS, weighted);
            else
                check_length(length, CHANNELS, weighted);
    for (int channels = 1; channels <= CHANNELS; channels++)
        for (int length = 0; length < 70; length += 3)
            check_length(length, channels, channels % 2);
}

/* In any parts, each in any accumulator, in any order. */
static void splits(void) {
    const int length = SHORT + 9 + 1; /* 3072 */
    const size_t count = length_of(length);
    for (int repeat = 0; repeat < 200; repeat++) {
        const int weighted = repeat % 2, parts = 1 + test_below(6);
        sh_accum accum[CHANNELS], own[CHANNELS];
        size_t first = 0;
        test_section("%d parts, weighted %d", parts, weighted);
        sh_accum_clear(CHANNELS, accum);
        for (int part = 0; part < parts; part++) {
            const size_t some = part + 1 < parts ? (size_t)test_below((int)(count - first) + 1) : count - first;
            float *value = planar(CHANNELS, first, some);
            sh_accum *into = part % 2 ? own : accum; /* added to what is there, or merged */
            sh_accum_clear(CHANNELS, own);
            EQUAL(sh_accum_samples(SH_L2, CHANNELS, x + first, y + first, z + first, value, weighted ? weight + first : NULL, some,
                                   into),
                  SH_OK);
            if (into == own)
                sh_accum_merge(CHANNELS, own, accum);
            first += some;
            free(value);
        }
        for (int k = 0; k < CHANNELS; k++) {
            const sums *s = &expected[weighted][k][length];
            NEAR_ALL(accum[k].sum, s->sum, 9, tolerance * s->magnitude);
            NEAR(accum[k].weight, s->weight, tolerance * s->weight);
        }
    }
}

/* One number in each vector: a compiler may fuse a product and a sum of the target's floats in one order and not in another. */
#if SHI_LANES == 1 && defined(FP_FAST_FMAF)
static const long double prefix_tolerance = 2e-7L;
#else
static const long double prefix_tolerance = 0.0L;
#endif

/* Lower orders are the first sums of higher ones, and touch nothing else. */
static void prefixes(void) {
    static const size_t counts[] = { 0, 1, 5, 16, 100, 5000 };
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        for (int weighted = 0; weighted <= 1; weighted++)
            for (int order = SH_L0; order <= SH_L1; order++) {
                const float *w = weighted ? weight : NULL;
                sh_accum whole, some;
                float all[9], few[9 + 1], guard;
                test_section("order %d of %d samples, weighted %d", order, (int)counts[i], weighted);
                memset(few, 0x55, sizeof few);
                memset(&guard, 0x55, sizeof guard);
                EQUAL(sh_project_samples(SH_L2, 1, x, y, z, values[1], w, counts[i], all), SH_OK);
                EQUAL(sh_project_samples(order, 1, x, y, z, values[1], w, counts[i], few), SH_OK);
                NEAR_ALL(few, all, SH_COUNT(order), prefix_tolerance);
                SAME_BITS(&few[SH_COUNT(order)], &guard, sizeof guard);
                sh_accum_clear(1, &whole);
                sh_accum_clear(1, &some);
                EQUAL(sh_accum_samples(SH_L2, 1, x, y, z, values[1], w, counts[i], &whole), SH_OK);
                EQUAL(sh_accum_samples(order, 1, x, y, z, values[1], w, counts[i], &some), SH_OK);
                NEAR_ALL(some.sum, whole.sum, SH_COUNT(order), prefix_tolerance * 4.0L * counts[i]); /* weights below 3 */
                NEAR(some.weight, whole.weight, 0);
                for (int j = SH_COUNT(order); j < 9; j++)
                    NEAR(some.sum[j], 0.0, 0);
            }
}

/* Arrays at every address that a float can have within a vector: the same bits. */
static void alignments(void) {
    enum { COUNT = 77, SHIFTS = 16 };
    static float copy[5][COUNT + SHIFTS];
    const float *from[5] = { x, y, z, values[0], weight };
    float first[9];
    for (int shift = 0; shift < SHIFTS; shift++) {
        float c[9];
        test_section("arrays shifted by %d floats", shift);
        for (int i = 0; i < 5; i++)
            memcpy(copy[i] + (shift * (i + 1)) % SHIFTS, from[i], COUNT * sizeof(float));
        const float *at[5];
        for (int i = 0; i < 5; i++)
            at[i] = copy[i] + (shift * (i + 1)) % SHIFTS;
        EQUAL(sh_project_samples(SH_L2, 1, at[0], at[1], at[2], at[3], at[4], COUNT, c), SH_OK);
        if (shift == 0)
            memcpy(first, c, sizeof c);
        SAME_BITS(c, first, sizeof c);
    }
}

static void run_tests(void) {
    random_samples();
    lengths();
    splits();
    prefixes();
    alignments();
}
