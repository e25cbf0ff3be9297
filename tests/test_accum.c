/* Accumulators: weights, merging, splitting, and sums that go on growing. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

enum { COUNT = 600, CHANNELS = 3 };

static float x[COUNT], y[COUNT], z[COUNT], value[CHANNELS * COUNT], weight[COUNT];

static void random_samples(void) {
    for (int i = 0; i < COUNT; i++) {
        float dir[3];
        test_direction(dir);
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
    }
    test_fill(value, CHANNELS * COUNT, -1.0, 2.0);
    test_fill(weight, COUNT, 0.0, 3.0);
}

/* What sums should be, by definition. */
static void expected_sums(int channel, int weighted, int count, long double sum[9], long double *total) {
    memset(sum, 0, 9 * sizeof sum[0]);
    *total = 0.0L;
    for (int i = 0; i < count; i++) {
        const long double dir[3] = { (long double)x[i], (long double)y[i], (long double)z[i] };
        const long double w = weighted ? (long double)weight[i] : 1.0L;
        long double basis[9];
        oracle_basis(dir, basis);
        *total += w;
        for (int k = 0; k < 9; k++)
            sum[k] += w * (long double)value[channel * COUNT + i] * basis[k];
    }
}

/* Double sums of products of floats: the errors that are allowed are those of double. */
static void sums(void) {
    for (int weighted = 0; weighted <= 1; weighted++) {
        sh_accum accum[CHANNELS], single[CHANNELS];
        test_section("sums, weighted %d", weighted);
        sh_accum_clear(CHANNELS, accum);
        sh_accum_clear(CHANNELS, single);
        EQUAL(sh_accum_samples(SH_L2, CHANNELS, x, y, z, value, weighted ? weight : NULL, COUNT, accum), SH_OK);
        for (int k = 0; k < CHANNELS; k++)
            for (int i = 0; i < COUNT; i++) {
                const float dir[3] = { x[i], y[i], z[i] };
                sh_accum_sample(SH_L2, dir, value[k * COUNT + i], weighted ? weight[i] : 1.0f, &single[k]);
            }
        for (int k = 0; k < CHANNELS; k++) {
            long double expected[9], total, mean[9];
            float c[9];
            expected_sums(k, weighted, COUNT, expected, &total);
            NEAR_ALL(single[k].sum, expected, 9, 1e-11); /* sums of 600 numbers up to 6, each rounded to 2^-53 */
            NEAR(single[k].weight, total, 1e-11);
            RELATIVE(accum[k].weight, total, 1e-7); /* the contract: kernels may sum short runs in float */
            NEAR_ALL(accum[k].sum, expected, 9, 1e-7L * total);
            sh_accum_total(SH_L2, 1, &single[k], c);
            NEAR_ALL(c, expected, 9, 6e-8L * 600);
            sh_accum_finish(SH_L2, 1, &single[k], c);
            for (int i = 0; i < 9; i++)
                mean[i] = expected[i] / total;
            NEAR_ALL(c, mean, 9, 3.1e-8); /* half an ulp below 1 */
        }
    }
}

/* Any split into parts, each accumulated on its own and merged, in any order. */
static void splits(void) {
    for (int repeat = 0; repeat < 100; repeat++) {
        sh_accum whole, merged;
        const int cut = test_below(COUNT + 1), second = cut + test_below(COUNT + 1 - cut);
        const int bounds[4] = { 0, cut, second, COUNT };
        float a[9], b[9];
        test_section("split at %d and %d", cut, second);
        sh_accum_clear(1, &whole);
        sh_accum_clear(1, &merged);
        EQUAL(sh_accum_samples(SH_L2, 1, x, y, z, value, weight, COUNT, &whole), SH_OK);
        for (int part = 2; part >= 0; part--) {
            const int from = bounds[part], count = bounds[part + 1] - from;
            sh_accum some;
            sh_accum_clear(1, &some);
            EQUAL(sh_accum_samples(SH_L2, 1, x + from, y + from, z + from, value + from, weight + from, (size_t)count, &some),
                  SH_OK);
            sh_accum_merge(1, &some, &merged);
        }
        RELATIVE(merged.weight, whole.weight, 5e-7);
        sh_accum_finish(SH_L2, 1, &whole, a);
        sh_accum_finish(SH_L2, 1, &merged, b);
        NEAR_ALL(a, b, 9, 1e-7);
    }
}

