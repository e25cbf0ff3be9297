/* Direction samplers: reproducible, unit length, uniform; and Monte Carlo with them converges at its rate. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

/* |dir| is 1 to three roundings of components. */
static void check_unit(const float dir[3]) {
    long double wide[3];
    oracle_widen(dir, 3, wide);
    NEAR(oracle_dot(wide, wide), 1.0, 2e-7);
}

/* Azimuth from +x to +y as a fraction of a turn, [0, 1); height from +z to -z as a fraction of the area, [0, 1]. */
static void square(const float dir[3], double uv[2]) {
    const double turn = atan2((double)dir[1], (double)dir[0]) / (2.0 * 3.14159265358979323846);
    uv[0] = turn < 0.0 ? turn + 1.0 : turn;
    uv[1] = 0.5 - 0.5 * (double)dir[2];
}

/* Direction i of n, by one of the samplers; seed is ignored by those without. */
typedef void (*sampler)(uint32_t i, uint32_t n, uint32_t seed, float dir[3]);

static void random_direction(uint32_t i, uint32_t n, uint32_t seed, float dir[3]) {
    (void)n;
    if (i == 0)
        test_seed(seed);
    test_direction(dir);
}

/* n is a square */
static void stratified(uint32_t i, uint32_t n, uint32_t seed, float dir[3]) {
    const uint32_t side = (uint32_t)(sqrt((double)n) + 0.5);
    sh_direction_stratified(i, side, side, seed, dir);
}

static void sequence(uint32_t i, uint32_t n, uint32_t seed, float dir[3]) {
    (void)n;
    sh_direction_sequence(i, seed, dir);
}

static void fibonacci(uint32_t i, uint32_t n, uint32_t seed, float dir[3]) {
    (void)seed;
    sh_direction_fibonacci(i, n, dir);
}

static const struct {
    const char *name;
    sampler sample;
    int seeded;
    double slope, slope_slack; /* of log error by log count, for a smooth light */
} samplers[] = {
    { "random", random_direction, 1, -0.5, 0.05 }, /* N^-1/2 */
    { "stratified", stratified, 1, -1.0, 0.15 },   /* N^-1: the variance within N cells of diameter N^-1/2 */
    { "sequence", sequence, 1, -1.0, 0.15 },       /* N^-1 and logarithms */
    { "fibonacci", fibonacci, 0, -1.5, 0.15 },     /* N^-3/2 was measured */
};
enum { SAMPLERS = sizeof samplers / sizeof samplers[0] };

static void unit_and_reproducible(void) {
    for (int s = 1; s < SAMPLERS; s++) {
        int moved = 0;
        test_section("%s: unit length, reproducible", samplers[s].name);
        for (uint32_t i = 0; i < 4096; i++) {
            float a[3], b[3], other[3];
            samplers[s].sample(i, 4096, 7, a);
            samplers[s].sample(i, 4096, 7, b);
            samplers[s].sample(i, 4096, 8, other);
            check_unit(a);
            SAME_BITS(a, b, sizeof a);
            moved += memcmp(a, other, sizeof a) != 0;
        }
        EQUAL(moved, samplers[s].seeded ? 4096 : 0);
    }
    test_section("the last of an endless sequence, and of the longest spiral");
    const uint32_t last = 0xffffffffu;
    float dir[3], before[3];
    sh_direction_sequence(last, 3, dir);
    check_unit(dir);
    sh_direction_sequence(last - 1, 3, before);
    CHECK(memcmp(dir, before, sizeof dir) != 0);
    sh_direction_fibonacci(last - 1, last, dir);
    check_unit(dir);
    NEAR(dir[2], -1.0, 0);
    sh_direction_fibonacci(0, 1, dir);
    NEAR(dir[2], 0.0, 0);
}

