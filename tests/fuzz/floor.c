/* The ambient floor is the smallest eigenvalue of the moment matrix, and says whether the set is some light's. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

/* Whether [[R0, sqrt3 R1'], [sqrt3 R1, R0 I + 3 R2]] - shift has only positive eigenvalues: all pivots are positive. */
static int is_positive(const float *c, double shift) {
    const double r = (double)c[SH_R0] - shift, k = sqrt(3.0), xx = (double)c[SH_XX], yy = (double)c[SH_YY];
    const double x = k * (double)c[SH_X], y = k * (double)c[SH_Y], z = k * (double)c[SH_Z];
    const double xy = 3 * (double)c[SH_XY], xz = 3 * (double)c[SH_XZ], yz = 3 * (double)c[SH_YZ];
    double m[4][4] = { { r, x, y, z }, { x, r + 3 * xx, xy, xz }, { y, xy, r + 3 * yy, yz }, { z, xz, yz, r - 3 * (xx + yy) } };
    for (int p = 0; p < 4; p++) {
        if (!(m[p][p] > 0.0))
            return 0;
        for (int i = p + 1; i < 4; i++)
            for (int j = 3; j > p; j--)
                m[i][j] -= m[i][p] / m[p][p] * m[p][j];
    }
    return 1;
}

static void fuzz_one(fuzz_input *in) {
    float c[9], dir[3];
    fuzz_coefficients(in, c);
    const float floor = sh_ambient_floor(c), most = fuzz_largest(c, 9);
    const double tolerance = 1e-6 * (double)most + 1e-43; /* R0 is the largest of a light's */
    FUZZ_CHECK(fuzz_all_finite(&floor, 1));
    if (most > 1e-30f) {
        FUZZ_CHECK(is_positive(c, (double)floor - tolerance));
        FUZZ_CHECK(!is_positive(c, (double)floor + tolerance));
    }
    const int real = sh_is_realizable(SH_L2, c);
    FUZZ_CHECK(real == 0 || real == 1);
    if (c[SH_R0] > 0.0f && (double)floor > tolerance)
        FUZZ_CHECK(real);
    if (!(c[SH_R0] >= 0.0f) || (double)floor < -2e-6 * (double)c[SH_R0] - tolerance)
        FUZZ_CHECK(!real);
    FUZZ_CHECK(!real || (sh_is_realizable(SH_L0, c) && sh_average_direction(c, dir) <= 1.00001f * c[SH_R0]));
}