/* Merging is the sum of the members, of each channel; merging what is empty changes nothing. */
static void merging(void) {
    sh_accum a[2], b[2], before[2], empty[2];
    test_section("merging");
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 9; i++) {
            a[k].sum[i] = 1.0 + i + 100.0 * k;
            b[k].sum[i] = 0.5 * i - 10.0 * k;
        }
        a[k].weight = 3.0 + k;
        b[k].weight = 0.25;
    }
    memcpy(before, a, sizeof a);
    sh_accum_clear(2, empty);
    sh_accum_merge(2, empty, a);
    SAME_BITS(a, before, sizeof a);
    sh_accum_merge(2, b, a);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 9; i++)
            NEAR(a[k].sum[i], before[k].sum[i] + b[k].sum[i], 0);
        NEAR(a[k].weight, 3.25 + k, 0);
    }
}

static void empty_and_weightless(void) {
    sh_accum accum[2];
    float c[2 * 9];
    const float dir[3] = { 0.0f, 1.0f, 0.0f };
    test_section("an empty accumulator");
    memset(accum, 0x55, sizeof accum);
    sh_accum_clear(2, accum);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 9; i++)
            NEAR(accum[k].sum[i], 0.0, 0);
        NEAR(accum[k].weight, 0.0, 0);
    }
    memset(c, 0x55, sizeof c);
    sh_accum_finish(SH_L2, 2, accum, c);
    for (int i = 0; i < 2 * 9; i++)
        NEAR(c[i], 0.0, 0);
    test_section("samples of weight 0");
    sh_accum_sample(SH_L2, dir, 5.0f, 0.0f, accum);
    sh_accum_finish(SH_L2, 2, accum, c);
    for (int i = 0; i < 2 * 9; i++)
        NEAR(c[i], 0.0, 0);
    test_section("one sample, of any weight, is its own mean");
    sh_accum_sample(SH_L2, dir, 5.0f, 1e-30f, accum);
    sh_accum_finish(SH_L2, 1, accum, c);
    NEAR(c[SH_R0], 5.0, 0);
    NEAR(c[SH_Y], 5.0, 0);
    NEAR(c[SH_YY], 10.0 / 3.0, 2.4e-7);
}

/* A float sum stops at 2^24: here, ones go on counting beyond. */
static void no_stagnation(void) {
    enum { BLOCK = 1 << 12, BLOCKS = (1 << 12) + 64 };
    static float bx[BLOCK], by[BLOCK], bz[BLOCK], ones[BLOCK];
    sh_accum accum;
    float c[9];
    test_section("2^24 samples and more");
    for (int i = 0; i < BLOCK; i++) {
        bx[i] = 0.6f;
        by[i] = 0.0f;
        bz[i] = 0.8f;
        ones[i] = 1.0f;
    }
    sh_accum_clear(1, &accum);
    for (int i = 0; i < BLOCKS; i++)
        sh_accum_samples(SH_L1, 1, bx, by, bz, ones, NULL, BLOCK, &accum);
    NEAR(accum.weight, (double)(BLOCK * BLOCKS), 0);
    NEAR(accum.sum[SH_R0], (double)(BLOCK * BLOCKS), 0);
    sh_accum_finish(SH_L1, 1, &accum, c);
    NEAR(c[SH_R0], 1.0, 0);
    NEAR(c[SH_X], 0.6f, 6e-8);
}

/* Equal samples: their roundings do not average out. */
static void equal_samples(void) {
    enum { SAMPLES = 20000 };
    static float sx[SAMPLES], sy[SAMPLES], sz[SAMPLES], values[SAMPLES], weights[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        sx[i] = 0.36f;
        sy[i] = 0.48f;
        sz[i] = 0.8f;
        values[i] = 0.1f;
        weights[i] = 0.7f;
    }
    for (int weighted = 0; weighted <= 1; weighted++) {
        const long double dir[3] = { (long double)sx[0], (long double)sy[0], (long double)sz[0] };
        long double expected[9];
        float c[9];
        test_section("equal samples, weighted %d", weighted);
        oracle_basis(dir, expected);
        for (int i = 0; i < 9; i++)
            expected[i] *= (long double)values[0];
        EQUAL(sh_project_samples(SH_L2, 1, sx, sy, sz, values, weighted ? weights : NULL, SAMPLES, c), SH_OK);
        NEAR_ALL(c, expected, 9, 5e-7L * (long double)values[0]); /* the contract */
    }
}

static void run_tests(void) {
    random_samples();
    sums();
    splits();
    merging();
    empty_and_weightless();
    no_stagnation();
    equal_samples();
}
