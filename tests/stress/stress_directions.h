/* stress_directions.h - generated directions, and functions projected by quadrature. */
#ifndef STRESS_DIRECTIONS_H
#define STRESS_DIRECTIONS_H

#include "stress_coefficients.h"

/* A bit pattern as an index: any number. */
static inline uint32_t stress_index(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline void stress_unit_length(stress_measure *m, const float dir[3]) {
    long double wide[3];
    oracle_widen(dir, 3, wide);
    stress_error(m, fabsl(sqrtl(oracle_dot(wide, wide)) - 1.0L), 1.0L);
}

/* in: three numbers as indices. Unit length; and on its place where that is known: in its stratum, on its circle of the spiral. */
static inline void stress_sequences(const float *in, stress_measure *m) {
    const uint32_t i = stress_index(in[0]), seed = stress_index(in[1]), count = stress_index(in[2]) | 1u;
    const uint32_t rows = 1 + count % 1000, columns = 1 + seed % 1000, at = i % (rows * columns), row = at / columns;
    float dir[3];
    sh_direction_sequence(i, seed, dir);
    stress_unit_length(m, dir);
    sh_direction_fibonacci(i % count, count, dir);
    stress_unit_length(m, dir);
    stress_compare(m, dir[2], 1.0L - 2.0L * ((long double)(i % count) + 0.5L) / count, 1.0L);
    sh_direction_stratified(i, columns, rows, seed, dir);
    stress_unit_length(m, dir);
    stress_error(m, fmaxl(0.0L, (long double)dir[2] - (1.0L - 2.0L * row / rows)), 1.0L);
    stress_error(m, fmaxl(0.0L, (1.0L - 2.0L * (row + 1.0L) / rows) - (long double)dir[2]), 1.0L);
}

static inline void stress_polynomial_value(const float dir[3], float *value, void *user) {
    const float *c = (const float *)user;
    const long double n[3] = { (long double)dir[0], (long double)dir[1], (long double)dir[2] };
    long double wide[9];
    oracle_widen(c, 9, wide);
    value[0] = (float)oracle_expand(wide, stress_radiance_kernel, n);
}

/* A polynomial of degree 2 comes back, whatever the degree asked for from 2 on. */
static inline void stress_project_function(const float *in, stress_measure *m) {
    float set[9], out[9];
    long double c[9], size = 0.0L;
    static const long double norm[9] = { 1.0L, 3.0L, 3.0L, 3.0L, 15.0L, 15.0L, 15.0L, 15.0L, 15.0L };
    memcpy(set, in, sizeof set);
    oracle_widen(in, 9, c);
    for (int i = 0; i < 9; i++)
        size += norm[i] * fabsl(c[i]);
    stress_require(m,
                   sh_project_function(SH_L2, 1, stress_polynomial_value, set, 2 + (int)(stress_index(in[9]) % 9), out) == SH_OK);
    stress_compare_all(m, out, c, 9, size);
}

static const stress_case stress_direction_cases[] = {
    { "sh_direction_stratified, _sequence, _fibonacci", "unit length, stratum and height to 1 ulp of 1",
      STRESS_ULP, 1.0, { SET(3) }, stress_sequences, 4 },
    { "sh_project_function", "1e-7 of the largest value of the function",
      STRESS_RELATIVE, 1e-7, { SET(9), SET(1) }, stress_project_function, 60 },
};

#endif /* STRESS_DIRECTIONS_H */
