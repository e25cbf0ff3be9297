/* lights.h - random lights that are nowhere negative, each a sum of single directions: deltas, pairs, caps, lobes, rings, mixtures and
 * small images. */
#ifndef LIGHTS_H
#define LIGHTS_H

#include "test.h"

enum { LIGHTS_MAX = 128, LIGHTS_KINDS = 8 };

typedef struct lights_light {
    int count;
    double dir[LIGHTS_MAX][3], value[LIGHTS_MAX]; /* value: mean radiance over the sphere */
} lights_light;

static inline void lights_add(const double dir[3], double value, lights_light *light) {
    for (int i = 0; i < 3; i++)
        light->dir[light->count][i] = dir[i];
    light->value[light->count++] = value;
}

/* Unit length in double, so that the moments of a light are those of its directions. */
static inline void lights_direction(double dir[3]) {
    float rough[3];
    double length = 0.0;
    test_direction(rough);
    for (int i = 0; i < 3; i++)
        length += (double)rough[i] * (double)rough[i];
    for (int i = 0; i < 3; i++)
        dir[i] = (double)rough[i] / sqrt(length);
}

static inline double lights_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* `count` directions with t = w.axis rising from `from` to 1, or all at `from` for a ring; their weight is exp(sharpness (t - 1)). */
static inline void lights_zonal(const double axis[3], int count, double from, double to, double sharpness, double value,
                                lights_light *light) {
    double u[3], v[3];
    const int least = fabs(axis[0]) < fabs(axis[1])   ? (fabs(axis[0]) < fabs(axis[2]) ? 0 : 2)
                      : fabs(axis[1]) < fabs(axis[2]) ? 1
                                                      : 2;
    double along = axis[least], length = sqrt(1.0 - along * along);
    for (int i = 0; i < 3; i++)
        u[i] = ((i == least) - along * axis[i]) / length;
    for (int i = 0; i < 3; i++)
        v[i] = axis[(i + 1) % 3] * u[(i + 2) % 3] - axis[(i + 2) % 3] * u[(i + 1) % 3];
    for (int j = 0; j < count; j++) {
        const double t = from + (to - from) * (j + 0.5) / count, s = sqrt(1.0 - t * t), angle = 2.39996322972865332 * j;
        double w[3];
        for (int i = 0; i < 3; i++)
            w[i] = t * axis[i] + s * (cos(angle) * u[i] + sin(angle) * v[i]);
        lights_add(w, value / count * exp(sharpness * (t - 1.0)), light);
    }
}

/* One random light of a kind in [0, LIGHTS_KINDS). */
static inline void lights_random(int kind, lights_light *light) {
    double axis[3];
    light->count = 0;
    lights_direction(axis);
    switch (kind) {
    case 0:
        lights_add(axis, 1.0, light);
        break;
    case 1: /* a pair, often opposed */
        lights_add(axis, 1.0, light);
        if (test_below(2))
            lights_direction(axis);
        else
            for (int i = 0; i < 3; i++)
                axis[i] = -axis[i];
        lights_add(axis, test_uniform(0.0, 1.0), light);
        break;
    case 2:
        lights_zonal(axis, 32, test_uniform(-1.0, 1.0), 1.0, 0.0, 1.0, light);
        break;
    case 3:
        lights_zonal(axis, 64, -1.0, 1.0, exp(test_uniform(-3.0, 5.0)), 1.0, light);
        break;
    case 4: {
        const double t = test_uniform(-1.0, 1.0);
        lights_zonal(axis, 16, t, t, 0.0, 1.0, light);
        break;
    }
    case 5: /* sun and ambient */
        lights_zonal(axis, 64, -1.0, 1.0, 0.0, test_uniform(0.0, 1.0), light);
        lights_add(axis, test_uniform(0.0, 1.0), light);
        break;
    case 6:
        for (int i = 2 + test_below(6); i > 0; i--) {
            lights_direction(axis);
            lights_add(axis, exp(test_uniform(-8.0, 0.0)), light);
        }
        break;
    default: /* an image of 64 texels of a wide range */
        for (int i = 0; i < 64; i++) {
            const double z = 1.0 - (2.0 * (i / 8) + 1.0) / 8.0, s = sqrt(1.0 - z * z), angle = 0.785398163397448 * (i % 8 + 0.5);
            const double w[3] = { s * cos(angle), s * sin(angle), z };
            lights_add(w, exp(test_uniform(-10.0, 0.0)), light);
        }
        break;
    }
}

/* Its coefficients, in the order of sh.h; at most 9. */
static inline void lights_moments(const lights_light *light, double scale, float c[9]) {
    double sum[9] = { 0 };
    for (int i = 0; i < light->count; i++) {
        const double x = light->dir[i][0], y = light->dir[i][1], z = light->dir[i][2], third = 1.0 / 3.0;
        const double basis[9] = { 1.0, x, y, z, x * x - third, x * y, x * z, y * y - third, y * z };
        for (int j = 0; j < 9; j++)
            sum[j] += scale * light->value[i] * basis[j];
    }
    for (int j = 0; j < 9; j++)
        c[j] = (float)sum[j];
}

/* Irradiance / pi, by definition. */
static inline double lights_irradiance(const lights_light *light, const float n[3]) {
    const double normal[3] = { (double)n[0], (double)n[1], (double)n[2] };
    double sum = 0.0;
    for (int i = 0; i < light->count; i++) {
        const double cosine = lights_dot(light->dir[i], normal);
        sum += cosine > 0.0 ? 4.0 * cosine * light->value[i] : 0.0;
    }
    return sum;
}

#endif /* LIGHTS_H */
