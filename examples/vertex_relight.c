/* Relights a vertex buffer: the colours of an interleaved mesh from its normals, in one call per frame; and, for a mesh that shadows
 * itself, radiance transfer: one dot product per vertex and channel with a vector that was baked once. */
#include <stdio.h>

#include "sh.h"

enum { VERTICES = 1000 };

typedef struct vertex {
    float position[3], normal[3], color[3];
} vertex;

static vertex mesh[VERTICES];
static float transfer[VERTICES][SH_COUNT(SH_L2)];

/* A sphere over a dark floor: what comes from below the horizon is blocked. The visibility is smoothed, so that its reconstruction stays
 * within 0 and 1. Transfer is visibility times 4 max(0, n.w). */
static void bake(void) {
    float lambert[3], visibility[SH_COUNT(SH_L2)] = { 0 };
    const float up[3] = { 0, 0, 1 }, open = 1.0f, blocked = 0.0f;
    sh_zonal_lambert(lambert);
    sh_add_hemisphere(SH_L2, 1, up, &open, &blocked, visibility);
    sh_convolve(SH_L2, visibility, lambert, visibility);
    for (uint32_t i = 0; i < VERTICES; i++) {
        float lobe[SH_COUNT(SH_L2)] = { 0 };
        sh_direction_fibonacci(i, VERTICES, mesh[i].normal);
        for (int k = 0; k < 3; k++)
            mesh[i].position[k] = mesh[i].normal[k];
        sh_zonal_add(SH_L2, lambert, mesh[i].normal, 1.0f, lobe);
        sh_product(SH_L2, lobe, visibility, transfer[i]);
    }
}

int main(void) {
    const float sky[3] = { 0.3f, 0.5f, 0.9f }, ground[3] = { 0.2f, 0.15f, 0.1f }, sunlight[3] = { 3.0f, 2.8f, 2.5f };
    const float up[3] = { 0, 0, 1 };
    double open_total = 0.0, shadowed_total = 0.0;
    bake();
    for (int frame = 0; frame < 4; frame++) {
        const float angle = 0.3f + 0.3f * (float)frame, sun[3] = { cosf(angle), 0, sinf(angle) };
        float light[3 * SH_COUNT(SH_L2)] = { 0 };
        sh_add_hemisphere(SH_L2, 3, up, sky, ground, light);
        sh_add_cap(SH_L2, 3, sun, 0.00465f, SH_IRRADIANCE, sunlight, light);
        sh_irradiance_batch_aos(SH_L2, 3, light, mesh[0].normal, sizeof(vertex), mesh[0].color, sizeof(vertex), VERTICES);
        open_total = shadowed_total = 0.0;
        for (int i = 0; i < VERTICES; i++)
            for (int k = 0; k < 3; k++) {
                open_total += (double)mesh[i].color[k] / VERTICES;
                shadowed_total += (double)sh_dot(SH_L2, light + k * SH_COUNT(SH_L2), transfer[i]) / VERTICES;
            }
        printf("sun at %2.0f degrees: mean irradiance / pi %.3f, with the floor's shadow %.3f\n", (double)angle * 57.29578, open_total,
               shadowed_total);
    }
    /* The mean irradiance over a sphere is R0, of each channel; a floor can only take light away. */
    float mean = 0.0f;
    for (int k = 0; k < 3; k++)
        mean += 0.5f * sky[k] + 0.5f * ground[k] + 0.25f * sunlight[k];
    return fabs(open_total - (double)mean) < 1e-2 && shadowed_total < open_total ? 0 : 1;
}
