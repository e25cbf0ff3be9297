/* Defines the function named PROBE, which computes the same numbers in every file that includes this one after sh.h. They are few,
 * but every one goes through code that a backend, a language or another header could change. */
#include "probes.h"

static void probe_light(const float dir[3], float *value, void *user) {
    (void)user;
    value[0] = 1.0f + dir[0] + 0.5f * dir[1] * dir[2];
    value[1] = 2.0f - dir[1] + dir[0] * dir[0];
}

#ifndef SH_NO_BATCH
static void probe_panorama(float c[3 * SH_COUNT(SH_L2)]) {
    enum { WIDTH = 53, HEIGHT = 27 };
    static float pixels[HEIGHT * WIDTH * 3];
    sh_image image = { NULL, WIDTH, HEIGHT, 0, 3, SH_F32 };

    for (int i = 0; i < HEIGHT * WIDTH * 3; i++)
        pixels[i] = (float)(i * 7919 % 1009) / 1009.0f;
    image.pixels = pixels;
    if (sh_project_equirect(SH_L2, &image, 0, c, NULL) != SH_OK)
        c[0] = -1.0f;
}
#endif

int PROBE(float result[PROBE_SIZE]) {
    const float n[3] = { 2.0f / 7.0f, -3.0f / 7.0f, 6.0f / 7.0f };
    float c[2 * SH_COUNT(SH_L2)] = { 0 };

    if (sh_project_function(SH_L2, 2, probe_light, NULL, 4, c) != SH_OK)
        return 0;
    memcpy(result, c, sizeof c);
    result[18] = sh_radiance(SH_L2, c, n);
    result[19] = sh_irradiance(SH_L2, c, n);
    result[20] = sh_irradiance_ao(SH_L2, c + 9, n, 0.5f);
    result[21] = sh_directionality(c);
    result[22] = sh_dot(SH_L2, c, c + 9);
#ifdef SH_NO_BATCH
    return PROBE_SCALAR;
#else
    probe_panorama(result + PROBE_SCALAR);
    return PROBE_SIZE;
#endif
}
