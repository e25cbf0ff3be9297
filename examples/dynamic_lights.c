/* Dynamic lights in a probe: added each frame on top of what was baked, the negligible ones skipped under a tolerance, and one removed
 * again by adding it with the opposite sign. */
#include <stdio.h>
#include <string.h>

#include "sh.h"

enum { LIGHTS = 64, SIZE = 3 * SH_COUNT(SH_L2) };

int main(void) {
    const float up[3] = { 0, 0, 1 }, sky[3] = { 0.2f, 0.3f, 0.5f }, ground[3] = { 0.1f, 0.1f, 0.1f };
    const float panel[3] = { 1.0f, 0.0f, 1.0f }, half_u[3] = { 0.0f, 0.5f, 0.0f }, half_v[3] = { 0.2f, 0.0f, -0.2f };
    const float warm[3] = { 4.0f, 3.0f, 2.0f }, minus_warm[3] = { -4.0f, -3.0f, -2.0f };
    float baked[SIZE] = { 0 }, lit[SIZE], exact[SIZE], spheres[4 * LIGHTS], radiance[3 * LIGHTS];
    sh_add_hemisphere(SH_L2, 3, up, sky, ground, baked);

    for (uint32_t i = 0; i < LIGHTS; i++) { /* positions relative to the probe, from 1 to 30 away */
        float dir[3];
        sh_direction_sequence(i, 7, dir);
        for (int k = 0; k < 3; k++) {
            spheres[4 * i + (uint32_t)k] = dir[k] * (1.0f + 29.0f * (float)i / LIGHTS);
            radiance[3 * i + (uint32_t)k] = 20.0f;
        }
        spheres[4 * i + 3] = 0.1f;
    }

    const float tolerance = 0.05f;
    memcpy(lit, baked, sizeof lit);
    memcpy(exact, baked, sizeof exact);
    const size_t added = sh_add_spheres(SH_L2, 3, spheres, radiance, LIGHTS, tolerance, lit);
    sh_add_spheres(SH_L2, 3, spheres, radiance, LIGHTS, 0.0f, exact);
    float worst = 0.0f;
    for (uint32_t i = 0; i < 1000; i++) {
        float n[3];
        sh_direction_fibonacci(i, 1000, n);
        const float error = fabsf(sh_irradiance(SH_L2, lit, n) - sh_irradiance(SH_L2, exact, n));
        worst = error > worst ? error : worst;
    }
    printf("%d of %d lights added; the rest changes irradiance / pi by %.4f, promised %.4f\n", (int)added, LIGHTS, (double)worst,
           (double)tolerance);

    float with_panel[SIZE], left = 0.0f;
    memcpy(with_panel, lit, sizeof with_panel);
    sh_add_rectangle(SH_L2, 3, panel, half_u, half_v, warm, with_panel);
    const float facing[3] = { 0.70710678f, 0.0f, 0.70710678f };
    printf("towards the panel: %.3f without it, %.3f with it\n", (double)sh_irradiance(SH_L2, lit, facing),
           (double)sh_irradiance(SH_L2, with_panel, facing));
    sh_add_rectangle(SH_L2, 3, panel, half_u, half_v, minus_warm, with_panel);
    for (int i = 0; i < SIZE; i++)
        left = fmaxf(left, fabsf(with_panel[i] - lit[i]));
    printf("removed again: %.1e left\n", (double)left);
    return worst <= tolerance && added < LIGHTS && left < 1e-6f ? 0 : 1;
}
