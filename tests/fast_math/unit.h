/* The part of sh.h that tests/fast_math compiles with -ffast-math, for a main that is compiled without. */
#ifndef UNIT_H
#define UNIT_H

#include "../golden/golden.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The golden cases; returns how many. */
int unit_golden(golden_case out[GOLDEN_CASES]);

/* kind 0: equirectangular, 1: a cube map of six times the same face, 2: octahedral */
int unit_project(int kind, const sh_image *image, unsigned flags, float *c, sh_report *report);

#ifdef __cplusplus
}
#endif

#endif
