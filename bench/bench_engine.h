/* bench_engine.h - the arithmetic of the baselines: what engines write today. Orthonormal basis, no Condon-Shortley phase, six
 * decimals, RGB interleaved. Green, "Spherical Harmonic Lighting: The Gritty Details"; Ramamoorthi and Hanrahan, "An Efficient
 * Representation for Irradiance Environment Maps". */
#ifndef BENCH_ENGINE_H
#define BENCH_ENGINE_H

#include "../tests/oracle.h"
#include "bench.h"

/* SH_COUNT(order) coefficients in the order Y00; Y1-1, Y10, Y11; Y2-2, Y2-1, Y20, Y21, Y22. */
typedef struct engine_rgb {
    float v[3];
} engine_rgb;

SHI_INLINE void engine_basis(int order, float x, float y, float z, float basis[9]) {
    basis[0] = 0.282095f;
    if (order >= SH_L1) {
        basis[1] = 0.488603f * y;
        basis[2] = 0.488603f * z;
        basis[3] = 0.488603f * x;
    }
    if (order >= SH_L2) {
        basis[4] = 1.092548f * x * y;
        basis[5] = 1.092548f * y * z;
        basis[6] = 0.315392f * (3.0f * z * z - 1.0f);
        basis[7] = 1.092548f * x * z;
        basis[8] = 0.546274f * (x * x - y * y);
    }
}

SHI_INLINE float engine_dot(int order, const engine_rgb *c, int channel, const float basis[9]) {
    float sum = c[0].v[channel] * basis[0];
    if (order >= SH_L1)
        sum += c[1].v[channel] * basis[1] + c[2].v[channel] * basis[2] + c[3].v[channel] * basis[3];
    if (order >= SH_L2)
        sum += c[4].v[channel] * basis[4] + c[5].v[channel] * basis[5] + c[6].v[channel] * basis[6] + c[7].v[channel] * basis[7] +
               c[8].v[channel] * basis[8];
    return sum;
}

/* Adds a sample of solid angle `weight`. */
SHI_INLINE void engine_add(int order, const float dir[3], const float rgb[3], float weight, engine_rgb *c) {
    float basis[9];
    engine_basis(order, dir[0], dir[1], dir[2], basis);
    for (int i = 0; i < SH_COUNT(order); i++) {
        const float w = basis[i] * weight;
        c[i].v[0] += rgb[0] * w;
        c[i].v[1] += rgb[1] * w;
        c[i].v[2] += rgb[2] * w;
    }
}

/* Factors from moments to orthonormal coefficients: of R0; R1; xy, yz, xz; zz; xx - yy. */
static inline void engine_factors(double factor[5]) {
    const double pi = (double)oracle_pi;
    const double value[5] = { 2.0 * sqrt(pi), sqrt(12.0 * pi), 2.0 * sqrt(15.0 * pi), 3.0 * sqrt(5.0 * pi), sqrt(15.0 * pi) };
    memcpy(factor, value, sizeof value);
}

/* From planar moments; band l times zonal[l]. */
static inline void engine_from_moments(int order, const float *c, const double zonal[3], engine_rgb *out) {
    double f[5];
    engine_factors(f);
    for (int k = 0; k < 3; k++) {
        double m[9] = { 0 };
        for (int i = 0; i < SH_COUNT(order); i++)
            m[i] = (double)c[k * SH_COUNT(order) + i] * zonal[i < 1 ? 0 : i < 4 ? 1 : 2];
        const double value[9] = { f[0] * m[SH_R0],
                                  f[1] * m[SH_Y],
                                  f[1] * m[SH_Z],
                                  f[1] * m[SH_X],
                                  f[2] * m[SH_XY],
                                  f[2] * m[SH_YZ],
                                  -f[3] * (m[SH_XX] + m[SH_YY]),
                                  f[2] * m[SH_XZ],
                                  f[4] * (m[SH_XX] - m[SH_YY]) };
        for (int i = 0; i < SH_COUNT(order); i++)
            out[i].v[k] = (float)value[i];
    }
}

/* To planar moments, times `scale`. */
static inline void engine_to_moments(int order, const engine_rgb *in, double scale, float *c) {
    double f[5];
    engine_factors(f);
    for (int k = 0; k < 3; k++) {
        double y[9];
        for (int i = 0; i < 9; i++)
            y[i] = i < SH_COUNT(order) ? scale * (double)in[i].v[k] : 0.0;
        const double zz = y[6] / f[3], difference = y[8] / f[4];
        const double value[9] = { y[0] / f[0],
                                  y[3] / f[1],
                                  y[1] / f[1],
                                  y[2] / f[1],
                                  (difference - zz) / 2.0,
                                  y[4] / f[2],
                                  y[7] / f[2],
                                  (-difference - zz) / 2.0,
                                  y[5] / f[2] };
        for (int i = 0; i < SH_COUNT(order); i++)
            c[k * SH_COUNT(order) + i] = (float)value[i];
    }
}

#endif /* BENCH_ENGINE_H */
