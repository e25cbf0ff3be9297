/* Runs the probes and compares each with the first: including sh.h in different ways, in files of different instruction sets and
 * languages that are linked together, never changes a result by more than rounding. */
#include "probes.h"

#include <math.h>
#include <stdio.h>

typedef int (*probe_function)(float result[PROBE_SIZE]);

static int passed, failed;

static void check(const char *name, probe_function probe, int expected_count) {
    float expected[PROBE_SIZE] = { 0 }, result[PROBE_SIZE] = { 0 };
    int bad = -1;
    int count = probe(result);

    probe_alone(expected);
    for (int i = 0; i < count; i++)
        if (!(fabsf(result[i] - expected[i]) <= 1e-6f * (1.0f + fabsf(expected[i]))))
            bad = i;
    if (count == expected_count && bad < 0) {
        passed++;
        return;
    }
    failed++;
    if (bad < 0)
        printf("%s: %d results, not %d\n", name, count, expected_count);
    else
        printf("%s: result %d is %.9g, not %.9g\n", name, bad, (double)result[bad], (double)expected[bad]);
}

int main(void) {
    check("alone", probe_alone, PROBE_SIZE);
    check("twice", probe_twice, PROBE_SIZE);
    check("last", probe_last, PROBE_SIZE);
    check("windows", probe_windows, PROBE_SIZE);
    check("no_batch", probe_no_batch, PROBE_SCALAR);
#ifdef PROBE_default
    check("default", probe_default, PROBE_SIZE);
#endif
#ifdef PROBE_scalar
    check("scalar", probe_scalar, PROBE_SIZE);
#endif
#ifdef PROBE_cxx
    check("cxx", probe_cxx, PROBE_SIZE);
#endif
    /* Linked on every x86-64, called where the machine can. */
#ifdef PROBE_avx2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        check("avx2", probe_avx2, PROBE_SIZE);
#endif
#ifdef PROBE_avx512
    if (__builtin_cpu_supports("avx512f"))
        check("avx512", probe_avx512, PROBE_SIZE);
#endif
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
