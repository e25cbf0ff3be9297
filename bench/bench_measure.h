/* bench_measure.h - how a case is measured.
 *
 * A case takes turns with its baseline and with its physical limit, so that all three see the same machine. A turn is as many calls
 * as fill BENCH_TURN seconds, or one call that is longer. Next is whichever has had the least time so far. */
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include "bench.h"
#include "bench_limits.h"

#define BENCH_TURN 1e-3 /* seconds: 10^4 steps of a clock of 100 ns, short against the drift of a clock frequency */

enum { BENCH_MAX_TURNS = 4096 };

typedef enum bench_role { BENCH_THE_CASE, BENCH_THE_BASELINE, BENCH_THE_LIMIT, BENCH_ROLES } bench_role;

/* One of the three that take turns. */
typedef struct bench_runner {
    bench_case *test;
    volatile bench_run run; /* no compiler sees through the call, so none removes or merges calls */
    size_t calls;           /* per turn */
    double spent;           /* seconds */
    int turns;
    double seconds[BENCH_MAX_TURNS]; /* per call */
} bench_runner;

static inline double bench_time(bench_runner *runner, size_t calls) {
    const double start = bench_now();
    for (size_t i = 0; i < calls; i++)
        runner->run(runner->test);
    return bench_now() - start;
}

static inline void bench_turn(bench_runner *runner) {
    const double seconds = bench_time(runner, runner->calls);
    runner->spent += seconds;
    runner->seconds[runner->turns++] = seconds / (double)runner->calls;
}

/* Finds the number of calls in a turn, and takes the first turns. A pause of the machine makes one turn long, not two: the shorter
 * of two decides. A call that takes longer than any pause is not repeated. */
static inline void bench_first_turns(bench_runner *runner) {
    for (runner->calls = 1;;) {
        runner->turns = 0;
        bench_turn(runner);
        if (runner->seconds[0] >= 100 * BENCH_TURN)
            return;
        bench_turn(runner);
        const double shorter = runner->seconds[0] < runner->seconds[1] ? runner->seconds[0] : runner->seconds[1];
        const double seconds = shorter * (double)runner->calls;
        if (seconds >= 0.9 * BENCH_TURN || runner->calls > ((size_t)1 << 30))
            return;
        const double growth = seconds > 0 ? 1.1 * BENCH_TURN / seconds : 10.0;
        runner->calls = 1 + (size_t)((double)runner->calls * (growth < 10.0 ? growth : 10.0));
    }
}

static inline int bench_ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Quantile of sorted numbers, linear between neighbours. */
static inline double bench_quantile(const double *sorted, int count, double quantile) {
    const double at = quantile * (count - 1);
    const int i = (int)at, next = i + 1 < count ? i + 1 : i;
    return sorted[i] + (at - i) * (sorted[next] - sorted[i]);
}

/* Times are in ns per item. */
typedef struct bench_result {
    const bench_case *test;
    double ns, ns_median;
    double spread; /* distance of the quartiles / median */
    double baseline_ns, limit_ns;
    double error, baseline_error;
} bench_result;

static inline int bench_failed(const bench_result *result) {
    return !(result->error <= result->test->error_bound);
}

/* Whose turn it is: of those that want more, who has had the least time. -1: none does. */
static inline int bench_next_role(const bench_runner runner[BENCH_ROLES], double seconds, int turns) {
    int next = -1;
    for (int role = 0; role < BENCH_ROLES; role++) {
        const bench_runner *r = &runner[role];
        const int wants = (r->spent < seconds || (r->turns < turns && r->spent < 8 * seconds)) && r->turns < BENCH_MAX_TURNS;
        if (wants && (next < 0 || r->spent < runner[next].spent))
            next = role;
    }
    return next;
}

static inline bench_result bench_summarise(bench_case *test, bench_runner runner[BENCH_ROLES]) {
    const double ns = 1e9 / (double)test->items;
    for (int role = 0; role < BENCH_ROLES; role++)
        qsort(runner[role].seconds, (size_t)runner[role].turns, sizeof(double), bench_ascending);
    const double *sorted = runner[BENCH_THE_CASE].seconds;
    const int count = runner[BENCH_THE_CASE].turns;
    const double median = bench_quantile(sorted, count, 0.5);
    bench_result result;
    memset(&result, 0, sizeof result);
    result.test = test;
    result.ns = ns * sorted[0];
    result.ns_median = ns * median;
    result.spread = (bench_quantile(sorted, count, 0.75) - bench_quantile(sorted, count, 0.25)) / median;
    result.baseline_ns = ns * runner[BENCH_THE_BASELINE].seconds[0];
    result.limit_ns = ns * runner[BENCH_THE_LIMIT].seconds[0] / bench_limit_calls(&test->limit);
    return result;
}

/* Measures each of the three for `seconds`, or for as many `turns` as do not take more than eight times as long. Errors are of what
 * the first turns leave. */
static inline bench_result bench_measure(bench_case *test, double seconds, int turns) {
    static bench_runner runner[BENCH_ROLES];
    const bench_run run[BENCH_ROLES] = { test->run, test->run_baseline, bench_run_limit };
    double error[2] = { 0, 0 };
    for (int role = 0; role < BENCH_ROLES; role++) {
        memset(&runner[role], 0, sizeof runner[role]);
        runner[role].test = test;
        runner[role].run = run[role];
        bench_first_turns(&runner[role]);
        if (role != BENCH_THE_LIMIT)
            error[role] = test->error(test, role == BENCH_THE_BASELINE);
    }
    for (int role; (role = bench_next_role(runner, seconds, turns)) >= 0;)
        bench_turn(&runner[role]);
    bench_result result = bench_summarise(test, runner);
    result.error = error[BENCH_THE_CASE];
    result.baseline_error = error[BENCH_THE_BASELINE];
    return result;
}

#endif /* BENCH_MEASURE_H */
