/* stress_lights.h - lights, against closed forms and integration over their solid angle. */
#ifndef STRESS_LIGHTS_H
#define STRESS_LIGHTS_H

#include "../oracle_area.h"
#include "stress_analysis.h"

/* The zonal lobe about a direction. */
static inline void stress_lobe_moments(const long double zonal[3], const long double dir[3], long double c[9]) {
    oracle_basis(dir, c);
    for (int i = 0; i < 9; i++)
        c[i] *= zonal[i < 1 ? 0 : i < 4 ? 1 : 2];
}

/* A light added to a black set: by its own R0. */
static inline void stress_light(stress_measure *m, const float *c, const long double expected[9], long double value) {
    for (int i = 0; i < 9; i++)
        stress_compare(m, c[i], value * expected[i], fabsl(value * expected[0]));
}

/* in: dir, value */
static inline void stress_directional(const float *in, stress_measure *m) {
    static const long double quarter[3] = { 0.25L, 0.25L, 0.25L };
    long double dir[3], expected[9];
    float c[9] = { 0 };
    oracle_widen(in, 3, dir);
    stress_lobe_moments(quarter, dir, expected);
    sh_add_directional(SH_L2, 1, in, in + 3, c);
    stress_light(m, c, expected, (long double)in[3]);
}

/* in: up, sky, ground, ambient */
static inline void stress_hemisphere(const float *in, stress_measure *m) {
    const long double sky = (long double)in[3], ground = (long double)in[4], ambient = (long double)in[5];
    const long double size = (fabsl(sky) + fabsl(ground)) / 2.0L + fabsl(ambient);
    float c[9] = { 0 };
    sh_add_hemisphere(SH_L2, 1, in, in + 3, in + 4, c);
    sh_add_ambient(SH_L2, 1, in + 5, c);
    stress_compare(m, c[0], (sky + ground) / 2.0L + ambient, size);
    for (int i = 0; i < 3; i++)
        stress_compare(m, c[1 + i], (sky - ground) / 4.0L * (long double)in[i], size);
    for (int i = 4; i < 9; i++)
        stress_require(m, c[i] == 0.0f);
}

/* Of a cap with h = 1 - cos(half-angle). */
static inline void stress_cap_kernel(long double h, sh_unit unit, long double zonal[3]) {
    const long double facing = unit == SH_IRRADIANCE && h < 1.0L ? h * (2.0L - h) : 1.0L; /* irradiance / pi of radiance 1 */
    zonal[0] = h / 2.0L / facing;
    zonal[1] = h * (2.0L - h) / 4.0L / facing;
    zonal[2] = (1.0L - h) * h * (2.0L - h) / 4.0L / facing;
}

/* in: dir, value, half-angle */
static inline void stress_cap(const float *in, stress_measure *m) {
    for (int unit = SH_RADIANCE; unit <= SH_IRRADIANCE; unit++) {
        long double dir[3], zonal[3], expected[9];
        const long double angle = fminl((long double)in[4], oracle_pi), sine = sinl(angle / 2.0L);
        float c[9] = { 0 };
        if (angle == 0.0L && unit == SH_IRRADIANCE)
            continue;
        oracle_widen(in, 3, dir);
        stress_cap_kernel(2.0L * sine * sine, (sh_unit)unit, zonal);
        stress_lobe_moments(zonal, dir, expected);
        sh_add_cap(SH_L2, 1, in, in[4], (sh_unit)unit, in + 3, c);
        stress_light(m, c, expected, (long double)in[3]);
    }
}

/* in: centre, radius by distance, value */
static inline void stress_sphere(const float *in, stress_measure *m) {
    for (int unit = SH_RADIANCE; unit <= SH_IRRADIANCE; unit++) {
        long double center[3], zonal[3] = { 1.0L, 0.0L, 0.0L }, dir[3] = { 0.0L, 0.0L, 1.0L }, expected[9];
        float c[9] = { 0 };
        oracle_widen(in, 3, center);
        const long double distance = sqrtl(oracle_dot(center, center));
        const float radius = (float)((long double)in[3] * distance);
        const long double sine = distance > 0.0L ? (long double)radius / distance : 0.0L;
        if (!(distance > 0.0L) || fabsl(sine - 1.0L) < 1e-6L || (sine == 0.0L && unit == SH_IRRADIANCE))
            continue;
        if (sine < 1.0L) {
            stress_cap_kernel(sine * sine / (1.0L + sqrtl(1.0L - sine * sine)), (sh_unit)unit, zonal);
            for (int i = 0; i < 3; i++)
                dir[i] = center[i] / distance;
        }
        stress_lobe_moments(zonal, dir, expected);
        sh_add_sphere(SH_L2, 1, in, radius, (sh_unit)unit, in + 4, c);
        stress_light(m, c, expected, (long double)in[4]);
    }
}

