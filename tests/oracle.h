/* oracle.h - what the tests compare with: long double, from definitions, slow on purpose. Shares nothing with sh.h.
 *
 * Moments of f are in the order R0, x, y, z, xx - 1/3, xy, xz, yy - 1/3, yz: means over the sphere, <f> = 1/(4 pi) integral f dOmega. */
#ifndef ORACLE_H
#define ORACLE_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static const long double oracle_pi = 3.14159265358979323846264338327950288L;

static inline long double oracle_dot(const long double a[3], const long double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* An array of floats in long double. */
static inline void oracle_widen(const float *from, int count, long double *to) {
    for (int i = 0; i < count; i++)
        to[i] = (long double)from[i];
}

/* ---- Functions on the sphere ---- */

/* Legendre polynomial P_l(t), by Bonnet's recursion. */
static inline long double oracle_legendre(int l, long double t) {
    long double before = 0.0L, p = 1.0L;
    for (int k = 0; k < l; k++) {
        const long double next = ((2 * k + 1) * t * p - k * before) / (k + 1);
        before = p;
        p = next;
    }
    return p;
}

/* Associated Legendre polynomial P_l^m(z) / (1 - z^2)^(m/2), 0 <= m <= l, without Condon-Shortley phase: upwards in l from
 * P_m^m = (2m - 1)!! (1 - z^2)^(m/2). */
static inline long double oracle_associated_legendre(int l, int m, long double z) {
    long double before = 0.0L, p = 1.0L;
    for (int k = 1; k <= m; k++)
        p *= 2 * k - 1;
    for (int k = m; k < l; k++) {
        const long double next = ((2 * k + 1) * z * p - (k + m) * before) / (k + 1 - m);
        before = p;
        p = next;
    }
    return p;
}

/* Orthonormal real spherical harmonic Y_lm, |m| <= l: sqrt(2) K P_l^|m|(cos theta) times cos(m phi), or sin(|m| phi) for m < 0.
 * phase: with the Condon-Shortley phase, (-1)^m. */
static inline long double oracle_y(int l, int m, const long double dir[3], int phase) {
    const int order = m < 0 ? -m : m;
    long double cosine = 1.0L, sine = 0.0L; /* (x + iy)^order = sin(theta)^order (cos(order phi) + i sin(order phi)) */
    for (int k = 0; k < order; k++) {
        const long double next = cosine * dir[0] - sine * dir[1];
        sine = cosine * dir[1] + sine * dir[0];
        cosine = next;
    }
    long double factorials = 1.0L; /* (l - order)! / (l + order)! */
    for (int k = l - order + 1; k <= l + order; k++)
        factorials /= k;
    long double norm = sqrtl((2 * l + 1) / (4.0L * oracle_pi) * factorials);
    if (order > 0)
        norm *= sqrtl(2.0L);
    if (phase && order % 2 == 1)
        norm = -norm;
    return norm * oracle_associated_legendre(l, order, dir[2]) * (m < 0 ? sine : cosine);
}

/* The nine functions whose means against a light are its moments. */
static inline void oracle_basis(const long double dir[3], long double basis[9]) {
    const long double x = dir[0], y = dir[1], z = dir[2], third = 1.0L / 3.0L;
    const long double value[9] = { 1.0L, x, y, z, x * x - third, x * y, x * z, y * y - third, y * z };
    for (int i = 0; i < 9; i++)
        basis[i] = value[i];
}

/* The symmetric traceless matrix whose upper triangle without zz is the second band of moments c. */
static inline void oracle_matrix(const long double c[9], long double matrix[3][3]) {
    const long double full[3][3] = { { c[4], c[5], c[6] }, { c[5], c[7], c[8] }, { c[6], c[8], -(c[4] + c[7]) } };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            matrix[i][j] = full[i][j];
}

/* n' R2 n */
static inline long double oracle_quadratic(const long double c[9], const long double n[3]) {
    long double matrix[3][3], sum = 0.0L;
    oracle_matrix(c, matrix);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += n[i] * matrix[i][j] * n[j];
    return sum;
}

/* The expansion sum of (2l + 1) k_l times band l at dir, k the factors of a zonal kernel: (1, 1, 1) is radiance. */
static inline long double oracle_expand(const long double c[9], const long double kernel[3], const long double dir[3]) {
    return kernel[0] * c[0] + 3.0L * kernel[1] * oracle_dot(&c[1], dir) + 7.5L * kernel[2] * oracle_quadratic(c, dir);
}

/* Moments of the light that was turned by the orthogonal matrix q: R1 -> q R1, R2 -> q R2 q'. */
static inline void oracle_rotate(const long double c[9], long double q[3][3], long double out[9]) {
    long double matrix[3][3], turned[3][3];
    oracle_matrix(c, matrix);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            turned[i][j] = 0.0L;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++)
                    turned[i][j] += q[i][k] * matrix[k][l] * q[j][l];
        }
    const long double first[3] = { oracle_dot(q[0], &c[1]), oracle_dot(q[1], &c[1]), oracle_dot(q[2], &c[1]) };
    const long double value[9] = { c[0],         first[0],     first[1],     first[2],    turned[0][0],
                                   turned[0][1], turned[0][2], turned[1][1], turned[1][2] };
    for (int i = 0; i < 9; i++)
        out[i] = value[i];
}