/* One direction in each cell of equal area, row by row from +z; and again on the next round, elsewhere in it. */
static void strata(void) {
    static const uint32_t sizes[][2] = { { 1, 1 }, { 4, 2 }, { 7, 5 }, { 32, 32 }, { 100, 3 } };
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++) {
        const uint32_t columns = sizes[n][0], rows = sizes[n][1], count = columns * rows;
        test_section("strata of %d x %d", (int)columns, (int)rows);
        for (uint32_t i = 0; i < 2 * count; i++) {
            float dir[3], next[3];
            double uv[2];
            const double slack = 1e-4; /* of a cell: float azimuths near the poles */
            sh_direction_stratified(i, columns, rows, 5, dir);
            sh_direction_stratified(i + count, columns, rows, 5, next);
            CHECK(memcmp(dir, next, sizeof dir) != 0);
            square(dir, uv);
            const double column = uv[0] * columns - i % columns, row = uv[1] * rows - i / columns % rows;
            CHECK(column >= -slack && column <= 1.0 + slack);
            CHECK(row >= -slack && row <= 1.0 + slack);
        }
    }
}

/* The jitter within cells is uniform, and independent between its two coordinates: means and products of 20000 numbers, within 4 of
 * their standard deviations, sqrt(1/12) and 1/12 over sqrt(20000). */
static void jitter(void) {
    const int count = 20000;
    double mean[2] = { 0.0, 0.0 }, product = 0.0, squares[2] = { 0.0, 0.0 };
    test_section("jitter");
    for (uint32_t i = 0; i < (uint32_t)count; i++) {
        float dir[3];
        double uv[2];
        sh_direction_stratified(i, 1, 1, i / 100, dir); /* one cell: each direction is anywhere */
        square(dir, uv);
        for (int k = 0; k < 2; k++) {
            mean[k] += (uv[k] - 0.5) / count;
            squares[k] += (uv[k] - 0.5) * (uv[k] - 0.5) / count;
        }
        product += (uv[0] - 0.5) * (uv[1] - 0.5) / count;
    }
    for (int k = 0; k < 2; k++) {
        NEAR(mean[k], 0.0, 4.0 * sqrt(1.0 / 12.0 / count));
        NEAR(squares[k], 1.0 / 12.0, 4.0 * sqrt(1.0 / 180.0 / count)); /* variance of (u - 1/2)^2 is 1/80 - 1/144 */
    }
    NEAR(product, 0.0, 4.0 / 12.0 / sqrt((double)count));
}

/* Pearson's statistic of 8 x 8 cells of equal area: 63 degrees of freedom, standard deviation sqrt(126) for random directions, and
 * far less for the others. */
static void uniform(void) {
    for (int s = 0; s < SAMPLERS; s++) {
        enum { SIDE = 8 };
        const uint32_t count = 16384;
        const double side = SIDE, expected = count / (side * side);
        int cells[SIDE * SIDE] = { 0 };
        double statistic = 0.0;
        test_section("%s: uniform", samplers[s].name);
        for (uint32_t i = 0; i < count; i++) {
            float dir[3];
            double uv[2];
            samplers[s].sample(i, count, 11, dir);
            square(dir, uv);
            cells[(int)(uv[1] * side * 0.9999999) * SIDE + (int)(uv[0] * side)]++;
        }
        for (int i = 0; i < SIDE * SIDE; i++)
            statistic += (cells[i] - expected) * (cells[i] - expected) / expected;
        CHECK(statistic < (s == 0 ? 63.0 + 4.0 * sqrt(126.0) : 1.0));
    }
}