/* in: dir, value, sharpness */
static inline void stress_vmf_light(const float *in, stress_measure *m) {
    for (int unit = SH_RADIANCE; unit <= SH_IRRADIANCE; unit++) {
        long double dir[3], zonal[3], expected[9], mean, facing;
        float c[9] = { 0 };
        oracle_widen(in, 3, dir);
        stress_vmf((long double)in[4], zonal, &mean, &facing);
        stress_lobe_moments(zonal, dir, expected);
        for (int i = 0; i < 9; i++)
            expected[i] *= unit == SH_RADIANCE ? mean : mean / facing;
        sh_add_vmf(SH_L2, 1, in, in[4], (sh_unit)unit, in + 3, c);
        stress_light(m, c, expected, (long double)in[3]);
    }
}

/* ---- Emitters with an area: about a centre at distance 1, scaled -------------------------------------------------------------------- */

/* 2^k with k in [-60, 60], from any number: scaling by it is exact. */
static inline float stress_scale(float seed) {
    int exponent;
    frexpf(seed, &exponent);
    return ldexpf(1.0f, exponent < -60 ? -60 : exponent > 60 ? 60 : exponent);
}

/* in: the directions of the centre and of two sides, their size, scale */
static inline void stress_rectangle(const float *in, stress_measure *m) {
    const float scale = stress_scale(in[10]), one = 1.0f;
    float center[3], u[3], v[3], c[9] = { 0 };
    long double expected[9] = { 0.0L }, p[3], wide_u[3], wide_v[3], normal[3];
    for (int i = 0; i < 3; i++) {
        center[i] = scale * in[i];
        u[i] = scale * in[9] * in[3 + i];
        v[i] = scale * in[9] * in[6 + i];
        p[i] = (long double)center[i] - (long double)u[i] - (long double)v[i];
        wide_u[i] = 2.0L * (long double)u[i];
        wide_v[i] = 2.0L * (long double)v[i];
    }
    oracle_cross(wide_u, wide_v, normal);
    const long double area = sqrtl(oracle_dot(normal, normal)), height = fabsl(oracle_dot(p, normal));
    /* Slivers, and what is seen nearly edge on, are as uncertain as their sides, which are floats. */
    if (area < 0.3L * (long double)(scale * scale * in[9] * in[9]) || height < 0.2L * area * (long double)scale)
        return;
    oracle_area_integrate(p, wide_u, wide_v, 0, 9, expected);
    sh_add_rectangle(SH_L2, 1, center, u, v, &one, c);
    stress_light(m, c, expected, 1.0L);
}

/* in: three vertices as directions, their distances, scale */
static inline void stress_triangle(const float *in, stress_measure *m) {
    const float scale = stress_scale(in[12]), one = 1.0f;
    float vertices[9], c[9] = { 0 };
    long double expected[9], p[3], u[3], v[3], normal[3];
    for (int i = 0; i < 9; i++)
        vertices[i] = scale * in[9 + i / 3] * in[i];
    for (int i = 0; i < 3; i++) {
        p[i] = (long double)vertices[i];
        u[i] = (long double)vertices[3 + i] - p[i];
        v[i] = (long double)vertices[6 + i] - p[i];
    }
    oracle_cross(u, v, normal);
    const long double area = sqrtl(oracle_dot(normal, normal));
    if (!(fabsl(oracle_dot(p, normal)) > 0.05L * area * (long double)scale) || area < 0.01L * (long double)(scale * scale))
        return;
    oracle_polygon(vertices, 3, 9, expected);
    stress_require(m, sh_add_polygon(SH_L2, 1, vertices, 3, &one, c) == SH_OK);
    stress_light(m, c, expected, 1.0L);
}

/* in: the direction of the centre, the normal, radius, scale */
static inline void stress_disk(const float *in, stress_measure *m) {
    const float scale = stress_scale(in[7]), one = 1.0f, radius = scale * in[6];
    float center[3], c[9] = { 0 };
    long double expected[9], p[3], axis[3], length;
    for (int i = 0; i < 3; i++)
        center[i] = scale * in[i];
    oracle_widen(in, 3, p);
    oracle_widen(in + 3, 3, axis);
    length = sqrtl(oracle_dot(axis, axis));
    if (!(fabsl(oracle_dot(p, axis)) > 0.3L) || fabsl(length - 1.0L) > 3e-7L)
        return;
    oracle_disk(center, in + 3, radius, 64, 192, expected);
    sh_add_disk(SH_L2, 1, center, in + 3, radius, &one, c);
    stress_light(m, c, expected, 1.0L);
}

