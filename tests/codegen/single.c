/* Functions of one direction or one set of coefficients, compiled with ORDER a literal: check.sh looks at each. */
#include "sh.h"

float radiance(const float *c, const float *dir) {
    return sh_radiance(ORDER, c, dir);
}

float irradiance(const float *c, const float *n) {
    return sh_irradiance(ORDER, c, n);
}

float irradiance_opposite(const float *c, const float *n, float irradiance_at_n) {
    return sh_irradiance_opposite(ORDER, c, n, irradiance_at_n);
}

float irradiance_ao(const float *c, const float *n, float cos_angle) {
    return sh_irradiance_ao(ORDER, c, n, cos_angle);
}

float dot(const float *a, const float *b) {
    return sh_dot(ORDER, a, b);
}

void basis(const float *dir, float *out) {
    sh_basis(ORDER, dir, out);
}

void add_sample(const float *dir, float value, float *c) {
    sh_add_sample(ORDER, dir, value, c);
}

void accum_sample(const float *dir, float value, float weight, sh_accum *accum) {
    sh_accum_sample(ORDER, dir, value, weight, accum);
}
