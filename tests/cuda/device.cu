// Device code of the functions of sh.h, and host code in the same file. Compiled by CI where there is an nvcc.
#include "sh.h"

// out += what the functions give, so that the compiler leaves none of them out.
__global__ void lit(const float *c, const float *normals, float *out, int count) {
    const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);
    if (i >= count)
        return;
    const float n[3] = { normals[3 * i], normals[3 * i + 1], normals[3 * i + 2] };
    float lo, hi;
    sh_closure closure;
    sh_irradiance_bounds(SH_L2, c, n, &lo, &hi);
    sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &closure);
    out[i] += lo + hi + sh_closure_irradiance(SH_L2, &closure, n);
    out[i] += sh_radiance(SH_L2, c, n) + sh_irradiance(SH_L2, c, n) + sh_irradiance_ao(SH_L2, c, n, 0.5f);
    out[i] += sh_irradiance_opposite(SH_L2, c, n, 1.0f);
    out[i] += sh_irradiance_closure(SH_L1, c, n) + sh_irradiance_closure(SH_L2, c, n);
    out[i] += sh_irradiance_geomerics(c, n) + sh_irradiance_zh3(c, n);
}

__global__ void operators(const float *a, const float *b, const float *m, float *out) {
    float zonal[3], c[SH_COUNT(SH_L2)], dir[3], at[3], intensity, ambient;
    sh_zonal_ggx(a[0], zonal);
    sh_product(SH_L2, a, b, c);
    sh_rotate(SH_L2, c, m, c);
    sh_convolve(SH_L2, c, zonal, c);
    sh_dominant_light(SH_L2, 1, c, dir, &intensity, &ambient);
    sh_zonal_add(SH_L2, zonal, dir, intensity, c);
    sh_add_sample(SH_L2, dir, ambient, c);
    sh_dering(SH_L2, 1, c, SH_WINDOW_HANN, c);
    c[0] += sh_min(SH_L2, c, at) + sh_max(SH_L2, c, at) + sh_ambient_floor(c) + sh_directionality(c) + sh_dot(SH_L2, a, b);
    c[0] += (float)(sh_order_needed(c, 0.01f) + sh_is_realizable(SH_L2, c));
    sh_lerp(SH_L2, a, c, 0.5f, out);
}

__global__ void lights(const float *dir, const float *value, float *c) {
    sh_add_ambient(SH_L2, 3, value, c);
    sh_add_directional(SH_L2, 3, dir, value, c);
    sh_add_hemisphere(SH_L2, 3, dir, value, value + 3, c);
    sh_add_cap(SH_L2, 3, dir, 0.5f, SH_IRRADIANCE, value, c);
    sh_add_sphere(SH_L2, 3, dir, 0.5f, SH_RADIANCE, value, c);
    sh_add_vmf(SH_L2, 3, dir, 8.0f, SH_RADIANCE, value, c);
    sh_add_rectangle(SH_L2, 3, dir, dir + 3, dir + 6, value, c);
    sh_add_disk(SH_L2, 3, dir, dir + 3, 0.5f, value, c);
    sh_add_segment(SH_L2, 3, dir, dir + 3, 0.1f, value, c);
}

__global__ void storage(const float *c, float *shader, uint16_t *half, uint8_t *ratio, float *r0, float *engine) {
    sh_pack_shader(c, shader);
    sh_pack_half(SH_L2, 3, c, half);
    sh_pack_unorm8(SH_L2, 3, c, r0, ratio);
    sh_to_orthonormal(SH_L2, c, SH_CONDON_SHORTLEY, engine);
    sh_to_unity(SH_L2, c, engine + 9);
}

__global__ void sampling(uint32_t seed, float *dir, sh_accum *accum) {
    sh_direction_sequence(threadIdx.x, seed, dir);
    sh_accum_sample(SH_L2, dir, 1.0f, 1.0f, accum);
}

// Batches and images, which a .cu file may call on the host, or one thread for a whole image.
__host__ __device__ void arrays(const float *c, const float *x, const float *y, const float *z, const float *m, const sh_image *image,
                                float *out) {
    sh_radiance_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_irradiance_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_radiance_batch_aos(SH_L2, 3, c, x, 0, out, 0, 100);
    sh_irradiance_batch_aos(SH_L2, 3, c, x, 0, out, 0, 100);
    sh_irradiance_closure_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_irradiance_geomerics_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_irradiance_zh3_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_irradiance_probes_batch(SH_L2, 3, c, x, y, z, out, 100);
    sh_rotate_batch(SH_L2, c, m, out, 100);
    sh_product_batch(SH_L2, c, x, out, 100);
    sh_project_samples(SH_L2, 1, x, y, z, x, NULL, 100, out);
    sh_project_equirect(SH_L2, image, 0, out, NULL);
    sh_project_cubemap(SH_L2, image, 0, out, NULL);
    sh_project_octahedral(SH_L2, image, 0, out, NULL);
    sh_fit_samples(SH_L2, 1, x, y, z, x, NULL, 100, NULL, 0.0f, out);
}

__global__ void one_thread(const float *c, const float *x, const float *y, const float *z, const float *m, const sh_image *image,
                           float *out) {
    arrays(c, x, y, z, m, image, out);
}

void on_the_host(const float *c, const float *x, const float *y, const float *z, const float *m, const sh_image *image, float *out) {
    arrays(c, x, y, z, m, image, out);
}
