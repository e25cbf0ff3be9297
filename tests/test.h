/* test.h - what a test program needs: checks, a section name for the failures, random numbers, and main.
 *
 *     #include "test.h"
 *
 *     static void run_tests(void) {
 *         test_section("square roots");
 *         CHECK(sqrt(4.0) > 1.0);
 *         NEAR(sqrt(2.0), 1.41421356, 1e-8);
 *     }
 *
 * A program is one C file that compiles as C99 and as C++11. It ends with `N passed, N failed`; the exit status is 0 if something was
 * checked and nothing failed. */
#ifndef TEST_H
#define TEST_H

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A condition. */
#define CHECK(condition) test_check((condition) ? 1 : 0, #condition, __FILE__, __LINE__)

/* Two integers of at most 64 bits. */
#define EQUAL(actual, expected) test_equal((long long)(actual), (long long)(expected), #actual, #expected, __FILE__, __LINE__)

/* |actual - expected| <= tolerance, in long double. NaN is near nothing; equal infinities are near. */
#define NEAR(actual, expected, tolerance)                                                                                          \
    test_near((long double)(actual), (long double)(expected), (long double)(tolerance), -1, #actual, #expected, __FILE__, __LINE__)

/* |actual - expected| <= tolerance |expected| */
#define RELATIVE(actual, expected, tolerance) NEAR(actual, expected, (long double)(tolerance)*fabsl((long double)(expected)))

/* NEAR for each element of two arrays of floating-point numbers, of any two types. */
#define NEAR_ALL(actual, expected, count, tolerance)                                                                               \
    do {                                                                                                                           \
        for (int test_index = 0; test_index < (int)(count); test_index++)                                                          \
            test_near((long double)(actual)[test_index], (long double)(expected)[test_index], (long double)(tolerance),            \
                      test_index, #actual, #expected, __FILE__, __LINE__);                                                         \
    } while (0)

/* Two objects of `size` bytes, bit for bit. */
#define SAME_BITS(actual, expected, size) CHECK(memcmp((actual), (expected), (size)) == 0)

/* What each program defines, unless it brings its own main and defines TEST_OWN_MAIN before it includes this. */
#ifndef TEST_OWN_MAIN
static void run_tests(void);
#endif

enum { TEST_MAX_PRINTED = 20 };

static struct {
    long passed, failed;
    char section[160];
    uint64_t random;
} test_state;

/* Names what follows, in the manner of printf; printed with a failure. */
static inline void test_section(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(test_state.section, sizeof test_state.section, format, arguments);
    va_end(arguments);
}

/* Counts a check; true if it failed and is to be printed, its place already is. */
static inline int test_count(int passed, const char *file, int line) {
    if (passed) {
        ++test_state.passed;
        return 0;
    }
    if (++test_state.failed > TEST_MAX_PRINTED)
        return 0;
#ifdef TEST_STOP_AT_FAILURE /* where nobody reads on */
    exit(1);
#endif
    printf("%s:%d: [%s] ", file, line, test_state.section);
    return 1;
}

static inline void test_check(int passed, const char *text, const char *file, int line) {
    if (test_count(passed, file, line))
        printf("%s\n", text);
}

static inline void test_equal(long long actual, long long expected, const char *actual_text, const char *expected_text,
                              const char *file, int line) {
    if (test_count(actual == expected, file, line))
        printf("%s is %lld, not %s = %lld\n", actual_text, actual, expected_text, expected);
}

/* index: of an array's element, or -1 */
static inline void test_near(long double actual, long double expected, long double tolerance, int index, const char *actual_text,
                             const char *expected_text, const char *file, int line) {
    const int passed = actual == expected || fabsl(actual - expected) <= tolerance;
    if (!test_count(passed, file, line))
        return;
    printf("%s", actual_text);
    if (index >= 0)
        printf("[%d]", index);
    printf(" is %.12g, not %s = %.12g: off by %.4g, tolerance %.4g\n", (double)actual, expected_text, (double)expected,
           (double)(actual - expected), (double)tolerance);
}

/* ---- Random numbers: the same on every machine ---- */

static inline void test_seed(uint64_t seed) {
    test_state.random = seed;
}

/* 64 random bits. Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators" (splitmix64). */
static inline uint64_t test_bits(void) {
    uint64_t bits = (test_state.random += UINT64_C(0x9e3779b97f4a7c15));
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return bits ^ (bits >> 31);
}

/* Uniform in [low, high). */
static inline double test_uniform(double low, double high) {
    return low + (high - low) * ((double)(test_bits() >> 11) / 9007199254740992.0);
}

/* Uniform in [0, count). */
static inline int test_below(int count) {
    return (int)(test_bits() % (uint64_t)count);
}

/* `count` numbers, uniform in [low, high). */
static inline void test_fill(float *out, size_t count, double low, double high) {
    for (size_t i = 0; i < count; i++)
        out[i] = (float)test_uniform(low, high);
}

/* Uniform on the sphere: a point of the ball, normalised; unit length to the rounding of the components. */
static inline void test_direction(float dir[3]) {
    double v[3], square;
    do {
        for (int i = 0; i < 3; i++)
            v[i] = test_uniform(-1.0, 1.0);
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    } while (square > 1.0 || square < 1e-4);
    for (int i = 0; i < 3; i++)
        dir[i] = (float)(v[i] / sqrt(square));
}

/* Memory of exactly `size` bytes, so that an address checker sees any access beyond it. */
static inline void *test_allocate(size_t size) {
    void *memory = malloc(size);
    if (memory == NULL) {
        printf("out of memory\n");
        exit(1);
    }
    return memory;
}

static inline void test_write_nan(void) {
    volatile double garbage[1 << 14];
    for (int i = 0; i < 1 << 14; i++)
        garbage[i] = (double)NAN;
    (void)garbage[0];
}

/* Leaves NaN on the stack, where the next call's variables will be: one that is read before it is written shows. */
static inline void test_dirty_stack(void) {
    void (*volatile write)(void) = test_write_nan; /* a call through it is not inlined */
    write();
}

#ifndef TEST_OWN_MAIN
int main(void) {
    test_seed(1);
    run_tests();
    if (test_state.failed > TEST_MAX_PRINTED)
        printf("... and %ld more\n", test_state.failed - TEST_MAX_PRINTED);
    printf("%ld passed, %ld failed\n", test_state.passed, test_state.failed);
    return test_state.passed > 0 && test_state.failed == 0 ? 0 : 1;
}
#endif

#endif /* TEST_H */
