/* Projection of functions and of samples, each against a closed form or against exact rationals. */
#include "oracle.h"
#include "sh.h"
#include "test.h"

/* Weights and coefficients are rounded to float, 2^-24 each, and the directions that f is called with too. */
static const long double exact_tolerance = 1e-7L;

enum { MONOMIALS = 35 }; /* of degree 0 to 4 */

static int powers[MONOMIALS][3];

static void list_monomials(void) {
    int count = 0;
    for (int i = 0; i <= 4; i++)
        for (int j = 0; i + j <= 4; j++)
            for (int k = 0; i + j + k <= 4; k++, count++) {
                powers[count][0] = i;
                powers[count][1] = j;
                powers[count][2] = k;
            }
    EQUAL(count, MONOMIALS);
}

/* Writes SH_MAX_CHANNELS monomials, from number *user on. */
static void monomials(const float dir[3], float *value, void *user) {
    const int first = *(const int *)user;
    for (int k = 0; k < SH_MAX_CHANNELS && first + k < MONOMIALS; k++) {
        double product = 1.0;
        for (int axis = 0; axis < 3; axis++)
            product *= pow((double)dir[axis], powers[first + k][axis]);
        value[k] = (float)product;
    }
}

static void polynomials(void) {
    for (int first = 0; first < MONOMIALS; first += SH_MAX_CHANNELS) {
        const int channels = MONOMIALS - first < SH_MAX_CHANNELS ? MONOMIALS - first : SH_MAX_CHANNELS;
        float c[SH_MAX_CHANNELS * 9];
        EQUAL(sh_project_function(SH_L2, channels, monomials, &first, 4, c), SH_OK);
        for (int k = 0; k < channels; k++) {
            const int *p = powers[first + k], x = p[0], y = p[1], z = p[2];
            const long double third = oracle_monomial(x, y, z) / 3.0L;
            const long double expected[9] = {
                oracle_monomial(x, y, z),         oracle_monomial(x + 1, y, z),         oracle_monomial(x, y + 1, z),
                oracle_monomial(x, y, z + 1),     oracle_monomial(x + 2, y, z) - third, oracle_monomial(x + 1, y + 1, z),
                oracle_monomial(x + 1, y, z + 1), oracle_monomial(x, y + 2, z) - third, oracle_monomial(x, y + 1, z + 1)
            };
            test_section("x^%d y^%d z^%d", x, y, z);
            NEAR_ALL(c + k * 9, expected, 9, exact_tolerance);
        }
    }
}

/* Coefficients of any light by quadrature, as the callback wants them. */
typedef struct callback {
    oracle_light light;
    const void *user;
    long double (*turn)[3]; /* NULL, or the light is turned by it: radiance from w is that from turn' w */
    int calls;
} callback;

static void call_light(const float dir[3], float *value, void *user) {
    callback *back = (callback *)user;
    long double wide[3], from[3];
    oracle_widen(dir, 3, wide);
    for (int i = 0; i < 3; i++)
        from[i] = back->turn ? back->turn[0][i] * wide[0] + back->turn[1][i] * wide[1] + back->turn[2][i] * wide[2] : wide[i];
    back->calls++;
    *value = (float)back->light(from, back->user);
}

static void project(oracle_light light, const void *user, int degree, float c[9]) {
    callback back = { light, user, NULL, 0 };
    EQUAL(sh_project_function(SH_L2, 1, call_light, &back, degree, c), SH_OK);
}

/* A light that depends on w.axis alone. */
typedef struct zonal_light {
    long double axis[3];
    oracle_kernel kernel;
    long double parameter;
} zonal_light;

static long double along_axis(const long double dir[3], const void *user) {
    const zonal_light *light = (const zonal_light *)user;
    return light->kernel(oracle_dot(dir, light->axis), &light->parameter);
}

static long double legendre(long double t, const void *user) {
    return oracle_legendre((int)*(const long double *)user, t);
}

static long double clamped_cosine(long double t, const void *user) {
    (void)user;
    return t > 0.0L ? 4.0L * t : 0.0L;
}

static long double cap(long double t, const void *user) {
    return t > *(const long double *)user ? 1.0L : 0.0L;
}

static long double vmf(long double t, const void *user) {
    const long double k = *(const long double *)user;
    return expl(k * (t - 1.0L)) * 2.0L * k / (1.0L - expl(-2.0L * k));
}

