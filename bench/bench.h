/* bench.h - what a benchmark case is; memory and clock. */
#ifndef BENCH_H
#define BENCH_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sh.h"

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <time.h>
#endif

enum { BENCH_ALIGNMENT = 64, BENCH_PADDING = 1024, BENCH_PAGE = 4096 };

/* ---- Cases ------------------------------------------------------------------------------------------------------------------- */

typedef enum bench_limit_kind {
    BENCH_FMA,  /* `fma` multiply-adds of one float per item, at the peak of the compiled backend */
    BENCH_READ, /* reading `read` bytes per item from `in` by a plain vector sum */
    BENCH_COPY  /* reading `read` bytes per item from `in`, 0 or a multiple of `written`, and writing `written` to `out` */
} bench_limit_kind;

typedef struct bench_limit {
    bench_limit_kind kind;
    size_t fma, read, written;
    const float *in;
    float *out;
} bench_limit;

/* One line of the table. A topic fills in everything but `data` and the limit's pointers, which prepare does. */
typedef struct bench_case bench_case;
typedef void (*bench_run)(bench_case *test);
struct bench_case {
    char name[64];
    size_t items;                           /* of one call */
    int order, kind, format, width, height; /* parameters of the topic */
    bench_run prepare;                      /* allocates with bench_alloc, and fills the inputs; not measured */
    bench_run run;                          /* one call */
    const char *baseline;                   /* what run_baseline does, in a few words */
    bench_run run_baseline;
    bench_limit limit;
    double (*error)(bench_case *test, int of_baseline); /* of what the last call left, against the long double oracle */
    double error_bound;                                 /* a case with a larger error, or NaN, fails */
    void *data;
};

typedef struct bench_list {
    bench_case *cases;
    int count, capacity;
} bench_list;

static inline void *bench_check(void *memory) {
    if (!memory) {
        fputs("sh_bench: out of memory\n", stderr);
        exit(2);
    }
    return memory;
}

/* A new case, all zero but its error bound, to fill in before the next call. */
static inline bench_case *bench_add(bench_list *list) {
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 64;
        list->cases = (bench_case *)bench_check(realloc(list->cases, (size_t)list->capacity * sizeof(bench_case)));
    }
    bench_case *test = &list->cases[list->count++];
    memset(test, 0, sizeof *test);
    test->error_bound = 1e-5;
    return test;
}

/* The larger of two errors. NaN is worse than anything. */
static inline double bench_worse(double a, double b) {
    return b <= a || a != a ? a : b;
}

/* ---- Memory: lives until the end of the case --------------------------------------------------------------------------------- */

typedef struct bench_block {
    struct bench_block *next;
} bench_block;

static bench_block *bench_blocks;

/* Zeroed, aligned to BENCH_ALIGNMENT, readable for BENCH_PADDING bytes beyond its end. Every page is there already: no call that is
 * measured waits for one. */
static inline void *bench_alloc(size_t size) {
    bench_block *block = (bench_block *)bench_check(calloc(1, sizeof(bench_block) + BENCH_ALIGNMENT + size + BENCH_PADDING));
    block->next = bench_blocks;
    bench_blocks = block;
    char *memory = (char *)(block + 1) + (BENCH_ALIGNMENT - (uintptr_t)(block + 1) % BENCH_ALIGNMENT) % BENCH_ALIGNMENT;
    for (size_t i = 0; i < size; i += BENCH_PAGE)
        *(volatile char *)(memory + i) = 0;
    return memory;
}

static inline float *bench_alloc_floats(size_t count) {
    return (float *)bench_alloc(count * sizeof(float));
}

static inline void bench_free_all(void) {
    while (bench_blocks) {
        bench_block *next = bench_blocks->next;
        free(bench_blocks);
        bench_blocks = next;
    }
}

/* ---- Clock ------------------------------------------------------------------------------------------------------------------- */

/* Seconds. Where the system tells it, the processor time of this thread: what other programs take in between does not count. */
static inline double bench_now(void) {
#if defined(_WIN32)
    LARGE_INTEGER ticks, frequency;
    QueryPerformanceCounter(&ticks);
    QueryPerformanceFrequency(&frequency);
    return (double)ticks.QuadPart / (double)frequency.QuadPart;
#else
    struct timespec t;
#if defined(CLOCK_THREAD_CPUTIME_ID)
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
#else
    clock_gettime(CLOCK_MONOTONIC, &t);
#endif
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
#endif
}

#endif /* BENCH_H */
