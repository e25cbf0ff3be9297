/* The functions that work on many directions or texels: with ORDER a literal, what the other orders need must not be in the file.
 * ORDER may also be `order`: then all are. */
#include "sh.h"

int equirect(int order, const sh_image *image, float *c, sh_report *report) {
    (void)order;
    return sh_project_equirect(ORDER, image, SH_CLAMP_NEGATIVE, c, report);
}

int samples(int order, const float *x, const float *y, const float *z, const float *value, size_t count, float *c) {
    (void)order;
    return sh_project_samples(ORDER, 3, x, y, z, value, NULL, count, c);
}

void batch(int order, const float *c, const float *x, const float *y, const float *z, float *out, size_t count) {
    (void)order;
    sh_irradiance_batch(ORDER, 3, c, x, y, z, out, count);
}