static zonal_light random_axis(oracle_kernel kernel, long double parameter) {
    zonal_light light = { { 0 }, kernel, parameter };
    float dir[3];
    test_direction(dir);
    oracle_widen(dir, 3, light.axis);
    const long double length = sqrtl(oracle_dot(light.axis, light.axis));
    for (int i = 0; i < 3; i++)
        light.axis[i] /= length;
    return light;
}

/* R0 = z0, R1 = z1 axis, R2 = z2 (axis axis' - I/3) */
static void expect_zonal(const float c[9], const long double axis[3], long double z0, long double z1, long double z2,
                         long double tolerance) {
    long double basis[9];
    oracle_basis(axis, basis);
    for (int i = 0; i < 9; i++)
        NEAR(c[i], basis[i] * (i == 0 ? z0 : i < 4 ? z1 : z2), tolerance);
}

/* A polynomial of the stated degree is projected exactly; those of degree 3 and more onto nothing. */
static void degrees(void) {
    for (int degree = 0; degree <= 60; degree++) {
        const zonal_light light = random_axis(legendre, degree);
        float c[9];
        test_section("Legendre polynomial of degree %d", degree);
        project(along_axis, &light, degree, c);
        expect_zonal(c, light.axis, degree == 0, degree == 1 ? 1.0L / 3.0L : 0.0L, degree == 2 ? 1.0L / 5.0L : 0.0L,
                     2.0L * exact_tolerance);
    }
    test_section("the largest degree");
    const zonal_light light = random_axis(legendre, 2);
    float c[9];
    project(along_axis, &light, 1000, c);
    expect_zonal(c, light.axis, 0.0L, 0.0L, 0.2L, exact_tolerance);
}

static long double constant(const long double dir[3], const void *user) {
    (void)dir;
    return *(const long double *)user;
}

/* Exact at every degree and order; as many calls as documented. */
static void constants(void) {
    for (int degree = 0; degree <= 40; degree++)
        for (int order = SH_L0; order <= SH_L2; order++) {
            const long double value = 3.7L;
            callback back = { constant, &value, NULL, 0 };
            float c[9];
            test_section("a constant, degree %d, order %d", degree, order);
            EQUAL(sh_project_function(order, 1, call_light, &back, degree, c), SH_OK);
            NEAR(c[0], value, 2.4e-7); /* an ulp */
            for (int i = 1; i < SH_COUNT(order); i++)
                NEAR(c[i], 0.0, 3.7L * exact_tolerance);
            const int total = degree + order;
            CHECK(back.calls >= total * total / 2 && back.calls <= (total + 2) * (total + 1) / 2 + total + 1);
        }
}

/* Lights that no polynomial equals: smooth ones to rounding, kinks and edges as far as a degree goes. The edge of a cap moves by at
 * most a spacing of nodes, pi / degree, and is a circle that nodes cross evenly; a kink loses one order more. */
static void lights(void) {
    float c[9];
    for (int i = -4; i <= 12; i++) {
        const long double k = powl(2.0L, 0.5L * i), first = 1.0L / tanhl(k) - 1.0L / k;
        const zonal_light light = random_axis(vmf, k);
        test_section("von Mises-Fisher, sharpness %g", (double)k);
        project(along_axis, &light, 150, c);
        expect_zonal(c, light.axis, 1.0L, first, 1.0L - 3.0L * first / k, 2.0L * exact_tolerance);
    }
    for (int i = 0; i < 5; i++) {
        const zonal_light light = random_axis(clamped_cosine, 0.0L);
        test_section("clamped cosine");
        project(along_axis, &light, 200, c);
        expect_zonal(c, light.axis, 1.0L, 2.0L / 3.0L, 0.25L, 8e-6L);
    }
    for (int i = -9; i <= 9; i++) {
        const long double cosine = 0.1L * i;
        const zonal_light light = random_axis(cap, cosine);
        test_section("a cap of cosine %g", (double)cosine);
        project(along_axis, &light, 300, c);
        expect_zonal(c, light.axis, (1.0L - cosine) / 2.0L, (1.0L - cosine * cosine) / 4.0L, (cosine - powl(cosine, 3.0L)) / 4.0L,
                     5e-4L);
    }
}

/* A light of all bands up to 4, that has no symmetry. */
static long double fourth_degree(const long double dir[3], const void *user) {
    const float *weight = (const float *)user;
    long double sum = 0.0L;
    for (int l = 0, i = 0; l <= 4; l++)
        for (int m = -l; m <= l; m++, i++)
            sum += (long double)weight[i] * oracle_y(l, m, dir, 0);
    return sum;
}

