/* Exact extrema, realizability, the ambient floor, de-ringing, orders needed: random and degenerate coefficients. SH_TEST_INPUTS=1000000 in
 * the environment searches, and takes the ringing from, so many. */
#include "test.h"

#include "lights.h"
#include "sh.h"

enum { DENSE = 4000 };

static float dense[DENSE][3];

/* Coefficients of every awkward kind. */
static void pick_coefficients(int kind, float c[9]) {
    float d[3], e[3];
    lights_light light;
    memset(c, 0, 9 * sizeof *c);
    c[0] = (float)test_uniform(-0.5, 2.0);
    test_direction(d);
    test_direction(e);
    switch (kind % 12) {
    case 0:
        test_fill(c + 1, 8, -1.0, 1.0);
        break;
    case 1:
        test_fill(c + 4, 5, -1.0, 1.0);
        break; /* R1 = 0 */
    case 2:
        test_fill(c + 1, 3, -1.0, 1.0);
        break; /* R2 = 0 */
    case 3:
        sh_add_sample(SH_L2, d, (float)test_uniform(-1.0, 1.0), c);
        break; /* a double root, R1 along the other */
    case 4:    /* a double root, R1 anywhere */
        sh_add_sample(SH_L2, d, 1.0f, c);
        test_fill(c + 1, 3, -1.0, 1.0);
        break;
    case 5: /* R1 along an eigenvector */
        c[SH_XX] = (float)test_uniform(-1.0, 1.0);
        c[SH_YY] = (float)test_uniform(-1.0, 1.0);
        c[SH_X + test_below(3)] = (float)test_uniform(-2.0, 2.0);
        break;
    case 6: /* R1 across an eigenvector, nearly */
        c[SH_XX] = (float)test_uniform(-1.0, 1.0);
        c[SH_YY] = (float)test_uniform(-1.0, 1.0);
        test_fill(c + 1, 3, -0.1, 0.1);
        c[SH_X + test_below(3)] = (float)(1e-3 * exp(-40.0 * test_uniform(0.0, 1.0)));
        break;
    case 7: /* nearly a double root */
        sh_add_sample(SH_L2, d, 1.0f, c);
        sh_add_sample(SH_L2, e, (float)exp(test_uniform(-20.0, -4.0)), c);
        break;
    case 8:
        break; /* constant */
    case 9:
        lights_random(test_below(LIGHTS_KINDS), &light);
        lights_moments(&light, 1.0, c);
        break;
    case 10: /* a tiny R2 beside R1, and the reverse */
        test_fill(c + 1, 3, -1.0, 1.0);
        test_fill(c + 4, 5, -1e-6, 1e-6);
        if (test_below(2))
            for (int i = 1; i < 9; i++)
                c[i] *= i < 4 ? 1e-6f : 1e6f;
        break;
    default:
        c[test_below(9)] = 1.0f;
        break;
    }
}

static float largest(const float c[9]) {
    float most = 0.0f;
    for (int i = 0; i < 9; i++)
        most = fabsf(c[i]) > most ? fabsf(c[i]) : most;
    return most;
}

/* By descent from the best of a dense set: projected Newton is not needed, shrinking steps are enough. */
static double search(int order, const float c[9], double sign, int irradiance, int polish) {
    double best = 1e300;
    float at[3] = { 0, 0, 1 };
    for (int i = 0; i < DENSE; i++) {
        const double value = sign * (double)(irradiance ? sh_irradiance(order, c, dense[i]) : sh_radiance(order, c, dense[i]));
        if (value < best) {
            best = value;
            memcpy(at, dense[i], sizeof at);
        }
    }
    for (double step = 0.05; polish && step > 1e-5; step *= 0.7)
        for (int i = 0; i < 8; i++) {
            float trial[3], toss[3];
            double length = 0.0;
            test_direction(toss);
            for (int k = 0; k < 3; k++) {
                trial[k] = at[k] + (float)step * toss[k];
                length += (double)trial[k] * (double)trial[k];
            }
            for (int k = 0; k < 3; k++)
                trial[k] /= (float)sqrt(length);
            const double value = sign * (double)(irradiance ? sh_irradiance(order, c, trial) : sh_radiance(order, c, trial));
            if (value < best) {
                best = value;
                memcpy(at, trial, sizeof at);
            }
        }
    return sign * best;
}

