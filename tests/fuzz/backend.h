/* backend.h - the functions that go through the vector kernels, from one translation unit per backend. */
#ifndef BACKEND_H
#define BACKEND_H

#include "sh.h"

typedef void (*fuzz_soa)(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                         size_t count);
typedef void (*fuzz_aos)(int order, int channels, const float *c, const float *n, size_t n_stride, float *out, size_t out_stride,
                         size_t count);
typedef int (*fuzz_rows)(int order, const sh_image *image, unsigned flags, int first_row, int row_count, sh_accum *accum,
                         sh_report *report);
typedef int (*fuzz_image)(int order, const sh_image *image, unsigned flags, float *c, sh_report *report);

/* What a batch evaluates. PREPARED: closures over their ambient floor, prepared by the backend. */
enum { FUZZ_RADIANCE, FUZZ_IRRADIANCE, FUZZ_CLOSURE, FUZZ_PREPARED, FUZZ_GEOMERICS, FUZZ_ZH3, FUZZ_MODELS };
enum { FUZZ_EQUIRECT, FUZZ_CUBEMAP, FUZZ_OCTAHEDRAL, FUZZ_MAPS };
enum { FUZZ_MAX_CHANNELS = 20 }; /* more than SH_MAX_CHANNELS */

typedef struct fuzz_backend {
    const char *name;
    fuzz_soa soa[FUZZ_MODELS];
    fuzz_aos aos[FUZZ_MODELS];
    fuzz_soa probes;
    fuzz_rows rows[FUZZ_MAPS];
    fuzz_image image[FUZZ_MAPS];
    int (*project_samples)(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                           const float *weight, size_t count, float *c);
    int (*accum_samples)(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                         const float *weight, size_t count, sh_accum *accum);
    void (*rotate_batch)(int order, const float *c, const float m[9], float *out, size_t sets);
    void (*product_batch)(int order, const float *a, const float *b, float *out, size_t count);
    void (*add_directional)(int order, int channels, const float dir[3], const float *irradiance, float *c);
} fuzz_backend;

extern const fuzz_backend fuzz_backend_scalar, fuzz_backend_sse2, fuzz_backend_avx2, fuzz_backend_avx512, fuzz_backend_native;

/* One of those that were built and that this machine runs, by any number. */
static inline const fuzz_backend *fuzz_backend_number(unsigned number) {
    const fuzz_backend *list[4] = { &fuzz_backend_scalar };
    unsigned count = 1;
#if defined(__x86_64__)
    list[count++] = &fuzz_backend_sse2;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        list[count++] = &fuzz_backend_avx2;
    if (__builtin_cpu_supports("avx512f"))
        list[count++] = &fuzz_backend_avx512;
#else
    list[count++] = &fuzz_backend_native;
#endif
    return list[number % count];
}

#endif /* BACKEND_H */