/* A random rotation, or with det -1 a reflection: two axes at right angles and their cross product. */
static void random_orthogonal(int reflect, long double q[3][3]) {
    float dir[3];
    test_direction(dir);
    oracle_widen(dir, 3, q[0]);
    const long double length = sqrtl(oracle_dot(q[0], q[0]));
    for (int i = 0; i < 3; i++)
        q[0][i] /= length;
    oracle_frame(q[0], q[1], q[2]);
    for (int i = 0; reflect && i < 3; i++)
        q[2][i] = -q[2][i];
}

/* Projecting a turned light gives the turned coefficients. */
static void rotations(void) {
    for (int i = 0; i < 40; i++) {
        float weight[25], c[9], turned[9];
        long double q[3][3], wide[9], expected[9];
        test_section("rotation covariance, %s", i % 2 ? "reflected" : "rotated");
        test_fill(weight, 25, -1.0, 1.0);
        random_orthogonal(i % 2, q);
        callback back = { fourth_degree, weight, NULL, 0 };
        EQUAL(sh_project_function(SH_L2, 1, call_light, &back, 4, c), SH_OK);
        back.turn = q;
        EQUAL(sh_project_function(SH_L2, 1, call_light, &back, 4, turned), SH_OK);
        oracle_widen(c, 9, wide);
        oracle_rotate(wide, q, expected);
        NEAR_ALL(turned, expected, 9, 3.0L * exact_tolerance); /* |light| is below 3 */
        oracle_rule rule = oracle_rule_sphere(6);
        oracle_moments(&rule, fourth_degree, weight, expected);
        oracle_rule_free(&rule);
        NEAR_ALL(c, expected, 9, 3.0L * exact_tolerance);
    }
}

/* Moments of a non-negative light: |R1| <= R0, and the quadratic form of R2 between -R0/3 and 2 R0/3. */
static void bounds(void) {
    for (int i = 0; i < 200; i++) {
        float c[9] = { 0 }, dir[3];
        const int count = 1 + test_below(5);
        test_section("bounds of %d lights", count);
        for (int k = 0; k < count; k++) {
            test_direction(dir);
            sh_add_sample(SH_L2, dir, (float)test_uniform(0.0, 1.0), c);
        }
        long double wide[9], n[3];
        oracle_widen(c, 9, wide);
        const long double slack = 3e-7L * wide[0];
        CHECK(sqrtl(oracle_dot(wide + 1, wide + 1)) <= wide[0] + slack);
        for (int k = 0; k < 20; k++) {
            test_direction(dir);
            oracle_widen(dir, 3, n);
            CHECK(oracle_quadratic(wide, n) >= -wide[0] / 3.0L - slack);
            CHECK(oracle_quadratic(wide, n) <= 2.0L / 3.0L * wide[0] + slack);
        }
    }
}

enum { SAMPLES = 1000, CHANNELS = 5 };

/* Directions, weights and values of several channels, in memory of exactly their size. */
typedef struct samples {
    float *x, *y, *z, *weight, *value;
} samples;

static samples random_samples(size_t count) {
    samples s;
    s.x = (float *)test_allocate(count * sizeof(float));
    s.y = (float *)test_allocate(count * sizeof(float));
    s.z = (float *)test_allocate(count * sizeof(float));
    s.weight = (float *)test_allocate(count * sizeof(float));
    s.value = (float *)test_allocate(CHANNELS * count * sizeof(float));
    for (size_t i = 0; i < count; i++) {
        float dir[3];
        test_direction(dir);
        s.x[i] = dir[0];
        s.y[i] = dir[1];
        s.z[i] = dir[2];
    }
    test_fill(s.weight, count, 0.0, 4.0);
    test_fill(s.value, CHANNELS * count, -1.0, 2.0);
    return s;
}

static void free_samples(samples *s) {
    free(s->x);
    free(s->y);
    free(s->z);
    free(s->weight);
    free(s->value);
}

/* Weighted means by definition; returns that of |value|. */
static long double expected_samples(const samples *s, int weighted, size_t count, int channel, long double c[9]) {
    long double total = 0.0L, magnitude = 0.0L;
    for (int k = 0; k < 9; k++)
        c[k] = 0.0L;
    for (size_t i = 0; i < count; i++) {
        const long double dir[3] = { (long double)s->x[i], (long double)s->y[i], (long double)s->z[i] };
        const long double weight = weighted ? (long double)s->weight[i] : 1.0L;
        const long double value = weight * (long double)s->value[(size_t)channel * count + i];
        long double basis[9];
        oracle_basis(dir, basis);
        total += weight;
        magnitude += fabsl(value);
        for (int k = 0; k < 9; k++)
            c[k] += value * basis[k];
    }
    for (int k = 0; k < 9; k++)
        c[k] /= total;
    return magnitude / total;
}

