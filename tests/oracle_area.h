/* oracle_area.h - moments of emitters of radiance 1 with an area, by brute-force integration over their solid angle, in long double. */
#ifndef ORACLE_AREA_H
#define ORACLE_AREA_H

#include "oracle.h"

static inline void oracle_area_point(const long double p[3], long double solid_angle, long double c[9]) {
    const long double length = sqrtl(oracle_dot(p, p));
    long double dir[3], basis[9];
    for (int i = 0; i < 3; i++)
        dir[i] = p[i] / length;
    oracle_basis(dir, basis);
    for (int i = 0; i < 9; i++)
        c[i] += solid_angle / (4.0L * oracle_pi) * basis[i];
}

static inline void oracle_cross(const long double a[3], const long double b[3], long double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* A product rule on the parallelogram p + s u + t v, s, t in [0, 1], or on its half s + t < 1, with the factor cos / distance^2. */
static inline void oracle_area_rule(const long double p[3], const long double u[3], const long double v[3], int triangle,
                                    long double c[9]) {
    enum { NODES = 8 };
    static long double node[NODES], weight[NODES];
    long double normal[3];
    if (weight[0] == 0.0L)
        oracle_gauss(NODES, 0.0L, 1.0L, node, weight);
    oracle_cross(u, v, normal);
    for (int i = 0; i < NODES; i++)
        for (int j = 0; j < NODES; j++) {
            const long double s = node[i], t = triangle ? node[j] * (1.0L - s) : node[j];
            long double q[3];
            for (int k = 0; k < 3; k++)
                q[k] = p[k] + s * u[k] + t * v[k];
            const long double square = oracle_dot(q, q), flux = fabsl(oracle_dot(q, normal)) / (square * sqrtl(square));
            oracle_area_point(q, weight[i] * weight[j] * (triangle ? 1.0L - s : 1.0L) * flux, c);
        }
}

/* Halved until it is small against its distance, `depth` times at most. */
static inline void oracle_area_integrate(const long double p[3], const long double u[3], const long double v[3], int triangle,
                                         int depth, long double c[9]) {
    long double middle[3], half_u[3], half_v[3], minus_u[3], minus_v[3], start[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = p[i] + (u[i] + v[i]) / (triangle ? 3.0L : 2.0L);
        half_u[i] = u[i] / 2.0L;
        half_v[i] = v[i] / 2.0L;
        minus_u[i] = -half_u[i];
        minus_v[i] = -half_v[i];
    }
    const long double uu = oracle_dot(u, u), vv = oracle_dot(v, v), distance = oracle_dot(middle, middle);
    if (depth == 0 || (uu <= 0.1L * distance && vv <= 0.1L * distance)) {
        oracle_area_rule(p, u, v, triangle, c);
        return;
    }
    if (!triangle && uu < 0.1L * vv) {
        for (int i = 0; i < 3; i++)
            start[i] = p[i] + half_v[i];
        oracle_area_integrate(p, u, half_v, 0, depth - 1, c);
        oracle_area_integrate(start, u, half_v, 0, depth - 1, c);
        return;
    }
    for (int part = 0; part < 4; part++) {
        const int last = triangle && part == 3;
        for (int i = 0; i < 3; i++)
            start[i] = p[i] + (part & 1 ? half_u[i] : 0.0L) + (part & 2 ? half_v[i] : 0.0L);
        oracle_area_integrate(start, last ? minus_u : half_u, last ? minus_v : half_v, triangle, depth - 1, c);
    }
}

/* A convex polygon, as a fan of triangles. */
static inline void oracle_polygon(const float *vertices, size_t count, int depth, long double c[9]) {
    for (int i = 0; i < 9; i++)
        c[i] = 0.0L;
    for (size_t i = 2; i < count; i++) {
        long double p[3], u[3], v[3];
        for (int k = 0; k < 3; k++) {
            p[k] = (long double)vertices[k];
            u[k] = (long double)vertices[3 * (i - 1) + (size_t)k] - p[k];
            v[k] = (long double)vertices[3 * i + (size_t)k] - p[k];
        }
        oracle_area_integrate(p, u, v, 1, depth, c);
    }
}

/* A disk in polar coordinates: Gauss-Legendre in the radius, uniform in azimuth. radii <= ORACLE_MAX_NODES. */
static inline void oracle_disk(const float center[3], const float normal[3], float radius, int radii, int azimuths,
                               long double c[9]) {
    static long double r[ORACLE_MAX_NODES], w[ORACLE_MAX_NODES];
    static int ready = 0;
    long double axis[3], u[3], v[3];
    if (ready != radii)
        oracle_gauss(radii, 0.0L, 1.0L, r, w);
    ready = radii;
    oracle_widen(normal, 3, axis);
    oracle_frame(axis, u, v);
    for (int i = 0; i < 9; i++)
        c[i] = 0.0L;
    for (int j = 0; j < azimuths; j++) {
        const long double phi = 2.0L * oracle_pi * j / azimuths, cosine = cosl(phi), sine = sinl(phi);
        for (int i = 0; i < radii; i++) {
            const long double from_middle = r[i] * (long double)radius;
            long double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = (long double)center[k] + from_middle * (cosine * u[k] + sine * v[k]);
            const long double square = oracle_dot(p, p),
                              area = w[i] * (long double)radius * from_middle * 2.0L * oracle_pi / azimuths;
            oracle_area_point(p, area * fabsl(oracle_dot(p, axis)) / (square * sqrtl(square)), c);
        }
    }
}

/* A segment of width 1: the limit of a rectangle that faces the receiver, per width. Parts of equal angles as seen from there. */
static inline void oracle_segment(const float a[3], const float b[3], long double c[9]) {
    enum { NODES = 64 };
    static long double node[NODES], weight[NODES];
    long double from[3], to[3], along[3], foot[3], length;
    if (weight[0] == 0.0L)
        oracle_gauss(NODES, 0.0L, 1.0L, node, weight);
    oracle_widen(a, 3, from);
    oracle_widen(b, 3, to);
    for (int i = 0; i < 3; i++)
        along[i] = to[i] - from[i];
    length = sqrtl(oracle_dot(along, along));
    for (int i = 0; i < 3; i++)
        along[i] /= length;
    const long double first = oracle_dot(from, along), last = oracle_dot(to, along);
    for (int i = 0; i < 3; i++)
        foot[i] = from[i] - first * along[i];
    const long double height = sqrtl(oracle_dot(foot, foot)), begin = atan2l(first, height), end = atan2l(last, height);
    for (int i = 0; i < 9; i++)
        c[i] = 0.0L;
    for (int i = 0; i < NODES; i++) {
        const long double angle = begin + (end - begin) * node[i];
        long double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = foot[k] + height * tanl(angle) * along[k];
        oracle_area_point(p, weight[i] * (end - begin) * cosl(angle) / height,
                          c); /* width cos / r^2 ds, ds = h / cos^2 d(angle), r = h / cos */
    }
}

#endif /* ORACLE_AREA_H */