/* The value is taken at the place, so that it is not too low, and a search finds none that is lower. */
static void test_against_search(int count) {
    test_section("extrema");
    for (int i = 0; i < count; i++) {
        float c[9], at[3];
        pick_coefficients(i, c);
        const int order = i % 7 ? SH_L2 : SH_L1;
        const double unit = (double)largest(c);
        const float low = sh_min(order, c, at);
        NEAR(low, sh_radiance(order, c, at), 1e-5 * unit);
        NEAR(at[0] * at[0] + at[1] * at[1] + at[2] * at[2], 1.0, 1e-6);
        const double found = search(order, c, 1.0, 0, i % 10 == 0);
        CHECK((double)low <= found + 1e-5 * unit);
        const float high = sh_max(order, c, at);
        NEAR(high, sh_radiance(order, c, at), 1e-5 * unit);
        CHECK((double)high >= search(order, c, -1.0, 0, 0) - 1e-5 * unit);
        const float dim = sh_irradiance_min(order, c, at);
        NEAR(dim, sh_irradiance(order, c, at), 1e-5 * unit);
        CHECK((double)dim <= search(order, c, 1.0, 1, 0) + 1e-5 * unit);
        const float bright = sh_irradiance_max(order, c, at);
        NEAR(bright, sh_irradiance(order, c, at), 1e-5 * unit);
        CHECK((double)bright >= search(order, c, -1.0, 1, 0) - 1e-5 * unit);
    }
}

/* Without a search: the value is taken at the place, and no random direction has less; many more inputs. */
static void test_many(int count) {
    double worst = 0.0, below = 0.0;
    test_section("many extrema");
    for (int i = 0; i < count; i++) {
        float c[9], at[3];
        pick_coefficients(i, c);
        const double unit = (double)largest(c);
        const float low = sh_min(SH_L2, c, at);
        const double difference = fabs((double)(low - sh_radiance(SH_L2, c, at))) / unit;
        worst = difference > worst ? difference : worst;
        for (int k = 0; k < 4; k++) {
            const double lower = (double)(low - sh_radiance(SH_L2, c, dense[test_below(DENSE)])) / unit;
            below = lower > below ? lower : below;
        }
    }
    printf("minimum: %.2g from the value at its place, %.2g above another value\n", worst, below);
    CHECK(worst <= 1e-5 && below <= 1e-5);
}

/* Smallest eigenvalue by Jacobi's method, 4 x 4, long double. */
static double smallest_eigenvalue(const float c[9]) {
    long double w[9];
    for (int i = 0; i < 9; i++)
        w[i] = (long double)c[i] * (i == 0 ? 1.0L : i < 4 ? sqrtl(3.0L) : 3.0L);
    long double m[4][4] = { { w[0], w[1], w[2], w[3] },
                            { w[1], w[0] + w[4], w[5], w[6] },
                            { w[2], w[5], w[0] + w[7], w[8] },
                            { w[3], w[6], w[8], w[0] - w[4] - w[7] } };
    for (int sweep = 0; sweep < 12; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 4; q++) {
                if (m[p][q] == 0.0L)
                    continue;
                const long double h = (m[q][q] - m[p][p]) / (2.0L * m[p][q]);
                const long double tangent = (h < 0.0L ? -1.0L : 1.0L) / (fabsl(h) + sqrtl(h * h + 1.0L));
                const long double cosine = 1.0L / sqrtl(tangent * tangent + 1.0L), sine = tangent * cosine;
                for (int k = 0; k < 4; k++) {
                    const long double a = m[k][p], b = m[k][q];
                    m[k][p] = cosine * a - sine * b;
                    m[k][q] = sine * a + cosine * b;
                }
                for (int k = 0; k < 4; k++) {
                    const long double a = m[p][k], b = m[q][k];
                    m[p][k] = cosine * a - sine * b;
                    m[q][k] = sine * a + cosine * b;
                }
            }
    long double least = m[0][0];
    for (int i = 1; i < 4; i++)
        least = m[i][i] < least ? m[i][i] : least;
    return (double)least;
}

