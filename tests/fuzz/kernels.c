/* Zonal kernels and directions: finite and in their ranges for any parameter that they take. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

static void check_kernel(const float zonal[3], float least) {
    FUZZ_CHECK(fuzz_all_finite(zonal, 3));
    for (int i = 0; i < 3; i++)
        FUZZ_CHECK(zonal[i] >= least && zonal[i] <= 1.000001f);
}

static void check_direction(const float d[3]) {
    FUZZ_CHECK(fabs((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2] - 1.0) < 4e-7);
}

static void fuzz_one(fuzz_input *in) {
    const float p = fuzz_finite(in), positive = fabsf(p);
    float zonal[3], dir[3], mirrored[3], n[3];
    sh_zonal_ao(p, zonal);
    check_kernel(zonal, 0.0f);
    sh_zonal_cap(p, zonal);
    check_kernel(zonal, -0.1f);
    sh_zonal_vmf(positive, zonal);
    check_kernel(zonal, 0.0f);
    sh_zonal_hann(positive, zonal);
    check_kernel(zonal, -1e-6f);
    sh_zonal_lanczos(positive, zonal);
    check_kernel(zonal, -1e-6f);
    sh_zonal_laplacian(positive, zonal);
    check_kernel(zonal, 0.0f);
    sh_zonal_cosine_power(positive, zonal);
    check_kernel(zonal, 0.0f);
    sh_zonal_ggx(p, zonal);
    check_kernel(zonal, 0.0f);
    sh_zonal_sharpness(p, zonal);
    FUZZ_CHECK(fuzz_all_finite(zonal, 3));

    const uint32_t i = fuzz_word(in), seed = fuzz_word(in), a = fuzz_word(in), b = fuzz_word(in);
    sh_direction_stratified(i, a ? a : 1, b ? b : 1, seed, dir);
    check_direction(dir);
    sh_direction_sequence(i, seed, dir);
    check_direction(dir);
    sh_direction_fibonacci(a ? i % a : 0, a ? a : 1, dir);
    check_direction(dir);
    fuzz_direction(in, n);
    sh_reflect(dir, n, mirrored);
    FUZZ_CHECK(fabs((double)mirrored[0] * (double)mirrored[0] + (double)mirrored[1] * (double)mirrored[1] +
                    (double)mirrored[2] * (double)mirrored[2] - 1.0) < 4e-6);
}
