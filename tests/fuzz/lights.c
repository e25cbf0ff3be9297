/* Lights of any place and size: what is added is finite, not negative for the whole sphere, no more than the sphere can have, and some
 * light's moments; a light that is to be of a given irradiance is. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void vector(fuzz_input *in, float v[3]) {
    for (int i = 0; i < 3; i++)
        v[i] = fuzz_finite(in);
}

/* Whether the receiver is on an edge of the parallelogram. */
static int on_rim(const float center[3], const float u[3], const float v[3]) {
    float corner[4][3];
    int on = 0;
    for (int i = 0; i < 12; i++) {
        const int k = i % 3;
        corner[i / 3][k] = center[k] + (i / 3 % 3 == 0 ? -u[k] : u[k]) + (i / 3 < 2 ? -v[k] : v[k]);
    }
    for (int i = 0; i < 4; i++)
        on |= fuzz_on_edge(corner[i], corner[(i + 1) % 4]);
    return on;
}

/* Whether the receiver is nearer to the disk's rim than radius / 30. */
static int near_rim(const float center[3], const float n[3], float radius) {
    double square = 0.0, height = 0.0;
    for (int i = 0; i < 3; i++) {
        square += (double)center[i] * (double)center[i];
        height += (double)center[i] * (double)n[i];
    }
    const double off = sqrt(fmax(0.0, square - height * height)) - (double)radius;
    return off * off + height * height <= (double)radius * (double)radius / 900.0;
}

enum { CAP, SPHERE, VMF, RECTANGLE, DISK, SEGMENT, HEMISPHERE, DIRECTIONAL, SPHERES, LIGHTS };

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3), kind = fuzz_below(in, LIGHTS), set = SH_COUNT(order);
    const sh_unit unit = (sh_unit)fuzz_below(in, 2);
    const float one[2] = { 1.0f, 0.0f }, none[2] = { 0.0f, 0.0f }, size = fuzz_finite(in);
    float *c = fuzz_place_floats(0, 2 * (size_t)set, fuzz_below(in, 2)), a[3], b[3], dir[3], spheres[16];
    memset(c, 0, 2 * (size_t)set * sizeof *c);
    vector(in, a);
    vector(in, b);
    fuzz_direction(in, dir);
    switch (kind) {
    case CAP:
        sh_add_cap(order, 2, dir, size, unit, one, c);
        break;
    case SPHERE:
        sh_add_sphere(order, 2, a, fabsf(size), unit, one, c);
        break;
    case VMF:
        sh_add_vmf(order, 2, dir, fabsf(size), unit, one, c);
        break;
    case RECTANGLE:
        sh_add_rectangle(order, 2, a, b, dir, one, c);
        break;
    case DISK:
        sh_add_disk(order, 2, a, dir, size, one, c);
        break;
    case SEGMENT:
        sh_add_segment(order, 2, a, b, size, one, c);
        break;
    case HEMISPHERE:
        sh_add_hemisphere(order, 2, dir, one, none, c);
        break;
    case DIRECTIONAL:
        sh_add_directional(order, 2, dir, one, c);
        break;
    default:
        for (int i = 0; i < 16; i++)
            spheres[i] = i % 4 == 3 ? fabsf(fuzz_finite(in)) : fuzz_finite(in);
        FUZZ_CHECK(sh_add_spheres(order, 2, spheres, (const float[8]){ 1, 0, 1, 0, 1, 0, 1, 0 }, 4, size, c) <= 4);
    }
    FUZZ_CHECK(fuzz_all_finite(c, 2 * (size_t)set));
    if (kind == RECTANGLE && on_rim(a, b, dir))
        return; /* only that it is finite is promised */
    if (kind == DISK && near_rim(a, dir, size)) {
        for (int i = 0; i < set; i++)
            FUZZ_CHECK(fabsf(c[i]) <= 1.0f); /* coarse, but light */
        return;
    }
    const double most = kind == SPHERES ? 4.0 : kind == SEGMENT ? 2.0 : 1.0, slack = 1e-5 * most;
    FUZZ_CHECK((double)c[SH_R0] >= -1e-6 && (double)c[SH_R0] <= most + slack);
    for (int i = 0; i < set; i++)
        FUZZ_CHECK(fabs((double)c[i]) <= (double)c[SH_R0] + slack && c[set + i] == 0.0f);
}