static void test_floor(int count) {
    double worst = 0.0;
    test_section("ambient floor");
    for (int i = 0; i < count; i++) {
        float c[9];
        lights_light light;
        if (i % 3) {
            lights_random(i % LIGHTS_KINDS, &light);
            lights_moments(&light, exp(test_uniform(-40.0, 40.0)), c);
            c[0] *= i % 5 ? 1.0f : 1.25f;
        } else
            pick_coefficients(i / 3, c);
        const double error = fabs((double)sh_ambient_floor(c) - smallest_eigenvalue(c)) / (double)largest(c);
        worst = error > worst ? error : worst;
    }
    printf("ambient floor: error %.2g\n", worst);
    CHECK(worst <= 1e-6);
    worst = 0.0;
    for (int i = 0; i < count; i++) { /* clusters: nearly constant light, and suns under it */
        float c[9];
        lights_light light;
        lights_random(i % LIGHTS_KINDS, &light);
        lights_moments(&light, exp(test_uniform(-16.0, 0.0)), c);
        c[0] += (float)test_uniform(0.0, 2.0);
        const double error = fabs((double)sh_ambient_floor(c) - smallest_eigenvalue(c)) / (double)c[0];
        worst = error > worst ? error : worst;
    }
    printf("ambient floor, clusters: error %.2g R0\n", worst);
    CHECK(worst <= 1e-6);
    for (int i = 0; i < 1000; i++) {
        float d[3], c[9] = { 0 };
        const float ambient = (float)test_uniform(0.0, 1.0);
        test_direction(d);
        c[0] = ambient;
        NEAR(sh_ambient_floor(c), ambient, 1e-6);
        sh_add_sample(SH_L2, d, 1.0f, c);
        NEAR(sh_ambient_floor(c), ambient, 1e-6);
    }
}

static void test_realizable(void) {
    lights_light light;
    float c[9];
    test_section("realizable");
    for (int i = 0; i < 20000; i++) {
        lights_random(i % LIGHTS_KINDS, &light);
        lights_moments(&light, exp(test_uniform(-20.0, 20.0)), c);
        for (int order = SH_L0; order <= SH_L2; order++)
            CHECK(sh_is_realizable(order, c));
        const float length = sqrtf(c[1] * c[1] + c[2] * c[2] + c[3] * c[3]), shift = 1e-3f * c[0];
        c[0] = i % 2 ? length - shift : -c[0];
        CHECK(!sh_is_realizable(SH_L1, c));
        CHECK(!sh_is_realizable(SH_L2, c));
        CHECK(i % 2 == 0 || length < shift || sh_is_realizable(SH_L0, c));
    }
}

/* The minimum over the sphere of a set under a window, relative to R0. */
static double windowed_minimum(const float *c, sh_window window, float parameter) {
    float zonal[3], out[9];
    if (window == SH_WINDOW_HANN)
        sh_zonal_hann(parameter, zonal);
    else if (window == SH_WINDOW_LANCZOS)
        sh_zonal_lanczos(parameter, zonal);
    else
        sh_zonal_laplacian(parameter, zonal);
    sh_convolve(SH_L2, c, zonal, out);
    return (double)(sh_min(SH_L2, out, NULL) / out[0]);
}

/* The parameter of a window that is weaker by a fraction of it. */
static float weaker_window(sh_window window, float parameter, float by) {
    return window == SH_WINDOW_LAPLACIAN ? parameter - by * parameter : parameter / (1.0f - by);
}

static void pick_ringing(int i, int channels, float *c) {
    for (int k = 0; k < channels; k++, c += 9)
        if (i % 2) {
            pick_coefficients(test_below(12), c);
            c[0] = fabsf(c[0]) + 1e-3f;
        } else {
            lights_light light;
            lights_random(test_below(LIGHTS_KINDS), &light);
            lights_moments(&light, exp(test_uniform(-8.0, 8.0)), c);
        }
}

/* Nothing is negative afterwards; under windows that are weaker by .1 %, 1 % and more, something is. */
static void test_dering(int count) {
    static const float by[5] = { 1e-3f, 0.01f, 0.05f, 0.2f, 0.7f };
    double least = 0.0;
    test_section("de-ringing");
    for (int i = 0; i < count; i++) {
        const int channels = 1 + i % 3;
        const sh_window window = (sh_window)(i / 3 % 3);
        float c[27], out[27];
        double before = 1.0, after = 1.0;
        pick_ringing(i, channels, c);
        const float parameter = sh_dering(SH_L2, channels, c, window, out);
        for (int k = 0; k < channels; k++) {
            const double was = (double)(sh_min(SH_L2, c + 9 * k, NULL) / c[9 * k]);
            const double is = (double)(sh_min(SH_L2, out + 9 * k, NULL) / c[9 * k]);
            before = was < before ? was : before;
            after = is < after ? is : after;
        }
        CHECK(after >= -1e-6);
        least = after < least ? after : least;
        if (before >= 0.0) {
            CHECK(window == SH_WINDOW_LAPLACIAN ? parameter == 0.0f : parameter > 1e30f);
            CHECK(memcmp(c, out, (size_t)channels * 9 * sizeof *c) == 0);
        }
        for (int j = 0; j < 5 && before < -1e-5; j++) {
            double weaker = 1.0;
            for (int k = 0; k < channels; k++) {
                const double value = windowed_minimum(c + 9 * k, window, weaker_window(window, parameter, by[j]));
                weaker = value < weaker ? value : weaker;
            }
            CHECK(weaker < 0.0);
        }
    }
    printf("de-ringing: minimum %.2g R0\n", least);
    const float hopeless[9] = { -1.0f, 1.0f }, black[9] = { 0 };
    float out[9];
    sh_dering(SH_L2, 1, hopeless, SH_WINDOW_HANN, out);
    SAME_BITS(out, hopeless, sizeof out);
    sh_dering(SH_L2, 1, black, SH_WINDOW_LAPLACIAN, out);
    SAME_BITS(out, black, sizeof out);
}