/* in: two directions, their distances, width, scale */
static inline void stress_segment(const float *in, stress_measure *m) {
    const float scale = stress_scale(in[9]), one = 1.0f, width = scale * in[8];
    float a[3], b[3], c[9] = { 0 };
    long double expected[9], p[3], q[3], normal[3];
    for (int i = 0; i < 3; i++) {
        a[i] = scale * in[6] * in[i];
        b[i] = scale * in[7] * in[3 + i];
    }
    oracle_widen(a, 3, p);
    oracle_widen(b, 3, q);
    oracle_cross(p, q, normal);
    for (int i = 0; i < 3; i++)
        q[i] -= p[i];
    /* The distance from the axis: far beyond the width, and known to some digits. */
    const long double length = sqrtl(oracle_dot(q, q)), height = sqrtl(oracle_dot(normal, normal)) / length;
    if (!(height > 0.1L * (long double)scale) || !(width > 0.0f))
        return;
    oracle_segment(a, b, expected);
    for (int i = 0; i < 9; i++)
        expected[i] *= (long double)width;
    sh_add_segment(SH_L2, 1, a, b, width, &one, c);
    stress_light(m, c, expected, 1.0L);
}

/* in: 6 centres, tolerance. What was skipped changes irradiance, true or reconstructed, by less than the tolerance. */
static inline void stress_spheres(const float *in, stress_measure *m) {
    float spheres[24], radiance[6], c[9] = { 0 }, all[9] = { 0 };
    long double d[9];
    const float tolerance = in[18];
    for (int i = 0; i < 6; i++) {
        long double p[3];
        oracle_widen(in + 3 * i, 3, p);
        memcpy(spheres + 4 * i, in + 3 * i, 3 * sizeof *in);
        spheres[4 * i + 3] = (float)(sqrtl(oracle_dot(p, p)) * 0.3L / (1 << i));
        radiance[i] = 1.0f;
        sh_add_sphere(SH_L2, 1, in + 3 * i, spheres[4 * i + 3], SH_RADIANCE, radiance + i, all);
    }
    sh_add_spheres(SH_L2, 1, spheres, radiance, 6, tolerance, c);
    for (int i = 0; i < 9; i++)
        d[i] = (long double)all[i] - (long double)c[i];
    const long double change = fmaxl(-stress_least(d, 2.0L, 1.875L), stress_greatest(d, 2.0L, 1.875L));
    stress_error(m, fmaxl(0.0L, change - 1e-6L), (long double)tolerance);
}

static const stress_case stress_light_cases[] = {
    { "sh_add_directional", "1e-6 of the light's R0", STRESS_RELATIVE, 1e-6, { DIRECTION, SET(1) }, stress_directional, 1 },
    { "sh_add_ambient, sh_add_hemisphere", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTION, SET(3) }, stress_hemisphere, 1 },
    { "sh_add_cap", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTION, SET(1), NUMBER(0.0, 3.14159274) }, stress_cap, 2 },
    { "sh_add_sphere", "1e-6 of the light's R0", STRESS_RELATIVE, 1e-6, { POINTS(1), NUMBER(0.0, 4.0), SET(1) }, stress_sphere, 2 },
    { "sh_add_vmf", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTION, SET(1), NUMBER(0.0, 1e18) }, stress_vmf_light, 12 },
    { "sh_add_rectangle", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTIONS(3), NUMBER(1e-3, 1.5), NUMBER(1e-18, 1e18) }, stress_rectangle, 1500 },
    { "sh_add_polygon, triangles", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTIONS(3), NUMBERS(3, 0.3, 3.0), NUMBER(1e-18, 1e18) }, stress_triangle, 1500 },
    { "sh_add_disk", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTIONS(2), NUMBER(0.001, 1.5), NUMBER(1e-18, 1e18) }, stress_disk, 5000 },
    { "sh_add_segment", "1e-6 of the light's R0",
      STRESS_RELATIVE, 1e-6, { DIRECTIONS(2), NUMBERS(2, 0.3, 3.0), NUMBER(0.0, 0.01), NUMBER(1e-18, 1e18) }, stress_segment, 20 },
    { "sh_add_spheres", "the skipped change irradiance by no more than the tolerance",
      STRESS_SHARE, 1.0, { POINTS(6), NUMBER(1e-4, 0.3) }, stress_spheres, 40 },
};

#endif /* STRESS_LIGHTS_H */