/* Counts around every width that a vector kernel might have. */
static void sample_arrays(void) {
    for (size_t count = 1; count <= SAMPLES; count += count < 40 ? 1 : 120)
        for (int weighted = 0; weighted <= 1; weighted++)
            for (int order = SH_L0; order <= SH_L2; order++) {
                samples s = random_samples(count);
                const int length = SH_COUNT(order);
                float *c = (float *)test_allocate((size_t)(CHANNELS * length) * sizeof(float));
                test_section("%d samples, weighted %d, order %d", (int)count, weighted, order);
                EQUAL(sh_project_samples(order, CHANNELS, s.x, s.y, s.z, s.value, weighted ? s.weight : NULL, count, c), SH_OK);
                for (int k = 0; k < CHANNELS; k++) {
                    long double expected[9];
                    const long double magnitude = expected_samples(&s, weighted, count, k, expected);
                    NEAR_ALL(c + k * length, expected, length, 5e-7L * magnitude); /* the contract */
                }
                free(c);
                free_samples(&s);
            }
    test_section("no samples");
    float none[2 * 9];
    memset(none, 0x55, sizeof none);
    EQUAL(sh_project_samples(SH_L2, 2, NULL, NULL, NULL, NULL, NULL, 0, none), SH_OK);
    for (int i = 0; i < 2 * 9; i++)
        NEAR(none[i], 0.0, 0);
}

/* Errors come back as such, and leave the output alone. */
static void errors(void) {
    const float dir[1] = { 1.0f };
    const long double value = 1.0L;
    callback back = { constant, &value, NULL, 0 };
    sh_accum accum[1], accum_before[1];
    float c[9], before[9];
    memset(c, 0x55, sizeof c);
    memset(accum, 0x55, sizeof accum);
    memcpy(before, c, sizeof c);
    memcpy(accum_before, accum, sizeof accum);
    const struct {
        const char *name;
        int order, channels;
        const float *x, *y, *z, *value;
        float *out;
    } cases[] = {
        { "order -1", -1, 1, dir, dir, dir, dir, c },      { "order 3", 3, 1, dir, dir, dir, dir, c },
        { "0 channels", 2, 0, dir, dir, dir, dir, c },     { "-1 channels", 2, -1, dir, dir, dir, dir, c },
        { "x NULL", 2, 1, NULL, dir, dir, dir, c },        { "y NULL", 2, 1, dir, NULL, dir, dir, c },
        { "z NULL", 2, 1, dir, dir, NULL, dir, c },        { "value NULL", 2, 1, dir, dir, dir, NULL, c },
        { "output NULL", 2, 1, dir, dir, dir, dir, NULL },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        test_section("sample errors: %s", cases[i].name);
        EQUAL(sh_project_samples(cases[i].order, cases[i].channels, cases[i].x, cases[i].y, cases[i].z, cases[i].value, NULL, 1,
                                 cases[i].out),
              SH_ERROR_ARGUMENT);
        EQUAL(sh_accum_samples(cases[i].order, cases[i].channels, cases[i].x, cases[i].y, cases[i].z, cases[i].value, NULL, 1,
                               cases[i].out ? accum : NULL),
              SH_ERROR_ARGUMENT);
    }
    test_section("function errors");
    EQUAL(sh_project_function(-1, 1, call_light, &back, 4, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(3, 1, call_light, &back, 4, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, 0, call_light, &back, 4, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, SH_MAX_CHANNELS + 1, call_light, &back, 4, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, 1, NULL, &back, 4, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, 1, call_light, &back, -1, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, 1, call_light, &back, 1001, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_project_function(2, 1, call_light, &back, 4, NULL), SH_ERROR_ARGUMENT);
    EQUAL(back.calls, 0);
    SAME_BITS(c, before, sizeof c);
    SAME_BITS(accum, accum_before, sizeof accum);
}

static void run_tests(void) {
    list_monomials();
    polynomials();
    degrees();
    constants();
    lights();
    rotations();
    bounds();
    sample_arrays();
    errors();
}