/* Two unit vectors at right angles to unit vector axis and to each other, right-handed. */
static inline void oracle_frame(const long double axis[3], long double u[3], long double v[3]) {
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabsl(axis[i]) < fabsl(axis[least]))
            least = i;
    for (int i = 0; i < 3; i++)
        u[i] = (i == least ? 1.0L : 0.0L) - axis[least] * axis[i];
    const long double length = sqrtl(oracle_dot(u, u));
    for (int i = 0; i < 3; i++)
        u[i] /= length;
    for (int i = 0; i < 3; i++)
        v[i] = axis[(i + 1) % 3] * u[(i + 2) % 3] - axis[(i + 2) % 3] * u[(i + 1) % 3];
}

/* <x^i y^j z^k>: (i - 1)!! (j - 1)!! (k - 1)!! / (i + j + k + 1)!! if all are even, 0 otherwise. */
static inline long double oracle_monomial(int i, int j, int k) {
    const int power[3] = { i, j, k };
    long double mean = 1.0L;
    for (int axis = 0; axis < 3; axis++) {
        if (power[axis] % 2 == 1)
            return 0.0L;
        for (int n = power[axis] - 1; n > 1; n -= 2)
            mean *= n;
    }
    for (int n = i + j + k + 1; n > 1; n -= 2)
        mean /= n;
    return mean;
}

/* ---- Quadrature ---- */

enum { ORACLE_MAX_NODES = 1024 };

/* Gauss-Legendre nodes and weights on [from, to], count <= ORACLE_MAX_NODES: exact for polynomials of degree 2 count - 1.
 * Newton's method from the roots of a Chebyshev polynomial. */
static inline void oracle_gauss(int count, long double from, long double to, long double *node, long double *weight) {
    for (int i = 0; i < count; i++) {
        long double t = cosl(oracle_pi * (i + 0.75L) / (count + 0.5L)), slope = 1.0L;
        for (int iteration = 0; iteration < 100; iteration++) {
            long double before = 0.0L, p = 1.0L;
            for (int k = 0; k < count; k++) {
                const long double next = ((2 * k + 1) * t * p - k * before) / (k + 1);
                before = p;
                p = next;
            }
            slope = count * (t * p - before) / (t * t - 1.0L);
            const long double step = p / slope;
            t -= step;
            if (fabsl(step) <= 4.0L * LDBL_EPSILON)
                break;
        }
        node[i] = 0.5L * (from + to) + 0.5L * (to - from) * t;
        weight[i] = (to - from) / ((1.0L - t * t) * slope * slope);
    }
}

/* A function of one number. */
typedef long double (*oracle_kernel)(long double t, const void *user);

/* <P_l k> of a zonal kernel that is 0 outside [from, to] and smooth within: 1/2 integral of P_l(t) k(t) dt. */
static inline long double oracle_zonal_moment(int l, oracle_kernel k, const void *user, long double from, long double to) {
    enum { COUNT = 48 };
    long double node[COUNT], weight[COUNT], sum = 0.0L;
    oracle_gauss(COUNT, from, to, node, weight);
    for (int i = 0; i < COUNT; i++)
        sum += 0.5L * weight[i] * oracle_legendre(l, node[i]) * k(node[i], user);
    return sum;
}

/* Directions with weights; the weights are fractions of the sphere. */
typedef struct oracle_node {
    long double dir[3], weight;
} oracle_node;