/* Any prefix of the sequence, and any spiral, has moments close to those of the sphere: within (log N) / N, and 1 / N. */
static void prefixes(void) {
    sh_accum whole;
    sh_accum_clear(1, &whole);
    test_section("prefixes of the sequence");
    for (uint32_t i = 0; i < 3000; i++) {
        float dir[3], c[9];
        sh_direction_sequence(i, 1, dir);
        sh_accum_sample(SH_L2, dir, 1.0f, 1.0f, &whole);
        sh_accum_finish(SH_L2, 1, &whole, c);
        for (int k = 1; k < 9; k++)
            NEAR(c[k], 0.0, (1.0 + log(i + 1.0)) / (i + 1.0));
    }
    for (uint32_t count = 2; count < 300; count += 7) {
        sh_accum accum;
        float c[9], above = 2.0f;
        sh_accum_clear(1, &accum);
        test_section("a spiral of %d", (int)count);
        for (uint32_t i = 0; i < count; i++) {
            float dir[3];
            sh_direction_fibonacci(i, count, dir);
            CHECK(dir[2] < above);
            above = dir[2];
            sh_accum_sample(SH_L2, dir, 1.0f, 1.0f, &accum);
        }
        sh_accum_finish(SH_L2, 1, &accum, c);
        for (int k = 1; k < 9; k++)
            NEAR(c[k], 0.0, 1.0 / count);
    }
}

/* A smooth light without symmetry: exp(4 (w.a - 1)) + bands, whose moments are known by quadrature. */
static long double smooth(const long double dir[3], const void *user) {
    const long double *axis = (const long double *)user;
    return expl(4.0L * (oracle_dot(dir, axis) - 1.0L)) + dir[0] * dir[0] * dir[1] + 0.3L * dir[2];
}

/* A light to project, and what it should give. */
typedef struct target {
    long double axis[3], moments[9];
} target;

enum { TARGETS = 60 };

static void random_targets(target targets[TARGETS]) {
    oracle_rule rule = oracle_rule_sphere(40);
    for (int i = 0; i < TARGETS; i++) {
        float dir[3];
        test_direction(dir);
        oracle_widen(dir, 3, targets[i].axis);
        oracle_moments(&rule, smooth, targets[i].axis, targets[i].moments);
    }
    oracle_rule_free(&rule);
}

/* The root mean square error over coefficients and lights, with another seed for each, of the projection from n directions. */
static double rms_error(const target targets[TARGETS], sampler sample, uint32_t n) {
    double sum = 0.0;
    for (uint32_t t = 0; t < TARGETS; t++) {
        sh_accum accum;
        float c[9];
        sh_accum_clear(1, &accum);
        for (uint32_t i = 0; i < n; i++) {
            float dir[3];
            sample(i, n, t * 77u + n, dir);
            const long double wide[3] = { (long double)dir[0], (long double)dir[1], (long double)dir[2] };
            sh_accum_sample(SH_L2, dir, (float)smooth(wide, targets[t].axis), 1.0f, &accum);
        }
        sh_accum_finish(SH_L2, 1, &accum, c);
        for (int k = 0; k < 9; k++)
            sum += pow((double)((long double)c[k] - targets[t].moments[k]), 2.0);
    }
    return sqrt(sum / (9 * TARGETS));
}

/* Least-squares slope of log error by log count, from 4^3 to 4^6 directions. */
static void convergence(void) {
    target targets[TARGETS];
    double last[SAMPLERS];
    random_targets(targets);
    for (int s = 0; s < SAMPLERS; s++) {
        double sxy = 0.0, sxx = 0.0;
        for (int k = 3; k <= 6; k++) {
            const double x = (k - 4.5) * log(4.0);
            last[s] = rms_error(targets, samplers[s].sample, (uint32_t)1 << (2 * k));
            sxy += x * log(last[s]);
            sxx += x * x;
        }
        test_section("%s: rate of convergence", samplers[s].name);
        const double slope = sxy / sxx;
        NEAR(slope, samplers[s].slope, samplers[s].slope_slack);
    }
    test_section("errors with 4096 directions, in order");
    CHECK(last[1] < last[0] / 10.0); /* stratified against random */
    CHECK(last[2] < last[0] / 10.0);
    CHECK(last[3] < last[1] / 5.0 && last[3] < last[2] / 5.0);
}

static void run_tests(void) {
    unit_and_reproducible();
    strata();
    jitter();
    uniform();
    prefixes();
    convergence();
}
