/* Polygons of any vertices: nothing read outside the array; finite; a solid angle of at most the sphere's; either sense. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 4) - (fuzz_byte(in) == 255), at_start = fuzz_below(in, 2), flat = fuzz_below(in, 2);
    const size_t count = (size_t)fuzz_below(in, 9);
    const float radiance[1] = { 1.0f }, height = fuzz_finite(in);
    float *vertices = fuzz_place_floats(0, 3 * count, at_start), c[9] = { 0 }, back[9] = { 0 };
    for (size_t i = 0; i < 3 * count; i++)
        vertices[i] = flat && i % 3 == 2 ? height : fuzz_finite(in);
    const int status = sh_add_polygon(order, 1, vertices, count, radiance, c);
    FUZZ_CHECK(status == (count < 3 || order < SH_L0 || order > SH_L2 ? SH_ERROR_ARGUMENT : SH_OK));
    if (status != SH_OK) {
        FUZZ_CHECK(memcmp(c, back, sizeof c) == 0);
        return;
    }
    FUZZ_CHECK(fuzz_all_finite(c, 9));
    if (count > 3)
        return; /* it may cross itself: what it covers twice counts twice */
    for (int i = 0; i < 3; i++)
        if (fuzz_on_edge(vertices + 3 * i, vertices + (3 * i + 3) % 9))
            return; /* only that it is finite is promised */
    FUZZ_CHECK(c[0] >= 0.0f && c[0] <= 0.500001f);
    for (int i = 1; i < 9; i++)
        FUZZ_CHECK(fabsf(c[i]) <= c[0] + 2e-6f);
    float *other = fuzz_place_floats(1, 9, at_start);
    for (int i = 0; i < 9; i++)
        other[i] = vertices[3 * (2 - i / 3) + i % 3];
    FUZZ_CHECK(sh_add_polygon(order, 1, other, 3, radiance, back) == SH_OK);
    FUZZ_CHECK(fabs((double)back[0] - (double)c[0]) <= 2e-6 + 1e-6 * (double)c[0]);
}