typedef struct oracle_rule {
    oracle_node *node;
    size_t count;
} oracle_rule;

/* The zone from < w.axis < to about a unit axis: Gauss-Legendre in w.axis, uniform in azimuth. Exact on the zone for polynomials of
 * (x, y, z) up to `degree`. Free with oracle_rule_free. */
static inline oracle_rule oracle_rule_zone(const long double axis[3], long double from, long double to, int degree) {
    const int heights = degree / 2 + 1, azimuths = degree + 1;
    long double t[ORACLE_MAX_NODES], weight[ORACLE_MAX_NODES], u[3], v[3];
    oracle_rule rule = { NULL, (size_t)heights * (size_t)azimuths };
    rule.node = (oracle_node *)malloc(rule.count * sizeof(oracle_node));
    if (rule.node == NULL)
        exit(1);
    oracle_gauss(heights, from, to, t, weight);
    oracle_frame(axis, u, v);
    oracle_node *node = rule.node;
    for (int j = 0; j < azimuths; j++) {
        const long double phi = 2.0L * oracle_pi * (j + 0.5L) / azimuths, cosine = cosl(phi), sine = sinl(phi);
        for (int i = 0; i < heights; i++, node++) {
            const long double s = sqrtl(1.0L - t[i] * t[i]);
            for (int k = 0; k < 3; k++)
                node->dir[k] = t[i] * axis[k] + s * (cosine * u[k] + sine * v[k]);
            node->weight = 0.5L * weight[i] / azimuths;
        }
    }
    return rule;
}

static inline oracle_rule oracle_rule_sphere(int degree) {
    const long double z[3] = { 0.0L, 0.0L, 1.0L };
    return oracle_rule_zone(z, -1.0L, 1.0L, degree);
}

static inline void oracle_rule_free(oracle_rule *rule) {
    free(rule->node);
    rule->node = NULL;
    rule->count = 0;
}

/* ---- Lights ---- */

/* Radiance from dir. */
typedef long double (*oracle_light)(const long double dir[3], const void *user);

/* Moments of what the rule covers of a light. Exact if light times basis is a polynomial that the rule integrates. */
static inline void oracle_moments(const oracle_rule *rule, oracle_light light, const void *user, long double c[9]) {
    for (int k = 0; k < 9; k++)
        c[k] = 0.0L;
    for (size_t i = 0; i < rule->count; i++) {
        long double basis[9];
        const long double value = rule->node[i].weight * light(rule->node[i].dir, user);
        oracle_basis(rule->node[i].dir, basis);
        for (int k = 0; k < 9; k++)
            c[k] += value * basis[k];
    }
}

/* Irradiance / pi at unit normal n from within the cone w.n > cos_angle, of a light that is a polynomial of at most `degree`. */
static inline long double oracle_irradiance(oracle_light light, const void *user, const long double n[3], long double cos_angle,
                                            int degree) {
    oracle_rule rule = oracle_rule_zone(n, cos_angle, 1.0L, degree + 1);
    long double sum = 0.0L;
    for (size_t i = 0; i < rule.count; i++)
        sum += 4.0L * rule.node[i].weight * oracle_dot(n, rule.node[i].dir) * light(rule.node[i].dir, user);
    oracle_rule_free(&rule);
    return sum;
}

/* A light from one direction, or an element of a sum over directions: its mean radiance over the sphere. */
typedef struct oracle_source {
    long double dir[3], mean;
} oracle_source;

/* Irradiance / pi at unit normal n, by summing the sources: 4 max(0, n.w) of each. */
static inline long double oracle_irradiance_sources(const oracle_source *source, size_t count, const long double n[3]) {
    long double sum = 0.0L;
    for (size_t i = 0; i < count; i++) {
        const long double cosine = oracle_dot(n, source[i].dir);
        if (cosine > 0.0L)
            sum += 4.0L * cosine * source[i].mean;
    }
    return sum;
}

/* Moments of sources. */
static inline void oracle_moments_sources(const oracle_source *source, size_t count, long double c[9]) {
    for (int k = 0; k < 9; k++)
        c[k] = 0.0L;
    for (size_t i = 0; i < count; i++) {
        long double basis[9];
        oracle_basis(source[i].dir, basis);
        for (int k = 0; k < 9; k++)
            c[k] += source[i].mean * basis[k];
    }
}

#endif /* ORACLE_H */