static void test_order_needed(void) {
    test_section("order needed");
    for (int i = 0; i < 3000; i++) {
        float c[9], low[9] = { 0 };
        pick_coefficients(i, c);
        const float tolerance = (float)exp(test_uniform(-6.0, 2.0));
        const int order = sh_order_needed(c, tolerance), radiance = sh_radiance_order_needed(c, tolerance);
        for (int k = 0; k < 60; k++) {
            const float *n = dense[test_below(DENSE)];
            CHECK(fabsf(sh_irradiance(order, c, n) - sh_irradiance(SH_L2, c, n)) <= tolerance * 1.00001f + 1e-6f);
            CHECK(fabsf(sh_radiance(radiance, c, n) - sh_radiance(SH_L2, c, n)) <= tolerance * 1.00001f + 3e-6f);
        }
        low[0] = 1.0f;
        low[1 + test_below(3)] = 0.4f * tolerance;
        EQUAL(sh_order_needed(low, tolerance), SH_L0);
        low[1] = 2.0f * tolerance;
        EQUAL(sh_order_needed(low, tolerance), SH_L1);
        low[4] = 2.0f * tolerance;
        EQUAL(sh_order_needed(low, tolerance), SH_L2);
    }
}

/* A lobe about z, tilted by less and less, then not at all: the frame of its axes stays one. */
static void test_tilted(void) {
    test_section("tilted lobes");
    for (int i = 0; i < 40; i++) {
        const float tilt = i == 39 ? 0.0f : (i % 2 ? -1e-2f : 1e-2f) / (float)(1 << i / 2);
        const float lobe[9] = { 1.0f, 0, 0, 0, -1.0f, 0, tilt / 3.0f, -1.0f, tilt };
        NEAR(sh_min(SH_L2, lobe, NULL), 1.0f - 7.5f, 1e-3);
        NEAR(sh_max(SH_L2, lobe, NULL), 1.0f + 15.0f, 1e-3);
    }
}

/* Where one coefficient is all there is of its band, the bounds are known: the weight of the band times |R1|, or times sqrt(4/3) the
 * coefficient, which xx + yy + zz = 0 allows an eigenvalue of R2 to reach. */
static void test_tight_bounds(void) {
    const double r2 = sqrt(4.0 / 3.0);
    const float ambient[9] = { 1.0f };
    EQUAL(sh_order_needed(ambient, 0.0f), SH_L0);
    for (int i = 1; i < 9; i++) {
        float c[18] = { 0 };
        const float irradiance = (float)(i < 4 ? 2.0 : 1.875 * r2), radiance = (float)(i < 4 ? 3.0 : 7.5 * r2);
        const int order = i < 4 ? SH_L1 : SH_L2;
        test_section("bounds of coefficient %d", i);
        c[i] = -0.5f;
        EQUAL(sh_order_needed(c, 0.4999f * irradiance), order);
        EQUAL(sh_order_needed(c, 0.5001f * irradiance), SH_L0);
        EQUAL(sh_order_needed(c, 0.0f), order);
        EQUAL(sh_radiance_order_needed(c, 0.4999f * radiance), order);
        EQUAL(sh_radiance_order_needed(c, 0.5001f * radiance), SH_L0);
        EQUAL(sh_is_grey(SH_L2, 2, c, 0.4999f * irradiance), 0);
        EQUAL(sh_is_grey(SH_L2, 2, c, 0.5001f * irradiance), 1);
        c[9 + i] = -0.5f;
        c[SH_R0] = 0.5f;
        EQUAL(sh_is_grey(SH_L2, 2, c, 0.4999f), 0);
        EQUAL(sh_is_grey(SH_L2, 2, c, 0.5001f), 1);
    }
}

static void test_black(void) {
    const float black[9] = { 0 };
    test_section("black");
    for (int order = SH_L0; order <= SH_L2; order++)
        CHECK(sh_is_realizable(order, black));
    for (int i = 1; i < 9; i++) { /* light of no mean has no moments */
        float c[9] = { 0 };
        c[i] = 1e-20f;
        CHECK(!sh_is_realizable(SH_L2, c));
    }
}

