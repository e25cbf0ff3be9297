/* backend.c - one backend: compiled once per instruction set, with its flags and the backend's name as FUZZ_BACKEND. */
#include "backend.h"

/* The header's functions are inlined wherever they are called; these have addresses. */
#define SOA(name)                                                                                                                  \
    static void name(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,          \
                     size_t count) {                                                                                               \
        sh_##name(order, channels, c, x, y, z, out, count);                                                                        \
    }
#define AOS(name)                                                                                                                  \
    static void name(int order, int channels, const float *c, const float *n, size_t n_stride, float *out, size_t out_stride,      \
                     size_t count) {                                                                                               \
        sh_##name(order, channels, c, n, n_stride, out, out_stride, count);                                                        \
    }
#define MAP(name)                                                                                                                  \
    static int name(int order, const sh_image *image, unsigned flags, float *c, sh_report *report) {                               \
        return sh_##name(order, image, flags, c, report);                                                                          \
    }                                                                                                                              \
    static int name##_rows(int order, const sh_image *image, unsigned flags, int first_row, int row_count, sh_accum *accum,        \
                           sh_report *report) {                                                                                    \
        return sh_##name##_rows(order, image, flags, first_row, row_count, accum, report);                                         \
    }

SOA(radiance_batch)
SOA(irradiance_batch)
SOA(irradiance_closure_batch)
SOA(irradiance_geomerics_batch)
SOA(irradiance_zh3_batch)
SOA(irradiance_probes_batch)
AOS(radiance_batch_aos)
AOS(irradiance_batch_aos)
AOS(irradiance_closure_batch_aos)
AOS(irradiance_geomerics_batch_aos)
AOS(irradiance_zh3_batch_aos)
MAP(project_equirect)
MAP(project_cubemap)
MAP(project_octahedral)

static void prepared_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                           size_t count) {
    sh_closure closure[FUZZ_MAX_CHANNELS];
    sh_closure_prepare(order, channels, c, SH_AMBIENT_FLOOR, closure);
    sh_closure_irradiance_batch(order, channels, closure, x, y, z, out, count);
}

static void prepared_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                               size_t out_stride, size_t count) {
    sh_closure closure[FUZZ_MAX_CHANNELS];
    sh_closure_prepare(order, channels, c, SH_AMBIENT_FLOOR, closure);
    sh_closure_irradiance_batch_aos(order, channels, closure, n, n_stride, out, out_stride, count);
}

static int project_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                           const float *weight, size_t count, float *c) {
    return sh_project_samples(order, channels, x, y, z, value, weight, count, c);
}

static int accum_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                         const float *weight, size_t count, sh_accum *accum) {
    return sh_accum_samples(order, channels, x, y, z, value, weight, count, accum);
}

static void add_directional(int order, int channels, const float dir[3], const float *irradiance, float *c) {
    sh_add_directional(order, channels, dir, irradiance, c);
}

extern const fuzz_backend FUZZ_BACKEND;
const fuzz_backend FUZZ_BACKEND = {
    SH_SIMD_NAME,
    { radiance_batch, irradiance_batch, irradiance_closure_batch, prepared_batch, irradiance_geomerics_batch,
      irradiance_zh3_batch },
    { radiance_batch_aos, irradiance_batch_aos, irradiance_closure_batch_aos, prepared_batch_aos, irradiance_geomerics_batch_aos,
      irradiance_zh3_batch_aos },
    irradiance_probes_batch,
    { project_equirect_rows, project_cubemap_rows, project_octahedral_rows },
    { project_equirect, project_cubemap, project_octahedral },
    project_samples,
    accum_samples,
    sh_rotate_batch,
    sh_product_batch,
    add_directional,
};
