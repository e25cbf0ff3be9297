/* Compiled with -ffast-math. */
#include "unit.h"

int unit_golden(golden_case out[GOLDEN_CASES]) {
    golden_compute();
    memcpy(out, golden, sizeof golden);
    return golden_count;
}

int unit_project(int kind, const sh_image *image, unsigned flags, float *c, sh_report *report) {
    const sh_image face[6] = { *image, *image, *image, *image, *image, *image };
    if (kind == 0)
        return sh_project_equirect(SH_L2, image, flags, c, report);
    return kind == 1 ? sh_project_cubemap(SH_L2, face, flags, c, report) : sh_project_octahedral(SH_L2, image, flags, c, report);
}
