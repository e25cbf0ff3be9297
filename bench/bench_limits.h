/* bench_limits.h - what the machine can do at most, measured with the vector vocabulary of the compiled backend. */
#ifndef BENCH_LIMITS_H
#define BENCH_LIMITS_H

#include "bench.h"

/* Takes the results that nobody needs, so that they have to be computed. */
static volatile float bench_sink;

/* A number that no compiler knows. */
static volatile float bench_seed = 1.0f;

/* Keeps one-lane chains from being packed into vectors, which would no longer measure one lane. No instruction. */
static inline shi_v bench_chain(shi_v a) {
#if defined(__GNUC__) && SH_SIMD == SH_SIMD_SCALAR && (defined(__SSE2__) || defined(__i386__))
    __asm__("" : "+x"(a));
#elif defined(__GNUC__) && SH_SIMD == SH_SIMD_SCALAR && defined(__aarch64__)
    __asm__("" : "+w"(a));
#endif
    return a;
}

static inline void bench_consume(shi_v a) {
    float lanes[SHI_LANES];
    shi_store(lanes, a);
    bench_sink = lanes[0];
}

/* `steps` times twelve independent chains of one multiply-add. Twelve in flight cover a latency of 4 to 6 cycles at 2 to 3 a cycle,
 * and with two constants they fit into 16 registers. They start apart, lest a compiler merge them, and tend to 2: no overflow, no
 * subnormals. */
static inline void bench_fma_chains(size_t steps) {
    const shi_v half = shi_splat(0.5f), one = shi_splat(1.0f);
    shi_v a = shi_splat(bench_seed), b = shi_add(a, one), c = shi_add(b, one), d = shi_add(c, one), e = shi_add(d, one);
    shi_v f = shi_add(e, one), g = shi_add(f, one), h = shi_add(g, one), i = shi_add(h, one), j = shi_add(i, one);
    shi_v k = shi_add(j, one), l = shi_add(k, one);
    for (size_t step = 0; step < steps; step++) {
        a = bench_chain(shi_madd(a, half, one));
        b = bench_chain(shi_madd(b, half, one));
        c = bench_chain(shi_madd(c, half, one));
        d = bench_chain(shi_madd(d, half, one));
        e = bench_chain(shi_madd(e, half, one));
        f = bench_chain(shi_madd(f, half, one));
        g = bench_chain(shi_madd(g, half, one));
        h = bench_chain(shi_madd(h, half, one));
        i = bench_chain(shi_madd(i, half, one));
        j = bench_chain(shi_madd(j, half, one));
        k = bench_chain(shi_madd(k, half, one));
        l = bench_chain(shi_madd(l, half, one));
    }
    const shi_v abc = shi_add(shi_add(a, b), c), def = shi_add(shi_add(d, e), f);
    const shi_v ghi = shi_add(shi_add(g, h), i), jkl = shi_add(shi_add(j, k), l);
    bench_consume(shi_add(shi_add(abc, def), shi_add(ghi, jkl)));
}

/* The sum of `count` floats, front to back; reads on to a whole number of eight vectors. */
static inline void bench_read(const float *in, size_t count) {
    const shi_v zero = shi_splat(0.0f);
    shi_v a = zero, b = zero, c = zero, d = zero, e = zero, f = zero, g = zero, h = zero;
    for (size_t i = 0; i < count; i += 8 * SHI_LANES) {
        a = shi_add(a, shi_load(in + i));
        b = shi_add(b, shi_load(in + i + SHI_LANES));
        c = shi_add(c, shi_load(in + i + 2 * SHI_LANES));
        d = shi_add(d, shi_load(in + i + 3 * SHI_LANES));
        e = shi_add(e, shi_load(in + i + 4 * SHI_LANES));
        f = shi_add(f, shi_load(in + i + 5 * SHI_LANES));
        g = shi_add(g, shi_load(in + i + 6 * SHI_LANES));
        h = shi_add(h, shi_load(in + i + 7 * SHI_LANES));
    }
    bench_consume(shi_add(shi_add(shi_add(a, b), shi_add(c, d)), shi_add(shi_add(e, f), shi_add(g, h))));
}

static inline void bench_write(float *out, size_t count) {
    const shi_v value = shi_splat(bench_seed);
    for (size_t i = 0; i < count; i += 4 * SHI_LANES) {
        shi_store(out + i, value);
        shi_store(out + i + SHI_LANES, value);
        shi_store(out + i + 2 * SHI_LANES, value);
        shi_store(out + i + 3 * SHI_LANES, value);
    }
}

/* Copies three arrays of `count` floats side by side, as from x, y, z to red, green, blue: faster than one after the other where
 * memory is far. */
static inline void bench_copy_three(const float *in, float *out, size_t count) {
    for (size_t i = 0; i < count; i += SHI_LANES) {
        shi_store(out + i, shi_load(in + i));
        shi_store(out + count + i, shi_load(in + count + i));
        shi_store(out + 2 * count + i, shi_load(in + 2 * count + i));
    }
}

/* Writes `count` floats, each vector the sum of the next `ratio` vectors read, front to back. */
SHI_INLINE void bench_copy_sums(const float *in, size_t ratio, float *out, size_t count) {
    for (size_t i = 0; i < count; i += SHI_LANES) {
        shi_v sum = shi_load(in + ratio * i);
        for (size_t j = 1; j < ratio; j++)
            sum = shi_add(sum, shi_load(in + ratio * i + j * SHI_LANES));
        shi_store(out + i, sum);
    }
}

static inline void bench_copy(const bench_limit *limit, size_t items) {
    const size_t count = items * limit->written / sizeof(float), ratio = limit->read / limit->written;
    if (ratio == 0)
        bench_write(limit->out, count);
    else if (ratio == 1)
        bench_copy_three(limit->in, limit->out, count / 3);
    else if (ratio == 2)
        bench_copy_sums(limit->in, 2, limit->out, count);
    else
        bench_copy_sums(limit->in, ratio, limit->out, count);
}

enum {
    BENCH_FMA_CALLS = 64
}; /* multiply-adds are done for so many calls at once: starting and ending the chains is not their peak */

static inline int bench_limit_calls(const bench_limit *limit) {
    return limit->kind == BENCH_FMA ? BENCH_FMA_CALLS : 1;
}

/* The limit of bench_limit_calls calls of a case. */
static inline void bench_run_limit(bench_case *test) {
    const bench_limit *limit = &test->limit;
    switch (limit->kind) {
    case BENCH_FMA: bench_fma_chains(BENCH_FMA_CALLS * test->items * limit->fma / (12 * SHI_LANES)); break;
    case BENCH_READ: bench_read(limit->in, test->items * limit->read / sizeof(float)); break;
    case BENCH_COPY: bench_copy(limit, test->items); break;
    }
}

/* "24 FMA", "read 12 B", "copy 32+16 B" (read + written), "write 12 B": per item. */
static inline void bench_limit_name(const bench_limit *limit, char *name, size_t size) {
    switch (limit->kind) {
    case BENCH_FMA: snprintf(name, size, "%d FMA", (int)limit->fma); break;
    case BENCH_READ: snprintf(name, size, "read %d B", (int)limit->read); break;
    case BENCH_COPY:
        if (limit->read)
            snprintf(name, size, "copy %d+%d B", (int)limit->read, (int)limit->written);
        else
            snprintf(name, size, "write %d B", (int)limit->written);
        break;
    }
}

#endif /* BENCH_LIMITS_H */