static void test_groups(void) {
    enum { PROBES = 300 };
    static float c[PROBES * 27];
    size_t index[PROBES], first[4];
    int seen[PROBES] = { 0 };
    test_section("groups by order");
    for (int i = 0; i < PROBES * 3; i++) {
        memset(c + 9 * i, 0, 9 * sizeof *c);
        c[9 * i] = 1.0f;
        if (i % 4 == 0)
            c[9 * i + 2] = (float)test_uniform(0.0, 0.3);
        if (i % 7 == 0)
            c[9 * i + 6] = (float)test_uniform(0.0, 0.3);
    }
    sh_group_by_order(3, c, PROBES, 0.1f, index, first);
    EQUAL(first[0], 0);
    EQUAL(first[3], PROBES);
    for (int order = 0; order < 3; order++)
        for (size_t i = first[order]; i < first[order + 1]; i++) {
            int needed = 0;
            for (int k = 0; k < 3; k++) {
                const int one = sh_order_needed(c + 27 * index[i] + 9 * k, 0.1f);
                needed = one > needed ? one : needed;
            }
            EQUAL(needed, order);
            seen[index[i]]++;
            CHECK(i == first[order] || index[i] > index[i - 1]);
        }
    for (int i = 0; i < PROBES; i++)
        EQUAL(seen[i], 1);
    sh_group_by_order(3, c, 0, 0.1f, index, first);
    EQUAL(first[3], 0);
}

static void test_grey_and_lights(void) {
    test_section("grey, lights");
    float c[27], n[3], budget = 0.5f, skipped[9] = { 0 };
    for (int i = 0; i < 500; i++) {
        test_fill(c, 9, -1.0, 1.0);
        const double spread = exp(test_uniform(-9.0, -2.0));
        for (int k = 9; k < 27; k++)
            c[k] = c[k % 9] + (float)test_uniform(-spread, spread);
        const float tolerance = (float)exp(test_uniform(-7.0, 0.0));
        if (sh_is_grey(SH_L2, 3, c, tolerance))
            for (int k = 0; k < 50; k++) {
                test_direction(n);
                const float grey = sh_irradiance(SH_L2, c, n);
                CHECK(fabsf(sh_irradiance(SH_L2, c + 9, n) - grey) <= tolerance + 1e-6f);
                CHECK(fabsf(sh_irradiance(SH_L2, c + 18, n) - grey) <= tolerance + 1e-6f);
            }
    }
    CHECK(sh_is_grey(SH_L2, 1, c, 0.0f));
    CHECK(!sh_skip_light(-1.0f, &budget) && !sh_skip_light(1.0f, &budget));
    float just = 4.25f;
    CHECK(sh_skip_light(1.0f, &just) == 1 && just == 0.0f);
    int count = 0;
    for (int i = 0; i < 200; i++) {
        const float value = (float)test_uniform(0.0, 0.01);
        test_direction(n);
        if (sh_skip_light(value, &budget)) {
            sh_add_sample(SH_L2, n, value, skipped);
            count++;
        }
    }
    CHECK(count > 20 && count < 200 && budget >= 0.0f);
    CHECK(sh_irradiance_max(SH_L2, skipped, NULL) <= 0.5f && sh_irradiance_min(SH_L2, skipped, NULL) >= -0.5f);
}

/* However small the lights and however many, they cost what they cost: a float budget would not feel a cost below half its ulp. */
static void test_budget(void) {
    static const float values[3] = { 6.9e-9f, 1.1e-8f, 3.3e-7f };
    for (int i = 0; i < 3; i++) {
        float budget = 1.0f;
        double spent = 0.0;
        test_section("a budget for lights of %g", (double)values[i]);
        for (int k = 0; k < 20000000 && sh_skip_light(values[i], &budget); k++)
            spent += 4.25 * (double)values[i];
        CHECK(spent <= 1.0 - (double)budget && spent > 0.4);
    }
}

static void run_tests(void) {
    for (uint32_t i = 0; i < DENSE; i++)
        sh_direction_fibonacci(i, DENSE, dense[i]);
    const char *inputs = getenv("SH_TEST_INPUTS");
    test_against_search(inputs ? atoi(inputs) : 600);
    test_many(1000000);
    test_floor(100000);
    test_realizable();
    test_dering(inputs ? atoi(inputs) : 3000);
    test_order_needed();
    test_budget();
    test_tight_bounds();
    test_tilted();
    test_black();
    test_groups();
    test_grey_and_lights();
}
