/* Golden values: sh.h gives the same results as when they were written down, to the bit where golden.h says so. That takes a compiler
 * that fuses nothing by itself (-ffp-contract=off) and IEEE arithmetic in float; elsewhere 3e-6 of a case's largest value is allowed: a
 * window's lambda, where it just stops a set from ringing, moves by 2e-6 for the roundings of the minimum.
 * -DGOLDEN_EXACT fails where it is. */
#include <float.h>

#include "golden/golden.h"
#include "test.h"

typedef struct expected_case {
    const char *name;
    int count;
    uint32_t bits[GOLDEN_VALUES];
} expected_case;

static const expected_case unfused[] = {
#include "golden/unfused.h"
};
static const expected_case fused[] = {
#include "golden/fused.h"
};

/* Whether float arithmetic is done in float, one operation at a time, without other liberties. */
static int is_exact(void) {
#if defined(__FAST_MATH__)
    return 0;
#else
    volatile float a = 1.0f + 1.0f / 4096, c = -(1.0f + 1.0f / 2048);
    const float difference = a * a + c; /* 2^-24 where the compiler fuses, or computes in double */
    return difference == 0.0f;
#endif
}

static void check_case(const golden_case *actual, const expected_case *expected, int exact) {
    float value[GOLDEN_VALUES], largest = 0.0f;
    EQUAL(actual->count, expected->count);
    memcpy(value, expected->bits, sizeof value);
    for (int i = 0; i < expected->count; i++)
        largest = fabsf(value[i]) > largest && fabsf(value[i]) <= FLT_MAX ? fabsf(value[i]) : largest;
    if (exact && actual->tolerance == 0.0)
        SAME_BITS(actual->value, expected->bits, (size_t)expected->count * sizeof(float));
    NEAR_ALL(actual->value, value, expected->count,
             (actual->tolerance > 0.0 ? actual->tolerance
              : exact                 ? 0.0
                                      : 3e-6) *
                 (double)largest);
}

static void run_tests(void) {
    const int exact = is_exact(), fuses = golden_fuses();
    printf("backend %s: %s, %s\n", SH_SIMD_NAME, fuses ? "fused" : "unfused", exact ? "bit for bit" : "to a tolerance");
    golden_compute();
    EQUAL(sizeof unfused / sizeof unfused[0], golden_count);
    EQUAL(sizeof fused / sizeof fused[0], golden_count);
    for (int i = 0; i < golden_count; i++) {
        const expected_case *expected = fuses ? &fused[i] : &unfused[i];
        test_section("%s", golden[i].name);
        CHECK(strcmp(golden[i].name, expected->name) == 0);
        check_case(&golden[i], expected, exact);
    }
#ifdef GOLDEN_EXACT
    CHECK(exact);
#endif
}
