/* sh.h - spherical harmonics for lighting, bands L0, L1 and L2, in one header. C99 and C++11. MIT licence, see the end.
 *
 *     #include "sh.h"
 *
 *     sh_image sky = { pixels, 1024, 512, 0, 3, SH_F32 };            // an equirectangular panorama, RGB floats
 *     float c[3 * SH_COUNT(SH_L2)];                                  // 9 coefficients a channel, planar
 *     if (sh_project_equirect(SH_L2, &sky, SH_CLOCKWISE, c, NULL) == SH_OK) {
 *         float up[3] = { 0, 0, 1 };
 *         float red = sh_irradiance_closure(SH_L2, c, up);           // what a white surface facing up reflects; green: c + 9
 *     }
 *
 * CONVENTIONS
 *   basis       1/4pi-normalised: coefficients are the moments of the light over the sphere, <f> = 1/(4 pi) integral f dOmega:
 *               R0 = <f>,  R1 = <w f>,  R2 = <(w w' - I/3) f>.  Radiance 1 everywhere is R0 = 1, all else 0. No Condon-Shortley phase.
 *   storage     float c[SH_COUNT(order)]: R0, x, y, z, xx, xy, xz, yy, yz; zz = -(xx + yy) is not stored.
 *               An order is a prefix: the first 4 of an L2 set are its L1 set. Channel k starts at c + k * SH_COUNT(order).
 *   order       the highest band, SH_L0, SH_L1 or SH_L2. Pass a literal: the bands above it are then not compiled.
 *   directions  float[3], unit length (never normalised for you), pointing to where the light comes from. Right-handed; panoramas
 *               have z up.
 *   irradiance  is E/pi: a white Lambertian surface under a sky of radiance 1 reads 1. Multiply by albedo for outgoing radiance,
 *               by pi for E in W/m^2.
 *   aliasing    an output may be exactly the same array as an input; partial overlap is undefined.
 *   errors      functions that can be handed bad input return SH_OK or a negative SH_ERROR_..., and write nothing on error; only
 *               sh_fit_samples has a positive warning, too. Batches return nothing: their arguments are the caller's to get right.
 *               Arithmetic does not look for NaN: NaN in, NaN out, of every function of numbers, but a direction that is chosen is then
 *               +z, and codes of 8, 10 or 16 bits have no NaN. Decisions take NaN for not negligible; images leave out texels that
 *               are not finite, and count them. Finite input up to 1e18 never gives NaN.
 *   rounding    an ulp is 2^-23 of what it is of. Where a comment states no bound, a result is within 4 ulp of the sum of its absolute
 *               terms. Where products underflow, up to 2^-144 times 1 + the largest input more. All of it: docs/accuracy.md.
 *   fast math   -ffast-math keeps results to 2e-6 and still leaves out bad texels; it gives up NaN in, NaN out, results that are the
 *               same to the bit, and numbers below 1.2e-38. docs/portability.md.
 *   state       none. No allocation, no globals, no dependency but the C library; everything is static inline.
 *
 * OPTIONS, each a macro to define before including
 *   SH_NO_BATCH  leaves out batches and images, and the intrinsics' header with them, which costs more time to compile than all
 *                the rest. For files that evaluate single directions. Default: everything.
 *   SH_NO_SIMD   forces the portable scalar kernels. Default: the best of what the compiler's target flags allow.
 *   SH_SIMD      one of the SH_SIMD_... numbers below, to force a backend; it is an error if the target lacks it. SH_SIMD_NAME, a
 *                string, says which it is (not with SH_NO_BATCH).
 *   SH_DEVICE    what every function is declared with besides `static inline`. Default: `__host__ __device__` where CUDA or HIP
 *                compiles, with scalar kernels then; nothing elsewhere. Define it as nothing for host code with vectors in a .cu.
 *
 * DOES NOT  go above L2; read or write image files; pick a tone map; know your engine's axes; allocate; start threads (the ..._rows
 *           forms and sh_accum let you).
 *
 * TAGS  spherical harmonics, SH, light probe, irradiance, radiance, ambient, image based lighting, IBL, environment map, global
 *       illumination, spherical Gaussian, zonal harmonics, ambient occlusion, equirectangular, panorama
 */
#ifndef SH_H
#define SH_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* ---- Configuration ------------------------------------------------------------------------------------------------------------ */

#define SH_SIMD_SCALAR 0
#define SH_SIMD_SSE2 1
#define SH_SIMD_AVX2 2 /* with FMA */
#define SH_SIMD_AVX512 3 /* F */
#define SH_SIMD_NEON 4
#define SH_SIMD_WASM 5

/* CUDA and HIP: everything for host and device; without intrinsics, which the device lacks. */
#ifndef SH_DEVICE
#if defined(__CUDACC__) || defined(__HIPCC__)
#define SH_DEVICE __host__ __device__
#ifndef SH_SIMD
#define SH_SIMD SH_SIMD_SCALAR
#endif
#else
#define SH_DEVICE
#endif
#endif

/* Small functions are always inlined, so that a literal order removes what it does not need at every level of optimisation that
 * removes anything. The large ones are left to the compiler. */
#if defined(__GNUC__) || defined(__clang__)
#define SHI_INLINE SH_DEVICE static inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define SHI_INLINE SH_DEVICE static __forceinline
#else
#define SHI_INLINE SH_DEVICE static inline
#endif
#define SHI_FUNCTION SH_DEVICE static inline

/* Two and four floats that compilers keep in one register where the target has such, without any header: vectors of GCC's language. */
#if defined(__GNUC__) && !defined(__TINYC__) && !defined(__CUDACC__)
#define SHI_HAS_FOUR 1
typedef float shi_two __attribute__((vector_size(8)));
typedef float shi_four __attribute__((vector_size(16)));
#else
#define SHI_HAS_FOUR 0
#endif

/* Before a loop to be unrolled n times: GCC leaves it rolled at -O2. */
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define SHI_PRAGMA(text) _Pragma(#text)
#define SHI_UNROLL(n) SHI_PRAGMA(GCC unroll n)
#else
#define SHI_UNROLL(n)
#endif

/* ---- Types and constants ------------------------------------------------------------------------------------------------------ */

enum { SH_L0, SH_L1, SH_L2 };                                        /* order: the highest band */
#define SH_COUNT(order) (((order) + 1) * ((order) + 1))              /* 1, 4, 9 coefficients */
enum { SH_R0, SH_X, SH_Y, SH_Z, SH_XX, SH_XY, SH_XZ, SH_YY, SH_YZ }; /* index of a coefficient */
enum { SH_MAX_CHANNELS = 16 };                                       /* of sh_project_function; batches and samples take any number */

enum {
    SH_OK = 0,
    SH_ERROR_ARGUMENT = -1, /* null pointer, order outside 0..2, channels < 1, unknown flag, function degree out of range */
    SH_ERROR_SIZE = -2,     /* width or height zero, negative or above 2^28; stride too small or overflowing size_t; rows outside */
    SH_ERROR_FORMAT = -3    /* unknown format, or a number of channels that it cannot have */
};

/* Sums of weighted samples of one channel, in double; all zero at the start. Plain numbers: the sum over threads, frames or machines
 * is the sum of the members. An RGB accumulator is an array of three. */
typedef struct sh_accum {
    double sum[9];
    double weight;
} sh_accum;

/* Calls back for the radiance arriving from `dir`; writes one value a channel. */
typedef void (*sh_function)(const float dir[3], float *value, void *user);

/* ---- Coefficients: all take one channel of SH_COUNT(order) floats -------------------------------------------------------------- */

/* The basis at unit direction dir: 1, x, y, z, xx - 1/3, xy, xz, yy - 1/3, yz. Each within 2 ulp of 1. */
SHI_INLINE void sh_basis(int order, const float dir[3], float *basis);

/* c += value * basis(dir): adds light of mean radiance `value` that arrives from the single direction dir. */
SHI_INLINE void sh_add_sample(int order, const float dir[3], float value, float *c);

SHI_INLINE void sh_scale(int order, const float *c, float scale, float *out);                   /* out = scale c */
SHI_INLINE void sh_madd(int order, const float *a, float scale, float *c);                      /* c += scale a */
SHI_INLINE void sh_lerp(int order, const float *a, const float *b, float t, float *out);        /* out = a + t (b - a); exact at 0 and 1 */

/* Mean over the sphere of the product of the two radiance reconstructions: a0 b0 + 3 a1.b1 + 15/2 A:B. */
SHI_INLINE float sh_dot(int order, const float *a, const float *b);

/* The first SH_COUNT(order_out) coefficients of each of `channels` planar sets; order_out <= order. out may be c. */
SHI_FUNCTION void sh_truncate(int order, int channels, const float *c, int order_out, float *out);

/* ---- Reconstruction: one channel, one unit direction ---------------------------------------------------------------------------- */

/* Radiance from dir: R0 + 3 R1.w + 15/2 w'R2 w. Exact for light without bands above `order`; rings, and may be negative, for others.
 * Rounding error <= 4 ulp of the sum of absolute terms. Hazel, "Alternative definition of Spherical Harmonics for Lighting". */
SHI_INLINE float sh_radiance(int order, const float *c, const float dir[3]);

/* Irradiance / pi at unit normal n, from radiance coefficients c: R0 + 2 R1.n + 15/8 n'R2 n.
 * Exact for light without bands above `order`; may be negative. For any other light, L2 leaves out the even bands from 4 on, each
 * at most 1/24 of its radiance. Rounding error <= 4 ulp of the sum of absolute terms. Hazel, "Converting SH Radiance to Irradiance". */
SHI_INLINE float sh_irradiance(int order, const float *c, const float n[3]);

/* Irradiance / pi at -n, given the irradiance / pi at n by any model or measurement: irradiance - 4 n.R1.
 * Not an approximation: it holds for the true irradiance of every light. Order 0 knows no R1 and returns its argument. */
SHI_INLINE float sh_irradiance_opposite(int order, const float *c, const float n[3], float irradiance);

/* Irradiance / pi at unit normal n from the directions within a cone about n only, n.w > cos_angle: ambient occlusion by an aperture.
 * cos_angle is clamped to [0, 1]; 0 is sh_irradiance, 1 is 0. For many normals: sh_zonal_ao and sh_convolve once, then
 * sh_radiance_batch. Rounding error <= 8 ulp of the sum of absolute terms. */
SHI_INLINE float sh_irradiance_ao(int order, const float *c, const float n[3], float cos_angle);

/* ---- Bounded irradiance and closures: one channel of L1 or L2, one unit normal ---------------------------------------------------
 * The odd part of irradiance is 2 R1.n exactly, whatever the light. For light that is nowhere negative the even part, 2 <|n.w|
 * f>, lies between bounds that the coefficients imply. A closure estimates the bands that were left out from those that are
 * known, and stays between the bounds: never negative, I(n) - I(-n) = 4 n.R1 to rounding, exact for one directional light and
 * for ambient light. Coefficients that no such light has, not even but for 1/512 of R0 as rounding to half floats leaves them, give
 * the linear reconstruction clamped at 0: R0 < 1e-34, |R1|^2 > (1 + 1/512) R0^2 at L1, at L2 a moment matrix (see
 * sh_ambient_floor) with an eigenvalue below -R0/512.
 * Rounding error <= 3e-6 R0 and, where the upper bound is b R0 and decides, 3e-6 R0 / b more, since it is a square root. */

/* Bounds of the true irradiance / pi of any non-negative light that has these coefficients, tight given R0, n.R1 and n'R2 n.
 * L0: 0 and 4 R0. The upper one allows for an error of 8 ulp of R0 in the coefficients; a larger error e R0 may put the truth
 * outside by the order of sqrt(e) R0. Where the coefficients are no light's, both are the linear reconstruction clamped at 0. */
SHI_INLINE void sh_irradiance_bounds(int order, const float *c, const float n[3], float *lo, float *hi);

/* Henyey-Greenstein closure up to L6, within the bounds. Over 18 channels of six measured panoramas its mean RMS error is .69 (L1)
 * and .61 (L2) times that of the linear reconstruction clamped at 0; of single ones it can be the larger: docs/irradiance.md. */
SHI_INLINE float sh_irradiance_closure(int order, const float *c, const float n[3]);

/* For comparison and compatibility, from L1: Geomerics' R0 (a + (1 - a) (p + 1) q^p), q = (1 + n.d) / 2, p = 1 + 2r, a = (1 - r)
 * / (1 + r), and ZH3 hallucination: linear L2 with R2 = R0 (.0619677 r + .804984 r^2) (dd' - I/3), clamped at 0, where d = R1 /
 * |R1|, r = |R1| / R0. Rounding error <= 4e-6 R0. "Reconstructing Diffuse Lighting from Spherical Harmonic Data", CEDEC 2015;
 * "ZH3: Quadratic Zonal Harmonics", 2024. */
SHI_INLINE float sh_irradiance_geomerics(const float *c, const float n[3]);
SHI_INLINE float sh_irradiance_zh3(const float *c, const float n[3]);

/* What a closure needs of one channel's coefficients, to evaluate it for many normals. Plain floats, to be copied at will. */
typedef struct sh_closure {
    int model;     /* private, as are the others: how to read them */
    float scale;
    float r1[3];
    float r2[6];   /* xx, xy, xz, yy, yz, zz */
    float even[4];
} sh_closure;

enum {
    SH_AMBIENT_FLOOR = 1 /* L2: takes sh_ambient_floor out first. A lower maximum error, and sun plus ambient exact up to L6; slower
                          * to prepare, equally fast to evaluate. L1 ignores it: what is left over the floor is a single light. */
};

/* out[channels] from planar sets c; then sh_closure_irradiance(order, out + k, n), of the same order, is sh_irradiance_closure of
 * channel k. */
SHI_INLINE void sh_closure_prepare(int order, int channels, const float *c, unsigned flags, sh_closure *out);
SHI_INLINE float sh_closure_irradiance(int order, const sh_closure *closure, const float n[3]);

#ifndef SH_NO_BATCH
/* The same for many normals x[i], y[i], z[i]; out is planar, channel k of normal i is out[k * count + i]. Any number of channels
 * and normals, 0 too. A result does not depend on its position or on count, and is the scalar function's to rounding; the power
 * in Geomerics' model is within 1e-6 of itself. out may be x, y or z. */
SHI_INLINE void sh_irradiance_closure_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                            float *out, size_t count);
SHI_INLINE void sh_closure_irradiance_batch(int order, int channels, const sh_closure *closure, const float *x, const float *y,
                                            const float *z, float *out, size_t count);
SHI_INLINE void sh_irradiance_geomerics_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                              float *out, size_t count);
SHI_INLINE void sh_irradiance_zh3_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                        float *out, size_t count);

/* The same for interleaved data: normal i is the three floats at (char *)n + i * n_stride, its result the `channels` floats at
 * (char *)out + i * out_stride. Strides in bytes; 0: tight. Nothing between items is written. */
SHI_INLINE void sh_irradiance_closure_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                                size_t out_stride, size_t count);
SHI_INLINE void sh_closure_irradiance_batch_aos(int order, int channels, const sh_closure *closure, const float *n, size_t n_stride,
                                                float *out, size_t out_stride, size_t count);
SHI_INLINE void sh_irradiance_geomerics_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                                  size_t out_stride, size_t count);
SHI_INLINE void sh_irradiance_zh3_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                            size_t out_stride, size_t count);
#endif /* SH_NO_BATCH */

/* ---- Zonal kernels: z[l] is the factor of band l under convolution, and the coefficient of band l of the lobe itself -------------
 * Rounding error <= 4 ulp of each factor; of the windows, <= 2 ulp of 1. */

SHI_FUNCTION void sh_zonal_lambert(float zonal[3]);                      /* 4 max(0, t): irradiance / pi. 1, 2/3, 1/4 */
SHI_FUNCTION void sh_zonal_ao(float cos_angle, float zonal[3]);          /* 4 t where t > cos_angle, in [0, 1] */
SHI_FUNCTION void sh_zonal_half_lambert(float zonal[3]);                 /* 1 + t. 1, 1/3, 0 */
SHI_FUNCTION void sh_zonal_cap(float cos_angle, float zonal[3]);         /* radiance 1 where t > cos_angle, in [-1, 1] */
SHI_FUNCTION void sh_zonal_vmf(float sharpness, float zonal[3]);         /* von Mises-Fisher lobe of mean 1, exp(K t), K >= 0 */
SHI_FUNCTION void sh_zonal_hann(float width, float zonal[3]);            /* window (1 + cos(pi l / width)) / 2, 0 from l = width on */
SHI_FUNCTION void sh_zonal_lanczos(float width, float zonal[3]);         /* window sinc(pi l / width), 0 from l = width on */
SHI_FUNCTION void sh_zonal_laplacian(float lambda, float zonal[3]);      /* window 1 / (1 + lambda l^2 (l + 1)^2), lambda >= 0 */

/* Convolution with a zonal kernel: band l times zonal[l]. */
SHI_INLINE void sh_convolve(int order, const float *c, const float zonal[3], float *out);

/* c += value * the zonal lobe about unit direction dir. zonal = { 1, 1, 1 } is sh_add_sample. */
SHI_INLINE void sh_zonal_add(int order, const float zonal[3], const float dir[3], float value, float *c);

/* ---- Analysis ------------------------------------------------------------------------------------------------------------------- */

/* |R1| / R0 of one channel of L1 or higher, in [0, 1]: 0 for light that is the same from opposite sides, 1 for a single direction.
 * Black, or R0 <= 0: 0. More than non-negative light can have: 1. Any magnitude, subnormal to 1e38. */
SHI_FUNCTION float sh_directionality(const float *c);

/* The mean direction of the light, unit length, from one channel of L1 or higher; returns |R1|. If R1 = 0: 0, and dir is +z, as it is
 * where R1 is NaN. */
SHI_FUNCTION float sh_average_direction(const float *c, float dir[3]);

/* The directional light and the ambient rest that have the same R0 and, for one channel, the same R1. dir is shared by the channels:
 * that of the sum of their R1 (+z if it is 0 or NaN). intensity[k] is irradiance / pi at normal incidence, 4 max(0, R1.dir); ambient[k] is
 * radiance, R0 - intensity / 4, not negative for a real light. c has `channels` sets of order >= 1. */
SHI_FUNCTION void sh_dominant_light(int order, int channels, const float *c, float dir[3], float *intensity, float *ambient);

/* The least and greatest value over the sphere of sh_radiance, and of sh_irradiance, and a unit direction where it is taken
 * (`at` may be NULL; one of them where there are many). Exact, not sampled: error <= 2e-6 of the largest coefficient. */
SHI_INLINE float sh_min(int order, const float *c, float at[3]);
SHI_INLINE float sh_max(int order, const float *c, float at[3]);
SHI_INLINE float sh_irradiance_min(int order, const float *c, float at[3]);
SHI_INLINE float sh_irradiance_max(int order, const float *c, float at[3]);

/* The radiance of the largest constant light that can be taken out of an L2 set and leave the moments of a non-negative light:
 * the smallest eigenvalue of [[R0, sqrt3 R1'], [sqrt3 R1, R0 I + 3 R2]]. Negative if the set itself has no such light. Error <=
 * 1e-6 of the largest coefficient: of R0, for light. */
SHI_FUNCTION float sh_ambient_floor(const float *c);

/* Whether some light that is nowhere negative has these coefficients, to 2e-6 R0. Necessary and sufficient. NaN: no. */
SHI_INLINE int sh_is_realizable(int order, const float *c);

typedef enum sh_window {
    SH_WINDOW_HANN,     /* sh_zonal_hann */
    SH_WINDOW_LANCZOS,  /* sh_zonal_lanczos */
    SH_WINDOW_LAPLACIAN /* sh_zonal_laplacian */
} sh_window;

/* Removes ringing: out = c under the weakest window of a family, one for all channels, for which no channel's radiance is
 * negative anywhere (>= -1e-6 R0, by sh_min); under every window that is weaker by 1e-3 or more, one is. Returns its parameter: a
 * width (INFINITY: nothing was to be done) or a lambda. R0 < 0 cannot be helped: such channels have no say. At most nine
 * passes of 40 minima a channel; as a rule, two of them with four in all. out may be c. */
SHI_INLINE float sh_dering(int order, int channels, const float *c, sh_window window, float *out);

/* The lowest order at which the irradiance (or the radiance) of an L2 set, anywhere, differs from L2's by at most `tolerance`,
 * which is absolute. Dropping R2 costs at most 15/8 (15/2) times its largest |eigenvalue|, which is at most sqrt(2/3 R2:R2); R1,
 * 2 |R1| (3 |R1|). A band that is not finite is needed. */
SHI_FUNCTION int sh_order_needed(const float *c, float tolerance);
SHI_FUNCTION int sh_radiance_order_needed(const float *c, float tolerance);

/* Sorts `count` L2 probes (one after the other, `channels` planar sets each) by the order that all their channels need:
 * index[first[o]] to index[first[o + 1] - 1] are those of order o, in rising order. index has `count` elements. */
SHI_FUNCTION void sh_group_by_order(int channels, const float *c, size_t count, float tolerance, size_t *index, size_t first[4]);

/* Whether the irradiance of every channel is that of channel 0, everywhere, to `tolerance`: then one evaluation serves them all. */
SHI_INLINE int sh_is_grey(int order, int channels, const float *c, float tolerance);

/* Whether to leave out a light of mean radiance `value` that comes from one direction, or is a convolution of such a light. It
 * adds at most 17/4 |value| to irradiance anywhere, which is taken from *budget, rounded down: however many lights are skipped,
 * together they change irradiance by at most what the budget was at first. */
SHI_INLINE int sh_skip_light(float value, float *budget);

/* The smallest height (power of two, half the width) of an equirectangular panorama, and width of a cube map's face, whose
 * projection to `order` yields irradiance within `tolerance` * R0 of that of any finer image that it is the average of, weighted
 * by texel area. For light that is nowhere negative. At most 2^24, for a tolerance of 0 or NaN too. */
SHI_FUNCTION int sh_equirect_size_for(int order, float tolerance);
SHI_FUNCTION int sh_cubemap_size_for(int order, float tolerance);

/* ---- Operators: one channel, unless they say otherwise --------------------------------------------------------------------------- */

/* Product of the two radiance reconstructions, kept to `order`: light times visibility, environment times mask. Bands of the product
 * above `order` are dropped. A square is a product with itself: compilers share its terms. Error <= 1e-6 of |a| |b|,
 * |a|^2 = sh_dot(a, a). At L2, with S = (AB + BA)/2 and dev() the symmetric traceless part:
 *     a0 b0 + 3 a1.b1 + 15/2 A:B,   a0 b1 + b0 a1 + 3 (A b1 + B a1),   a0 B + b0 A + 6/5 dev(a1 b1') + 30/7 dev(S). */
SHI_INLINE void sh_product(int order, const float *a, const float *b, float *out);

/* The light turned by an orthogonal matrix, row-major: what came from d comes from m d. Reflections (determinant -1) included.
 * R1 -> m R1, R2 -> m R2 m'. Error <= 4e-7 of |c| for |m m' - I| <= 1e-7; never normalised for you. */
SHI_INLINE void sh_rotate(int order, const float *c, const float m[9], float *out);

/* Row-major matrix of the rotation by quaternion q = x, y, z, w of any length; the identity if q = 0. */
SHI_FUNCTION void sh_rotation_from_quaternion(const float q[4], float m[9]);

/* The light in other axes: new axis i is old axis |axis[i]| (1 = x, 2 = y, 3 = z), negated if axis[i] < 0. Exact but for zz's rounding.
 * axis is a signed permutation of 1, 2, 3, not checked. From right-handed z up: { 1, 3, -2 } is right-handed y up (OpenGL, Godot,
 * three.js), { 1, 3, 2 } left-handed y up (Unity, Babylon, Direct3D), { 1, -2, 3 } left-handed z up (Unreal). */
SHI_INLINE void sh_swap_axes(int order, const float *c, const int axis[3], float *out);
SHI_INLINE void sh_z_up_to_y_up(int order, const float *c, float *out);                         /* (x, y, z) -> (x, z, -y) */
SHI_INLINE void sh_y_up_to_z_up(int order, const float *c, float *out);                         /* its inverse: (x, -z, y) */

/* Radiance from dir through a zonal kernel: c convolved, then looked at. With sh_zonal_ggx and the mirrored view: a specular probe.
 * For many directions, sh_convolve once, then sh_radiance_batch. */
SHI_INLINE float sh_radiance_zonal(int order, const float *c, const float zonal[3], const float dir[3]);

/* The direction in which unit vector `view`, pointing to the eye, is mirrored by unit normal n: 2 (n.view) n - view. */
SHI_INLINE void sh_reflect(const float view[3], const float n[3], float out[3]);

/* More kernels, as in "Zonal kernels": of mean 1.
 * cosine_power: max(0, t)^exponent, exponent >= 0: 1, (s + 1)/(s + 2), s/(s + 3). 0 is the hemisphere, 1 is Lambert.
 * ggx: the GGX lobe of width alpha (the square of most engines' roughness), in [0, 1], about the mirrored view, seen along the normal
 *     and weighted by the cosine, as split-sum prefiltering does: 0 is a mirror (1, 1, 1), 1 is Lambert. Error 1e-7. Walter et al.,
 *     "Microfacet Models for Refraction through Rough Surfaces", 2007; Karis, "Real Shading in Unreal Engine 4", 2013.
 * sharpness: 1 + s t, the adjustable probe of first-order lighting: 0 averages, 1 is half Lambert, 2 the linear part of Lambert,
 *     3 the L1 radiance. Not negative for any light if s <= 1. It has no second band. */
SHI_FUNCTION void sh_zonal_cosine_power(float exponent, float zonal[3]);
SHI_FUNCTION void sh_zonal_ggx(float alpha, float zonal[3]);
SHI_FUNCTION void sh_zonal_sharpness(float sharpness, float zonal[3]);

#ifndef SH_NO_BATCH
/* sh_rotate of `sets` sets in a row, by one matrix: channels, probes, or both. An RGB probe is three sets. */
SHI_FUNCTION void sh_rotate_batch(int order, const float *c, const float m[9], float *out, size_t sets);

/* sh_product of `count` pairs in planes: coefficient i of pair p is a[i * count + p], and so for b and out. */
SHI_FUNCTION void sh_product_batch(int order, const float *a, const float *b, float *out, size_t count);
#endif

/* ---- Lights: each adds to `channels` planar sets; a value is an array of one float per channel ------------------------------------
 * Positions are relative to the receiver. Nothing is clipped by a surface's horizon, nothing casts a shadow. What is normalised is the
 * continuous light, never its reconstruction. Errors <= 1e-6 of the light's R0, unless stated. Any magnitude up to 1e18; lights of no
 * size add nothing, unless their unit says how much light arrives. */

typedef enum sh_unit {
    SH_RADIANCE,  /* the emitter's radiance: what a camera sees, at whatever distance and size; for a lobe, at its peak */
    SH_IRRADIANCE /* irradiance / pi of a white surface that faces the light's centre: it is the same at whatever size */
} sh_unit;

SHI_INLINE void sh_add_ambient(int order, int channels, const float *radiance, float *c);

/* Light from one direction; irradiance / pi at normal incidence. 4 times sh_add_sample's value. */
SHI_INLINE void sh_add_directional(int order, int channels, const float dir[3], const float *irradiance, float *c);

/* Radiance `sky` above the plane with unit normal `up`, `ground` below. Irradiance / pi is then (sky + ground)/2 + (sky - ground)/2
 * n.up, exactly. */
SHI_INLINE void sh_add_hemisphere(int order, int channels, const float up[3], const float *sky, const float *ground, float *c);

/* A cap (a sun, a cone of sky) about dir of half_angle radians, in [0, pi]. A cap of solid angle S has half-angle
 * 2 asin(sqrt(S / (4 pi))). Facing irradiance / pi is radiance times sin^2(half_angle), or 1 from pi/2 on. */
SHI_INLINE void sh_add_cap(int order, int channels, const float dir[3], float half_angle, sh_unit unit, const float *value, float *c);

/* A sphere seen from outside is a cap; from inside it is ambient light. A sphere of radius 0 at the receiver adds no radiance. */
SHI_INLINE void sh_add_sphere(int order, int channels, const float center[3], float radius, sh_unit unit, const float *value, float *c);

/* A von Mises-Fisher lobe (spherical Gaussian) exp(sharpness (t - 1)), sharpness >= 0. */
SHI_FUNCTION void sh_add_vmf(int order, int channels, const float dir[3], float sharpness, sh_unit unit, const float *value, float *c);

/* A planar polygon, convex or not, without crossings: `count` vertices x, y, z, in either sense; emits from both faces. Exact, by
 * edge integrals: band l is a sum over edges of -1 / (l (l + 1)) times the outward derivative of the basis; R0 is the solid angle of
 * a fan of triangles (Van Oosterom and Strackee, 1983). Seen edge on it adds nothing; a receiver on the polygon itself has a
 * hemisphere of light on one of its sides; one on an edge, something finite. SH_ERROR_ARGUMENT: NULL, or count < 3. */
SHI_FUNCTION int sh_add_polygon(int order, int channels, const float *vertices, size_t count, const float *radiance, float *c);

/* A parallelogram from its centre and the vectors from there to the middles of two adjacent sides; as sh_add_polygon. */
SHI_FUNCTION void sh_add_rectangle(int order, int channels, const float center[3], const float half_u[3], const float half_v[3],
                                   const float *radiance, float *c);

/* A disk with unit normal, emitting from both faces. The same integrals around the rim, by the trapezoidal rule. Error <= 1e-6 of R0
 * where the rim is farther away than radius / 30; larger nearer to it. On the disk: a hemisphere of light, towards the normal. */
SHI_FUNCTION void sh_add_disk(int order, int channels, const float center[3], const float normal[3], float radius, const float *radiance,
                              float *c);

/* A tube from a to b of diameter `width`, small against its distance: the limit of a rectangle that faces the receiver. Nearer to its
 * axis than width / 2 it grows no brighter; on the axis it adds nothing. */
SHI_FUNCTION void sh_add_segment(int order, int channels, const float a[3], const float b[3], float width, const float *radiance,
                                 float *c);

/* Adds `count` spheres x, y, z, radius, of radiance[i * channels + k], and skips the negligible: those left out change irradiance / pi
 * (true or reconstructed) by at most `tolerance` together, in any channel at any normal. Returns how many were added. The bound:
 * a sphere's irradiance / pi is at most L r^2 / d^2, and its L2 reconstruction 17/16 of that. Most are skipped if they come in
 * descending order of it. */
SHI_FUNCTION size_t sh_add_spheres(int order, int channels, const float *spheres, const float *radiance, size_t count, float tolerance,
                                   float *c);

/* ---- Conversion and storage: one channel, unless they say otherwise ----------------------------------------------------------------
 * Sets of other engines, numbered l (l + 1) + m: 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2, in their own axes (sh_swap_axes):
 *     three.js SphericalHarmonics3, Probulator, sphericart          orthonormal; three.js is interleaved, its getIrradianceAt is pi times
 *                                                                   sh_irradiance
 *     DirectXMath, Unreal, google/spherical-harmonics, Blender,     orthonormal with SH_CONDON_SHORTLEY; an "order" of 3 is SH_L2
 *     Babylon SphericalHarmonics
 *     Unity SphericalHarmonicsL2, Filament, Babylon preScaled       unity; Unity keeps the channels planar, the others interleaved
 *     Babylon SphericalPolynomial                                   babylon. What its materials take for an environment was convolved once
 *                                                                   more: give them the set after sh_convolve by sh_zonal_lambert
 * A round trip is exact to 4 ulp of the largest coefficient of a band. */

enum { SH_CONDON_SHORTLEY = 1 }; /* phase: coefficients of odd m change sign; 0: all positive */

/* f = integral of L Y dOmega, of orthonormal real Y. out may be c. */
SHI_FUNCTION void sh_to_orthonormal(int order, const float *c, int phase, float *out);
SHI_FUNCTION void sh_from_orthonormal(int order, const float *f, int phase, float *out);

/* The factors of the polynomial that is irradiance / pi: E/pi(n) = u0 + u1 y + u2 z + u3 x + u4 xy + ... + u6 (3z^2 - 1) + ... */
SHI_FUNCTION void sh_to_unity(int order, const float *c, float *out);
SHI_FUNCTION void sh_from_unity(int order, const float *u, float *out);

/* An L2 set as the factors of x, y, z, xx, yy, zz, yz, zx, xy of irradiance / pi, the order of SphericalPolynomial's members. */
SHI_FUNCTION void sh_to_babylon(const float *c, float out[9]);
SHI_FUNCTION void sh_from_babylon(const float p[9], float *out);

/* Planar sets to coefficients of all channels side by side (a vec3 or Vector3 per coefficient), and back. out must not be c. */
SHI_FUNCTION void sh_interleave(int order, int channels, const float *c, float *out);
SHI_FUNCTION void sh_deinterleave(int order, int channels, const float *c, float *out);

/* Three L2 sets as seven float4, s[0] to s[6], for irradiance / pi at n by 7 dot products or multiply-adds of a shader. GLSL:
 *     vec4 p = vec4(n, 1.0), q = n.xyzz * n.yzzx;
 *     vec3 e = vec3(dot(s[0], p), dot(s[1], p), dot(s[2], p)) + vec3(dot(s[3], q), dot(s[4], q), dot(s[5], q))
 *            + s[6].rgb * (n.x * n.x - n.y * n.y);
 * HLSL: the same with float4 p = float4(n, 1.0), q = n.xyzz * n.yzzx; float3 e = float3(...) + float3(...) + ... out may be c. */
SHI_FUNCTION void sh_pack_shader(const float *c, float out[28]);

/* `channels` planar sets as halves with one exponent: out has channels * SH_COUNT(order) halves, each coefficient * 2^-e, and e (two's
 * complement) as its last word. The largest lies in [2^14, 2^15): nothing overflows up to 1e38, and only what is 2^-29 of it becomes
 * subnormal. A set that non-negative light can have stays one: its R0 is rounded up as far as that needs, 8 steps of a half at most.
 * Error of irradiance / pi <= 0.003 R0, and <= 0.007 R0 where R0 was rounded up (largest seen: 0.0011, 0.0024). What is not finite
 * is stored as 0. */
SHI_FUNCTION void sh_pack_half(int order, int channels, const float *c, uint16_t *out);
SHI_FUNCTION void sh_unpack_half(int order, int channels, const uint16_t *in, float *out);

/* Sets as their R0, kept in `r0[channel]` for you to store as you like, and ratios to R0 in the ranges that light can have: x, y, z in
 * [-1, 1], xy, xz, yz in [-1/2, 1/2], xx and yy in [-1/3, 2/3]. 8 bits: SH_COUNT(order) - 1 bytes a channel, in the order of the
 * coefficients. 10 bits: three to a word, red first (RGB10A2): 0, 1 or 3 words a channel; alpha is 0. 0 is kept exactly; with
 * n = 2^(bits - 1) - 1, a unorm t decodes to ((2n + 1) t - n - 1) / n, half of that, or t - 1/3.
 * A set that non-negative light can have stays one, whatever precision R0 is stored in: its ratios are shrunk, as far as that needs.
 * Error of irradiance / pi <= 0.024 R0 in 8 bits, 0.006 R0 in 10; where ratios had to be shrunk (nearly a single direction) <= 0.12 R0
 * and 0.03 R0 (largest seen: 0.045, 0.013). Ratios of sets that light cannot have are clamped; R0 <= 0 decodes to R0 alone. */
SHI_FUNCTION void sh_pack_unorm8(int order, int channels, const float *c, float *r0, uint8_t *ratio);
SHI_FUNCTION void sh_unpack_unorm8(int order, int channels, const float *r0, const uint8_t *ratio, float *out);
SHI_FUNCTION void sh_pack_unorm10(int order, int channels, const float *c, float *r0, uint32_t *ratio);
SHI_FUNCTION void sh_unpack_unorm10(int order, int channels, const float *r0, const uint32_t *ratio, float *out);

/* ---- Fitting -------------------------------------------------------------------------------------------------------------------- */

enum { SH_WARNING_UNDETERMINED = 1 };

/* Least squares: coefficients whose reconstruction is nearest to `count` measurements at directions x[i], y[i], z[i]; for few or uneven
 * samples, where sh_project_samples, which trusts their distribution, is biased. value is planar: channel k is value[k * count + i];
 * any number of channels. weight >= 0, NULL: all equal.
 * zonal: what was measured. NULL: radiance. sh_zonal_lambert's: irradiance / pi.
 * regularization lambda >= 0 adds lambda l^2 (l + 1)^2 times the mean square of band l of the radiance to the mean square error: bands
 * that the samples do not need stay small. 1e-3 to 1e-1 for measured light; 0: none.
 * SH_OK; SH_WARNING_UNDETERMINED if some combination of coefficients hardly changes what is measured (by less than 1e-6 in mean square
 * where its radiance has a mean square of 1): c is then the smallest fit. SH_ERROR_ARGUMENT: NULL, bad order or channels, weights whose
 * sum is not positive and finite, lambda < 0 or not finite; nothing is written. Samples of light of `order` give it back to 3e-6 of
 * its largest coefficient if they cover more than half of the sphere; to 1e-4 wherever there is no warning. */
SHI_FUNCTION int sh_fit_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                const float *weight, size_t count, const float *zonal, float regularization, float *c);

/* ---- Projection from samples and functions -------------------------------------------------------------------------------------- */

SHI_FUNCTION void sh_accum_clear(int channels, sh_accum *accum);

/* Adds one sample of one channel. Uniformly distributed samples have equal weights (importance sampling: weight 1, and value divided
 * by 4 pi pdf); quadrature nodes have their solid angle, in any unit. */
SHI_INLINE void sh_accum_sample(int order, const float dir[3], float value, float weight, sh_accum *accum);

SHI_FUNCTION void sh_accum_merge(int channels, const sh_accum *from, sh_accum *into);           /* into += from */

/* Coefficients as the weighted mean of what was added; 0 where nothing was. accum has `channels` elements. */
SHI_FUNCTION void sh_accum_finish(int order, int channels, const sh_accum *accum, float *c);

/* Coefficients as the sum itself: what was not added is black. For image rows, whose weights are fractions of the sphere. */
SHI_FUNCTION void sh_accum_total(int order, int channels, const sh_accum *accum, float *c);

/* Projects a function by Gauss-Legendre x uniform quadrature: exact, to rounding, if f is a polynomial of at most `degree` in
 * (x, y, z), 0 <= degree <= 1000. Calls f about (degree + order)^2 / 2 times. channels <= SH_MAX_CHANNELS. */
SHI_FUNCTION int sh_project_function(int order, int channels, sh_function f, void *user, int degree, float *c);

/* Direction i of a columns x rows stratification of the sphere into equal areas, jittered by `seed`: i in [0, columns * rows),
 * row by row from +z; larger i wrap round with a new jitter. columns and rows are at least 1. Equal arguments give equal directions. */
SHI_FUNCTION void sh_direction_stratified(uint32_t i, uint32_t columns, uint32_t rows, uint32_t seed, float dir[3]);

/* Direction i of an endless low-discrepancy sequence, uniform on the sphere; `seed` shifts it. Any prefix is well distributed.
 * Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences" (R2). */
SHI_FUNCTION void sh_direction_sequence(uint32_t i, uint32_t seed, float dir[3]);

/* Direction i of `count` on the Fibonacci spiral, from +z to -z: the best of the three where count is known. */
SHI_FUNCTION void sh_direction_fibonacci(uint32_t i, uint32_t count, float dir[3]);

#ifndef SH_NO_BATCH
/* ---- Batches: many directions at once -------------------------------------------------------------------------------------------
 * Any order, number of channels, count (0 too) and alignment. A result does not depend on its position or on count. Rounding error
 * <= 8 ulp of the sum of absolute terms, zz among them. out may be x, y or z. */

/* sh_radiance and sh_irradiance of `channels` planar sets c in directions x[i], y[i], z[i]. out is planar: channel k of direction i
 * is out[k * count + i]. */
SHI_INLINE void sh_radiance_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                                  size_t count);
SHI_INLINE void sh_irradiance_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                    float *out, size_t count);

/* The same for interleaved data, such as a vertex buffer: direction i is the three floats at (char *)dir + i * dir_stride, its
 * result the `channels` floats at (char *)out + i * out_stride. Strides in bytes; 0: tight. Nothing between items is written. */
SHI_INLINE void sh_radiance_batch_aos(int order, int channels, const float *c, const float *dir, size_t dir_stride, float *out,
                                      size_t out_stride, size_t count);
SHI_INLINE void sh_irradiance_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                        size_t out_stride, size_t count);

/* sh_irradiance of one probe and one normal per item: item i has the `channels` planar sets at c + i * channels * SH_COUNT(order),
 * as one probe after the other lies in a grid. out is planar; it may be x, y or z. */
SHI_INLINE void sh_irradiance_probes_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                           float *out, size_t count);

/* c = weighted mean of value * basis over `count` directions x[i], y[i], z[i]. value is planar: channel k is value[k * count + i].
 * weight NULL: all equal. Sums of runs are in double: no stagnation. Error <= 5e-7 of the weighted mean of |value|. */
SHI_INLINE int sh_project_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                    const float *weight, size_t count, float *c);

/* The same sums added to accum[channels], to go on with later or elsewhere. */
SHI_INLINE int sh_accum_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                  const float *weight, size_t count, sh_accum *accum);

/* ---- Images --------------------------------------------------------------------------------------------------------------------- */

typedef enum sh_format {
    SH_F32,    /* float */
    SH_F16,    /* IEEE half, subnormal ones on every target */
    SH_RGBE8,  /* Radiance: bytes r, g, b, e; radiance = m 2^(e - 136), 0 for e = 0, e = 255 as 254. 3 channels in 4 bytes */
    SH_RGB9E5, /* shared exponent in a native 32-bit word, red in the low 9 bits; radiance = m 2^(e - 24). 3 channels in 4 bytes */
    SH_SRGB8   /* bytes with the sRGB transfer curve; 255 is radiance 1 */
} sh_format;

/* Pixels in memory, never written. Any alignment. channels: 1, 3 or 4; the 4th is padding or alpha and is ignored. RGBE8 and RGB9E5
 * have 3 (4 is taken to mean the same). row_stride: bytes from a row to the next; 0: rows are tight. */
typedef struct sh_image {
    const void *pixels;
    int width, height;
    size_t row_stride;
    int channels;
    sh_format format;
} sh_image;

/* What a projection found. A texel is non-finite if any of its colour channels is NaN or infinite: it is left out whole, as if
 * black. It is negative if any is below zero. */
typedef struct sh_report {
    uint64_t texels, nonfinite, negative;
} sh_report;

enum {
    SH_CLAMP_NEGATIVE = 1, /* negative values count as 0; they are kept otherwise */
    SH_POINT_TEXELS = 2,   /* a texel is a sample at its centre, not an average over its area */
    SH_CLOCKWISE = 4       /* equirectangular: columns run from +x to -y */
};

/* Colour channels of an image, and of the coefficients projected from it: 1 or 3. */
SHI_FUNCTION int sh_image_channels(const sh_image *image);

/* Projects an equirectangular panorama to sh_image_channels(image) planar sets.
 * Row 0 is at +z; column x is at azimuth 2 pi (x + 1/2) / width, from +x to +y: on the inside of the sphere, columns run to the left.
 * For a panorama as a camera sees it, columns to the right, pass SH_CLOCKWISE.
 * Texels are area averages: the basis is integrated over each exactly. With SH_POINT_TEXELS they are point samples: exact for
 * images of bands up to degree min(width, height) - 3, from 3 x 3 up. Error <= 1e-6 of the mean of |radiance|; the largest seen is half
 * of it, of a sun of one texel; 1e-7 on photographs. report may be NULL. */
SHI_INLINE int sh_project_equirect(int order, const sh_image *image, unsigned flags, float *c, sh_report *report);

/* Adds rows [first_row, first_row + row_count) to accum[sh_image_channels(image)], and to report: time slices, dirty tiles, half
 * skies, threads. The weights are fractions of the sphere: sh_accum_total when all rows are in, or to read the others as black. */
SHI_INLINE int sh_project_equirect_rows(int order, const sh_image *image, unsigned flags, int first_row, int row_count,
                                          sh_accum *accum, sh_report *report);

/* Projects a cube map: six square faces of one size and format, +x, -x, +y, -y, +z, -z, oriented as OpenGL and Direct3D do (rows from
 * the top). A texel is light from the direction of its centre, weighted by its solid angle: for smooth light, off by 1 / size^2 of it.
 * The weights are within 1e-6 of themselves at every size, and their sum is divided out. Error of the sums <= 1e-6 of the mean of
 * |radiance|, 1e-7 on photographs. Flag: SH_CLAMP_NEGATIVE. */
SHI_INLINE int sh_project_cubemap(int order, const sh_image face[6], unsigned flags, float *c, sh_report *report);

/* Adds rows [first_row, first_row + row_count) of all six faces, as sh_project_equirect_rows does. A range that is symmetric about the
 * middle is faster. */
SHI_INLINE int sh_project_cubemap_rows(int order, const sh_image face[6], unsigned flags, int first_row, int row_count, sh_accum *accum,
                                       sh_report *report);

/* Projects a square octahedral map: at u, v in [-1, 1], rows from v = -1, the direction is (u, v, 1 - |u| - |v|) normalised and, beyond
 * the fold |u| + |v| = 1, ((1 - |v|) sign u, (1 - |u|) sign v, 1 - |u| - |v|). Texels as in sh_project_cubemap; weights within 5e-6.
 * Leave out a border of repeated texels by pixels and row_stride. */
SHI_INLINE int sh_project_octahedral(int order, const sh_image *image, unsigned flags, float *c, sh_report *report);
SHI_INLINE int sh_project_octahedral_rows(int order, const sh_image *image, unsigned flags, int first_row, int row_count,
                                          sh_accum *accum, sh_report *report);
#endif /* SH_NO_BATCH */

/* ---- Coefficients --------------------------------------------------------------------------------------------------------------- */

SHI_INLINE void sh_basis(int order, const float dir[3], float *basis) {
    const float x = dir[0], y = dir[1], z = dir[2], third = 1.0f / 3.0f;
    basis[SH_R0] = 1.0f;
    if (order < SH_L1)
        return;
    basis[SH_X] = x;
    basis[SH_Y] = y;
    basis[SH_Z] = z;
    if (order < SH_L2)
        return;
    basis[SH_XX] = x * x - third;
    basis[SH_XY] = x * y;
    basis[SH_XZ] = x * z;
    basis[SH_YY] = y * y - third;
    basis[SH_YZ] = y * z;
}

SHI_INLINE void sh_scale(int order, const float *c, float scale, float *out) {
    SHI_UNROLL(9)
    for (int i = 0; i < SH_COUNT(order); i++)
        out[i] = scale * c[i];
}

SHI_INLINE void sh_madd(int order, const float *a, float scale, float *c) {
    SHI_UNROLL(9)
    for (int i = 0; i < SH_COUNT(order); i++)
        c[i] += scale * a[i];
}

SHI_INLINE void sh_lerp(int order, const float *a, const float *b, float t, float *out) {
    SHI_UNROLL(9)
    for (int i = 0; i < SH_COUNT(order); i++)
        out[i] = (1.0f - t) * a[i] + t * b[i];
}

#if SHI_HAS_FOUR
SHI_INLINE void shi_madd_two(const float *a, float scale, float *c) {
    const shi_two vector = { a[0], a[1] }, factor = { scale, scale };
    shi_two sum;
    memcpy(&sum, c, sizeof sum);
    sum = factor * vector + sum;
    memcpy(c, &sum, sizeof sum);
}

SHI_INLINE void shi_madd_four(const float *a, float scale, float *c) {
    const shi_four vector = { a[0], a[1], a[2], a[3] }, factor = { scale, scale, scale, scale };
    shi_four sum;
    memcpy(&sum, c, sizeof sum);
    sum = factor * vector + sum;
    memcpy(c, &sum, sizeof sum);
}

/* Nine floats in the fewest vectors that begin at multiples of their size: one that crosses a cache line reaches the load of the next
 * sample late, and nine stores of single floats take longer than the arithmetic. */
SHI_INLINE void shi_madd_nine(const float *a, float scale, float *c) {
    switch ((uintptr_t)c & 12u) {
    case 0:
        shi_madd_four(a, scale, c);
        shi_madd_four(a + 4, scale, c + 4);
        sh_madd(SH_L0, a + 8, scale, c + 8);
        break;
    case 4:
        sh_madd(SH_L0, a, scale, c);
        shi_madd_two(a + 1, scale, c + 1);
        shi_madd_four(a + 3, scale, c + 3);
        shi_madd_two(a + 7, scale, c + 7);
        break;
    case 8:
        shi_madd_two(a, scale, c);
        shi_madd_four(a + 2, scale, c + 2);
        shi_madd_two(a + 6, scale, c + 6);
        sh_madd(SH_L0, a + 8, scale, c + 8);
        break;
    default:
        sh_madd(SH_L0, a, scale, c);
        shi_madd_four(a + 1, scale, c + 1);
        shi_madd_four(a + 5, scale, c + 5);
        break;
    }
}
#endif

/* Made for sums of many samples into one set, which wait for its stores. */
SHI_INLINE void sh_add_sample(int order, const float dir[3], float value, float *c) {
    float basis[SH_COUNT(SH_L2)] = { 0 };
    sh_basis(order, dir, basis);
#if SHI_HAS_FOUR
    if (order == SH_L1)
        shi_madd_four(basis, value, c);
    else if (order >= SH_L2)
        shi_madd_nine(basis, value, c);
    else
#endif
        sh_madd(order, basis, value, c);
}

SHI_INLINE float shi_dot3(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SHI_INLINE float sh_dot(int order, const float *a, const float *b) {
    float sum = a[SH_R0] * b[SH_R0];
    if (order >= SH_L1)
        sum += 3.0f * shi_dot3(a + SH_X, b + SH_X);
    if (order >= SH_L2) {
        const float diagonal = a[SH_XX] * b[SH_XX] + a[SH_YY] * b[SH_YY] + (a[SH_XX] + a[SH_YY]) * (b[SH_XX] + b[SH_YY]);
        const float rest = a[SH_XY] * b[SH_XY] + a[SH_XZ] * b[SH_XZ] + a[SH_YZ] * b[SH_YZ];
        sum += 7.5f * (diagonal + 2.0f * rest);
    }
    return sum;
}

SHI_FUNCTION void sh_truncate(int order, int channels, const float *c, int order_out, float *out) {
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < SH_COUNT(order_out); i++)
            out[k * SH_COUNT(order_out) + i] = c[k * SH_COUNT(order) + i];
}

/* ---- Reconstruction ------------------------------------------------------------------------------------------------------------- */

/* w'R2 w, with zz = -(xx + yy). */
SHI_INLINE float shi_quadratic(const float *c, const float w[3]) {
    const float x = w[0], y = w[1], z = w[2];
    const float diagonal = c[SH_XX] * (x * x - z * z) + c[SH_YY] * (y * y - z * z);
    return diagonal + 2.0f * (c[SH_XY] * (x * y) + c[SH_XZ] * (x * z) + c[SH_YZ] * (y * z));
}

/* The reconstruction whose bands are weighted w0, w1, w2: the sum of w_l (2l + 1) times the band's part of the light. */
SHI_INLINE float shi_reconstruct(int order, const float *c, const float w[3], float w0, float w1, float w2) {
    float sum = w0 * c[SH_R0];
    if (order >= SH_L1)
        sum += w1 * shi_dot3(c + SH_X, w);
    if (order >= SH_L2)
        sum += w2 * shi_quadratic(c, w);
    return sum;
}

SHI_INLINE float sh_radiance(int order, const float *c, const float dir[3]) {
    return shi_reconstruct(order, c, dir, 1.0f, 3.0f, 7.5f);
}

SHI_INLINE float sh_irradiance(int order, const float *c, const float n[3]) {
    return shi_reconstruct(order, c, n, 1.0f, 2.0f, 1.875f);
}

SHI_INLINE float sh_irradiance_opposite(int order, const float *c, const float n[3], float irradiance) {
    return order >= SH_L1 ? irradiance - 4.0f * shi_dot3(c + SH_X, n) : irradiance;
}

SHI_INLINE float shi_clamp(float x, float lo, float hi) {
    return x < lo ? lo : x > hi ? hi : x;
}

SHI_INLINE float sh_irradiance_ao(int order, const float *c, const float n[3], float cos_angle) {
    float zonal[3];
    sh_zonal_ao(cos_angle, zonal);
    return sh_radiance_zonal(order, c, zonal, n);
}

/* ---- Zonal kernels -------------------------------------------------------------------------------------------------------------- */

SHI_INLINE void shi_set3(float a, float b, float c, float out[3]) {
    out[0] = a;
    out[1] = b;
    out[2] = c;
}

SHI_FUNCTION void sh_zonal_lambert(float zonal[3]) {
    shi_set3(1.0f, 2.0f / 3.0f, 0.25f, zonal);
}

SHI_FUNCTION void sh_zonal_half_lambert(float zonal[3]) {
    shi_set3(1.0f, 1.0f / 3.0f, 0.0f, zonal);
}

/* Both polynomials have the factor 1 - c, taken out so that narrow cones keep their relative accuracy. */
SHI_FUNCTION void sh_zonal_ao(float cos_angle, float zonal[3]) {
    const float c = shi_clamp(cos_angle, 0.0f, 1.0f), cc = c * c, k0 = (1.0f - c) * (1.0f + c);
    shi_set3(k0, 2.0f / 3.0f * (1.0f - c) * (1.0f + c + cc), 0.25f * k0 * (1.0f + 3.0f * cc), zonal);
}

SHI_FUNCTION void sh_zonal_cap(float cos_angle, float zonal[3]) {
    const float c = shi_clamp(cos_angle, -1.0f, 1.0f), k1 = 0.25f * (1.0f - c) * (1.0f + c);
    shi_set3(0.5f * (1.0f - c), k1, c * k1, zonal);
}

/* a1 = coth K - 1/K and a2 = 1 - 3 a1 / K cancel for small K: there, their Taylor series, off by < 1e-9 relative at K = 1/4. */
SHI_FUNCTION void sh_zonal_vmf(float sharpness, float zonal[3]) {
    const double k = (double)sharpness, kk = k * k;
    double a1, a2;
    if (k < 0.25) {
        a1 = k * (1.0 / 3 - kk * (1.0 / 45 - kk * (2.0 / 945 - kk * (1.0 / 4725))));
        a2 = kk * (1.0 / 15 - kk * (2.0 / 315 - kk * (1.0 / 1575 - kk * (2.0 / 31185))));
    } else {
        a1 = 1.0 / tanh(k) - 1.0 / k;
        a2 = 1.0 - 3.0 * a1 / k;
    }
    shi_set3(1.0f, (float)a1, (float)a2, zonal);
}

#define SHI_PI 3.14159265358979323846 /* pi */

SHI_FUNCTION void sh_zonal_hann(float width, float zonal[3]) {
    for (int l = 0; l < 3; l++)
        zonal[l] = l == 0 ? 1.0f : (float)l >= width ? 0.0f : (float)(0.5 + 0.5 * cos(SHI_PI * l / (double)width));
}

SHI_FUNCTION void sh_zonal_lanczos(float width, float zonal[3]) {
    for (int l = 0; l < 3; l++) {
        const double t = l == 0 ? 0.0 : SHI_PI * l / (double)width;
        zonal[l] = l == 0 ? 1.0f : (float)l >= width ? 0.0f : (float)(t <= 1e-8 ? 1.0 : sin(t) / t);
    }
}

SHI_FUNCTION void sh_zonal_laplacian(float lambda, float zonal[3]) {
    shi_set3(1.0f, 1.0f / (1.0f + 4.0f * lambda), 1.0f / (1.0f + 36.0f * lambda), zonal);
}

/* All loads before the stores: out may be c or zonal for all that a compiler knows. */
SHI_INLINE void sh_convolve(int order, const float *c, const float zonal[3], float *out) {
    const float r0 = zonal[0] * c[SH_R0];
    if (order < SH_L1) {
        out[SH_R0] = r0;
        return;
    }
    const float k1 = zonal[1], x = k1 * c[SH_X], y = k1 * c[SH_Y], z = k1 * c[SH_Z];
    if (order >= SH_L2) {
        const float k2 = zonal[2], xx = k2 * c[SH_XX], xy = k2 * c[SH_XY], xz = k2 * c[SH_XZ], yy = k2 * c[SH_YY], yz = k2 * c[SH_YZ];
        out[SH_XX] = xx;
        out[SH_XY] = xy;
        out[SH_XZ] = xz;
        out[SH_YY] = yy;
        out[SH_YZ] = yz;
    }
    out[SH_R0] = r0;
    out[SH_X] = x;
    out[SH_Y] = y;
    out[SH_Z] = z;
}

SHI_INLINE void sh_zonal_add(int order, const float zonal[3], const float dir[3], float value, float *c) {
    float lobe[SH_COUNT(SH_L2)] = { 0 };
    sh_basis(order, dir, lobe);
    sh_convolve(order, lobe, zonal, lobe);
    sh_madd(order, lobe, value, c);
}

/* ---- Analysis ------------------------------------------------------------------------------------------------------------------- */

/* The length of v, and v / |v| (+z where v = 0). In double no square of a float overflows or underflows. */
SHI_FUNCTION double shi_normalize(const float v[3], float unit[3]) {
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2], length = sqrt(x * x + y * y + z * z);
    if (length > 0)
        shi_set3((float)(x / length), (float)(y / length), (float)(z / length), unit);
    else
        shi_set3(0.0f, 0.0f, 1.0f, unit);
    return length;
}

SHI_FUNCTION float sh_average_direction(const float *c, float dir[3]) {
    return (float)shi_normalize(c + SH_X, dir);
}

SHI_FUNCTION float sh_directionality(const float *c) {
    float dir[3];
    const double length = shi_normalize(c + SH_X, dir);
    return c[SH_R0] <= 0.0f ? 0.0f : shi_clamp((float)(length / (double)c[SH_R0]), 0.0f, 1.0f);
}

SHI_FUNCTION void sh_dominant_light(int order, int channels, const float *c, float dir[3], float *intensity, float *ambient) {
    float sum[3] = { 0, 0, 0 };
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < 3; i++)
            sum[i] += c[k * SH_COUNT(order) + SH_X + i];
    shi_normalize(sum, dir);
    for (int k = 0; k < channels; k++) {
        const float *ck = c + k * SH_COUNT(order);
        const float along = shi_dot3(ck + SH_X, dir), beam = along < 0.0f ? 0.0f : along;
        intensity[k] = 4.0f * beam;
        ambient[k] = ck[SH_R0] - beam;
    }
}

/* ---- Bounded irradiance and closures --------------------------------------------------------------------------------------------
 * In units of R0, u = R1 / R0 and A = R2 / R0. The even part of irradiance is 2 <|t|>, t = n.w, over a distribution of
 * directions with <t> = n.u and <t^2> = n'A n + 1/3. From t^2 <= |t| and Cauchy-Schwarz: max(|n.u|, <t^2>) <= <|t|> <=
 * sqrt(<t^2>). Knowing u only, <t^2> <= 1 - |u|^2 + (n.u)^2: the covariance has no negative eigenvalue, and its trace is 1 -
 * |u|^2. */

enum { SHI_LINEAR, SHI_CLOSURE_L1, SHI_CLOSURE_L1_BOUNDED, SHI_CLOSURE_L2, SHI_CLOSURE_L2_BOUNDED, SHI_GEOMERICS, SHI_ZH3 };

#define SHI_BLACK 1e-34f                 /* an R0 below it counts as 0; its inverse, times the largest gain below, is finite */
#define SHI_ULPS (1.0f / 2097152.0f)     /* 2^-21: 8 ulp, an error of <t^2> due to the coefficients' rounding */
#define SHI_UNREAL (1.0f / 512.0f)       /* eigenvalues of a moment matrix down to this times -R0 are taken for rounding */

SHI_INLINE float shi_larger(float a, float b) {
    return a > b ? a : b;
}

/* The linear reconstruction, to be clamped at 0. */
SHI_INLINE void shi_prepare_linear(int order, const float *c, sh_closure *out) {
    memset(out, 0, sizeof *out);
    out->model = SHI_LINEAR;
    out->even[0] = c[SH_R0];
    if (order >= SH_L1)
        shi_set3(2.0f * c[SH_X], 2.0f * c[SH_Y], 2.0f * c[SH_Z], out->r1);
    if (order >= SH_L2) {
        for (int i = 0; i < 5; i++)
            out->r2[i] = 1.875f * c[SH_XX + i];
        out->r2[5] = -(out->r2[0] + out->r2[3]);
    }
}

#define SHI_SIGMA 1.0795557526404014     /* (3003/2048)^(1/5) */

/* With t = (n.u)^2 and s = |u|^2, the even part over R0 is a cubic in t,
 * 1 + 5/8 (3t - s) - 3/64 (35 t^2 - 30 s t + 3 s^2) + 13/1024 (231 t^3 - 315 s t^2 + 105 s^2 t - 5 s^3).
 * For s <= 7/8 it lies between the bounds by itself, at least .004 above the lower and .05 below the upper: no clamp, no square
 * root; and in T = sigma^2 t it is 2 / sigma times a monic cubic. */
SHI_INLINE void shi_prepare_closure_l1(const float *c, sh_closure *out) {
    const double r0 = (double)c[SH_R0], inverse = 1.0 / r0;
    const double u[3] = { inverse * (double)c[SH_X], inverse * (double)c[SH_Y], inverse * (double)c[SH_Z] };
    const float s = (float)(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    if (!(c[SH_R0] > SHI_BLACK && s <= 1.0f + SHI_UNREAL)) {
        shi_prepare_linear(SH_L1, c, out);
        return;
    }
    const int inside = s <= 0.875f;
    const double unit = inside ? SHI_SIGMA : 2.0;
    const float v2 = (float)(unit * unit), k = inside ? 0.5f * (float)SHI_SIGMA : 1.0f;
    memset(out, 0, sizeof *out);
    out->model = inside ? SHI_CLOSURE_L1 : SHI_CLOSURE_L1_BOUNDED;
    out->scale = (float)(inside ? 2.0 / SHI_SIGMA * r0 : r0);
    shi_set3((float)(unit * u[0]), (float)(unit * u[1]), (float)(unit * u[2]), out->r1);
    out->even[0] = k * (1.0f - s * (5.0f / 8.0f + s * (9.0f / 64.0f + s * (65.0f / 1024.0f))));
    out->even[1] = (inside ? v2 * v2 / 3003.0f : 1.0f / 4096.0f) * (1920.0f + s * (1440.0f + 1365.0f * s));
    out->even[2] = -(inside ? v2 / 3003.0f : 1.0f / 16384.0f) * (1680.0f + 4095.0f * s);
    out->even[3] = shi_larger(4.0f * (1.0f - SHI_ULPS - s), 0.0f);
}

SHI_INLINE float shi_determinant(const float a[6]) {
    return a[0] * (a[3] * a[5] - a[4] * a[4]) - a[1] * (a[1] * a[5] - a[4] * a[2]) + a[2] * (a[1] * a[4] - a[3] * a[2]);
}

/* Whether [[g, sqrt3 u'], [sqrt3 u, g I + 3 A]] has no eigenvalue below about -g/512: Sylvester's criterion on what eliminating
 * the first row of the matrix so shifted leaves. f is A:A. A light has u.u <= g^2 and f <= 2/3 g^2; far beyond, minors that cancel
 * round to either sign. */
SHI_INLINE int shi_is_real(float g, const float u[3], const float a[6], float f) {
    if (!(shi_dot3(u, u) + f <= 2.0f * g * g))
        return 0;
    const float head = g * (1.0f + SHI_UNREAL), k = 3.0f / head;
    const float b[6] = { head + 3.0f * a[0] - k * u[0] * u[0], 3.0f * a[1] - k * u[0] * u[1], 3.0f * a[2] - k * u[0] * u[2],
                         head + 3.0f * a[3] - k * u[1] * u[1], 3.0f * a[4] - k * u[1] * u[2], head + 3.0f * a[5] - k * u[2] * u[2] };
    return b[0] > 0.0f && b[0] * b[3] - b[1] * b[1] > 0.0f && shi_determinant(b) > 0.0f;
}

/* The light but for a constant `ambient` is w = R0 - ambient strong. In units of w, A and u are its moments, and g = R0 / w is R0:
 * E = g + 15/8 q - 105/64 T4 + 3003/1024 T6,  T4 = q^2 - 4/7 a + 2/35 f,  T6 = q (q^2 - 12/11 a + 2/11 f) + 16/77 det A,
 * where q = n'A n, a = |A n|^2, f = A:A; the traceless parts of A (x) A and A (x) A (x) A stand for L4 and L6. For f <= 1/8 it is
 * below the upper bound by itself, by at least .04 (a scan of all eigenvalues and directions; g > 1 only widens the gap): no
 * square root. Returns 0 if no light has these moments. */
SHI_INLINE int shi_prepare_closure_l2(const float *c, float ambient, sh_closure *out) {
    const float r0 = c[SH_R0], w = shi_larger(r0 - ambient, r0 * (1.0f / 1024.0f)), g = r0 / w;
    const float u[3] = { c[SH_X] / w, c[SH_Y] / w, c[SH_Z] / w }, inverse = 1.0f / w;
    float *a = out->r2;
    for (int i = 0; i < 5; i++)
        a[i] = c[SH_XX + i] * inverse;
    a[5] = -(a[0] + a[3]);
    const float f = a[0] * a[0] + a[3] * a[3] + a[5] * a[5] + 2.0f * (a[1] * a[1] + a[2] * a[2] + a[4] * a[4]);
    if (!(r0 > SHI_BLACK && shi_is_real(g, u, a, f)))
        return 0;
    out->model = f <= 0.125f ? SHI_CLOSURE_L2 : SHI_CLOSURE_L2_BOUNDED;
    out->scale = w;
    shi_set3(2.0f * u[0], 2.0f * u[1], 2.0f * u[2], out->r1);
    out->even[0] = g - 3.0f / 32.0f * f + 39.0f / 64.0f * shi_determinant(a);
    out->even[1] = 15.0f / 8.0f + 273.0f / 512.0f * f;
    out->even[2] = 2.0f * g;
    out->even[3] = 2.0f * g * (1.0f / 3.0f - SHI_ULPS);
    return 1;
}

SHI_INLINE void shi_prepare_closure(int order, const float *c, unsigned flags, sh_closure *out) {
    if (order == SH_L0)
        shi_prepare_linear(order, c, out);
    else if (order == SH_L1)
        shi_prepare_closure_l1(c, out);
    else if (!shi_prepare_closure_l2(c, flags & SH_AMBIENT_FLOOR ? shi_larger(sh_ambient_floor(c), 0.0f) : 0.0f, out))
        shi_prepare_linear(order, c, out);
}

SHI_INLINE void sh_closure_prepare(int order, int channels, const float *c, unsigned flags, sh_closure *out) {
    for (int k = 0; k < channels; k++)
        shi_prepare_closure(order, c + k * SH_COUNT(order), flags, out + k);
}

/* r = |R1| / R0 <= 1 and `factor` times the unit direction of R1; 0 if no light has these coefficients. */
SHI_INLINE int shi_prepare_axis(const float *c, float factor, sh_closure *out, float *r) {
    float d[3];
    const float r0 = c[SH_R0], ratio = sh_average_direction(c, d) / r0;
    if (!(r0 > SHI_BLACK && ratio <= 1.0f + SHI_UNREAL))
        return 0;
    memset(out, 0, sizeof *out);
    out->scale = r0;
    shi_set3(factor * d[0], factor * d[1], factor * d[2], out->r1);
    *r = ratio < 1.0f ? ratio : 1.0f;
    return 1;
}

/* (1 - a) (p + 1) = 4r. */
SHI_INLINE void shi_prepare_geomerics(const float *c, sh_closure *out) {
    float r;
    if (!shi_prepare_axis(c, 0.5f, out, &r)) {
        shi_prepare_linear(SH_L1, c, out);
        return;
    }
    out->model = SHI_GEOMERICS;
    out->even[0] = (1.0f - r) / (1.0f + r);
    out->even[1] = 4.0f * r;
    out->even[2] = 1.0f + 2.0f * r;
}

SHI_INLINE void shi_prepare_zh3(const float *c, sh_closure *out) {
    float r;
    if (!shi_prepare_axis(c, 1.0f, out, &r)) {
        shi_prepare_linear(SH_L1, c, out);
        return;
    }
    const float r2 = r * (0.0619677f + 0.804984f * r);
    out->model = SHI_ZH3;
    out->even[0] = 1.0f - 0.625f * r2;
    out->even[1] = 2.0f * r;
    out->even[2] = 1.875f * r2;
}

/* A n, for the upper triangle of A row by row. */
SHI_INLINE void shi_symmetric_times(const float a[6], const float n[3], float out[3]) {
    out[0] = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
    out[1] = a[1] * n[0] + a[3] * n[1] + a[4] * n[2];
    out[2] = a[2] * n[0] + a[4] * n[1] + a[5] * n[2];
}

/* The model's r1.n, rounded once. */
SHI_INLINE float shi_model_odd(const sh_closure *p, const float n[3]) {
    return (float)((double)p->r1[0] * (double)n[0] + (double)p->r1[1] * (double)n[1] + (double)p->r1[2] * (double)n[2]);
}

SHI_INLINE float shi_evaluate_linear(int order, const sh_closure *p, const float n[3]) {
    float an[3], sum = p->even[0] + shi_model_odd(p, n);
    if (order >= SH_L2) {
        shi_symmetric_times(p->r2, n, an);
        sum += shi_dot3(an, n);
    }
    return sum < 0.0f ? 0.0f : sum;
}

/* <t^2> is taken for its rounding error less, so that the bounds of a single direction close on it. */
SHI_INLINE float shi_evaluate_closure(int order, const sh_closure *p, const float n[3]) {
    const float *k = p->even;
    if (p->model == SHI_LINEAR)
        return shi_evaluate_linear(order, p, n);
    const float v = shi_model_odd(p, n);
    float even, upper, lower = fabsf(v);
    if (order <= SH_L1) {
        const float t = v * v;
        if (p->model == SHI_CLOSURE_L1)
            return p->scale * (((t + k[2]) * t + k[1]) * t + k[0] + v);
        even = ((3003.0f / 65536.0f * t + k[2]) * t + k[1]) * t + k[0];
        upper = k[3] + t;
    } else {
        float an[3];
        shi_symmetric_times(p->r2, n, an);
        const float q = shi_dot3(an, n), a = shi_dot3(an, an), m2 = 2.0f * q + k[3];
        even = k[0] + q * (k[1] + q * (3003.0f / 1024.0f * q - 105.0f / 64.0f)) + a * (15.0f / 16.0f - 819.0f / 256.0f * q);
        lower = shi_larger(lower, m2);
        if (p->model == SHI_CLOSURE_L2)
            return p->scale * (shi_larger(even, lower) + v);
        upper = k[2] * m2;
    }
    upper = sqrtf(shi_larger(upper, 0.0f));
    return p->scale * (shi_larger(even < upper ? even : upper, lower) + v);
}

SHI_INLINE float sh_closure_irradiance(int order, const sh_closure *closure, const float n[3]) {
    return shi_evaluate_closure(order, closure, n);
}

SHI_INLINE float sh_irradiance_closure(int order, const float *c, const float n[3]) {
    sh_closure closure;
    shi_prepare_closure(order, c, 0, &closure);
    return shi_evaluate_closure(order, &closure, n);
}

/* In double, so that what is left of 8 ulp is the coefficients' own rounding. */
SHI_INLINE void sh_irradiance_bounds(int order, const float *c, const float n[3], float *lo, float *hi) {
    const double r0 = (double)c[SH_R0], x = (double)n[0], y = (double)n[1], z = (double)n[2];
    sh_closure closure;
    shi_prepare_closure(order, c, 0, &closure);
    if (closure.model == SHI_LINEAR && !(order == SH_L0 && c[SH_R0] > SHI_BLACK)) {
        *lo = *hi = shi_evaluate_linear(order, &closure, n);
        return;
    }
    double m1 = 0.0, lower = 0.0, upper = 2.0 * r0;
    if (order >= SH_L1) {
        const double u[3] = { (double)c[SH_X], (double)c[SH_Y], (double)c[SH_Z] };
        m1 = u[0] * x + u[1] * y + u[2] * z;
        lower = fabs(m1);
        double square = r0 * r0 - (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + m1 * m1;
        if (order >= SH_L2) {
            const double xx = (double)c[SH_XX], yy = (double)c[SH_YY], third = r0 / 3.0;
            const double cross = (double)c[SH_XY] * x * y + (double)c[SH_XZ] * x * z + (double)c[SH_YZ] * y * z;
            const double m2 = (xx + third) * x * x + (yy + third) * y * y + (third - xx - yy) * z * z + 2.0 * cross;
            lower = m2 > lower ? m2 : lower;
            square = r0 * m2;
        }
        square += r0 * r0 * (double)SHI_ULPS;
        upper = square > lower * lower ? sqrt(square) : lower;
    }
    *lo = (float)(2.0 * (lower + m1));
    *hi = (float)(2.0 * (upper + m1));
}

SHI_INLINE float sh_irradiance_geomerics(const float *c, const float n[3]) {
    sh_closure m;
    shi_prepare_geomerics(c, &m);
    if (m.model == SHI_LINEAR)
        return shi_evaluate_linear(SH_L1, &m, n);
    return m.scale * (m.even[0] + m.even[1] * powf(shi_clamp(0.5f + shi_model_odd(&m, n), 0.0f, 1.0f), m.even[2]));
}

SHI_INLINE float sh_irradiance_zh3(const float *c, const float n[3]) {
    sh_closure m;
    shi_prepare_zh3(c, &m);
    if (m.model == SHI_LINEAR)
        return shi_evaluate_linear(SH_L1, &m, n);
    const float v = shi_model_odd(&m, n), sum = m.scale * (m.even[0] + v * (m.even[1] + m.even[2] * v));
    return sum < 0.0f ? 0.0f : sum;
}

/* ---- Extrema, realizability, de-ringing -----------------------------------------------------------------------------------------
 * In the frame of R2's eigenvectors every question is about one sum over three axes and one unknown. In double: the fourth
 * powers of any float are finite, and clustered eigenvalues cost half the digits at worst. */

/* R1 and R2 in the frame of R2's eigenvectors, eigenvalues rising. */
typedef struct shi_quadric {
    double mean, linear[3], value[3], axis[3][3];
} shi_quadric;

SHI_INLINE double shi_dot3d(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

SHI_INLINE void shi_cross(const double a[3], const double b[3], double out[3]) {
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/* cos(acos(r) / 3) for r in [0, 1], the largest root of 4 x^3 - 3 x = r: a Newton step from a fit that is off by 1e-5; error <
 * 2e-10. */
SHI_INLINE double shi_cos_third(double r) {
    const double x = 0.86603 + r * (0.16641 + r * (-0.04592 + r * (0.01751 - r * 0.00404)));
    return x - ((4.0 * x * x - 3.0) * x - r) / (12.0 * x * x - 3.0);
}

/* Two unit vectors that form a right-handed frame with unit w. Duff et al., "Building an Orthonormal Basis, Revisited", 2017. */
SHI_INLINE void shi_complete_frame(const double w[3], double u[3], double v[3]) {
    const double sign = w[2] < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + w[2]), b = w[0] * w[1] * a;
    u[0] = 1.0 + sign * w[0] * w[0] * a;
    u[1] = sign * b;
    u[2] = -sign * w[0];
    v[0] = b;
    v[1] = sign + w[1] * w[1] * a;
    v[2] = -w[1];
}

/* The eigenvalue that is farthest from the others, and its unit eigenvector: of traceless a (rows m) with p^2 = a:a / 6 > 0, it
 * is 2 p cos(acos|r| / 3), with the sign of r = det(a / p) / 2. It is no closer than sqrt(3) p to another one, so that rows of a
 * - value span a plane, whose normal is the largest of their cross products. */
SHI_FUNCTION double shi_isolated_axis(double m[3][3], double p2, double axis[3]) {
    const double p = sqrt(p2);
    double cross[3][3];
    shi_cross(m[1], m[2], cross[0]);
    const double r = 0.5 * shi_dot3d(m[0], cross[0]) / (p2 * p), size = fabs(r) < 1.0 ? fabs(r) : 1.0;
    const double value = (r < 0.0 ? -2.0 : 2.0) * p * shi_cos_third(size);
    double row[3][3], square[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            row[i][j] = m[i][j] - (i == j ? value : 0.0);
    for (int i = 0; i < 3; i++) {
        shi_cross(row[(i + 1) % 3], row[(i + 2) % 3], cross[i]);
        square[i] = shi_dot3d(cross[i], cross[i]);
    }
    const int largest = square[0] >= square[1] && square[0] >= square[2] ? 0 : square[1] >= square[2] ? 1 : 2;
    const double scale = 1.0 / sqrt(square[largest]);
    for (int i = 0; i < 3; i++)
        axis[i] = scale * cross[largest][i];
    return value;
}

/* Turns the orthonormal u and v to the eigenvectors of the matrix within their plane, uu and vv becoming the eigenvalues, uu <=
 * vv. */
SHI_FUNCTION void shi_diagonalize2(double *uu, double uv, double *vv, double u[3], double v[3]) {
    const double half = 0.5 * (*vv - *uu), middle = 0.5 * (*vv + *uu), radius = sqrt(half * half + uv * uv);
    /* v's angle to the upper eigenvector is half that of (half, uv). */
    const double c2 = radius > 0.0 ? half / radius : 1.0, s2 = radius > 0.0 ? uv / radius : 0.0;
    const double greater = sqrt(0.5 * (1.0 + fabs(c2))), lesser = 0.5 * s2 / greater;
    const double c = c2 < 0.0 ? fabs(lesser) : greater, s = c2 < 0.0 ? (s2 < 0.0 ? -greater : greater) : lesser;
    for (int i = 0; i < 3; i++) {
        const double ui = u[i], vi = v[i];
        u[i] = c * ui - s * vi;
        v[i] = c * vi + s * ui;
    }
    *uu = middle - radius;
    *vv = middle + radius;
}

/* Of sign times one channel. */
SHI_INLINE void shi_quadric_init(int order, const float *c, double sign, shi_quadric *q) {
    double m[3][3] = { { 0 } }, p2 = 0.0, image[3], r1[3] = { 0 };
    if (order >= SH_L1)
        for (int i = 0; i < 3; i++)
            r1[i] = sign * (double)c[SH_X + i];
    if (order >= SH_L2) {
        m[0][0] = sign * (double)c[SH_XX];
        m[0][1] = m[1][0] = sign * (double)c[SH_XY];
        m[0][2] = m[2][0] = sign * (double)c[SH_XZ];
        m[1][1] = sign * (double)c[SH_YY];
        m[1][2] = m[2][1] = sign * (double)c[SH_YZ];
        m[2][2] = -(m[0][0] + m[1][1]);
        p2 = (shi_dot3d(m[0], m[0]) + shi_dot3d(m[1], m[1]) + shi_dot3d(m[2], m[2])) / 6.0;
    }
    q->mean = sign * (double)c[SH_R0];
    if (!(p2 > 0.0)) {
        for (int i = 0; i < 3; i++) {
            q->value[i] = p2;
            q->linear[i] = r1[i];
            for (int j = 0; j < 3; j++)
                q->axis[i][j] = i == j;
        }
        return;
    }
    double isolated[3];
    const double value = shi_isolated_axis(m, p2, isolated);
    const int at = value > 0.0 ? 2 : 0;
    double *u = q->axis[at == 0 ? 1 : 0], *v = q->axis[at == 0 ? 2 : 1];
    shi_complete_frame(isolated, u, v);
    for (int i = 0; i < 3; i++) {
        q->axis[at][i] = isolated[i];
        image[i] = shi_dot3d(m[i], u);
    }
    const double uv = shi_dot3d(image, v);
    double uu = shi_dot3d(image, u), vv = -value - uu;
    shi_diagonalize2(&uu, uv, &vv, u, v);
    q->value[at] = value;
    q->value[at == 0 ? 1 : 0] = uu;
    q->value[at == 0 ? 2 : 1] = vv;
    for (int i = 0; i < 3; i++)
        q->linear[i] = shi_dot3d(q->axis[i], r1);
}

/* The minimum over unit x of mean + sum of w1 linear x + w2 value x^2, w1, w2 >= 0: with half = w1 linear / 2 and gap = w2
 * (value - value[0]), x = -half / (gap + t) where |x| = 1, a trust-region subproblem (More and Sorensen, 1983). 1 / |x| is
 * concave and rises with t, so Newton's method on it climbs from any t that is too small, as are those at which one term alone
 * has length 1. If half[0] = 0 and |x| < 1 at t = 0 (the "hard case"), what is missing is along axis 0. The value is that of the
 * Lagrangian, stationary in t. */
SHI_FUNCTION double shi_quadric_min(const shi_quadric *q, double w1, double w2, double x[3]) {
    double half[3], gap[3], t = 0.0, norm2 = 0.0, value;
    for (int i = 0; i < 3; i++) {
        half[i] = 0.5 * w1 * q->linear[i];
        gap[i] = w2 * (q->value[i] - q->value[0]);
        if (fabs(half[i]) - gap[i] > t)
            t = fabs(half[i]) - gap[i];
    }
    for (int step = 0; step < 20; step++) {
        double slope = 0.0;
        norm2 = 0.0;
        value = q->mean + w2 * q->value[0] - t;
        for (int i = 0; i < 3; i++) {
            const double inverse = half[i] != 0.0 ? 1.0 / (gap[i] + t) : 0.0;
            x[i] = -half[i] * inverse;
            value += half[i] * x[i];
            norm2 += x[i] * x[i];
            slope += x[i] * x[i] * inverse;
        }
        if (!(norm2 > 1.0 + 1e-7))
            break;
        t += norm2 * (sqrt(norm2) - 1.0) / slope;
    }
    if (t == 0.0 && norm2 < 1.0) {
        x[0] = sqrt(1.0 - norm2);
        return value;
    }
    const double scale = 1.0 / sqrt(norm2);
    for (int i = 0; i < 3; i++)
        x[i] *= scale;
    return value;
}

/* The minimum of sign * (R0 + w1 R1.n + w2 n'R2 n). */
SHI_INLINE float shi_extremum(int order, const float *c, double sign, double w1, double w2, float at[3]) {
    shi_quadric q;
    double x[3];
    shi_quadric_init(order, c, sign, &q);
    const double value = shi_quadric_min(&q, w1, w2, x);
    if (at)
        for (int i = 0; i < 3; i++)
            at[i] = (float)(x[0] * q.axis[0][i] + x[1] * q.axis[1][i] + x[2] * q.axis[2][i]);
    return (float)(sign * value);
}

SHI_INLINE float sh_min(int order, const float *c, float at[3]) {
    return shi_extremum(order, c, 1.0, 3.0, 7.5, at);
}

SHI_INLINE float sh_max(int order, const float *c, float at[3]) {
    return shi_extremum(order, c, -1.0, 3.0, 7.5, at);
}

SHI_INLINE float sh_irradiance_min(int order, const float *c, float at[3]) {
    return shi_extremum(order, c, 1.0, 2.0, 1.875, at);
}

SHI_INLINE float sh_irradiance_max(int order, const float *c, float at[3]) {
    return shi_extremum(order, c, -1.0, 2.0, 1.875, at);
}

/* base - x + sum of b / (x + g), which falls and is convex in x > 0. */
SHI_INLINE double shi_secular(double base, const double b[3], const double g[3], double x, double *sum1, double *sum2) {
    *sum1 = *sum2 = 0.0;
    for (int i = 0; i < 3; i++) {
        const double inverse = 1.0 / (x + g[i]), term = b[i] * inverse;
        *sum1 += term;
        *sum2 += term * inverse;
    }
    return base - x + *sum1;
}

/* The smallest eigenvalue of the moment matrix is R0 + 3 value[0] - x, where x >= 0 is the root of shi_secular (or 0) for base =
 * 3 value[0], b = 3 linear^2, g = 3 (value - value[0]). The sum is at least total / (x + mean g), and at most total / x: a root
 * for either is a start on its side. Tangents pass below, so that Newton's method leads from either side to the left of the root
 * and climbs. In 1 / x the sum is concave: a tangent there, solved for its zero, descends from the right, and gives Newton's
 * method a fresh start where a pole with a small b makes it slow. Ends when the root is no more than `enough` beyond `left`. */
SHI_FUNCTION float sh_ambient_floor(const float *c) {
    shi_quadric q;
    double g[3], b[3], low1, low2, sum1, sum2;
    shi_quadric_init(SH_L2, c, 1.0, &q);
    for (int i = 0; i < 3; i++) {
        g[i] = 3.0 * (q.value[i] - q.value[0]);
        b[i] = 3.0 * q.linear[i] * q.linear[i];
    }
    const double base = 3.0 * q.value[0], total = b[0] + b[1] + b[2], width = sqrt(base * base + 4.0 * total);
    const double enough = 5e-8 * (fabs(q.mean) + width);
    const double gap = total > 0.0 ? (b[1] * g[1] + b[2] * g[2]) / total : 0.0, sum = gap - base, product = total + base * gap;
    double left = product <= 0.0 ? 0.0 : 2.0 * product / (sum + sqrt(sum * sum + 4.0 * product));
    double right = total > 0.0 ? 2.0 * total / (width - base) : 0.0;
    for (int step = 0; step < 30 && right > enough; step++) {
        const double probe = left + enough, lack = shi_secular(base, b, g, probe, &low1, &low2);
        const double excess = shi_secular(base, b, g, right, &sum1, &sum2);
        if (!(lack > 0.0))
            break;
        const double climb = probe + lack / (1.0 + low2), restart = right + excess / (1.0 + sum2);
        const double pole = right * right * sum2, rest = base + sum1 - right * sum2;
        left = climb > restart ? climb : restart;
        right = 0.5 * (rest + sqrt(rest * rest + 4.0 * pole));
    }
    return (float)(q.mean + base - left);
}

/* Whether symmetric [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] is positive definite: elimination without pivoting, which such a matrix
 * does not need. */
SHI_INLINE int shi_positive_definite(double xx, double xy, double xz, double yy, double yz, double zz) {
    const double inverse = 1.0 / xx, f = inverse * xy, g = inverse * xz;
    yy -= f * xy;
    yz -= f * xz;
    zz -= g * xz;
    return xx > 0.0 && yy > 0.0 && zz - yz / yy * yz > 0.0;
}

/* Whether light that is nowhere negative has these coefficients, but for `slack` R0: |R1| <= R0, and the ambient floor is not negative,
 * that is, what eliminating R0 from [[R0, R1'], [R1, R2 + I/3 R0]] leaves is positive definite. */
SHI_FUNCTION int shi_realizable(int order, const float *c, double slack) {
    const double r0 = (double)c[SH_R0] * (1.0 + slack);
    if (order == SH_L0 || !(r0 >= 0.0))
        return r0 >= 0.0;
    const double x = (double)c[SH_X], y = (double)c[SH_Y], z = (double)c[SH_Z];
    if (order == SH_L1)
        return x * x + y * y + z * z <= r0 * r0;
    const double xx = (double)c[SH_XX], xy = (double)c[SH_XY], xz = (double)c[SH_XZ], yy = (double)c[SH_YY], yz = (double)c[SH_YZ];
    if (r0 > 0.0) {
        const double third = r0 * (1.0 / 3.0), inverse = 1.0 / r0, u = inverse * x, v = inverse * y, w = inverse * z;
        return shi_positive_definite(xx + third - u * x, xy - u * y, xz - u * z, yy + third - v * y, yz - v * z, third - xx - yy - w * z);
    }
    return x == 0.0 && y == 0.0 && z == 0.0 && xx == 0.0 && xy == 0.0 && xz == 0.0 && yy == 0.0 && yz == 0.0;
}

SHI_INLINE int sh_is_realizable(int order, const float *c) {
    return shi_realizable(order, c, 1e-6);
}

/* Not the macro INFINITY: clang warns of it under -ffast-math. */
SHI_INLINE float shi_infinity(void) {
    const uint32_t bits = 0x7f800000u;
    float a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* Strength s in [0, 1], none to all, as the parameter of a family. */
SHI_INLINE float shi_window_parameter(sh_window window, double s) {
    if (window == SH_WINDOW_LAPLACIAN)
        return s < 1.0 ? (float)(s / (1.0 - s)) : shi_infinity();
    return s > 0.0 ? (float)(1.0 / s) : shi_infinity();
}

SHI_INLINE void shi_window_zonal(sh_window window, float parameter, float zonal[3]) {
    switch (window) {
    case SH_WINDOW_HANN: sh_zonal_hann(parameter, zonal); break;
    case SH_WINDOW_LANCZOS: sh_zonal_lanczos(parameter, zonal); break;
    default: sh_zonal_laplacian(parameter, zonal); break;
    }
}

/* R0 + 3 z1 R1.n + 15/2 z2 n'R2 n under a window of strength s, at one n: at[0] + z1 at[1] + z2 at[2]. */
SHI_FUNCTION double shi_windowed(const double at[3], sh_window window, double s) {
    float zonal[3];
    shi_window_zonal(window, shi_window_parameter(window, s), zonal);
    return at[0] + at[1] * (double)zonal[1] + at[2] * (double)zonal[2];
}

/* The strength above s from which on shi_windowed is not negative, as it is at s; its parameter is within 2e-5. There is one: z1 falls
 * to 0 as s rises to 1, where at[0] >= 0 is left, and z2 is a convex function of z1 in each family, so that the sum is convex or
 * concave in z1 and crosses 0 once. By regula falsi; an end that stays twice counts half ("Illinois"). */
SHI_FUNCTION double shi_strength_where(const double at[3], sh_window window, double s) {
    double weak = s, strong = 1.0, below = shi_windowed(at, window, s), above = at[0];
    for (int step = 0, stayed = 0; step < 60 && strong - weak > 2e-5 * strong * (1.0 - strong); step++) {
        const double secant = (weak * above - strong * below) / (above - below), least = 1e-5 * strong * (1.0 - strong);
        const double middle = secant < weak + least ? weak + least : secant > strong - least ? strong - least : secant;
        const double value = shi_windowed(at, window, middle);
        if (value < 0.0) {
            weak = middle;
            below = value;
            above *= stayed > 0 ? 0.5 : 1.0;
            stayed = 1;
        } else {
            strong = middle;
            above = value;
            below *= stayed < 0 ? 0.5 : 1.0;
            stayed = -1;
        }
    }
    return strong;
}

/* The weakest strength from s on that leaves a channel nowhere negative, by more than 4 ulp of R0. Where a strength leaves a negative
 * minimum, all up to the one that mends this direction do: no weaker one is passed over. */
SHI_FUNCTION double shi_strength_needed(const shi_quadric *q, sh_window window, double s) {
    if (!(q->mean >= 0.0))
        return s;
    for (int step = 0; step < 40; step++) {
        double x[3], at[3] = { q->mean, 0.0, 0.0 };
        float zonal[3];
        shi_window_zonal(window, shi_window_parameter(window, s), zonal);
        if (!(shi_quadric_min(q, 3.0 * (double)zonal[1], 7.5 * (double)zonal[2], x) < -q->mean / 4194304.0)) /* 2^22 */
            return s;
        for (int i = 0; i < 3; i++) {
            at[1] += 3.0 * q->linear[i] * x[i];
            at[2] += 7.5 * q->value[i] * x[i] * x[i];
        }
        s = shi_strength_where(at, window, s);
    }
    return 1.0;
}

/* A stronger window can bring back the ringing of a channel that an earlier pass had passed, since bands fade at different rates; a
 * pass without change ends the search, and the strongest window does after eight that had some. */
SHI_INLINE float sh_dering(int order, int channels, const float *c, sh_window window, float *out) {
    double s = 0.0, before = -1.0;
    for (int pass = 0; pass < 9 && s > before; pass++) {
        before = s;
        for (int k = 0; k < channels; k++) {
            shi_quadric q;
            shi_quadric_init(order, c + k * SH_COUNT(order), 1.0, &q);
            s = shi_strength_needed(&q, window, s);
        }
    }
    if (s > before)
        s = 1.0;
    const float parameter = shi_window_parameter(window, s);
    float zonal[3];
    shi_window_zonal(window, parameter, zonal);
    for (int k = 0; k < channels; k++)
        sh_convolve(order, c + k * SH_COUNT(order), zonal, out + k * SH_COUNT(order));
    return parameter;
}

/* Bounds of |R1| and of the largest |eigenvalue| of R2, of the difference of two sets (b may be NULL). In double no square
 * overflows. */
SHI_INLINE void shi_band_bounds(int order, const float *a, const float *b, double bound[3]) {
    double d[SH_COUNT(SH_L2)] = { 0 };
    for (int i = 0; i < SH_COUNT(order); i++)
        d[i] = (double)a[i] - (b ? (double)b[i] : 0.0);
    const double half = d[SH_XX] * d[SH_XX] + d[SH_YY] * d[SH_YY] + d[SH_XX] * d[SH_YY] + d[SH_XY] * d[SH_XY] + d[SH_XZ] * d[SH_XZ] +
                        d[SH_YZ] * d[SH_YZ];
    bound[0] = fabs(d[SH_R0]);
    bound[1] = sqrt(shi_dot3d(d + SH_X, d + SH_X));
    bound[2] = sqrt(4.0 / 3.0 * half);
}

SHI_INLINE int shi_order_for(const float *c, double w1, double w2, float tolerance) {
    double bound[3];
    shi_band_bounds(SH_L2, c, NULL, bound);
    const double without_r2 = w2 * bound[2], without_both = without_r2 + w1 * bound[1];
    return without_both <= (double)tolerance ? SH_L0 : without_r2 <= (double)tolerance ? SH_L1 : SH_L2;
}

SHI_FUNCTION int sh_order_needed(const float *c, float tolerance) {
    return shi_order_for(c, 2.0, 1.875, tolerance);
}

SHI_FUNCTION int sh_radiance_order_needed(const float *c, float tolerance) {
    return shi_order_for(c, 3.0, 7.5, tolerance);
}

SHI_FUNCTION int shi_probe_order(int channels, const float *c, float tolerance) {
    int order = SH_L0;
    for (int k = 0; k < channels && order < SH_L2; k++) {
        const int needed = sh_order_needed(c + k * SH_COUNT(SH_L2), tolerance);
        order = needed > order ? needed : order;
    }
    return order;
}

SHI_FUNCTION void sh_group_by_order(int channels, const float *c, size_t count, float tolerance, size_t *index, size_t first[4]) {
    const size_t stride = (size_t)channels * SH_COUNT(SH_L2);
    size_t next[4] = { 0, 0, 0, 0 };
    for (size_t i = 0; i < count; i++)
        next[shi_probe_order(channels, c + i * stride, tolerance) + 1]++;
    for (int o = 0; o < 3; o++)
        next[o + 1] += next[o];
    memcpy(first, next, sizeof next);
    for (size_t i = 0; i < count; i++)
        index[next[shi_probe_order(channels, c + i * stride, tolerance)]++] = i;
}

SHI_INLINE int sh_is_grey(int order, int channels, const float *c, float tolerance) {
    for (int k = 1; k < channels; k++) {
        double bound[3];
        shi_band_bounds(order, c, c + k * SH_COUNT(order), bound);
        if (!(bound[0] + 2.0 * bound[1] + 1.875 * bound[2] <= (double)tolerance))
            return 0;
    }
    return 1;
}

/* 17/4 = 1 + 2 + 15/8 * 2/3. */
SHI_INLINE int sh_skip_light(float value, float *budget) {
    const double rest = (double)*budget - 4.25 * fabs((double)value);
    if (!(rest >= 0.0))
        return 0;
    *budget = (float)rest;
    if ((double)*budget > rest) /* never rounded up: any number of lights spend what they cost */
        *budget -= *budget * (1.0f / 8388608.0f);
    return 1;
}

/* Averaging a texel's light changes irradiance at n by the integral over the texel of the light times K - (mean of K), K the
 * reconstruction's kernel 1 + 2t + 15/8 (t^2 - 1/3), t = n.w: at most the light's share of R0 times K's steepest slope over the
 * angle (L1: 2; L2: 3.402, at t = .588) times the mean distance from a corner to the rest of the texel, .766 of the side of a
 * square. .8 covers the texels that are wider at one end. The widest sides are pi / height and 2 / width. */
SHI_INLINE int shi_size_for(int order, double side, float tolerance) {
    const double slope = order == SH_L0 ? 0.0 : order == SH_L1 ? 2.0 : 3.402, needed = 0.8 * slope * side;
    const int most = 1 << 24;
    int size = needed <= (double)tolerance * most ? 1 : most; /* NaN asks for the most */
    while (size < most && needed > (double)tolerance * size)
        size *= 2;
    return size;
}

SHI_FUNCTION int sh_equirect_size_for(int order, float tolerance) {
    return shi_size_for(order, SHI_PI, tolerance);
}

SHI_FUNCTION int sh_cubemap_size_for(int order, float tolerance) {
    return shi_size_for(order, 2.0, tolerance);
}

/* ---- Projection from samples and functions -------------------------------------------------------------------------------------- */

SHI_FUNCTION void sh_accum_clear(int channels, sh_accum *accum) {
    for (int k = 0; k < channels; k++) {
        for (int i = 0; i < SH_COUNT(SH_L2); i++)
            accum[k].sum[i] = 0.0;
        accum[k].weight = 0.0;
    }
}

SHI_INLINE void shi_accum_sample(int order, const float dir[3], double value, double weight, sh_accum *accum) {
    const double x = (double)dir[0], y = (double)dir[1], z = (double)dir[2], third = 1.0 / 3.0, v = weight * value;
    double *sum = accum->sum;
    accum->weight += weight;
    sum[SH_R0] += v;
    if (order >= SH_L1) {
        sum[SH_X] += v * x;
        sum[SH_Y] += v * y;
        sum[SH_Z] += v * z;
    }
    if (order >= SH_L2) {
        sum[SH_XX] += v * (x * x - third);
        sum[SH_XY] += v * (x * y);
        sum[SH_XZ] += v * (x * z);
        sum[SH_YY] += v * (y * y - third);
        sum[SH_YZ] += v * (y * z);
    }
}

SHI_INLINE void sh_accum_sample(int order, const float dir[3], float value, float weight, sh_accum *accum) {
    shi_accum_sample(order, dir, (double)value, (double)weight, accum);
}

SHI_FUNCTION void sh_accum_merge(int channels, const sh_accum *from, sh_accum *into) {
    for (int k = 0; k < channels; k++) {
        for (int i = 0; i < SH_COUNT(SH_L2); i++)
            into[k].sum[i] += from[k].sum[i];
        into[k].weight += from[k].weight;
    }
}

SHI_FUNCTION void sh_accum_finish(int order, int channels, const sh_accum *accum, float *c) {
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < SH_COUNT(order); i++)
            c[k * SH_COUNT(order) + i] = accum[k].weight != 0.0 ? (float)(accum[k].sum[i] / accum[k].weight) : 0.0f;
}

SHI_FUNCTION void sh_accum_total(int order, int channels, const sh_accum *accum, float *c) {
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < SH_COUNT(order); i++)
            c[k * SH_COUNT(order) + i] = (float)accum[k].sum[i];
}

SHI_INLINE int shi_order_ok(int order) {
    return order >= SH_L0 && order <= SH_L2;
}

/* Node i of n of Gauss-Legendre quadrature on [-1, 1], descending, by Newton's method on P_n; returns its weight (they sum to 2). */
SHI_FUNCTION double shi_gauss_legendre(int i, int n, double *node) {
    double x = cos(SHI_PI * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 6; step++) {
        double p0 = 1.0, p1 = x;
        for (int l = 2; l <= n; l++) {
            const double p2 = ((2 * l - 1) * x * p1 - (l - 1) * p0) / l;
            p0 = p1;
            p1 = p2;
        }
        slope = n * (p0 - x * p1) / (1.0 - x * x);
        x -= p1 / slope;
    }
    *node = x;
    return 2.0 / ((1.0 - x * x) * slope * slope);
}

SHI_INLINE void shi_polar_direction(double z, double azimuth, float dir[3]) {
    const double s = sqrt(z * z < 1.0 ? 1.0 - z * z : 0.0);
    shi_set3((float)(s * cos(azimuth)), (float)(s * sin(azimuth)), (float)z, dir);
}

SHI_FUNCTION int sh_project_function(int order, int channels, sh_function f, void *user, int degree, float *c) {
    if (!shi_order_ok(order) || channels < 1 || channels > SH_MAX_CHANNELS || !f || degree < 0 || degree > 1000 || !c)
        return SH_ERROR_ARGUMENT;
    const int rows = (degree + order) / 2 + 1, columns = degree + order + 1;
    sh_accum accum[SH_MAX_CHANNELS];
    sh_accum_clear(channels, accum);
    for (int i = 0; i < rows; i++) {
        double z;
        const double weight = shi_gauss_legendre(i, rows, &z);
        for (int j = 0; j < columns; j++) {
            float dir[3], value[SH_MAX_CHANNELS];
            shi_polar_direction(z, 2.0 * SHI_PI * (j + 0.5) / columns, dir);
            f(dir, value, user);
            for (int k = 0; k < channels; k++)
                shi_accum_sample(order, dir, (double)value[k], weight, accum + k);
        }
    }
    sh_accum_finish(order, channels, accum, c);
    return SH_OK;
}

/* A bijective hash of 32 bits whose output bits each depend on all input bits (multiply and xor-shift, as in MurmurHash3's finish). */
SHI_INLINE uint32_t shi_hash(uint32_t x) {
    x = (x ^ (x >> 16)) * 0x85ebca6bu;
    x = (x ^ (x >> 13)) * 0xc2b2ae35u;
    return x ^ (x >> 16);
}

/* Maps two uniform 32-bit fractions to a direction, area-preserving. */
SHI_INLINE void shi_square_direction(double u, double v, float dir[3]) {
    shi_polar_direction(1.0 - 2.0 * v, 2.0 * SHI_PI * u, dir);
}

SHI_FUNCTION void sh_direction_stratified(uint32_t i, uint32_t columns, uint32_t rows, uint32_t seed, float dir[3]) {
    const double unit = 1.0 / 4294967296.0; /* 2^-32 */
    const uint32_t a = shi_hash(i ^ shi_hash(seed)), b = shi_hash(a ^ 0x9e3779b9u);
    shi_square_direction((i % columns + (a + 0.5) * unit) / columns, (i / columns % rows + (b + 0.5) * unit) / rows, dir);
}

SHI_FUNCTION void sh_direction_sequence(uint32_t i, uint32_t seed, float dir[3]) {
    const double unit = 1.0 / 4294967296.0; /* 2^-32 */
    const uint32_t a = shi_hash(seed), b = shi_hash(a ^ 0x9e3779b9u);
    /* 2^32 / g and 2^32 / g^2, where g^3 = g + 1; unsigned arithmetic takes the fraction exactly. */
    const uint32_t u = a + i * 3242174889u, v = b + i * 2447445414u;
    shi_square_direction((u + 0.5) * unit, (v + 0.5) * unit, dir);
}

SHI_FUNCTION void sh_direction_fibonacci(uint32_t i, uint32_t count, float dir[3]) {
    const double golden = 0.61803398874989484820; /* (sqrt 5 - 1) / 2 */
    const double turns = i * golden;
    shi_square_direction(turns - floor(turns), (i + 0.5) / count, dir);
}

/* ---- Operators ------------------------------------------------------------------------------------------------------------------ */

SHI_INLINE void sh_product(int order, const float *a, const float *b, float *out) {
    const float a0 = a[SH_R0], b0 = b[SH_R0];
    if (order < SH_L1) {
        out[SH_R0] = a0 * b0;
        return;
    }
    const float ax = a[SH_X], ay = a[SH_Y], az = a[SH_Z], bx = b[SH_X], by = b[SH_Y], bz = b[SH_Z];
    const float x = ax * bx, y = ay * by, z = az * bz, dot = x + y + z;
    if (order < SH_L2) {
        out[SH_R0] = a0 * b0 + 3.0f * dot;
        out[SH_X] = a0 * bx + b0 * ax;
        out[SH_Y] = a0 * by + b0 * ay;
        out[SH_Z] = a0 * bz + b0 * az;
        return;
    }
    const float axx = a[SH_XX], axy = a[SH_XY], axz = a[SH_XZ], ayy = a[SH_YY], ayz = a[SH_YZ], azz = -(axx + ayy);
    const float bxx = b[SH_XX], bxy = b[SH_XY], bxz = b[SH_XZ], byy = b[SH_YY], byz = b[SH_YZ], bzz = -(bxx + byy);
    /* Diagonal of AB, and twice the rest of its symmetric part by A's and B's zero trace. */
    const float xy = axy * bxy, xz = axz * bxz, yz = ayz * byz;
    const float sxx = axx * bxx + xy + xz, syy = ayy * byy + xy + yz, szz = azz * bzz + xz + yz, trace = sxx + syy + szz;
    const float sxy = axz * byz + ayz * bxz - axy * bzz - bxy * azz;
    const float sxz = axy * byz + ayz * bxy - axz * byy - bxz * ayy;
    const float syz = axy * bxz + axz * bxy - ayz * bxx - byz * axx;
    const float isotropic = -0.4f * dot - 10.0f / 7.0f * trace; /* what dev() takes from the diagonal */
    out[SH_R0] = a0 * b0 + 3.0f * dot + 7.5f * trace;
    out[SH_X] = a0 * bx + b0 * ax + 3.0f * (axx * bx + axy * by + axz * bz + bxx * ax + bxy * ay + bxz * az);
    out[SH_Y] = a0 * by + b0 * ay + 3.0f * (axy * bx + ayy * by + ayz * bz + bxy * ax + byy * ay + byz * az);
    out[SH_Z] = a0 * bz + b0 * az + 3.0f * (axz * bx + ayz * by + azz * bz + bxz * ax + byz * ay + bzz * az);
    out[SH_XX] = a0 * bxx + b0 * axx + 1.2f * x + 30.0f / 7.0f * sxx + isotropic;
    out[SH_XY] = a0 * bxy + b0 * axy + 0.6f * (ax * by + ay * bx) + 15.0f / 7.0f * sxy;
    out[SH_XZ] = a0 * bxz + b0 * axz + 0.6f * (ax * bz + az * bx) + 15.0f / 7.0f * sxz;
    out[SH_YY] = a0 * byy + b0 * ayy + 1.2f * y + 30.0f / 7.0f * syy + isotropic;
    out[SH_YZ] = a0 * byz + b0 * ayz + 0.6f * (ay * bz + az * by) + 15.0f / 7.0f * syz;
}

/* m R2 m': of the rows of m R2, only the first two are needed. */
SHI_INLINE void shi_rotate_second(const float *c, const float m[9], float *out) {
    const float xx = c[SH_XX], xy = c[SH_XY], xz = c[SH_XZ], yy = c[SH_YY], yz = c[SH_YZ], zz = -(xx + yy);
    const float px = m[0] * xx + m[1] * xy + m[2] * xz, qx = m[3] * xx + m[4] * xy + m[5] * xz;
    const float py = m[0] * xy + m[1] * yy + m[2] * yz, qy = m[3] * xy + m[4] * yy + m[5] * yz;
    const float pz = m[0] * xz + m[1] * yz + m[2] * zz, qz = m[3] * xz + m[4] * yz + m[5] * zz;
    out[SH_XX] = px * m[0] + py * m[1] + pz * m[2];
    out[SH_XY] = px * m[3] + py * m[4] + pz * m[5];
    out[SH_XZ] = px * m[6] + py * m[7] + pz * m[8];
    out[SH_YY] = qx * m[3] + qy * m[4] + qz * m[5];
    out[SH_YZ] = qx * m[6] + qy * m[7] + qz * m[8];
}

SHI_INLINE void sh_rotate(int order, const float *c, const float m[9], float *out) {
    out[SH_R0] = c[SH_R0];
    if (order >= SH_L1) {
        const float v[3] = { c[SH_X], c[SH_Y], c[SH_Z] };
        shi_set3(shi_dot3(m, v), shi_dot3(m + 3, v), shi_dot3(m + 6, v), out + SH_X);
    }
    if (order >= SH_L2)
        shi_rotate_second(c, m, out);
}

SHI_FUNCTION void sh_rotation_from_quaternion(const float q[4], float m[9]) {
    const double x = (double)q[0], y = (double)q[1], z = (double)q[2], w = (double)q[3];
    const double square = x * x + y * y + z * z + w * w, s = square == 0.0 ? 0.0 : 2.0 / square;
    shi_set3((float)(1 - s * (y * y + z * z)), (float)(s * (x * y - w * z)), (float)(s * (x * z + w * y)), m);
    shi_set3((float)(s * (x * y + w * z)), (float)(1 - s * (x * x + z * z)), (float)(s * (y * z - w * x)), m + 3);
    shi_set3((float)(s * (x * z - w * y)), (float)(s * (y * z + w * x)), (float)(1 - s * (x * x + y * y)), m + 6);
}

SHI_INLINE void sh_swap_axes(int order, const float *c, const int axis[3], float *out) {
    int from[3];
    float sign[3];
    for (int i = 0; i < 3; i++) {
        from[i] = (axis[i] < 0 ? -axis[i] : axis[i]) - 1;
        sign[i] = axis[i] < 0 ? -1.0f : 1.0f;
    }
    out[SH_R0] = c[SH_R0];
    if (order >= SH_L1) {
        const float v[3] = { c[SH_X], c[SH_Y], c[SH_Z] };
        for (int i = 0; i < 3; i++)
            out[SH_X + i] = sign[i] * v[from[i]];
    }
    if (order >= SH_L2) {
        const float diagonal[3] = { c[SH_XX], c[SH_YY], -(c[SH_XX] + c[SH_YY]) };
        const float rest[4] = { 0.0f, c[SH_XY], c[SH_XZ], c[SH_YZ] }; /* of axes i and j: at i + j */
        out[SH_XX] = diagonal[from[0]];
        out[SH_XY] = sign[0] * sign[1] * rest[from[0] + from[1]];
        out[SH_XZ] = sign[0] * sign[2] * rest[from[0] + from[2]];
        out[SH_YY] = diagonal[from[1]];
        out[SH_YZ] = sign[1] * sign[2] * rest[from[1] + from[2]];
    }
}

SHI_INLINE void sh_z_up_to_y_up(int order, const float *c, float *out) {
    const int axis[3] = { 1, 3, -2 };
    sh_swap_axes(order, c, axis, out);
}

SHI_INLINE void sh_y_up_to_z_up(int order, const float *c, float *out) {
    const int axis[3] = { 1, -3, 2 };
    sh_swap_axes(order, c, axis, out);
}

SHI_INLINE float sh_radiance_zonal(int order, const float *c, const float zonal[3], const float dir[3]) {
    return shi_reconstruct(order, c, dir, zonal[0], 3.0f * zonal[1], 7.5f * zonal[2]);
}

SHI_INLINE void sh_reflect(const float view[3], const float n[3], float out[3]) {
    const float twice = 2.0f * shi_dot3(n, view);
    shi_set3(twice * n[0] - view[0], twice * n[1] - view[1], twice * n[2] - view[2], out);
}

SHI_FUNCTION void sh_zonal_cosine_power(float exponent, float zonal[3]) {
    const float k2 = exponent < 1.0f ? exponent / (exponent + 3.0f) : 1.0f - 3.0f / (exponent + 3.0f); /* infinity: 1 */
    shi_set3(1.0f, 1.0f - 1.0f / (exponent + 2.0f), k2, zonal);
}

SHI_FUNCTION void sh_zonal_sharpness(float sharpness, float zonal[3]) {
    shi_set3(1.0f, sharpness / 3.0f, 0.0f, zonal);
}

/* J[k - 1] = integral over [0, 1] of t^k / (1 - q t)^2, k = 1, 2, 3; rest = 1 - q. By q J[k] = J[k - 1] - I[k - 1], where I[k] is the
 * integral of t^k / (1 - q t); it cancels for small q: there, the sum of (n + 1) q^n / (n + k + 1), below 1e-12 from n = 48 on. */
SHI_FUNCTION void shi_ggx_integrals(double q, double rest, double J[3]) {
    if (q < 0.5) {
        double power = 1.0;
        J[0] = J[1] = J[2] = 0.0;
        for (int n = 0; n < 48; n++, power *= q)
            for (int k = 1; k <= 3; k++)
                J[k - 1] += (n + 1) * power / (n + k + 1);
        return;
    }
    const double i0 = -log(rest) / q, i1 = (i0 - 1.0) / q, i2 = (i1 - 0.5) / q;
    J[0] = (1.0 / rest - i0) / q;
    J[1] = (J[0] - i1) / q;
    J[2] = (J[1] - i2) / q;
}

/* The half vector h between normal and light has h.n^2 = (1 + t)/2, so D(h) ~ (1 - q t)^-2 with q = (1 - a^2) / (1 + a^2). */
SHI_FUNCTION void sh_zonal_ggx(float alpha, float zonal[3]) {
    const double a = (double)shi_clamp(alpha, 0.0f, 1.0f), aa = a * a;
    double J[3] = { 1.0, 1.0, 1.0 };
    if (!(a <= 1e-9)) /* NaN: NaN */
        shi_ggx_integrals((1.0 - aa) / (1.0 + aa), 2.0 * aa / (1.0 + aa), J);
    shi_set3(1.0f, (float)(J[1] / J[0]), (float)(1.5 * J[2] / J[0] - 0.5), zonal);
}

/* ---- Lights --------------------------------------------------------------------------------------------------------------------- */

/* Two statements, which only compilers that fuse vectors' sums as well make one: L0 and L1, whose sets are added to in scalars, are the
 * first of L2's to the bit. */
SHI_INLINE void shi_add_scaled(float value, float lobe, float *c) {
    const float product = value * lobe;
    *c += product;
}

/* Adds value[k] * lobe to channel k. Written out, for compilers that do not unroll. */
SHI_INLINE void shi_add_lobe(int order, int channels, const float *lobe, const float *value, float *c) {
    for (int k = 0; k < channels; k++, c += SH_COUNT(order)) {
        const float v = value[k];
        shi_add_scaled(v, lobe[SH_R0], c + SH_R0);
        if (order >= SH_L1) {
            shi_add_scaled(v, lobe[SH_X], c + SH_X);
            shi_add_scaled(v, lobe[SH_Y], c + SH_Y);
            shi_add_scaled(v, lobe[SH_Z], c + SH_Z);
        }
        if (order >= SH_L2) {
            shi_add_scaled(v, lobe[SH_XX], c + SH_XX);
            shi_add_scaled(v, lobe[SH_XY], c + SH_XY);
            shi_add_scaled(v, lobe[SH_XZ], c + SH_XZ);
            shi_add_scaled(v, lobe[SH_YY], c + SH_YY);
            shi_add_scaled(v, lobe[SH_YZ], c + SH_YZ);
        }
    }
}

/* Adds value[k] * the zonal lobe about dir. */
SHI_INLINE void shi_add_zonal_scalar(int order, int channels, const float zonal[3], const float dir[3], const float *value, float *c) {
    const float x = dir[0], y = dir[1], z = dir[2], k1 = zonal[1], k2 = zonal[2], third = 1.0f / 3.0f;
    const float lobe[9] = { zonal[0],  k1 * x,        k1 * y, k1 * z, k2 * (x * x - third), k2 * (x * y), k2 * (x * z),
                            k2 * (y * y - third), k2 * (y * z) };
    shi_add_lobe(order, channels, lobe, value, c);
}

/* The same, on vectors where there are any: defined with them. */
SHI_INLINE void shi_add_zonal(int order, int channels, const float zonal[3], const float dir[3], const float *value, float *c);
#ifdef SH_NO_BATCH
SHI_INLINE void shi_add_zonal(int order, int channels, const float zonal[3], const float dir[3], const float *value, float *c) {
    shi_add_zonal_scalar(order, channels, zonal, dir, value, c);
}
#endif

SHI_INLINE void sh_add_ambient(int order, int channels, const float *radiance, float *c) {
    for (int k = 0; k < channels; k++)
        c[k * SH_COUNT(order)] += radiance[k];
}

SHI_INLINE void sh_add_directional(int order, int channels, const float dir[3], const float *irradiance, float *c) {
    const float zonal[3] = { 0.25f, 0.25f, 0.25f };
    shi_add_zonal(order, channels, zonal, dir, irradiance, c);
}

SHI_INLINE void sh_add_hemisphere(int order, int channels, const float up[3], const float *sky, const float *ground, float *c) {
    for (int k = 0; k < channels; k++, c += SH_COUNT(order)) {
        c[SH_R0] += 0.5f * sky[k] + 0.5f * ground[k];
        if (order >= SH_L1)
            for (int i = 0; i < 3; i++)
                c[SH_X + i] += (0.25f * sky[k] - 0.25f * ground[k]) * up[i];
    }
}

/* The lobe of a cap with h = 1 - cos(half-angle), which is exact where the cosine has lost the angle. */
SHI_INLINE void shi_cap_lobe(float h, sh_unit unit, float zonal[3]) {
    if (unit == SH_IRRADIANCE && h < 1.0f)
        shi_set3(0.5f / (2.0f - h), 0.25f, 0.25f * (1.0f - h), zonal);
    else
        shi_set3(0.5f * h, 0.25f * h * (2.0f - h), 0.25f * (1.0f - h) * h * (2.0f - h), zonal);
}

SHI_INLINE void sh_add_cap(int order, int channels, const float dir[3], float half_angle, sh_unit unit, const float *value, float *c) {
    const float s = sinf(0.5f * shi_clamp(half_angle, 0.0f, (float)SHI_PI));
    float zonal[3];
    shi_cap_lobe(2.0f * s * s, unit, zonal);
    shi_add_zonal(order, channels, zonal, dir, value, c);
}

SHI_INLINE void sh_add_sphere(int order, int channels, const float center[3], float radius, sh_unit unit, const float *value, float *c) {
    const double x = (double)center[0], y = (double)center[1], z = (double)center[2], r = (double)radius;
    const double square = x * x + y * y + z * z;
    float zonal[3], dir[3] = { 0.0f, 0.0f, 1.0f };
    if (square <= r * r)
        shi_set3(r > 0.0 || unit == SH_IRRADIANCE ? 1.0f : 0.0f, 0.0f, 0.0f, zonal);
    else {
        const double inverse = 1.0 / sqrt(square), sine = r * inverse, ss = sine * sine;
        shi_set3((float)(x * inverse), (float)(y * inverse), (float)(z * inverse), dir);
        shi_cap_lobe((float)(ss / (1.0 + sqrt(1.0 - ss))), unit, zonal);
    }
    shi_add_zonal(order, channels, zonal, dir, value, c);
}

/* For a lobe of mean 1, the peak is 2K / (1 - exp(-2K)), facing irradiance / pi 4 (K - 1 + exp(-K)) / (K (1 - exp(-2K))); below
 * K = 1/1000, their series. */
SHI_FUNCTION void sh_add_vmf(int order, int channels, const float dir[3], float sharpness, sh_unit unit, const float *value, float *c) {
    const double k = (double)sharpness, rest = -expm1(-2.0 * k);
    const double peak = k < 1e-3 ? 1.0 + k + k * k / 3.0 : 2.0 * k / rest;
    const double facing = k < 1e-3 ? 1.0 + 2.0 / 3.0 * k + k * k / 12.0 : 4.0 * (k + expm1(-k)) / (k * rest);
    const double mean = 1.0 / (unit == SH_RADIANCE ? peak : facing);
    float zonal[3];
    sh_zonal_vmf(sharpness, zonal);
    shi_set3((float)mean, (float)(mean * (double)zonal[1]), (float)(mean * (double)zonal[2]), zonal);
    shi_add_zonal(order, channels, zonal, dir, value, c);
}

/* out = a + t b */
SHI_INLINE void shi_along(const double a[3], double t, const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = a[i] + t * b[i];
}

SHI_INLINE void shi_widen(const float a[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i];
}

/* Adds radiance times a light's moments of radiance 1, given as integrals over the sphere. */
SHI_FUNCTION void shi_add_integral(int order, int channels, const double integral[9], const float *radiance, float *c) {
    float lobe[9];
    for (int i = 0; i < 9; i++)
        lobe[i] = (float)(integral[i] / (4.0 * SHI_PI));
    shi_add_lobe(order, channels, lobe, radiance, c);
}

/* integral = solid_angle * basis(p / |p|): a light too small to have a shape. */
SHI_FUNCTION void shi_point_integral(const double p[3], double solid_angle, double integral[9]) {
    const double square = shi_dot3d(p, p), inverse = square > 0.0 ? 1.0 / sqrt(square) : 0.0;
    const double x = p[0] * inverse, y = p[1] * inverse, z = p[2] * inverse, third = square > 0.0 ? 1.0 / 3.0 : 0.0;
    const double basis[9] = { 1.0, x, y, z, x * x - third, x * y, x * z, y * y - third, y * z };
    for (int i = 0; i < 9; i++)
        integral[i] = solid_angle * basis[i];
}

/* The part of R1 and R2 of a piece of a light's outline: f = integral of the inward normal along it, and of sym(inward u'). */
SHI_INLINE void shi_outline_add(const double f[3], const double n[3], const double g[3], double integral[9]) {
    for (int i = 0; i < 3; i++)
        integral[SH_X + i] += f[i] / 2.0;
    integral[SH_XX] += n[0] * g[0] / 3.0;
    integral[SH_XY] += (n[0] * g[1] + n[1] * g[0]) / 6.0;
    integral[SH_XZ] += (n[0] * g[2] + n[2] * g[0]) / 6.0;
    integral[SH_YY] += n[1] * g[1] / 3.0;
    integral[SH_YZ] += (n[1] * g[2] + n[2] * g[1]) / 6.0;
}

/* The great arc from a to b: its inward normal n is constant, f = angle n, g = integral of u. n = a x b from the difference of the
 * vertices and the nearer one, so that neither a small light far away nor one with a far vertex loses its digits. */
SHI_FUNCTION void shi_edge_add(const double a[3], const double b[3], double integral[9]) {
    double edge[3], n[3], f[3], g[3], chord[3];
    const double dot = shi_dot3d(a, b), la = sqrt(shi_dot3d(a, a)), lb = sqrt(shi_dot3d(b, b));
    shi_along(b, -1.0, a, edge);
    shi_cross(la < lb ? a : b, edge, n);
    const double cross = sqrt(shi_dot3d(n, n));
    if (cross <= 0.0)
        return;
    const double angle = atan2(cross, dot), half_tangent = cross / (la * lb + dot);
    for (int i = 0; i < 3; i++) {
        n[i] /= cross;
        f[i] = angle * n[i];
        g[i] = (a[i] / la + b[i] / lb) * half_tangent;
        chord[i] = a[i] / la - b[i] / lb;
    }
    if (dot < 0.0)
        shi_cross(n, chord, g);
    shi_outline_add(f, n, g, integral);
}

/* Signed solid angle of a triangle. */
SHI_FUNCTION double shi_triangle_angle(const double a[3], const double b[3], const double c[3]) {
    double ab[3], ac[3], normal[3];
    shi_along(b, -1.0, a, ab);
    shi_along(c, -1.0, a, ac);
    shi_cross(ab, ac, normal);
    const double la = sqrt(shi_dot3d(a, a)), lb = sqrt(shi_dot3d(b, b)), lc = sqrt(shi_dot3d(c, c));
    const double rest = la * lb * lc + shi_dot3d(a, b) * lc + shi_dot3d(b, c) * la + shi_dot3d(c, a) * lb;
    return 2.0 * atan2(shi_dot3d(a, normal), rest);
}

/* Vertices are relative to `center`. */
SHI_INLINE void shi_vertex(const float center[3], const float *vertex, double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = (double)center[i] + (double)vertex[i];
}

/* The unit normal of a polygon, away from the receiver, whose height over its plane it returns; 0 and -1 if it has no area. */
SHI_FUNCTION double shi_polygon_axis(const float center[3], const float *vertices, size_t count, double axis[3]) {
    double nearest[3] = { 0, 0, 0 }, from[3] = { 0, 0, 0 }, to[3], p[3], least = -1.0;
    axis[0] = axis[1] = axis[2] = 0.0;
    for (size_t i = 0; i < count; i++) {
        shi_vertex(center, vertices + 3 * i, p);
        if (least < 0.0 || shi_dot3d(p, p) < least) {
            least = shi_dot3d(p, p);
            memcpy(nearest, p, sizeof nearest);
        }
    }
    for (size_t i = 0; i <= count; i++) {
        double area[3];
        shi_vertex(center, vertices + 3 * (i % count), p);
        shi_along(p, -1.0, nearest, to);
        shi_cross(from, to, area);
        shi_along(axis, i > 0 ? 1.0 : 0.0, area, axis);
        memcpy(from, to, sizeof from);
    }
    const double length = sqrt(shi_dot3d(axis, axis)), height = shi_dot3d(axis, nearest);
    if (!(length > 0.0))
        return -1.0;
    for (int i = 0; i < 3; i++)
        axis[i] /= height < 0.0 ? -length : length;
    return fabs(height) / length;
}

/* Signed solid angle of a polygon as the sum over its edges of that of a triangle with the axis: exact to rounding for a receiver
 * in the plane too, where a fan of triangles has 0 / 0 on its diagonals. */
SHI_FUNCTION double shi_polygon_angle(const float center[3], const float *vertices, size_t count, const double axis[3]) {
    double last[3], p[3], normal[3], sum = 0.0;
    shi_vertex(center, vertices + 3 * (count - 1), last);
    for (size_t i = 0; i < count; i++) {
        shi_vertex(center, vertices + 3 * i, p);
        shi_cross(last, p, normal);
        const double a = sqrt(shi_dot3d(last, last)), b = sqrt(shi_dot3d(p, p));
        sum += 2.0 * atan2(shi_dot3d(axis, normal), a * b + shi_dot3d(axis, last) * b + shi_dot3d(axis, p) * a + shi_dot3d(last, p));
        memcpy(last, p, sizeof last);
    }
    return sum;
}

SHI_FUNCTION void shi_polygon_integral(const float center[3], const float *vertices, size_t count, double integral[9]) {
    double first[3], last[3], axis[3], middle[3] = { 0, 0, 0 }, solid_angle = 0.0, extent = 0.0;
    memset(integral, 0, 9 * sizeof *integral);
    shi_vertex(center, vertices, first);
    shi_vertex(center, vertices + 3 * (count - 1), last);
    for (size_t i = 0; i < count; i++) {
        double p[3], from_first[3];
        shi_vertex(center, vertices + 3 * i, p);
        shi_edge_add(last, p, integral);
        if (i >= 2)
            solid_angle += shi_triangle_angle(first, last, p);
        shi_along(p, -1.0, first, from_first);
        extent = fmax(extent, shi_dot3d(from_first, from_first));
        shi_along(middle, 1.0 / (double)count, p, middle);
        memcpy(last, p, sizeof last);
    }
    const double height = shi_polygon_axis(center, vertices, count, axis);
    if (height >= 0.0 && height * height < 1e-12 * extent)
        solid_angle = shi_polygon_angle(center, vertices, count, axis);
    /* The sums over edges cancel to the square of the light's angular size; at 1e-8, half of a double's digits are left. */
    if (extent < 1e-16 * shi_dot3d(first, first))
        shi_point_integral(middle, solid_angle, integral);
    integral[SH_R0] = solid_angle;
    if (solid_angle < 0.0)
        for (int i = 0; i < 9; i++)
            integral[i] = -integral[i];
}

SHI_FUNCTION int sh_add_polygon(int order, int channels, const float *vertices, size_t count, const float *radiance, float *c) {
    const float receiver[3] = { 0.0f, 0.0f, 0.0f };
    double integral[9];
    if (!shi_order_ok(order) || channels < 1 || !vertices || count < 3 || !radiance || !c)
        return SH_ERROR_ARGUMENT;
    shi_polygon_integral(receiver, vertices, count, integral);
    shi_add_integral(order, channels, integral, radiance, c);
    return SH_OK;
}

/* Corners as floats would be off by 6e-8 of their distance: too much where they are near to each other. */
SHI_FUNCTION void sh_add_rectangle(int order, int channels, const float center[3], const float half_u[3], const float half_v[3],
                                   const float *radiance, float *c) {
    float corner[4][3];
    double integral[9];
    for (int i = 0; i < 3; i++) {
        corner[0][i] = -half_u[i] - half_v[i];
        corner[1][i] = half_u[i] - half_v[i];
        corner[2][i] = half_u[i] + half_v[i];
        corner[3][i] = half_v[i] - half_u[i];
    }
    shi_polygon_integral(center, corner[0], 4, integral);
    shi_add_integral(order, channels, integral, radiance, c);
}

/* Points on the rim for an error of 1e-8 of the solid angle, which falls with the height over the disk's plane. The integrand's nearest
 * pole is at azimuth + i y, where |p|^2 = 0: cosh y - 1 = gap^2 / (2 radius * distance from the axis). */
SHI_FUNCTION int shi_rim_points(const double center[3], const double axis[3], double radius) {
    const double height = shi_dot3d(center, axis), off = sqrt(fmax(0.0, shi_dot3d(center, center) - height * height));
    const double gap = (off - radius) * (off - radius) + height * height, span = 2.0 * radius * off;
    const double t = gap < 100.0 * span ? gap / span : 100.0, y = log1p(t + sqrt(t * (t + 2.0)));
    const double edge_on = gap > 0.0 ? 0.5 * log1p(gap / (height * height + 1e-12 * gap)) : 0.0;
    return 16 + (int)((20.0 + edge_on) / fmax(y, 0.02));
}

/* Around the rim p of a disk: f = integral of u x du, R2 from (u x du) u', and the solid angle from axis.(u x du) / (1 + axis.u), whose
 * denominator is at least 1 as the axis points away from the receiver. No part of the rim is seen under more than half a turn, however
 * near it is. */
SHI_FUNCTION void shi_disk_integral(const double center[3], const double axis[3], double radius, double integral[9]) {
    const int points = shi_rim_points(center, axis, radius);
    const double step = 2.0 * SHI_PI / points, cos_step = cos(step), sin_step = sin(step), least = radius * step / SHI_PI;
    double u[3], v[3], cosine = 1.0, sine = 0.0;
    shi_complete_frame(axis, u, v);
    memset(integral, 0, 9 * sizeof *integral);
    for (int i = 0; i < points; i++) {
        double p[3], slope[3], f[3], g[3];
        for (int k = 0; k < 3; k++) {
            p[k] = center[k] + radius * (cosine * u[k] + sine * v[k]);
            slope[k] = radius * step * (cosine * v[k] - sine * u[k]);
        }
        shi_cross(p, slope, f);
        const double inverse = 1.0 / fmax(shi_dot3d(p, p), least * least), length = sqrt(inverse);
        for (int k = 0; k < 3; k++) {
            f[k] *= inverse;
            g[k] = p[k] * length;
        }
        integral[SH_R0] += shi_dot3d(axis, f) / (1.0 + shi_dot3d(axis, g));
        shi_outline_add(f, f, g, integral);
        const double next = cosine * cos_step - sine * sin_step;
        sine = sine * cos_step + cosine * sin_step;
        cosine = next;
    }
}

SHI_FUNCTION void sh_add_disk(int order, int channels, const float center[3], const float normal[3], float radius, const float *radiance,
                              float *c) {
    double p[3], axis[3], integral[9];
    const double r = (double)radius;
    if (r <= 0.0)
        return;
    shi_widen(center, p);
    shi_widen(normal, axis);
    if (shi_dot3d(p, axis) < 0.0)
        for (int i = 0; i < 3; i++)
            axis[i] = -axis[i];
    const double square = shi_dot3d(p, p);
    if (r * r < 1e-16 * square)
        shi_point_integral(p, SHI_PI * r * r / square * shi_dot3d(p, axis) / sqrt(square), integral);
    else
        shi_disk_integral(p, axis, r, integral);
    shi_add_integral(order, channels, integral, radiance, c);
}

/* At angle p from the foot of the perpendicular, the tube is width cos(p) / h wide: moments are integrals of products of cos and sin. */
SHI_FUNCTION void sh_add_segment(int order, int channels, const float a[3], const float b[3], float width, const float *radiance,
                                 float *c) {
    double from[3], to[3], t[3], e[3], integral[9];
    shi_widen(a, from);
    shi_widen(b, to);
    shi_along(to, -1.0, from, t);
    const double length = sqrt(shi_dot3d(t, t));
    if (length <= 0.0)
        return;
    for (int i = 0; i < 3; i++)
        t[i] /= length;
    const double a0 = shi_dot3d(from, t), b0 = shi_dot3d(to, t);
    if (fabs(a0) < fabs(b0)) /* the nearer end has the more accurate foot of the perpendicular */
        shi_along(from, -a0, t, e);
    else
        shi_along(to, -b0, t, e);
    const double h = sqrt(shi_dot3d(e, e)), la = sqrt(a0 * a0 + h * h), lb = sqrt(b0 * b0 + h * h);
    if (h <= 0.0 || width <= 0.0f)
        return;
    for (int i = 0; i < 3; i++)
        e[i] /= h;
    const double s0 = a0 / la, s1 = b0 / lb, c0 = h / la, c1 = h / lb;
    const double angle = atan2(s1, c1) - atan2(s0, c0), w = (double)width / fmax(h, 0.5 * (double)width);
    const double cubes = (s1 * s1 * s1 - s0 * s0 * s0) / 3.0, one = s1 - s0;
    const double ec = (angle + s1 * c1 - s0 * c0) / 2.0, tc = (s1 * s1 - s0 * s0) / 2.0;      /* of cos^2, of sin cos */
    const double ee = one - cubes, et = (c0 * c0 * c0 - c1 * c1 * c1) / 3.0, tt = cubes;      /* of cos^3, cos^2 sin, cos sin^2 */
    integral[SH_R0] = w * one;
    for (int i = 0, at = SH_XX; i < 3; i++) {
        integral[SH_X + i] = w * (ec * e[i] + tc * t[i]);
        for (int j = i; j < 3 && at <= SH_YZ; j++, at++)
            integral[at] = w * (ee * e[i] * e[j] + et * (e[i] * t[j] + t[i] * e[j]) + tt * t[i] * t[j] - (i == j ? one / 3.0 : 0.0));
    }
    shi_add_integral(order, channels, integral, radiance, c);
}

SHI_FUNCTION size_t sh_add_spheres(int order, int channels, const float *spheres, const float *radiance, size_t count, float tolerance,
                                   float *c) {
    double skipped = 0.0;
    size_t added = 0;
    for (size_t i = 0; i < count; i++, spheres += 4, radiance += channels) {
        double p[3], most = 0.0;
        shi_widen(spheres, p);
        for (int k = 0; k < channels; k++)
            most = fabs((double)radiance[k]) <= most || most != most ? most : fabs((double)radiance[k]); /* NaN stays */
        const double square = shi_dot3d(p, p), rr = (double)spheres[3] * (double)spheres[3];
        const double bound = rr >= square ? most : 17.0 / 16.0 * most * rr / square;
        if (bound * (double)(count - i) <= (double)tolerance - skipped) { /* its share of what is left, for it and all that follow */
            skipped += bound;
            continue;
        }
        sh_add_sphere(order, channels, spheres, spheres[3], SH_RADIANCE, radiance, c);
        added++;
    }
    return added;
}

/* ---- Conversion and storage ----------------------------------------------------------------------------------------------------- */

/* A set in the order 1; y, z, x; xy, yz, zz, xz, xx - yy: factors of R0, of R1, of the three products, of zz and of xx - yy; what odd m
 * is multiplied by as well. */
typedef struct shi_convention {
    double f0, f1, f2, f20, f22, odd;
} shi_convention;

SHI_FUNCTION shi_convention shi_orthonormal(int phase) {
    const double root_pi = 1.77245385090551602730; /* sqrt(pi) */
    const shi_convention k = { 2.0 * root_pi,             sqrt(12.0) * root_pi, 2.0 * sqrt(15.0) * root_pi, 3.0 * sqrt(5.0) * root_pi,
                               sqrt(15.0) * root_pi, phase == SH_CONDON_SHORTLEY ? -1.0 : 1.0 };
    return k;
}

SHI_FUNCTION shi_convention shi_unity(void) {
    const shi_convention k = { 1.0, 2.0, 15.0 / 4.0, 15.0 / 16.0, 15.0 / 16.0, 1.0 };
    return k;
}

SHI_FUNCTION void shi_to_convention(int order, const float *c, const shi_convention *k, float *out) {
    double wide[9] = { 0 };
    for (int i = 0; i < SH_COUNT(order); i++)
        wide[i] = (double)c[i];
    out[0] = (float)(k->f0 * wide[SH_R0]);
    if (order >= SH_L1) {
        out[1] = (float)(k->odd * k->f1 * wide[SH_Y]);
        out[2] = (float)(k->f1 * wide[SH_Z]);
        out[3] = (float)(k->odd * k->f1 * wide[SH_X]);
    }
    if (order >= SH_L2) {
        out[4] = (float)(k->f2 * wide[SH_XY]);
        out[5] = (float)(k->odd * k->f2 * wide[SH_YZ]);
        out[6] = (float)(k->f20 * -(wide[SH_XX] + wide[SH_YY]));
        out[7] = (float)(k->odd * k->f2 * wide[SH_XZ]);
        out[8] = (float)(k->f22 * (wide[SH_XX] - wide[SH_YY]));
    }
}

SHI_FUNCTION void shi_from_convention(int order, const float *f, const shi_convention *k, float *out) {
    double wide[9] = { 0 };
    for (int i = 0; i < SH_COUNT(order); i++)
        wide[i] = (double)f[i];
    out[SH_R0] = (float)(wide[0] / k->f0);
    if (order >= SH_L1) {
        out[SH_X] = (float)(k->odd * wide[3] / k->f1);
        out[SH_Y] = (float)(k->odd * wide[1] / k->f1);
        out[SH_Z] = (float)(wide[2] / k->f1);
    }
    if (order >= SH_L2) {
        const double zz = wide[6] / k->f20, difference = wide[8] / k->f22;
        out[SH_XX] = (float)((difference - zz) / 2.0);
        out[SH_XY] = (float)(wide[4] / k->f2);
        out[SH_XZ] = (float)(k->odd * wide[7] / k->f2);
        out[SH_YY] = (float)(-(difference + zz) / 2.0);
        out[SH_YZ] = (float)(k->odd * wide[5] / k->f2);
    }
}

SHI_FUNCTION void sh_to_orthonormal(int order, const float *c, int phase, float *out) {
    const shi_convention k = shi_orthonormal(phase);
    shi_to_convention(order, c, &k, out);
}

SHI_FUNCTION void sh_from_orthonormal(int order, const float *f, int phase, float *out) {
    const shi_convention k = shi_orthonormal(phase);
    shi_from_convention(order, f, &k, out);
}

SHI_FUNCTION void sh_to_unity(int order, const float *c, float *out) {
    const shi_convention k = shi_unity();
    shi_to_convention(order, c, &k, out);
}

SHI_FUNCTION void sh_from_unity(int order, const float *u, float *out) {
    const shi_convention k = shi_unity();
    shi_from_convention(order, u, &k, out);
}

/* R0 (x^2 + y^2 + z^2) + 2 R1.n + 15/8 n'R2 n */
SHI_FUNCTION void sh_to_babylon(const float *c, float out[9]) {
    const double r0 = (double)c[SH_R0], xx = (double)c[SH_XX], yy = (double)c[SH_YY], squares = 15.0 / 8.0;
    const float yz = 3.75f * c[SH_YZ], zx = 3.75f * c[SH_XZ], xy = 3.75f * c[SH_XY];
    shi_set3(2.0f * c[SH_X], 2.0f * c[SH_Y], 2.0f * c[SH_Z], out);
    shi_set3((float)(r0 + squares * xx), (float)(r0 + squares * yy), (float)(r0 - squares * (xx + yy)), out + 3);
    shi_set3(yz, zx, xy, out + 6);
}

SHI_FUNCTION void sh_from_babylon(const float p[9], float *out) {
    const double xx = (double)p[3], yy = (double)p[4], zz = (double)p[5], r0 = (xx + yy + zz) / 3.0, squares = 8.0 / 15.0;
    const float yz = p[6] / 3.75f, zx = p[7] / 3.75f, xy = p[8] / 3.75f;
    shi_set3(0.5f * p[0], 0.5f * p[1], 0.5f * p[2], out + SH_X);
    out[SH_R0] = (float)r0;
    out[SH_XX] = (float)(squares * (xx - r0));
    out[SH_XY] = xy;
    out[SH_XZ] = zx;
    out[SH_YY] = (float)(squares * (yy - r0));
    out[SH_YZ] = yz;
}

SHI_FUNCTION void sh_interleave(int order, int channels, const float *c, float *out) {
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < SH_COUNT(order); i++)
            out[i * channels + k] = c[k * SH_COUNT(order) + i];
}

SHI_FUNCTION void sh_deinterleave(int order, int channels, const float *c, float *out) {
    for (int k = 0; k < channels; k++)
        for (int i = 0; i < SH_COUNT(order); i++)
            out[k * SH_COUNT(order) + i] = c[i * channels + k];
}

SHI_FUNCTION void sh_pack_shader(const float *c, float out[28]) {
    float in[3 * SH_COUNT(SH_L2)]; /* out may be c */
    memcpy(in, c, sizeof in);
    for (int k = 0; k < 3; k++) {
        const float *a = in + k * SH_COUNT(SH_L2), zz = -0.9375f * (a[SH_XX] + a[SH_YY]); /* 15/16 */
        shi_set3(2.0f * a[SH_X], 2.0f * a[SH_Y], 2.0f * a[SH_Z], out + 4 * k);
        out[4 * k + 3] = a[SH_R0] - zz;
        shi_set3(3.75f * a[SH_XY], 3.75f * a[SH_YZ], 3.0f * zz, out + 12 + 4 * k);
        out[15 + 4 * k] = 3.75f * a[SH_XZ];
        out[24 + k] = 0.9375f * (a[SH_XX] - a[SH_YY]);
    }
    out[27] = 1.0f;
}

/* What counts as realizable: before packing, to the rounding of floats; after, to that of the elimination. */
#define SHI_SLACK_BEFORE 2e-6
#define SHI_SLACK_AFTER 1e-9

/* To the nearest half, ties to even; |x| < 2^16. */
SHI_INLINE uint16_t shi_to_half(float x) {
    const float shifted = fabsf(x) + 0.5f; /* whose bits count steps of 2^-24, that of subnormal halves */
    uint32_t bits, steps;
    memcpy(&bits, &x, sizeof bits);
    memcpy(&steps, &shifted, sizeof steps);
    const uint32_t magnitude = bits & 0x7fffffffu, sign = bits >> 31 << 15;
    if (magnitude < 0x38800000u) /* 2^-14 */
        return (uint16_t)(sign | (steps - 0x3f000000u));
    return (uint16_t)(sign | (magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u)) >> 13);
}

/* Finite halves only. No branch on the sign, which is as good as random. */
SHI_INLINE float shi_from_half(uint16_t h) {
    const uint32_t magnitude = h & 0x7fffu, sign = (uint32_t)(h & 0x8000u) << 16;
    uint32_t bits = (magnitude << 13) + 0x38000000u;
    float x;
    if (magnitude < 0x0400u) {
        x = (float)(int)magnitude / 16777216.0f;
        memcpy(&bits, &x, sizeof bits);
    }
    bits |= sign;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* 2^exponent, for -1022 <= exponent <= 1023. */
SHI_INLINE double shi_power_of_two(int exponent) {
    const uint64_t bits = (uint64_t)(1023 + exponent) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* The exponent e of 2^e <= x < 2^(e + 1), for a positive float. */
SHI_INLINE int shi_exponent(float x) {
    const double wide = (double)x; /* is never subnormal */
    uint64_t bits;
    memcpy(&bits, &wide, sizeof bits);
    return (int)(bits >> 52) - 1023;
}

/* Rounds R0 up until light can have the set, if it could have c, in 8 steps at most. */
SHI_FUNCTION void shi_raise_half(int order, const float *c, uint16_t *half) {
    float decoded[9];
    for (int i = 0; i < SH_COUNT(order); i++)
        decoded[i] = shi_from_half(half[i]);
    if (shi_realizable(order, decoded, SHI_SLACK_AFTER) || !shi_realizable(order, c, SHI_SLACK_BEFORE))
        return;
    for (int step = 0; step < 8 && !shi_realizable(order, decoded, SHI_SLACK_AFTER); step++)
        decoded[SH_R0] = shi_from_half(++half[SH_R0]);
}

/* By bits that the compiler cannot trace to a float: under -ffast-math it may hold that every float is finite (clang 19 does). */
SHI_INLINE int shi_is_finite(const float *a) {
    uint32_t bits;
    memcpy(&bits, a, sizeof bits);
    volatile uint32_t untraced = bits;
    return (untraced & 0x7f800000u) != 0x7f800000u;
}

SHI_FUNCTION void sh_pack_half(int order, int channels, const float *c, uint16_t *out) {
    const int count = SH_COUNT(order);
    float most = 0.0f;
    for (int i = 0; i < channels * count; i++)
        most = shi_is_finite(c + i) && fabsf(c[i]) > most ? fabsf(c[i]) : most;
    const int exponent = most > 0.0f ? shi_exponent(most) - 14 : 0;
    const double scale = shi_power_of_two(-exponent);
    for (int i = 0; i < channels * count; i++)
        out[i] = shi_is_finite(c + i) ? shi_to_half((float)(scale * (double)c[i])) : 0;
    for (int k = 0; k < channels; k++)
        shi_raise_half(order, c + k * count, out + k * count);
    out[channels * count] = (uint16_t)exponent;
}

SHI_FUNCTION void sh_unpack_half(int order, int channels, const uint16_t *in, float *out) {
    const int count = channels * SH_COUNT(order), word = in[count];
    const int exponent = word < 0x8000 ? word : word - 0x10000;
    const double scale = shi_power_of_two(exponent < -300 ? -300 : exponent > 300 ? 300 : exponent); /* beyond: 0 or infinity */
    for (int i = 0; i < count; i++)
        out[i] = (float)(scale * (double)shi_from_half(in[i]));
}

/* Ratios are coded as zero + scale * ratio, in [0, 2^bits - 1]; step = 1 / scale. */
typedef struct shi_ratio {
    double zero, scale, step, least, most;
} shi_ratio;

/* Of coefficient i. Constants, once i and bits are. */
SHI_INLINE shi_ratio shi_ratio_code(int i, int bits) {
    const double top = (double)((1 << bits) - 1), middle = (double)(1 << (bits - 1)), third = 1.0 / 3.0;
    const int square = i == SH_XX || i == SH_YY;
    shi_ratio ratio;
    ratio.most = i < SH_XX ? 1.0 : square ? 2.0 * third : 0.5;
    ratio.least = square ? -third : -ratio.most;
    ratio.zero = square ? third * top : middle;
    ratio.scale = square ? top : (middle - 1.0) / ratio.most;
    ratio.step = 1.0 / ratio.scale;
    return ratio;
}

SHI_INLINE void shi_decode_ratios(int order, const uint16_t *code, int bits, float r0, float *out) {
    const double unit = r0 > 0.0f ? (double)r0 : 0.0;
    out[SH_R0] = r0;
    SHI_UNROLL(9)
    for (int i = SH_X; i < SH_COUNT(order); i++) {
        const shi_ratio ratio = shi_ratio_code(i, bits);
        out[i] = (float)(unit * (((double)code[i - 1] - ratio.zero) * ratio.step));
    }
}

SHI_INLINE void shi_encode_ratios(int order, const float *c, int bits, double shrink, uint16_t *code) {
    const double inverse = c[SH_R0] > 0.0f ? shrink / (double)c[SH_R0] : 0.0;
    SHI_UNROLL(9)
    for (int i = SH_X; i < SH_COUNT(order); i++) {
        const shi_ratio ratio = shi_ratio_code(i, bits);
        const double t = inverse * (double)c[i], low = t > ratio.least ? t : ratio.least;
        code[i - 1] = (uint16_t)(int)(ratio.zero + ratio.scale * (low < ratio.most ? low : ratio.most) + 0.5);
    }
}

/* Codes of one channel that decode to a realizable set if c is one. */
SHI_INLINE void shi_pack_ratios(int order, const float *c, int bits, uint16_t *code) {
    float decoded[9];
    for (int step = 0; step < 64; step++) {
        shi_encode_ratios(order, c, bits, 1.0 - step / (2.0 * (1 << bits)), code);
        shi_decode_ratios(order, code, bits, 1.0f, decoded);
        if (shi_realizable(order, decoded, SHI_SLACK_AFTER) || (step == 0 && !shi_realizable(order, c, SHI_SLACK_BEFORE)))
            return;
    }
}

SHI_FUNCTION void sh_pack_unorm8(int order, int channels, const float *c, float *r0, uint8_t *ratio) {
    const int count = SH_COUNT(order) - 1;
    for (int k = 0; k < channels; k++) {
        uint16_t code[8];
        r0[k] = c[k * SH_COUNT(order)];
        shi_pack_ratios(order, c + k * SH_COUNT(order), 8, code);
        for (int i = 0; i < count; i++)
            ratio[k * count + i] = (uint8_t)code[i];
    }
}

SHI_FUNCTION void sh_unpack_unorm8(int order, int channels, const float *r0, const uint8_t *ratio, float *out) {
    const int count = SH_COUNT(order) - 1;
    for (int k = 0; k < channels; k++) {
        uint16_t code[8];
        for (int i = 0; i < count; i++)
            code[i] = ratio[k * count + i];
        shi_decode_ratios(order, code, 8, r0[k], out + k * SH_COUNT(order));
    }
}

SHI_FUNCTION void sh_pack_unorm10(int order, int channels, const float *c, float *r0, uint32_t *ratio) {
    const int words = (SH_COUNT(order) + 1) / 3;
    for (int k = 0; k < channels; k++) {
        uint16_t code[9] = { 0 };
        r0[k] = c[k * SH_COUNT(order)];
        shi_pack_ratios(order, c + k * SH_COUNT(order), 10, code);
        for (int i = 0; i < words; i++)
            ratio[k * words + i] = code[3 * i] | (uint32_t)code[3 * i + 1] << 10 | (uint32_t)code[3 * i + 2] << 20;
    }
}

SHI_FUNCTION void sh_unpack_unorm10(int order, int channels, const float *r0, const uint32_t *ratio, float *out) {
    const int words = (SH_COUNT(order) + 1) / 3;
    for (int k = 0; k < channels; k++) {
        uint16_t code[9];
        for (int i = 0; i < 3 * words; i++)
            code[i] = (uint16_t)(ratio[k * words + i / 3] >> (10 * (i % 3)) & 0x3ffu);
        shi_decode_ratios(order, code, 10, r0[k], out + k * SH_COUNT(order));
    }
}

/* ---- Fitting --------------------------------------------------------------------------------------------------------------------
 * The unknowns are coefficients of functions whose mean square over the sphere is 1: orthonormal harmonics times sqrt(4 pi). */

SHI_FUNCTION int shi_band(int i) {
    return i < 1 ? 0 : i < 4 ? 1 : 2;
}

/* 1; sqrt3 (y, z, x); sqrt15 (xy, yz), sqrt5/2 (3z^2 - 1), sqrt15 xz, sqrt15/2 (x^2 - y^2), each times the kernel of its band. */
SHI_FUNCTION void shi_fit_row(const double dir[3], const float *zonal, double row[9]) {
    const double x = dir[0], y = dir[1], z = dir[2], r3 = sqrt(3.0), r15 = sqrt(15.0);
    const double value[9] = { 1.0, r3 * y, r3 * z, r3 * x, r15 * x * y, r15 * y * z, sqrt(1.25) * (3.0 * z * z - 1.0), r15 * x * z,
                              r15 / 2.0 * (x * x - y * y) };
    for (int i = 0; i < 9; i++)
        row[i] = value[i] * (zonal ? (double)zonal[shi_band(i)] : 1.0);
}

/* The lower Cholesky factor of m in place; 0 at a pivot that is not above `least`. */
SHI_FUNCTION int shi_cholesky(double m[9][9], int size, double least) {
    for (int k = 0; k < size; k++) {
        for (int j = 0; j < k; j++)
            m[k][k] -= m[k][j] * m[k][j];
        if (!(m[k][k] > least))
            return 0;
        m[k][k] = sqrt(m[k][k]);
        for (int i = k + 1; i < size; i++) {
            for (int j = 0; j < k; j++)
                m[i][k] -= m[i][j] * m[k][j];
            m[i][k] /= m[k][k];
        }
    }
    return 1;
}

SHI_FUNCTION void shi_cholesky_solve(double m[9][9], int size, double v[9]) {
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < i; j++)
            v[i] -= m[i][j] * v[j];
        v[i] /= m[i][i];
    }
    for (int i = size - 1; i >= 0; i--) {
        for (int j = i + 1; j < size; j++)
            v[i] -= m[j][i] * v[j];
        v[i] /= m[i][i];
    }
}

/* What is fitted. */
typedef struct shi_fit {
    const float *x, *y, *z, *weight, *zonal;
    size_t count;
} shi_fit;

/* The least eigenvalue of a matrix that shi_cholesky has factored, by inverse iteration; where many are near it, not below it. */
SHI_FUNCTION double shi_cholesky_least(double m[9][9], int n) {
    double x[9], square = 0.0;
    for (int i = 0; i < n; i++)
        x[i] = 1.0 / (i + 2.0);
    for (int step = 0; step < 8; step++) {
        shi_cholesky_solve(m, n, x);
        square = 0.0;
        for (int i = 0; i < n; i++)
            square += x[i] * x[i];
        for (int i = 0; i < n; i++)
            x[i] /= sqrt(square);
    }
    return 1.0 / sqrt(square);
}

/* The weight of sample i, and its row. */
SHI_FUNCTION double shi_fit_sample(const shi_fit *fit, size_t i, double row[9]) {
    const double dir[3] = { (double)fit->x[i], (double)fit->y[i], (double)fit->z[i] };
    shi_fit_row(dir, fit->zonal, row);
    return fit->weight ? (double)fit->weight[i] : 1.0;
}

/* The weighted mean of the rows' outer products, plus lambda l^2 (l + 1)^2 and `ridge` on the diagonal; returns the sum of weights. */
SHI_FUNCTION double shi_fit_matrix(const shi_fit *fit, double lambda, double ridge, double m[9][9]) {
    double total = 0.0, row[9];
    memset(m, 0, 81 * sizeof(double));
    for (size_t i = 0; i < fit->count; i++) {
        const double w = shi_fit_sample(fit, i, row);
        total += w;
        for (int j = 0; j < 9; j++)
            for (int k = 0; k <= j; k++)
                m[j][k] += w * row[j] * row[k];
    }
    for (int j = 0; j < 9; j++) {
        const double l = shi_band(j);
        for (int k = 0; k <= j; k++)
            m[j][k] /= total;
        m[j][j] += lambda * l * l * (l + 1.0) * (l + 1.0) + ridge;
    }
    return total;
}

SHI_FUNCTION void shi_fit_channel(const shi_fit *fit, int order, const float *value, double total, double m[9][9], float *c) {
    /* From functions of mean square 1 to moments. */
    const shi_convention k = { 1.0, sqrt(3.0), sqrt(15.0), 1.5 * sqrt(5.0), sqrt(3.75), 1.0 };
    double right[9] = { 0 }, row[9];
    float solution[9];
    for (size_t i = 0; i < fit->count; i++) {
        const double w = shi_fit_sample(fit, i, row) / total * (double)value[i];
        for (int j = 0; j < 9; j++)
            right[j] += w * row[j];
    }
    shi_cholesky_solve(m, SH_COUNT(order), right);
    for (int j = 0; j < 9; j++)
        solution[j] = (float)right[j];
    shi_from_convention(order, solution, &k, c);
}

SHI_FUNCTION int sh_fit_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                const float *weight, size_t count, const float *zonal, float regularization, float *c) {
    const double least = 1e-6, lambda = (double)regularization;
    const shi_fit fit = { x, y, z, weight, zonal, count };
    double m[9][9];
    int status = SH_OK;
    if (!shi_order_ok(order) || channels < 1 || !x || !y || !z || !value || !c || !(regularization >= 0.0f))
        return SH_ERROR_ARGUMENT;
    double total = shi_fit_matrix(&fit, lambda, 0.0, m);
    if (!(total > 0.0 && total < 1e300))
        return SH_ERROR_ARGUMENT;
    if (!shi_cholesky(m, SH_COUNT(order), 0.0) || !(shi_cholesky_least(m, SH_COUNT(order)) >= least)) {
        status = SH_WARNING_UNDETERMINED;
        total = shi_fit_matrix(&fit, lambda, least, m);
        if (!shi_cholesky(m, SH_COUNT(order), 0.0))
            return SH_ERROR_ARGUMENT;
    }
    for (int k = 0; k < channels; k++)
        shi_fit_channel(&fit, order, value + (size_t)k * count, total, m, c + k * SH_COUNT(order));
    return status;
}

#ifndef SH_NO_BATCH
/* ---- Vector vocabulary: the only place with intrinsics --------------------------------------------------------------------------
 * A kernel below is written once, on these operations; scalar is the backend of one lane. shi_v is a vector of SHI_LANES floats,
 * shi_m a mask of as many, shi_i of as many 32-bit integers. Loads and stores take any alignment. Only shi_madd may fuse.
 *   min, max     the second operand where one is NaN
 *   select       (m, a, b): a where m is set, b elsewhere
 *   load8, store8  the first eight lanes, or all where there are fewer; loaded, the others are 0
 *   load_half    halves, where SHI_HAS_HALF says that the target converts them; infinity and NaN stay what they are
 *   iload16      16-bit words, sign-extended;  iload32  native 32-bit words
 *   repeat3      (a, part): every lane three times, in three vectors; part 0, 1 or 2 of them
 *   transpose4   4 x 4 transposes within each group of four lanes
 *   load4        four consecutive floats of each of SHI_LANES items, `stride` bytes apart: v[j] has float j of all items
 *   store3       a, b, c to three consecutive floats of each item, writing nothing else
 *   keep         the same value, in a register: GCC would rather load it again for each use, and loads are what the kernels wait for
 *   hide         the same number, which the compiler cannot know: in a loop, it then multiplies a stride where it is needed, and does
 *                not step dozens of pointers that do not fit into registers
 *   prefetch     asks for two vectors' cache lines, which need not be readable */

#if defined(SH_NO_SIMD)
#undef SH_SIMD
#define SH_SIMD SH_SIMD_SCALAR
#endif

#if defined(__AVX512F__)
#define SHI_HAS_AVX512 1
#else
#define SHI_HAS_AVX512 0
#endif
#if defined(__AVX2__) && (defined(__FMA__) || defined(_MSC_VER))
#define SHI_HAS_AVX2 1
#else
#define SHI_HAS_AVX2 0
#endif
#if defined(__SSE2__) || defined(_M_X64) || (defined(_M_IX86_FP) && _M_IX86_FP >= 2)
#define SHI_HAS_SSE2 1
#else
#define SHI_HAS_SSE2 0
#endif
#if (defined(__ARM_NEON) && defined(__ARMEL__)) || defined(__AARCH64EL__) || defined(_M_ARM64)
#define SHI_HAS_NEON 1
#else
#define SHI_HAS_NEON 0
#endif
#if defined(__wasm_simd128__)
#define SHI_HAS_WASM 1
#else
#define SHI_HAS_WASM 0
#endif

#ifndef SH_SIMD
#if SHI_HAS_AVX512
#define SH_SIMD SH_SIMD_AVX512
#elif SHI_HAS_AVX2
#define SH_SIMD SH_SIMD_AVX2
#elif SHI_HAS_SSE2
#define SH_SIMD SH_SIMD_SSE2
#elif SHI_HAS_NEON
#define SH_SIMD SH_SIMD_NEON
#elif SHI_HAS_WASM
#define SH_SIMD SH_SIMD_WASM
#else
#define SH_SIMD SH_SIMD_SCALAR
#endif
#endif

#if SH_SIMD == SH_SIMD_AVX512 || SH_SIMD == SH_SIMD_AVX2 || SH_SIMD == SH_SIMD_SSE2
#if SH_SIMD == SH_SIMD_SSE2
#include <emmintrin.h>
#elif defined(__GNUC__) && !defined(__clang__)
/* GCC takes the undefined operands inside its own AVX-512 functions for uninitialised variables (its bug 105593). */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#else
#include <immintrin.h>
#endif
SHI_INLINE __m128 shi_load_four(const void *p) { return _mm_loadu_ps((const float *)p); }
SHI_INLINE void shi_store_low(void *p, __m128 a) { _mm_storel_pi((__m64 *)p, a); }
SHI_INLINE void shi_store_high(void *p, __m128 a) { _mm_storeh_pi((__m64 *)p, a); }
/* a, b, c to three consecutive floats of each of four items: a and b as pairs, c alone. */
SHI_INLINE void shi_store_threes(unsigned char *p, size_t stride, __m128 a, __m128 b, __m128 c) {
    const __m128 ab = _mm_unpacklo_ps(a, b), ab_high = _mm_unpackhi_ps(a, b);
    const float c0 = _mm_cvtss_f32(c), c1 = _mm_cvtss_f32(_mm_shuffle_ps(c, c, _MM_SHUFFLE(1, 1, 1, 1)));
    const float c2 = _mm_cvtss_f32(_mm_movehl_ps(c, c)), c3 = _mm_cvtss_f32(_mm_shuffle_ps(c, c, _MM_SHUFFLE(3, 3, 3, 3)));
    shi_store_low(p, ab);
    memcpy(p + 8, &c0, sizeof c0);
    shi_store_high(p + stride, ab);
    memcpy(p + stride + 8, &c1, sizeof c1);
    shi_store_low(p + 2 * stride, ab_high);
    memcpy(p + 2 * stride + 8, &c2, sizeof c2);
    shi_store_high(p + 3 * stride, ab_high);
    memcpy(p + 3 * stride + 8, &c3, sizeof c3);
}
#endif

#if SH_SIMD == SH_SIMD_AVX512
#if !SHI_HAS_AVX512
#error "SH_SIMD is SH_SIMD_AVX512, but the compiler's target has no AVX-512F"
#endif
#define SH_SIMD_NAME "AVX-512"
#define SHI_LANES 16
typedef __m512 shi_v;
typedef __m512i shi_i;
typedef __mmask16 shi_m;
SHI_INLINE shi_v shi_splat(float a) { return _mm512_set1_ps(a); }
SHI_INLINE shi_v shi_load(const void *p) { return _mm512_loadu_ps(p); }
SHI_INLINE void shi_store(void *p, shi_v a) { _mm512_storeu_ps(p, a); }
#define SHI_HAS_HALF 1
SHI_INLINE shi_v shi_load_half(const void *p) { return _mm512_cvtph_ps(_mm256_loadu_si256((const __m256i *)p)); }
SHI_INLINE shi_v shi_load8(const void *p) { return _mm512_zextps256_ps512(_mm256_loadu_ps((const float *)p)); }
SHI_INLINE void shi_store8(void *p, shi_v a) { _mm256_storeu_ps((float *)p, _mm512_castps512_ps256(a)); }
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return _mm512_add_ps(a, b); }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return _mm512_sub_ps(a, b); }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return _mm512_mul_ps(a, b); }
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return _mm512_div_ps(a, b); }
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return _mm512_fmadd_ps(a, b, c); }
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return _mm512_min_ps(a, b); }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return _mm512_max_ps(a, b); }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return _mm512_sqrt_ps(a); }
SHI_INLINE shi_v shi_abs(shi_v a) { return _mm512_abs_ps(a); }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) {
    return _mm512_castsi512_ps(_mm512_or_si512(_mm512_castps_si512(a), _mm512_castps_si512(b)));
}
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return _mm512_mask_blend_ps(m, b, a); }
SHI_INLINE shi_i shi_iload16(const void *p) { return _mm512_cvtepi16_epi32(_mm256_loadu_si256((const __m256i *)p)); }
SHI_INLINE shi_i shi_iload32(const void *p) { return _mm512_loadu_si512(p); }
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return _mm512_and_si512(a, _mm512_set1_epi32(b)); }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return _mm512_add_epi32(a, _mm512_set1_epi32(b)); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return _mm512_sll_epi32(a, _mm_cvtsi32_si128(n)); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) { return _mm512_srl_epi32(a, _mm_cvtsi32_si128(n)); }
SHI_INLINE shi_v shi_as_float(shi_i a) { return _mm512_castsi512_ps(a); }
SHI_INLINE shi_v shi_to_float(shi_i a) { return _mm512_cvtepi32_ps(a); }
SHI_INLINE void shi_transpose4(shi_v v[4]) {
    const __m512d a = _mm512_castps_pd(_mm512_unpacklo_ps(v[0], v[1])), b = _mm512_castps_pd(_mm512_unpacklo_ps(v[2], v[3]));
    const __m512d c = _mm512_castps_pd(_mm512_unpackhi_ps(v[0], v[1])), d = _mm512_castps_pd(_mm512_unpackhi_ps(v[2], v[3]));
    v[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(a, b));
    v[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(a, b));
    v[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(c, d));
    v[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(c, d));
}
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    const __m512i index[3] = { _mm512_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5),
                               _mm512_setr_epi32(5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8, 9, 9, 9, 10, 10),
                               _mm512_setr_epi32(10, 11, 11, 11, 12, 12, 12, 13, 13, 13, 14, 14, 14, 15, 15, 15) };
    return _mm512_permutexvar_ps(index[part], a);
}
SHI_INLINE shi_v shi_load_fours(const unsigned char *p, size_t stride) {
    shi_v v = _mm512_castps128_ps512(shi_load_four(p));
    v = _mm512_insertf32x4(v, shi_load_four(p + stride), 1);
    v = _mm512_insertf32x4(v, shi_load_four(p + 2 * stride), 2);
    return _mm512_insertf32x4(v, shi_load_four(p + 3 * stride), 3);
}
SHI_INLINE void shi_store3(unsigned char *p, size_t stride, shi_v a, shi_v b, shi_v c) {
    shi_store_threes(p, stride, _mm512_castps512_ps128(a), _mm512_castps512_ps128(b), _mm512_castps512_ps128(c));
    shi_store_threes(p + 4 * stride, stride, _mm512_extractf32x4_ps(a, 1), _mm512_extractf32x4_ps(b, 1), _mm512_extractf32x4_ps(c, 1));
    shi_store_threes(p + 8 * stride, stride, _mm512_extractf32x4_ps(a, 2), _mm512_extractf32x4_ps(b, 2), _mm512_extractf32x4_ps(c, 2));
    shi_store_threes(p + 12 * stride, stride, _mm512_extractf32x4_ps(a, 3), _mm512_extractf32x4_ps(b, 3), _mm512_extractf32x4_ps(c, 3));
}

#elif SH_SIMD == SH_SIMD_AVX2
#if !SHI_HAS_AVX2
#error "SH_SIMD is SH_SIMD_AVX2, but the compiler's target has no AVX2 with FMA"
#endif
#define SH_SIMD_NAME "AVX2+FMA"
#define SHI_LANES 8
typedef __m256 shi_v;
typedef __m256i shi_i;
typedef __m256 shi_m;
SHI_INLINE shi_v shi_splat(float a) { return _mm256_set1_ps(a); }
SHI_INLINE shi_v shi_load(const void *p) { return _mm256_loadu_ps((const float *)p); }
SHI_INLINE void shi_store(void *p, shi_v a) { _mm256_storeu_ps((float *)p, a); }
#if defined(__F16C__) || (defined(_MSC_VER) && !defined(__clang__)) /* every processor with AVX2 has it, but GCC wants -mf16c */
#define SHI_HAS_HALF 1
SHI_INLINE shi_v shi_load_half(const void *p) { return _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)p)); }
#endif
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return _mm256_add_ps(a, b); }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return _mm256_sub_ps(a, b); }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return _mm256_mul_ps(a, b); }
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return _mm256_div_ps(a, b); }
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return _mm256_fmadd_ps(a, b, c); }
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return _mm256_min_ps(a, b); }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return _mm256_max_ps(a, b); }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return _mm256_sqrt_ps(a); }
SHI_INLINE shi_v shi_abs(shi_v a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) { return _mm256_or_ps(a, b); }
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return _mm256_blendv_ps(b, a, m); }
SHI_INLINE shi_i shi_iload16(const void *p) { return _mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)p)); }
SHI_INLINE shi_i shi_iload32(const void *p) { return _mm256_loadu_si256((const __m256i *)p); }
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return _mm256_and_si256(a, _mm256_set1_epi32(b)); }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return _mm256_add_epi32(a, _mm256_set1_epi32(b)); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return _mm256_slli_epi32(a, n); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) { return _mm256_srli_epi32(a, n); }
SHI_INLINE shi_v shi_as_float(shi_i a) { return _mm256_castsi256_ps(a); }
SHI_INLINE shi_v shi_to_float(shi_i a) { return _mm256_cvtepi32_ps(a); }
SHI_INLINE void shi_transpose4(shi_v v[4]) {
    const __m256d a = _mm256_castps_pd(_mm256_unpacklo_ps(v[0], v[1])), b = _mm256_castps_pd(_mm256_unpacklo_ps(v[2], v[3]));
    const __m256d c = _mm256_castps_pd(_mm256_unpackhi_ps(v[0], v[1])), d = _mm256_castps_pd(_mm256_unpackhi_ps(v[2], v[3]));
    v[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(a, b));
    v[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(a, b));
    v[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(c, d));
    v[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(c, d));
}
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    const __m256i index[3] = { _mm256_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2), _mm256_setr_epi32(2, 3, 3, 3, 4, 4, 4, 5),
                               _mm256_setr_epi32(5, 5, 6, 6, 6, 7, 7, 7) };
    return _mm256_permutevar8x32_ps(a, index[part]);
}
SHI_INLINE shi_v shi_load_fours(const unsigned char *p, size_t stride) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(shi_load_four(p)), shi_load_four(p + stride), 1);
}
SHI_INLINE void shi_store3(unsigned char *p, size_t stride, shi_v a, shi_v b, shi_v c) {
    shi_store_threes(p, stride, _mm256_castps256_ps128(a), _mm256_castps256_ps128(b), _mm256_castps256_ps128(c));
    shi_store_threes(p + 4 * stride, stride, _mm256_extractf128_ps(a, 1), _mm256_extractf128_ps(b, 1), _mm256_extractf128_ps(c, 1));
}

#elif SH_SIMD == SH_SIMD_SSE2
#if !SHI_HAS_SSE2
#error "SH_SIMD is SH_SIMD_SSE2, but the compiler's target has no SSE2"
#endif
#define SH_SIMD_NAME "SSE2"
#define SHI_LANES 4
typedef __m128 shi_v;
typedef __m128i shi_i;
typedef __m128 shi_m;
SHI_INLINE shi_v shi_splat(float a) { return _mm_set1_ps(a); }
SHI_INLINE shi_v shi_load(const void *p) { return _mm_loadu_ps((const float *)p); }
SHI_INLINE void shi_store(void *p, shi_v a) { _mm_storeu_ps((float *)p, a); }
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return _mm_add_ps(a, b); }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return _mm_sub_ps(a, b); }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return _mm_mul_ps(a, b); }
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return _mm_div_ps(a, b); }
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return _mm_min_ps(a, b); }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return _mm_max_ps(a, b); }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return _mm_sqrt_ps(a); }
SHI_INLINE shi_v shi_abs(shi_v a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) { return _mm_or_ps(a, b); }
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return _mm_cmplt_ps(a, b); }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
SHI_INLINE shi_i shi_iload16(const void *p) {
    const __m128i words = _mm_loadl_epi64((const __m128i *)p);
    return _mm_srai_epi32(_mm_unpacklo_epi16(words, words), 16);
}
SHI_INLINE shi_i shi_iload32(const void *p) { return _mm_loadu_si128((const __m128i *)p); }
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return _mm_and_si128(a, _mm_set1_epi32(b)); }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return _mm_add_epi32(a, _mm_set1_epi32(b)); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return _mm_slli_epi32(a, n); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) { return _mm_srli_epi32(a, n); }
SHI_INLINE shi_v shi_as_float(shi_i a) { return _mm_castsi128_ps(a); }
SHI_INLINE shi_v shi_to_float(shi_i a) { return _mm_cvtepi32_ps(a); }
SHI_INLINE void shi_transpose4(shi_v v[4]) { _MM_TRANSPOSE4_PS(v[0], v[1], v[2], v[3]); }
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    return part == 0   ? _mm_shuffle_ps(a, a, _MM_SHUFFLE(1, 0, 0, 0))
           : part == 1 ? _mm_shuffle_ps(a, a, _MM_SHUFFLE(2, 2, 1, 1))
                       : _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 3, 3, 2));
}

#elif SH_SIMD == SH_SIMD_NEON
#if !SHI_HAS_NEON
#error "SH_SIMD is SH_SIMD_NEON, but the compiler's target has no little-endian NEON"
#endif
#include <arm_neon.h>
#define SH_SIMD_NAME "NEON"
#define SHI_LANES 4
typedef float32x4_t shi_v;
typedef int32x4_t shi_i;
typedef uint32x4_t shi_m;
SHI_INLINE shi_v shi_splat(float a) { return vdupq_n_f32(a); }
SHI_INLINE shi_v shi_load(const void *p) { return vreinterpretq_f32_u8(vld1q_u8((const uint8_t *)p)); }
SHI_INLINE void shi_store(void *p, shi_v a) { vst1q_u8((uint8_t *)p, vreinterpretq_u8_f32(a)); }
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return vaddq_f32(a, b); }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return vsubq_f32(a, b); }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return vmulq_f32(a, b); }
#if defined(__aarch64__) || defined(_M_ARM64)
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return vdivq_f32(a, b); }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return vsqrtq_f32(a); }
#define SHI_HAS_HALF 1
SHI_INLINE shi_v shi_load_half(const void *p) { return vcvt_f32_f16(vreinterpret_f16_u8(vld1_u8((const uint8_t *)p))); }
#else
/* 32-bit NEON has estimates only; division and square root lane by lane are correctly rounded and not in any inner loop's way. */
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) {
    float x[4], y[4];
    vst1q_f32(x, a);
    vst1q_f32(y, b);
    for (int i = 0; i < 4; i++)
        x[i] /= y[i];
    return vld1q_f32(x);
}
SHI_INLINE shi_v shi_sqrt(shi_v a) {
    float x[4];
    vst1q_f32(x, a);
    for (int i = 0; i < 4; i++)
        x[i] = sqrtf(x[i]);
    return vld1q_f32(x);
}
#endif
#if defined(__ARM_FEATURE_FMA) || defined(_M_ARM64)
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return vfmaq_f32(c, a, b); }
#else
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return vaddq_f32(vmulq_f32(a, b), c); }
#endif
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
SHI_INLINE shi_v shi_abs(shi_v a) { return vabsq_f32(a); }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) {
    return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return vcltq_f32(a, b); }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return vbslq_f32(m, a, b); }
SHI_INLINE shi_i shi_iload16(const void *p) {
    return vmovl_s16(vreinterpret_s16_u8(vld1_u8((const uint8_t *)p)));
}
SHI_INLINE shi_i shi_iload32(const void *p) { return vreinterpretq_s32_u8(vld1q_u8((const uint8_t *)p)); }
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return vandq_s32(a, vdupq_n_s32(b)); }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return vaddq_s32(a, vdupq_n_s32(b)); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return vshlq_s32(a, vdupq_n_s32(n)); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) {
    return vreinterpretq_s32_u32(vshlq_u32(vreinterpretq_u32_s32(a), vdupq_n_s32(-n)));
}
SHI_INLINE shi_v shi_as_float(shi_i a) { return vreinterpretq_f32_s32(a); }
SHI_INLINE shi_v shi_to_float(shi_i a) { return vcvtq_f32_s32(a); }
SHI_INLINE void shi_transpose4(shi_v v[4]) {
    const float32x4x2_t a = vtrnq_f32(v[0], v[1]), b = vtrnq_f32(v[2], v[3]);
    v[0] = vcombine_f32(vget_low_f32(a.val[0]), vget_low_f32(b.val[0]));
    v[1] = vcombine_f32(vget_low_f32(a.val[1]), vget_low_f32(b.val[1]));
    v[2] = vcombine_f32(vget_high_f32(a.val[0]), vget_high_f32(b.val[0]));
    v[3] = vcombine_f32(vget_high_f32(a.val[1]), vget_high_f32(b.val[1]));
}
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    const float32x2_t lo = vget_low_f32(a), hi = vget_high_f32(a);
    return part == 0   ? vcombine_f32(vdup_lane_f32(lo, 0), lo)
           : part == 1 ? vcombine_f32(vdup_lane_f32(lo, 1), vdup_lane_f32(hi, 0))
                       : vcombine_f32(hi, vdup_lane_f32(hi, 1));
}

#elif SH_SIMD == SH_SIMD_WASM
#if !SHI_HAS_WASM
#error "SH_SIMD is SH_SIMD_WASM, but the compiler's target has no WebAssembly SIMD"
#endif
#include <wasm_simd128.h>
#define SH_SIMD_NAME "WebAssembly SIMD"
#define SHI_LANES 4
typedef v128_t shi_v;
typedef v128_t shi_i;
typedef v128_t shi_m;
SHI_INLINE shi_v shi_splat(float a) { return wasm_f32x4_splat(a); }
SHI_INLINE shi_v shi_load(const void *p) { return wasm_v128_load(p); }
SHI_INLINE void shi_store(void *p, shi_v a) { wasm_v128_store(p, a); }
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return wasm_f32x4_add(a, b); }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return wasm_f32x4_sub(a, b); }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return wasm_f32x4_mul(a, b); }
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return wasm_f32x4_div(a, b); }
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return wasm_f32x4_add(wasm_f32x4_mul(a, b), c); }
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return wasm_f32x4_pmin(b, a); }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return wasm_f32x4_pmax(b, a); }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return wasm_f32x4_sqrt(a); }
SHI_INLINE shi_v shi_abs(shi_v a) { return wasm_f32x4_abs(a); }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) { return wasm_v128_or(a, b); }
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return wasm_f32x4_lt(a, b); }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return wasm_v128_bitselect(a, b, m); }
SHI_INLINE shi_i shi_iload16(const void *p) { return wasm_i32x4_load16x4(p); }
SHI_INLINE shi_i shi_iload32(const void *p) { return wasm_v128_load(p); }
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return wasm_v128_and(a, wasm_i32x4_splat(b)); }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return wasm_i32x4_add(a, wasm_i32x4_splat(b)); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return wasm_i32x4_shl(a, (uint32_t)n); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) { return wasm_u32x4_shr(a, (uint32_t)n); }
SHI_INLINE shi_v shi_as_float(shi_i a) { return a; }
SHI_INLINE shi_v shi_to_float(shi_i a) { return wasm_f32x4_convert_i32x4(a); }
SHI_INLINE void shi_transpose4(shi_v v[4]) {
    const shi_v a = wasm_i32x4_shuffle(v[0], v[1], 0, 4, 1, 5), b = wasm_i32x4_shuffle(v[2], v[3], 0, 4, 1, 5);
    const shi_v c = wasm_i32x4_shuffle(v[0], v[1], 2, 6, 3, 7), d = wasm_i32x4_shuffle(v[2], v[3], 2, 6, 3, 7);
    v[0] = wasm_i64x2_shuffle(a, b, 0, 2);
    v[1] = wasm_i64x2_shuffle(a, b, 1, 3);
    v[2] = wasm_i64x2_shuffle(c, d, 0, 2);
    v[3] = wasm_i64x2_shuffle(c, d, 1, 3);
}
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    return part == 0   ? wasm_i32x4_shuffle(a, a, 0, 0, 0, 1)
           : part == 1 ? wasm_i32x4_shuffle(a, a, 1, 1, 2, 2)
                       : wasm_i32x4_shuffle(a, a, 2, 3, 3, 3);
}

#elif SH_SIMD == SH_SIMD_SCALAR
#define SH_SIMD_NAME "scalar"
#define SHI_LANES 1
typedef float shi_v;
typedef int32_t shi_i;
typedef int shi_m;
SHI_INLINE shi_v shi_splat(float a) { return a; }
SHI_INLINE shi_v shi_load(const void *p) {
    shi_v a;
    memcpy(&a, p, sizeof a);
    return a;
}
SHI_INLINE void shi_store(void *p, shi_v a) { memcpy(p, &a, sizeof a); }
SHI_INLINE shi_v shi_add(shi_v a, shi_v b) { return a + b; }
SHI_INLINE shi_v shi_sub(shi_v a, shi_v b) { return a - b; }
SHI_INLINE shi_v shi_mul(shi_v a, shi_v b) { return a * b; }
SHI_INLINE shi_v shi_div(shi_v a, shi_v b) { return a / b; }
SHI_INLINE shi_v shi_madd(shi_v a, shi_v b, shi_v c) { return a * b + c; }
SHI_INLINE shi_v shi_min(shi_v a, shi_v b) { return a < b ? a : b; }
SHI_INLINE shi_v shi_max(shi_v a, shi_v b) { return a > b ? a : b; }
SHI_INLINE shi_v shi_sqrt(shi_v a) { return sqrtf(a); }
SHI_INLINE shi_v shi_abs(shi_v a) { return fabsf(a); }
SHI_INLINE shi_i shi_iload16(const void *p) {
    int16_t a;
    memcpy(&a, p, sizeof a);
    return a;
}
SHI_INLINE shi_i shi_iload32(const void *p) {
    shi_i a;
    memcpy(&a, p, sizeof a);
    return a;
}
SHI_INLINE shi_i shi_iand(shi_i a, int b) { return a & b; }
SHI_INLINE shi_i shi_iadd(shi_i a, int b) { return (shi_i)((uint32_t)a + (uint32_t)b); }
SHI_INLINE shi_i shi_shl(shi_i a, int n) { return (shi_i)((uint32_t)a << n); }
SHI_INLINE shi_i shi_shr(shi_i a, int n) { return (shi_i)((uint32_t)a >> n); }
SHI_INLINE shi_v shi_as_float(shi_i a) { return shi_load(&a); }
SHI_INLINE shi_v shi_to_float(shi_i a) { return (float)a; }
SHI_INLINE shi_m shi_less(shi_v a, shi_v b) { return a < b; }
SHI_INLINE shi_v shi_select(shi_m m, shi_v a, shi_v b) { return m ? a : b; }
SHI_INLINE shi_v shi_or(shi_v a, shi_v b) {
    shi_i x = shi_iload32(&a) | shi_iload32(&b);
    return shi_load(&x);
}
SHI_INLINE shi_v shi_repeat3(shi_v a, int part) {
    (void)part;
    return a;
}
SHI_INLINE void shi_load4(const unsigned char *p, size_t stride, shi_v v[4]) {
    (void)stride;
    memcpy(v, p, 4 * sizeof *v);
}

#else
#error "SH_SIMD is not one of the SH_SIMD_... numbers"
#endif

#if SHI_LANES == 4
SHI_INLINE shi_v shi_load_fours(const unsigned char *p, size_t stride) {
    (void)stride;
    return shi_load(p);
}
#endif

#if SHI_LANES > 1
SHI_INLINE void shi_load4(const unsigned char *p, size_t stride, shi_v v[4]) {
    v[0] = shi_load_fours(p, 4 * stride);
    v[1] = shi_load_fours(p + stride, 4 * stride);
    v[2] = shi_load_fours(p + 2 * stride, 4 * stride);
    v[3] = shi_load_fours(p + 3 * stride, 4 * stride);
    shi_transpose4(v);
}
#endif

#if SH_SIMD == SH_SIMD_SSE2
SHI_INLINE void shi_store3(unsigned char *p, size_t stride, shi_v a, shi_v b, shi_v c) {
    shi_store_threes(p, stride, a, b, c);
}
#elif SH_SIMD != SH_SIMD_AVX2 && SH_SIMD != SH_SIMD_AVX512
SHI_INLINE void shi_store3(unsigned char *p, size_t stride, shi_v a, shi_v b, shi_v c) {
    float lanes[3][SHI_LANES];
    shi_store(lanes[0], a);
    shi_store(lanes[1], b);
    shi_store(lanes[2], c);
    for (int i = 0; i < SHI_LANES; i++, p += stride) {
        const float item[3] = { lanes[0][i], lanes[1][i], lanes[2][i] };
        memcpy(p, item, sizeof item);
    }
}
#endif

#if SHI_LANES <= 8
SHI_INLINE shi_v shi_load8(const void *p) { return shi_load(p); }
SHI_INLINE void shi_store8(void *p, shi_v a) { shi_store(p, a); }
#endif

SHI_INLINE shi_v shi_keep(shi_v a) {
#if defined(__GNUC__) && (SH_SIMD == SH_SIMD_AVX512 || SH_SIMD == SH_SIMD_AVX2 || SH_SIMD == SH_SIMD_SSE2)
    __asm__("" : "+x"(a));
#endif
    return a;
}

SHI_INLINE size_t shi_hide(size_t n) {
#if defined(__GNUC__) && SH_SIMD != SH_SIMD_SCALAR
    __asm__("" : "+r"(n));
#endif
    return n;
}

SHI_INLINE void shi_prefetch_line(const void *p) {
#if SH_SIMD == SH_SIMD_AVX512 || SH_SIMD == SH_SIMD_AVX2 || SH_SIMD == SH_SIMD_SSE2
    _mm_prefetch((const char *)p, _MM_HINT_T0);
#elif defined(__GNUC__) && !defined(__CUDACC__)
    __builtin_prefetch(p);
#else
    (void)p;
#endif
}

SHI_INLINE void shi_prefetch(const unsigned char *p) {
    shi_prefetch_line(p);
    if (2 * sizeof(shi_v) > 64)
        shi_prefetch_line(p + 64);
}

/* Four bytes a lane as a word whose low byte is the first. */
SHI_INLINE shi_i shi_iload_bytes(const unsigned char *p) {
#if SHI_LANES == 1
    return (shi_i)((uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24);
#else
    return shi_iload32(p);
#endif
}

/* ---- Batch evaluation -----------------------------------------------------------------------------------------------------------
 * Both reconstructions are one quadratic polynomial in x, y, z. With z^2 = 1 - x^2 - y^2 taken out, it has one coefficient per SH
 * coefficient, and a nested form costs one fused multiply-add for each but the first: the least possible. */

enum { SHI_BATCH = 1024 }; /* directions per block: their coordinates stay in the first-level cache while the channels go by */

enum { SHI_1, SHI_X, SHI_Y, SHI_Z, SHI_XX, SHI_XY, SHI_XZ, SHI_YY, SHI_YZ };

/* The polynomial R0 + w1 R1.n + w2 n'R2 n. */
SHI_INLINE void shi_polynomial_fold(int order, const float *c, float w1, float w2, float *p) {
    p[SHI_1] = c[SH_R0];
    if (order >= SH_L1) {
        p[SHI_X] = w1 * c[SH_X];
        p[SHI_Y] = w1 * c[SH_Y];
        p[SHI_Z] = w1 * c[SH_Z];
    }
    if (order >= SH_L2) {
        const float zz = -(c[SH_XX] + c[SH_YY]);
        p[SHI_1] += w2 * zz;
        p[SHI_XX] = w2 * (c[SH_XX] - zz);
        p[SHI_XY] = 2.0f * w2 * c[SH_XY];
        p[SHI_XZ] = 2.0f * w2 * c[SH_XZ];
        p[SHI_YY] = w2 * (c[SH_YY] - zz);
        p[SHI_YZ] = 2.0f * w2 * c[SH_YZ];
    }
}

SHI_INLINE shi_v shi_polynomial(int order, const shi_v *p, shi_v x, shi_v y, shi_v z) {
    if (order == SH_L0)
        return p[SHI_1];
    shi_v px = p[SHI_X], py = p[SHI_Y];
    if (order >= SH_L2) {
        px = shi_madd(p[SHI_XX], x, shi_madd(p[SHI_XY], y, shi_madd(p[SHI_XZ], z, px)));
        py = shi_madd(p[SHI_YY], y, shi_madd(p[SHI_YZ], z, py));
    }
    return shi_madd(px, x, shi_madd(py, y, shi_madd(p[SHI_Z], z, p[SHI_1])));
}

/* sums += factor * values, twice: two share the load of a factor. */
SHI_INLINE void shi_madd_both(shi_v factor, shi_v a, shi_v b, shi_v *sum_a, shi_v *sum_b) {
    factor = shi_keep(factor);
    *sum_a = shi_madd(factor, a, *sum_a);
    *sum_b = shi_madd(factor, b, *sum_b);
}

/* shi_polynomial of two vectors of directions a and b, each x, y, z, for kernels whose coefficients do not all fit into registers. */
SHI_INLINE void shi_polynomial_two(int order, const shi_v *p, const shi_v *a, const shi_v *b, shi_v out[2]) {
    shi_v c = p[SHI_1], d = p[SHI_1];
    if (order >= SH_L1) {
        shi_v px_a = p[SHI_X], px_b = p[SHI_X], py_a = p[SHI_Y], py_b = p[SHI_Y];
        if (order >= SH_L2) {
            shi_madd_both(p[SHI_XZ], a[2], b[2], &px_a, &px_b);
            shi_madd_both(p[SHI_YZ], a[2], b[2], &py_a, &py_b);
            shi_madd_both(p[SHI_XY], a[1], b[1], &px_a, &px_b);
            shi_madd_both(p[SHI_YY], a[1], b[1], &py_a, &py_b);
            shi_madd_both(p[SHI_XX], a[0], b[0], &px_a, &px_b);
        }
        shi_madd_both(p[SHI_Z], a[2], b[2], &c, &d);
        c = shi_madd(px_a, a[0], shi_madd(py_a, a[1], c));
        d = shi_madd(px_b, b[0], shi_madd(py_b, b[1], d));
    }
    out[0] = c;
    out[1] = d;
}

SHI_INLINE void shi_splat_all(int order, const float *p, shi_v *v) {
    for (int i = 0; i < SH_COUNT(order); i++)
        v[i] = shi_splat(p[i]);
}

/* One channel of `count` directions, a multiple of SHI_LANES. Unless NULL, as many floats from `next_in` and `next_out` on are asked
 * for: what the next block needs, in small portions, while there is arithmetic to do. */
SHI_INLINE void shi_evaluate(int order, const float *polynomial, const float *x, const float *y, const float *z, float *out,
                             size_t count, const float *next_in, const float *next_out) {
    shi_v p[SH_COUNT(SH_L2)];
    shi_splat_all(order, polynomial, p);
    SHI_UNROLL(2)
    for (size_t i = 0; i < count; i += SHI_LANES) {
        shi_store(out + i, shi_polynomial(order, p, shi_load(x + i), shi_load(y + i), shi_load(z + i)));
        if (next_out) {
            shi_prefetch_line(next_in + i);
            shi_prefetch_line(next_out + i);
        }
    }
}

/* A block of directions copied out of the caller's arrays, padded to whole vectors, and one channel of results. */
typedef struct shi_block {
    float x[SHI_BATCH], y[SHI_BATCH], z[SHI_BATCH], out[SHI_BATCH];
} shi_block;

SHI_INLINE size_t shi_round_up(size_t count) {
    return (count + SHI_LANES - 1) / SHI_LANES * SHI_LANES;
}

SHI_INLINE void shi_copy_padded(const float *in, size_t count, float *out) {
    memcpy(out, in, count * sizeof *out);
    for (size_t i = count; i < shi_round_up(count); i++)
        out[i] = 0.0f;
}

/* A block's directions: `count` of three arrays, or of items `stride` bytes apart. */
SHI_INLINE void shi_block_copy(const float *x, const float *y, const float *z, size_t count, shi_block *block) {
    shi_copy_padded(x, count, block->x);
    shi_copy_padded(y, count, block->y);
    shi_copy_padded(z, count, block->z);
}

SHI_INLINE void shi_block_gather(const unsigned char *in, size_t stride, size_t count, shi_block *block) {
    for (size_t j = 0; j < shi_round_up(count); j++) {
        float d[3] = { 0.0f, 0.0f, 0.0f };
        if (j < count)
            memcpy(d, in + j * stride, sizeof d);
        block->x[j] = d[0];
        block->y[j] = d[1];
        block->z[j] = d[2];
    }
}

/* A block's results to floats `stride` bytes apart. */
SHI_INLINE void shi_block_scatter(const shi_block *block, size_t count, unsigned char *out, size_t stride) {
    for (size_t j = 0; j < count; j++)
        memcpy(out + j * stride, block->out + j, sizeof(float));
}

/* Whether two arrays of floats share memory. */
SHI_INLINE int shi_overlap(const float *a, size_t a_count, const float *b, size_t b_count) {
    const uintptr_t p = (uintptr_t)a, q = (uintptr_t)b;
    return p < q + b_count * sizeof *b && q < p + a_count * sizeof *a;
}

/* Whether a batch's output shares memory with one of its three inputs. */
SHI_INLINE int shi_overlaps_any(const float *x, const float *y, const float *z, size_t count, const float *out, size_t total) {
    return shi_overlap(x, count, out, total) || shi_overlap(y, count, out, total) || shi_overlap(z, count, out, total);
}

SHI_INLINE size_t shi_at_most(size_t count, size_t limit) {
    return count < limit ? count : limit;
}

/* The arguments of a planar batch: the reconstruction's factors of bands 1 and 2, and the caller's. */
typedef struct shi_soa {
    float w1, w2;
    int channels;
    const float *c, *x, *y, *z;
    float *out;
    size_t count;
} shi_soa;

SHI_INLINE void shi_evaluate_soa(int order, const shi_soa *job) {
    const float *x = job->x, *y = job->y, *z = job->z;
    const size_t count = job->count, total = (size_t)job->channels * count;
    const int copy = shi_overlaps_any(x, y, z, count, job->out, total);
    for (size_t i = 0; i < count; i += SHI_BATCH) {
        const size_t n = shi_at_most(count - i, SHI_BATCH);
        const size_t whole = copy ? 0 : n / SHI_LANES * SHI_LANES, rest = n - whole; /* in place; through a copy */
        float fold[2][SH_COUNT(SH_L2)]; /* the next channel is folded while this one is evaluated */
        shi_block block;
        if (rest)
            shi_block_copy(x + i + whole, y + i + whole, z + i + whole, rest, &block);
        shi_polynomial_fold(order, job->c, job->w1, job->w2, fold[0]);
        for (int k = 0; k < job->channels; k++) {
            const float *polynomial = fold[k % 2];
            float *out = job->out + (size_t)k * count + i;
            if (k + 1 < job->channels)
                shi_polynomial_fold(order, job->c + (k + 1) * SH_COUNT(order), job->w1, job->w2, fold[(k + 1) % 2]);
            if (order >= SH_L2 && count - i >= 2 * SHI_BATCH) { /* below, there is too little arithmetic to hide anything behind */
                const float *next_in = k % 3 == 0 ? x : k % 3 == 1 ? y : z;
                shi_evaluate(order, polynomial, x + i, y + i, z + i, out, whole, next_in + i + SHI_BATCH, out + SHI_BATCH);
            } else {
                shi_evaluate(order, polynomial, x + i, y + i, z + i, out, whole, NULL, NULL);
            }
            if (rest) {
                shi_evaluate(order, polynomial, block.x, block.y, block.z, block.out, shi_round_up(rest), NULL, NULL);
                memcpy(out + whole, block.out, rest * sizeof *out);
            }
        }
    }
}

/* One function per order: a literal order calls one of them and leaves the others out. */
SHI_FUNCTION void shi_evaluate_soa_l0(const shi_soa *job) { shi_evaluate_soa(SH_L0, job); }
SHI_FUNCTION void shi_evaluate_soa_l1(const shi_soa *job) { shi_evaluate_soa(SH_L1, job); }
SHI_FUNCTION void shi_evaluate_soa_l2(const shi_soa *job) { shi_evaluate_soa(SH_L2, job); }
SHI_INLINE void shi_evaluate_soa_any(int order, const shi_soa *job) {
    if (order == SH_L0)
        shi_evaluate_soa_l0(job);
    else if (order == SH_L1)
        shi_evaluate_soa_l1(job);
    else
        shi_evaluate_soa_l2(job);
}

SHI_INLINE void sh_radiance_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                                  size_t count) {
    const shi_soa job = { 3.0f, 7.5f, channels, c, x, y, z, out, count };
    shi_evaluate_soa_any(order, &job);
}

SHI_INLINE void sh_irradiance_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                    float *out, size_t count) {
    const shi_soa job = { 2.0f, 1.875f, channels, c, x, y, z, out, count };
    shi_evaluate_soa_any(order, &job);
}

/* The arguments of an interleaved batch; strides in bytes. */
typedef struct shi_aos {
    float w1, w2;
    int channels;
    const float *c;
    const unsigned char *in;
    size_t in_stride;
    unsigned char *out;
    size_t out_stride, count;
} shi_aos;

/* By way of planar blocks: any number of channels. */
SHI_INLINE void shi_evaluate_aos_blocks(int order, const shi_aos *job) {
    for (size_t i = 0; i < job->count; i += SHI_BATCH) {
        const size_t n = shi_at_most(job->count - i, SHI_BATCH);
        shi_block block;
        shi_block_gather(job->in + i * job->in_stride, job->in_stride, n, &block);
        for (int k = 0; k < job->channels; k++) {
            float polynomial[SH_COUNT(SH_L2)];
            shi_polynomial_fold(order, job->c + k * SH_COUNT(order), job->w1, job->w2, polynomial);
            shi_evaluate(order, polynomial, block.x, block.y, block.z, block.out, shi_round_up(n), NULL, NULL);
            shi_block_scatter(&block, n, job->out + i * job->out_stride + (size_t)k * sizeof(float), job->out_stride);
        }
    }
}

/* Three channels, whose polynomials lie one after the other, of 2 * SHI_LANES items, transposed in registers. load4 reads one float
 * past a direction. */
SHI_INLINE void shi_evaluate_aos_pass(int order, const shi_v *p, const unsigned char *in, size_t in_stride,
                                      unsigned char *out, size_t out_stride) {
    shi_v a[4], b[4], v[3][2];
    shi_load4(in, in_stride, a);
    shi_load4(in + SHI_LANES * in_stride, in_stride, b);
    SHI_UNROLL(9)
    for (int k = 0; k < 3; k++)
        shi_polynomial_two(order, p + k * SH_COUNT(order), a, b, v[k]);
    shi_store3(out, out_stride, v[0][0], v[1][0], v[2][0]);
    shi_store3(out + SHI_LANES * out_stride, out_stride, v[0][1], v[1][1], v[2][1]);
}

/* The last pass, of at most 2 * SHI_LANES items, goes through a copy. */
SHI_INLINE void shi_evaluate_aos_rgb(int order, const shi_aos *job) {
    const unsigned char *in = job->in;
    unsigned char *out = job->out;
    size_t left = job->count;
    shi_v p[3 * SH_COUNT(SH_L2)];
    float copy[2 * SHI_LANES][4];
    for (int k = 0; k < 3; k++) {
        float polynomial[SH_COUNT(SH_L2)];
        shi_polynomial_fold(order, job->c + k * SH_COUNT(order), job->w1, job->w2, polynomial);
        shi_splat_all(order, polynomial, p + k * SH_COUNT(order));
    }
    for (; left > 2 * SHI_LANES; left -= 2 * SHI_LANES) {
        const size_t in_stride = shi_hide(job->in_stride), out_stride = shi_hide(job->out_stride);
        shi_evaluate_aos_pass(order, p, in, in_stride, out, out_stride);
        in += 2 * SHI_LANES * in_stride;
        out += 2 * SHI_LANES * out_stride;
    }
    memset(copy, 0, sizeof copy);
    for (size_t i = 0; i < left; i++)
        memcpy(copy[i], in + i * job->in_stride, 3 * sizeof(float));
    shi_evaluate_aos_pass(order, p, (const unsigned char *)copy, sizeof copy[0], (unsigned char *)copy, sizeof copy[0]);
    for (size_t i = 0; i < left; i++)
        memcpy(out + i * job->out_stride, copy[i], 3 * sizeof(float));
}

SHI_INLINE void shi_evaluate_aos(int order, const shi_aos *job) {
    if (job->channels == 3)
        shi_evaluate_aos_rgb(order, job);
    else
        shi_evaluate_aos_blocks(order, job);
}

SHI_FUNCTION void shi_evaluate_aos_l0(const shi_aos *job) { shi_evaluate_aos(SH_L0, job); }
SHI_FUNCTION void shi_evaluate_aos_l1(const shi_aos *job) { shi_evaluate_aos(SH_L1, job); }
SHI_FUNCTION void shi_evaluate_aos_l2(const shi_aos *job) { shi_evaluate_aos(SH_L2, job); }
SHI_INLINE void shi_evaluate_aos_any(int order, float w1, float w2, int channels, const float *c, const float *dir, size_t dir_stride,
                                     float *out, size_t out_stride, size_t count) {
    const shi_aos job = { w1, w2, channels, c, (const unsigned char *)dir, dir_stride ? dir_stride : 3 * sizeof *dir,
                          (unsigned char *)out, out_stride ? out_stride : (size_t)channels * sizeof *out, count };
    if (order == SH_L0)
        shi_evaluate_aos_l0(&job);
    else if (order == SH_L1)
        shi_evaluate_aos_l1(&job);
    else
        shi_evaluate_aos_l2(&job);
}

SHI_INLINE void sh_radiance_batch_aos(int order, int channels, const float *c, const float *dir, size_t dir_stride, float *out,
                                      size_t out_stride, size_t count) {
    shi_evaluate_aos_any(order, 3.0f, 7.5f, channels, c, dir, dir_stride, out, out_stride, count);
}

SHI_INLINE void sh_irradiance_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                        size_t out_stride, size_t count) {
    shi_evaluate_aos_any(order, 2.0f, 1.875f, channels, c, n, n_stride, out, out_stride, count);
}

/* One item's channel is nine floats: they are transposed to a vector per coefficient, SHI_LANES items at a time. Two loads of
 * four and one of the last four, of which the first three are known already, stay inside the item. */
SHI_INLINE void shi_load_coefficients(int order, const unsigned char *c, size_t stride, shi_v *v) {
    shi_v last[4];
    shi_load4(c, stride, v);
    if (order >= SH_L2) {
        shi_load4(c + 4 * sizeof(float), stride, v + 4);
        shi_load4(c + 5 * sizeof(float), stride, last);
        v[SH_YZ] = last[3];
    }
}

/* Irradiance by lane: R0 + 2 R1.n + 15/8 (xx (x^2 - z^2) + yy (y^2 - z^2) + 2 (xy xy + xz xz + yz yz)). */
SHI_INLINE shi_v shi_irradiance_lanes(int order, const shi_v *c, shi_v x, shi_v y, shi_v z) {
    shi_v sum = shi_madd(c[SH_Z], z, shi_madd(c[SH_Y], y, shi_mul(c[SH_X], x)));
    if (order >= SH_L2) {
        const shi_v zz = shi_mul(z, z), a = shi_sub(shi_mul(x, x), zz), b = shi_sub(shi_mul(y, y), zz);
        const shi_v mixed = shi_madd(c[SH_XY], shi_mul(x, y), shi_madd(c[SH_XZ], shi_mul(x, z), shi_mul(c[SH_YZ], shi_mul(y, z))));
        const shi_v diagonal = shi_madd(c[SH_XX], a, shi_mul(c[SH_YY], b));
        sum = shi_madd(shi_splat(0.9375f), diagonal, shi_madd(shi_splat(1.875f), mixed, sum));
    }
    return shi_madd(shi_splat(2.0f), sum, c[SH_R0]);
}

/* A channel of fewer than SHI_LANES items, copied out and padded. */
SHI_INLINE void shi_copy_coefficients(int order, int channels, const float *c, size_t count, float *out) {
    memset(out, 0, SHI_LANES * (size_t)SH_COUNT(order) * sizeof *out);
    for (size_t i = 0; i < count; i++)
        memcpy(out + i * (size_t)SH_COUNT(order), c + i * (size_t)(channels * SH_COUNT(order)), (size_t)SH_COUNT(order) * sizeof *out);
}

/* Order 1 or 2. */
SHI_INLINE void shi_evaluate_probes(int order, int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                                    size_t count) {
    const size_t set = (size_t)SH_COUNT(order), item = set * (size_t)channels;
    for (size_t i = 0; i < count; i += SHI_LANES) {
        const size_t n = shi_at_most(count - i, SHI_LANES);
        float coords[3][SHI_LANES], sets[SHI_LANES * SH_COUNT(SH_L2)], results[SHI_LANES];
        shi_copy_padded(x + i, n, coords[0]);
        shi_copy_padded(y + i, n, coords[1]);
        shi_copy_padded(z + i, n, coords[2]);
        const shi_v vx = shi_load(coords[0]), vy = shi_load(coords[1]), vz = shi_load(coords[2]);
        for (int k = 0; k < channels; k++) {
            const float *ck = c + i * item + (size_t)k * set;
            shi_v v[SH_COUNT(SH_L2)];
            if (n == SHI_LANES) {
                shi_load_coefficients(order, (const unsigned char *)ck, item * sizeof *c, v);
                shi_store(out + (size_t)k * count + i, shi_irradiance_lanes(order, v, vx, vy, vz));
            } else {
                shi_copy_coefficients(order, channels, ck, n, sets);
                shi_load_coefficients(order, (const unsigned char *)sets, set * sizeof *c, v);
                shi_store(results, shi_irradiance_lanes(order, v, vx, vy, vz));
                memcpy(out + (size_t)k * count + i, results, n * sizeof *out);
            }
        }
    }
}
SHI_FUNCTION void shi_evaluate_probes_l1(int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                                         size_t count) {
    shi_evaluate_probes(SH_L1, channels, c, x, y, z, out, count);
}
SHI_FUNCTION void shi_evaluate_probes_l2(int channels, const float *c, const float *x, const float *y, const float *z, float *out,
                                         size_t count) {
    shi_evaluate_probes(SH_L2, channels, c, x, y, z, out, count);
}

SHI_INLINE void sh_irradiance_probes_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                           float *out, size_t count) {
    if (order == SH_L2)
        shi_evaluate_probes_l2(channels, c, x, y, z, out, count);
    else if (order == SH_L1)
        shi_evaluate_probes_l1(channels, c, x, y, z, out, count);
    else
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < channels; k++)
                out[(size_t)k * count + i] = c[i * (size_t)channels + (size_t)k];
}

/* ---- Projection of samples ------------------------------------------------------------------------------------------------------
 * Sums in float vectors over short chunks, these in float vectors over a run of chunks, the runs in double. */

enum { SHI_CHUNK = 16 * SHI_LANES, SHI_RUN = 16 * SHI_CHUNK };

/* Sums of w, v, vx, vy, vz, vxx, vxy, vxz, vyy, vyz, where v = weight * value. */
enum { SHI_SAMPLE_WEIGHT = SH_COUNT(SH_L2), SHI_SAMPLE_SUMS };

/* Adds a chunk of `count` samples, a multiple of SHI_LANES; weight NULL: all 1. */
SHI_INLINE void shi_sum_chunk(int order, const float *x, const float *y, const float *z, const float *value, const float *weight,
                              size_t count, shi_v total[SHI_SAMPLE_SUMS]) {
    const shi_v zero = shi_splat(0.0f);
    shi_v w0 = zero, s0 = zero, sx = zero, sy = zero, sz = zero, sxx = zero, sxy = zero, sxz = zero, syy = zero, syz = zero;
    for (size_t i = 0; i < count; i += SHI_LANES) {
        const shi_v px = shi_load(x + i), py = shi_load(y + i), pz = shi_load(z + i);
        shi_v v = shi_load(value + i);
        if (weight) {
            const shi_v w = shi_load(weight + i);
            w0 = shi_add(w0, w);
            s0 = shi_madd(v, w, s0);
            v = shi_mul(v, w);
        } else {
            s0 = shi_add(s0, v);
        }
        if (order >= SH_L1) {
            sx = shi_madd(v, px, sx);
            sy = shi_madd(v, py, sy);
            sz = shi_madd(v, pz, sz);
            if (order >= SH_L2) {
                const shi_v vx = shi_mul(v, px), vy = shi_mul(v, py);
                sxx = shi_madd(vx, px, sxx);
                sxy = shi_madd(vx, py, sxy);
                sxz = shi_madd(vx, pz, sxz);
                syy = shi_madd(vy, py, syy);
                syz = shi_madd(vy, pz, syz);
            }
        }
    }
    const shi_v sums[SHI_SAMPLE_SUMS] = { s0, sx, sy, sz, sxx, sxy, sxz, syy, syz, w0 };
    for (int i = 0; i < SHI_SAMPLE_SUMS; i++)
        total[i] = shi_add(total[i], sums[i]);
}

/* Adds a run's sums to an accumulator. */
SHI_FUNCTION void shi_sum_run(int order, const shi_v total[SHI_SAMPLE_SUMS], sh_accum *accum) {
    double sum[SHI_SAMPLE_SUMS] = { 0 };
    for (int i = 0; i < SHI_SAMPLE_SUMS; i++) {
        float lanes[SHI_LANES];
        shi_store(lanes, total[i]);
        for (int j = 0; j < SHI_LANES; j++)
            sum[i] += (double)lanes[j];
    }
    const double third = sum[SH_R0] / 3.0;
    if (order >= SH_L2) {
        sum[SH_XX] -= third;
        sum[SH_YY] -= third;
    }
    for (int i = 0; i < SH_COUNT(order); i++)
        accum->sum[i] += sum[i];
    accum->weight += sum[SHI_SAMPLE_WEIGHT];
}

/* Planar samples, as in sh_accum_samples. */
typedef struct shi_samples {
    const float *x, *y, *z, *value, *weight;
    size_t count;
} shi_samples;

/* Samples [first, first + count), fewer than SHI_LANES, by way of a padded copy. */
SHI_INLINE void shi_sum_tail(int order, const shi_samples *s, size_t first, size_t count, shi_v total[SHI_SAMPLE_SUMS]) {
    float tail[5][SHI_LANES];
    shi_copy_padded(s->x + first, count, tail[0]);
    shi_copy_padded(s->y + first, count, tail[1]);
    shi_copy_padded(s->z + first, count, tail[2]);
    shi_copy_padded(s->value + first, count, tail[3]);
    if (s->weight)
        shi_copy_padded(s->weight + first, count, tail[4]);
    shi_sum_chunk(order, tail[0], tail[1], tail[2], tail[3], s->weight ? tail[4] : NULL, SHI_LANES, total);
}

SHI_INLINE void shi_accum_channel(int order, const shi_samples *s, sh_accum *accum) {
    const size_t whole = s->count / SHI_LANES * SHI_LANES;
    for (size_t run = 0; run < s->count; run += SHI_RUN) {
        const size_t end = run + shi_at_most(s->count - run, SHI_RUN), whole_end = run + shi_at_most(whole - run, SHI_RUN);
        shi_v total[SHI_SAMPLE_SUMS];
        for (int i = 0; i < SHI_SAMPLE_SUMS; i++)
            total[i] = shi_splat(0.0f);
        for (size_t i = run; i < whole_end; i += SHI_CHUNK)
            shi_sum_chunk(order, s->x + i, s->y + i, s->z + i, s->value + i, s->weight ? s->weight + i : NULL,
                          shi_at_most(whole_end - i, SHI_CHUNK), total);
        if (whole_end < end)
            shi_sum_tail(order, s, whole_end, end - whole_end, total);
        shi_sum_run(order, total, accum);
    }
    if (!s->weight)
        accum->weight += (double)s->count;
}
SHI_FUNCTION void shi_accum_channel_l0(const shi_samples *s, sh_accum *accum) { shi_accum_channel(SH_L0, s, accum); }
SHI_FUNCTION void shi_accum_channel_l1(const shi_samples *s, sh_accum *accum) { shi_accum_channel(SH_L1, s, accum); }
SHI_FUNCTION void shi_accum_channel_l2(const shi_samples *s, sh_accum *accum) { shi_accum_channel(SH_L2, s, accum); }

SHI_INLINE int sh_accum_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                const float *weight, size_t count, sh_accum *accum) {
    if (!shi_order_ok(order) || channels < 1 || !accum || (count && !(x && y && z && value)))
        return SH_ERROR_ARGUMENT;
    for (int k = 0; count && k < channels; k++) {
        const shi_samples samples = { x, y, z, value + (size_t)k * count, weight, count };
        if (order == SH_L0)
            shi_accum_channel_l0(&samples, accum + k);
        else if (order == SH_L1)
            shi_accum_channel_l1(&samples, accum + k);
        else
            shi_accum_channel_l2(&samples, accum + k);
    }
    return SH_OK;
}

SHI_INLINE int sh_project_samples(int order, int channels, const float *x, const float *y, const float *z, const float *value,
                                  const float *weight, size_t count, float *c) {
    if (!shi_order_ok(order) || channels < 1 || !c || (count && !(x && y && z && value)))
        return SH_ERROR_ARGUMENT;
    for (int k = 0; k < channels; k++) {
        sh_accum accum;
        sh_accum_clear(1, &accum);
        if (count)
            sh_accum_samples(order, 1, x, y, z, value + (size_t)k * count, weight, count, &accum);
        sh_accum_finish(order, 1, &accum, c + k * SH_COUNT(order));
    }
    return SH_OK;
}

/* ---- Batches of operators ------------------------------------------------------------------------------------------------------- */

enum {
    SHI_ROTATED = 8, /* coefficients that turn: x, y, z, xx, xy, xz, yy, yz */
    SHI_ROTATE_VECTORS = (SHI_ROTATED + SHI_LANES - 1) / SHI_LANES
};

/* Column j of the matrix that turns the eight coefficients, as vectors over its rows; all of one vector lie together. */
typedef struct shi_rotation {
    shi_v column[SHI_ROTATE_VECTORS][SHI_ROTATED];
} shi_rotation;

/* Rows 3 to 7 of a column are products of entries of two rows i, j of m: (0, 0), (0, 1), (0, 2), (1, 1), (1, 2). They are spread over
 * the lanes by multiplication with 0 and 1, which is exact and takes no shuffles. */
SHI_INLINE void shi_rotation_vector(const float m[9], int first, shi_v column[SHI_ROTATED]) {
    static const float is_i[2][16] = { { 0, 0, 0, 1, 1, 1 }, { 0, 0, 0, 0, 0, 0, 1, 1 } };
    static const float is_j[3][16] = { { 1, 0, 0, 1 }, { 0, 1, 0, 0, 1, 0, 1 }, { 0, 0, 1, 0, 0, 1, 0, 1 } };
    static const float is_first_band[16] = { 1, 1, 1 };
    const shi_v i0 = shi_load(is_i[0] + first), i1 = shi_load(is_i[1] + first), band = shi_load(is_first_band + first);
    const shi_v j0 = shi_load(is_j[0] + first), j1 = shi_load(is_j[1] + first), j2 = shi_load(is_j[2] + first);
    shi_v i[3], j[3];
    for (int k = 0; k < 3; k++) {
        i[k] = shi_madd(i0, shi_splat(m[k]), shi_mul(i1, shi_splat(m[3 + k])));
        j[k] = shi_madd(j0, shi_splat(m[k]), shi_madd(j1, shi_splat(m[3 + k]), shi_mul(j2, shi_splat(m[6 + k]))));
        column[k] = shi_mul(band, j[k]);
    }
    const shi_v zz = shi_mul(i[2], j[2]);
    column[3] = shi_sub(shi_mul(i[0], j[0]), zz);
    column[4] = shi_madd(i[0], j[1], shi_mul(i[1], j[0]));
    column[5] = shi_madd(i[0], j[2], shi_mul(i[2], j[0]));
    column[6] = shi_sub(shi_mul(i[1], j[1]), zz);
    column[7] = shi_madd(i[1], j[2], shi_mul(i[2], j[1]));
}

/* c: x of a set. Two chains of additions, so that sets overlap better. */
SHI_INLINE shi_v shi_rotate_vector(const shi_v column[SHI_ROTATED], const float *c) {
    shi_v a = shi_mul(column[0], shi_splat(c[0])), b = shi_mul(column[4], shi_splat(c[4]));
    a = shi_madd(column[1], shi_splat(c[1]), a);
    b = shi_madd(column[5], shi_splat(c[5]), b);
    a = shi_madd(column[2], shi_splat(c[2]), a);
    b = shi_madd(column[6], shi_splat(c[6]), b);
    a = shi_madd(column[3], shi_splat(c[3]), a);
    b = shi_madd(column[7], shi_splat(c[7]), b);
    return shi_add(a, b);
}

SHI_INLINE void shi_rotate_sets(const float *c, const float m[9], float *out, size_t sets) {
    shi_rotation rotation;
    for (int v = 0; v < SHI_ROTATE_VECTORS; v++)
        shi_rotation_vector(m, v * SHI_LANES, rotation.column[v]);
    for (size_t s = 0; s < sets; s++, c += SH_COUNT(SH_L2), out += SH_COUNT(SH_L2)) {
        shi_v turned[SHI_ROTATE_VECTORS];
        for (int v = 0; v < SHI_ROTATE_VECTORS; v++)
            turned[v] = shi_rotate_vector(rotation.column[v], c + SH_X);
        out[SH_R0] = c[SH_R0];
        for (int v = 0; v < SHI_ROTATE_VECTORS; v++)
            shi_store8(out + SH_X + v * SHI_LANES, turned[v]);
    }
}

SHI_FUNCTION void sh_rotate_batch(int order, const float *c, const float m[9], float *out, size_t sets) {
    if (SHI_LANES > 1 && order == SH_L2) {
        shi_rotate_sets(c, m, out, sets);
        return;
    }
    for (size_t s = 0; s < sets; s++) {
        const size_t at = s * (size_t)SH_COUNT(order);
        sh_rotate(order, c + at, m, out + at);
    }
}

/* A v + sum, for a row p, q, r of a matrix. */
SHI_INLINE shi_v shi_madd_row(shi_v p, shi_v q, shi_v r, shi_v x, shi_v y, shi_v z, shi_v sum) {
    return shi_madd(p, x, shi_madd(q, y, shi_madd(r, z, sum)));
}

/* An entry off the diagonal: first is of a1 b1' + b1 a1', second of AB + BA. */
SHI_INLINE shi_v shi_product_rest(shi_v a0, shi_v b0, shi_v a, shi_v b, shi_v first, shi_v second) {
    const shi_v sum = shi_madd(shi_splat(0.6f), first, shi_mul(shi_splat(15.0f / 7.0f), second));
    return shi_madd(a0, b, shi_madd(b0, a, sum));
}

/* sh_product of SHI_LANES pairs whose planes are `stride` floats apart. Named vectors, not arrays, and stores last: compilers keep them
 * in registers, and out may be a or b. */
SHI_INLINE void shi_product_block(int order, const float *a, const float *b, float *out, size_t stride) {
    const shi_v three = shi_splat(3.0f), zero = shi_splat(0.0f);
    const shi_v a0 = shi_load(a), b0 = shi_load(b);
    if (order < SH_L1) {
        shi_store(out, shi_mul(a0, b0));
        return;
    }
    const shi_v ax = shi_load(a + SH_X * stride), ay = shi_load(a + SH_Y * stride), az = shi_load(a + SH_Z * stride);
    const shi_v bx = shi_load(b + SH_X * stride), by = shi_load(b + SH_Y * stride), bz = shi_load(b + SH_Z * stride);
    const shi_v x = shi_mul(ax, bx), y = shi_mul(ay, by), z = shi_mul(az, bz), dot = shi_add(shi_add(x, y), z);
    const shi_v p0 = shi_madd(three, dot, shi_mul(a0, b0));
    const shi_v px = shi_madd(a0, bx, shi_mul(b0, ax)), py = shi_madd(a0, by, shi_mul(b0, ay)), pz = shi_madd(a0, bz, shi_mul(b0, az));
    if (order < SH_L2) {
        shi_store(out, p0);
        shi_store(out + SH_X * stride, px);
        shi_store(out + SH_Y * stride, py);
        shi_store(out + SH_Z * stride, pz);
        return;
    }
    const shi_v axx = shi_load(a + SH_XX * stride), axy = shi_load(a + SH_XY * stride), axz = shi_load(a + SH_XZ * stride);
    const shi_v ayy = shi_load(a + SH_YY * stride), ayz = shi_load(a + SH_YZ * stride);
    const shi_v bxx = shi_load(b + SH_XX * stride), bxy = shi_load(b + SH_XY * stride), bxz = shi_load(b + SH_XZ * stride);
    const shi_v byy = shi_load(b + SH_YY * stride), byz = shi_load(b + SH_YZ * stride);
    const shi_v minus_azz = shi_add(axx, ayy), minus_bzz = shi_add(bxx, byy);
    const shi_v azz = shi_sub(zero, minus_azz), bzz = shi_sub(zero, minus_bzz);

    const shi_v vx = shi_madd_row(axx, axy, axz, bx, by, bz, shi_madd_row(bxx, bxy, bxz, ax, ay, az, zero));
    const shi_v vy = shi_madd_row(axy, ayy, ayz, bx, by, bz, shi_madd_row(bxy, byy, byz, ax, ay, az, zero));
    const shi_v vz = shi_madd_row(axz, ayz, azz, bx, by, bz, shi_madd_row(bxz, byz, bzz, ax, ay, az, zero));
    const shi_v rx = shi_madd(three, vx, px), ry = shi_madd(three, vy, py), rz = shi_madd(three, vz, pz);

    const shi_v sxy = shi_madd(axz, byz, shi_madd(ayz, bxz, shi_madd(axy, minus_bzz, shi_mul(bxy, minus_azz))));
    const shi_v sxz = shi_sub(shi_madd(axy, byz, shi_mul(ayz, bxy)), shi_madd(axz, byy, shi_mul(bxz, ayy)));
    const shi_v syz = shi_sub(shi_madd(axy, bxz, shi_mul(axz, bxy)), shi_madd(ayz, bxx, shi_mul(byz, axx)));
    const shi_v rxy = shi_product_rest(a0, b0, axy, bxy, shi_madd(ax, by, shi_mul(ay, bx)), sxy);
    const shi_v rxz = shi_product_rest(a0, b0, axz, bxz, shi_madd(ax, bz, shi_mul(az, bx)), sxz);
    const shi_v ryz = shi_product_rest(a0, b0, ayz, byz, shi_madd(ay, bz, shi_mul(az, by)), syz);

    const shi_v xy = shi_mul(axy, bxy), xz = shi_mul(axz, bxz), yz = shi_mul(ayz, byz);
    const shi_v sxx = shi_madd(axx, bxx, shi_add(xy, xz)), syy = shi_madd(ayy, byy, shi_add(xy, yz));
    const shi_v szz = shi_madd(azz, bzz, shi_add(xz, yz)), trace = shi_add(shi_add(sxx, syy), szz);
    const shi_v isotropic = shi_madd(shi_splat(-0.4f), dot, shi_mul(shi_splat(-10.0f / 7.0f), trace));
    const shi_v dxx = shi_madd(shi_splat(1.2f), x, shi_madd(shi_splat(30.0f / 7.0f), sxx, isotropic));
    const shi_v dyy = shi_madd(shi_splat(1.2f), y, shi_madd(shi_splat(30.0f / 7.0f), syy, isotropic));
    shi_store(out, shi_madd(shi_splat(7.5f), trace, p0));
    shi_store(out + SH_X * stride, rx);
    shi_store(out + SH_Y * stride, ry);
    shi_store(out + SH_Z * stride, rz);
    shi_store(out + SH_XX * stride, shi_madd(a0, bxx, shi_madd(b0, axx, dxx)));
    shi_store(out + SH_XY * stride, rxy);
    shi_store(out + SH_XZ * stride, rxz);
    shi_store(out + SH_YY * stride, shi_madd(a0, byy, shi_madd(b0, ayy, dyy)));
    shi_store(out + SH_YZ * stride, ryz);
}

SHI_INLINE void shi_product_planes(int order, const float *a, const float *b, float *out, size_t count) {
    size_t p = 0;
    for (; p + SHI_LANES <= count; p += SHI_LANES)
        shi_product_block(order, a + p, b + p, out + p, count);
    if (p == count)
        return;
    float padded[2][SH_COUNT(SH_L2) * SHI_LANES] = { { 0 } };
    for (int i = 0; i < SH_COUNT(order); i++) {
        memcpy(padded[0] + i * SHI_LANES, a + (size_t)i * count + p, (count - p) * sizeof(float));
        memcpy(padded[1] + i * SHI_LANES, b + (size_t)i * count + p, (count - p) * sizeof(float));
    }
    shi_product_block(order, padded[0], padded[1], padded[0], SHI_LANES);
    for (int i = 0; i < SH_COUNT(order); i++)
        memcpy(out + (size_t)i * count + p, padded[0] + i * SHI_LANES, (count - p) * sizeof(float));
}

SHI_FUNCTION void sh_product_batch(int order, const float *a, const float *b, float *out, size_t count) {
    switch (order) {
    case SH_L0: shi_product_planes(SH_L0, a, b, out, count); break;
    case SH_L1: shi_product_planes(SH_L1, a, b, out, count); break;
    default: shi_product_planes(SH_L2, a, b, out, count); break;
    }
}

#if SHI_LANES > 1
/* The basis but its 1, as products p q - r, whose factors are spread over the lanes as in shi_rotation_vector. */
SHI_INLINE shi_v shi_basis_vector(const float dir[3], int first) {
    static const float p_is[3][8] = { { 1, 0, 0, 1, 1, 1 }, { 0, 1, 0, 0, 0, 0, 1, 1 }, { 0, 0, 1 } };
    static const float q_is[4][8] = { { 1, 1, 1 }, { 0, 0, 0, 1 }, { 0, 0, 0, 0, 1, 0, 1 }, { 0, 0, 0, 0, 0, 1, 0, 1 } };
    static const float minus_r[8] = { 0, 0, 0, -1.0f / 3.0f, 0, 0, -1.0f / 3.0f };
    const shi_v x = shi_splat(dir[0]), y = shi_splat(dir[1]), z = shi_splat(dir[2]);
    const shi_v p = shi_madd(shi_load8(p_is[0] + first), x, shi_madd(shi_load8(p_is[1] + first), y, shi_mul(shi_load8(p_is[2] + first), z)));
    const shi_v q = shi_madd(shi_load8(q_is[1] + first), x, shi_madd(shi_load8(q_is[2] + first), y,
                             shi_madd(shi_load8(q_is[3] + first), z, shi_load8(q_is[0] + first))));
    return shi_madd(p, q, shi_load8(minus_r + first));
}

SHI_INLINE void shi_add_zonal(int order, int channels, const float zonal[3], const float dir[3], const float *value, float *c) {
    static const float is_first[8] = { 1, 1, 1 }, is_second[8] = { 0, 0, 0, 1, 1, 1, 1, 1 };
    if (order < SH_L2) {
        shi_add_zonal_scalar(order, channels, zonal, dir, value, c);
        return;
    }
    SHI_UNROLL(9)
    for (int k = 0; k < channels; k++)
        shi_add_scaled(value[k], zonal[0], c + k * SH_COUNT(SH_L2));
    for (int first = 0; first < SHI_ROTATED; first += SHI_LANES) {
        const shi_v k1 = shi_splat(zonal[1]), k2 = shi_splat(zonal[2]);
        const shi_v factor = shi_madd(shi_load8(is_first + first), k1, shi_mul(shi_load8(is_second + first), k2));
        const shi_v lobe = shi_mul(factor, shi_basis_vector(dir, first));
        float *at = c + SH_X + first;
        SHI_UNROLL(9)
        for (int k = 0; k < channels; k++, at += SH_COUNT(SH_L2))
            shi_store8(at, shi_add(shi_load8(at), shi_mul(shi_splat(value[k]), lobe)));
    }
}
#else
SHI_INLINE void shi_add_zonal(int order, int channels, const float zonal[3], const float dir[3], const float *value, float *c) {
    shi_add_zonal_scalar(order, channels, zonal, dir, value, c);
}
#endif

/* ---- Images ---------------------------------------------------------------------------------------------------------------------
 * Rows are read in blocks of up to SHI_BLOCK pixels: in place where they are clean floats, decoded to floats otherwise, padded with
 * black to whole vectors. Float vectors add up SHI_CHAIN blocks of a row, then a group of SHI_GROUP rows; doubles add up the groups.
 * Interleaved channels stay so: vectors repeat their channels every `phases`. */

enum { SHI_BLOCK = SHI_LANES == 1 ? 32 : 128, SHI_PHASES = 4, SHI_GROUP = 16, SHI_CHAIN = 32 };
enum { SHI_MAX_SIDE = 1 << 28 }; /* 2 (x + SHI_BLOCK) is an int */

/* How texels lie in memory, and in the blocks that the kernels read: `planes` planes of `interleave` interleaved channels. */
typedef struct shi_layout {
    int channels;      /* colour channels: 1 or 3 */
    int interleave;    /* channels per pixel in a plane */
    int planes;
    size_t pixel_size; /* bytes */
} shi_layout;

/* 0 for a format and a number of channels that do not exist. */
SHI_FUNCTION int shi_image_layout(const sh_image *image, shi_layout *layout) {
    const int n = image->channels;
    const int packed = image->format == SH_RGBE8 || image->format == SH_RGB9E5;
    const int size = image->format == SH_F32 ? 4 : image->format == SH_F16 ? 2 : image->format == SH_SRGB8 ? 1 : 0;
    if (packed ? n != 3 && n != 4 : !size || (n != 1 && n != 3 && n != 4))
        return 0;
    layout->channels = n == 1 ? 1 : 3;
    layout->interleave = packed ? 1 : n;
    layout->planes = packed ? 3 : 1;
    layout->pixel_size = packed ? 4 : (size_t)(n * size);
    return 1;
}

SHI_FUNCTION int sh_image_channels(const sh_image *image) {
    return image->channels == 1 ? 1 : 3;
}

SHI_FUNCTION int shi_image_check(const sh_image *image, shi_layout *layout) {
    if (!image->pixels)
        return SH_ERROR_ARGUMENT;
    if (!shi_image_layout(image, layout))
        return SH_ERROR_FORMAT;
    const size_t limit = (size_t)-1 / 2;
    if (image->width < 1 || image->width > SHI_MAX_SIDE || image->height < 1 || image->height > SHI_MAX_SIDE ||
        (size_t)image->width > limit / layout->pixel_size)
        return SH_ERROR_SIZE;
    const size_t row = (size_t)image->width * layout->pixel_size, stride = image->row_stride ? image->row_stride : row;
    return stride < row || (size_t)image->height > limit / stride ? SH_ERROR_SIZE : SH_OK;
}

/* Reads an image's texels as floats. */
typedef struct shi_reader {
    const sh_image *image;
    shi_layout layout;
    size_t stride;
    unsigned flags;
    int look_for_negative;
    int careful;     /* look at every value: leave out, clamp, count in `report` */
    float scale;     /* what careful reading multiplies values by: below 1 if their sum overflows */
    sh_report report;
    float srgb[256]; /* linear value of an sRGB byte */
} shi_reader;

/* t^(1/5) for t in [0.004, 1], by Newton's method. */
SHI_FUNCTION double shi_fifth_root(double t) {
    double y = 1.0;
    for (int i = 0; i < 12; i++)
        y += (t / (y * y * y * y) - y) / 5.0;
    return y;
}

/* IEC 61966-2-1: b / 12.92 up to 0.04045, ((b + 0.055) / 1.055)^2.4 above. */
SHI_FUNCTION float shi_srgb_to_linear(int byte) {
    const double b = byte / 255.0, t = (b + 0.055) / 1.055, root = b > 0.04045 ? shi_fifth_root(t) : 0.0;
    return (float)(b > 0.04045 ? t * t * root * root : b / 12.92);
}

SHI_INLINE void shi_reader_use(shi_reader *reader, const sh_image *image) {
    reader->image = image;
    reader->stride = image->row_stride ? image->row_stride : (size_t)image->width * reader->layout.pixel_size;
}

/* Checks the images as well, of which there may be several, alike but for their pixels and strides. */
SHI_FUNCTION int shi_reader_init(const sh_image *image, int images, unsigned flags, const sh_report *report, shi_reader *reader) {
    for (int i = 0; i < images; i++) {
        const int status = shi_image_check(image + i, &reader->layout);
        if (status != SH_OK)
            return status;
        if (image[i].width != image->width || image[i].height != image->height)
            return SH_ERROR_SIZE;
        if (image[i].channels != image->channels || image[i].format != image->format)
            return SH_ERROR_FORMAT;
    }
    shi_reader_use(reader, image);
    reader->flags = flags;
    reader->look_for_negative = (report || flags & SH_CLAMP_NEGATIVE) && (image->format == SH_F32 || image->format == SH_F16);
    reader->careful = 0;
    reader->scale = 1.0f;
    reader->report.texels = reader->report.nonfinite = reader->report.negative = 0;
    if (image->format == SH_SRGB8)
        for (int i = 0; i < 256; i++)
            reader->srgb[i] = shi_srgb_to_linear(i);
    return SH_OK;
}

/* Halves to floats: the exponent is rebiased as an integer. Of a subnormal half, m 2^-24, that makes y = 2^-15 + m 2^-25, of which
 * 2y - 2^-14 is the value; of any other it is no less than y. No operand is a subnormal float, which -ffast-math and 32-bit NEON flush,
 * and which many processors are slow with. NaN becomes infinite, which is left out as well. */
SHI_INLINE shi_v shi_decode_half(const void *p) {
#if defined(SHI_HAS_HALF)
    return shi_load_half(p);
#else
    const shi_i h = shi_iload16(p);
    const shi_v y = shi_as_float(shi_iadd(shi_iand(shi_shl(h, 13), 0x0fffe000), 112 << 23));
    const shi_v magnitude = shi_min(y, shi_madd(y, shi_splat(2.0f), shi_splat(-1.0f / 16384)));
    const shi_v infinite = shi_as_float(shi_iadd(shi_iand(h, 0), 0x7f800000)), sign = shi_as_float(shi_iand(h, -0x7fffffff - 1));
    return shi_or(sign, shi_select(shi_less(magnitude, shi_splat(65536.0f)), magnitude, infinite));
#endif
}

SHI_INLINE void shi_decode_f16(const unsigned char *in, int count, float *out) {
    for (int i = 0; i < count; i += SHI_LANES)
        shi_store(out + i, shi_decode_half(in + 2 * i));
}

/* A word of three mantissas of `bits` bits each, lowest first, and an exponent whose scale is given. */
SHI_INLINE void shi_unpack_rgb(shi_i word, int bits, shi_v scale, float *out) {
    SHI_UNROLL(9)
    for (int k = 0; k < 3; k++)
        shi_store(out + k * SHI_BLOCK, shi_mul(shi_to_float(shi_iand(shi_shr(word, k * bits), (1 << bits) - 1)), scale));
}

SHI_INLINE void shi_decode_rgbe8(const unsigned char *in, int count, float *out) {
    for (int i = 0; i < count; i += SHI_LANES) {
        const shi_i word = shi_iload_bytes(in + 4 * i);
        const shi_v power = shi_as_float(shi_iand(shi_shr(word, 1), 0x7f800000)); /* 2^(e - 127); 0 for e = 0 */
        const shi_v highest = shi_splat(170141183460469231731687303715884105728.0f); /* 2^127 */
        shi_unpack_rgb(word, 8, shi_mul(shi_min(power, highest), shi_splat(1.0f / 512)), out + i);
    }
}

SHI_INLINE void shi_decode_rgb9e5(const unsigned char *in, int count, float *out) {
    for (int i = 0; i < count; i += SHI_LANES) {
        const shi_i word = shi_iload32(in + 4 * i);
        shi_unpack_rgb(word, 9, shi_as_float(shi_shl(shi_iadd(shi_shr(word, 27), 103), 23)), out + i); /* 2^(e - 24) */
    }
}

SHI_INLINE void shi_decode_srgb8(const unsigned char *in, const float *srgb, int count, float *out) {
    for (int i = 0; i < count; i++)
        out[i] = srgb[in[i]];
}

/* Leaves out, clamps, counts and scales, in a decoded block of `count` pixels. */
SHI_FUNCTION void shi_clean(shi_reader *reader, int count, float *pixels) {
    const int stride = reader->layout.interleave, channels = reader->layout.channels;
    for (int i = 0; i < count; i++) {
        float *texel = pixels + i * stride;
        int finite = 1, negative = 0;
        for (int k = 0; k < channels; k++)
            finite &= shi_is_finite(&texel[k]);
        for (int k = 0; k < channels; k++) {
            negative |= finite && texel[k] < 0.0f;
            texel[k] = !finite || (texel[k] < 0.0f && (reader->flags & SH_CLAMP_NEGATIVE)) ? 0.0f : reader->scale * texel[k];
        }
        reader->report.nonfinite += !finite;
        reader->report.negative += (uint64_t)negative;
    }
}

/* What a block of pixels is copied or decoded to. */
typedef struct shi_scratch {
    unsigned char raw[SHI_BLOCK * 16];
    float decoded[SHI_BLOCK * 4];
} shi_scratch;

SHI_FUNCTION const unsigned char *shi_decode_block(shi_reader *reader, const unsigned char *in, int count, int padded,
                                                   shi_scratch *scratch) {
    const size_t size = reader->layout.pixel_size;
    const int values = padded * reader->layout.interleave;
    if (count < padded) {
        memcpy(scratch->raw, in, (size_t)count * size);
        memset(scratch->raw + (size_t)count * size, 0, (size_t)(padded - count) * size);
        in = scratch->raw;
    }
    switch (reader->image->format) {
    case SH_F32:
        if (!reader->careful)
            return in;
        memcpy(scratch->decoded, in, (size_t)values * sizeof(float));
        break;
    case SH_F16: shi_decode_f16(in, values, scratch->decoded); break;
    case SH_RGBE8: shi_decode_rgbe8(in, padded, scratch->decoded); break;
    case SH_RGB9E5: shi_decode_rgb9e5(in, padded, scratch->decoded); break;
    case SH_SRGB8: shi_decode_srgb8(in, reader->srgb, values, scratch->decoded); break;
    }
    if (reader->careful && reader->layout.planes == 1)
        shi_clean(reader, count, scratch->decoded);
    else if (reader->careful) /* a shared exponent: finite, not negative */
        for (int i = 0; i < padded; i++)
            for (int plane = 0; plane < reader->layout.planes; plane++)
                scratch->decoded[plane * SHI_BLOCK + i] *= reader->scale;
    return (const unsigned char *)scratch->decoded;
}

SHI_INLINE const unsigned char *shi_texel(const shi_reader *reader, int row, int x) {
    return (const unsigned char *)reader->image->pixels + (size_t)row * reader->stride + (size_t)x * reader->layout.pixel_size;
}

/* Pixels x to x + count of a row as floats, padded with black to `padded` pixels, a multiple of SHI_LANES, both <= SHI_BLOCK. */
SHI_INLINE const unsigned char *shi_read_block(shi_reader *reader, int row, int x, int count, int padded, shi_scratch *scratch) {
    const unsigned char *in = shi_texel(reader, row, x);
    if (reader->image->format == SH_F32 && !reader->careful && count == padded)
        return in;
    return shi_decode_block(reader, in, count, padded, scratch);
}

/* ---- Equirectangular panoramas --------------------------------------------------------------------------------------------------
 * A row needs five sums over its texels: L times 1, cos p, sin p, cos 2p, sin 2p. Two texels half a turn apart share their
 * functions up to sign, so they are folded first. Within a block p is counted from the block's first column: all blocks share one
 * small table, and their sums are turned to the block's azimuth. */

enum { SHI_SUM, SHI_COS1, SHI_SIN1, SHI_COS2, SHI_SIN2, SHI_SUMS, SHI_MOMENTS = 9, SHI_FRAMES = 3 };

typedef struct shi_fold_sums {
    shi_v sum, cos1, sin1, cos2, sin2;
} shi_fold_sums;

/* What depends on a panorama's columns only: cos p, sin p, cos 2p, sin 2p for each vector of a block's columns, aligned and side by
 * side (four arrays a power of two apart would compete for the same cache lines); the angle of a block; and the factor that makes a
 * row's sum of frequency 0, 1, 2 a mean over azimuth. */
typedef struct shi_columns {
    shi_v table[SHI_BLOCK * 4 / SHI_LANES][4];
    double block_cos, block_sin, mean[3];
} shi_columns;

SHI_FUNCTION void shi_columns_init(int width, int interleave, int point, shi_columns *columns) {
    const double step = 2.0 * SHI_PI / width;
    const int padded = width < SHI_BLOCK ? (int)shi_round_up((size_t)width) : SHI_BLOCK;
    float lanes[4][SHI_LANES];
    for (int i = 0; i < padded; i++) {
        const double c = cos((i + 0.5) * step), s = sin((i + 0.5) * step);
        for (int j = i * interleave; j < (i + 1) * interleave; j++) {
            const int lane = j % SHI_LANES;
            lanes[0][lane] = (float)c;
            lanes[1][lane] = (float)s;
            lanes[2][lane] = (float)(c * c - s * s);
            lanes[3][lane] = (float)(2.0 * c * s);
            for (int f = 0; f < 4 && lane == SHI_LANES - 1; f++)
                columns->table[j / SHI_LANES][f] = shi_load(lanes[f]);
        }
    }
    columns->block_cos = cos((double)SHI_BLOCK * step);
    columns->block_sin = sin((double)SHI_BLOCK * step);
    /* A texel's width smears frequency k by sinc(k pi / width). Points see none of a frequency that is constant on all columns. */
    columns->mean[0] = 1.0 / width;
    columns->mean[1] = (point ? width > 1 : sin(0.5 * step) / (0.5 * step)) / width;
    columns->mean[2] = (point ? width > 2 : sin(step) / step) / width;
}

/* total += the sums of a block whose first column is at azimuth p: c1, s1, c2, s2 are the cosine and sine of p and of 2p. */
SHI_INLINE void shi_fold_turn(int order, const shi_fold_sums *s, const float turn[4], shi_v total[SHI_SUMS]) {
    total[SHI_SUM] = shi_add(total[SHI_SUM], s->sum);
    if (order >= SH_L1) {
        const shi_v c1 = shi_splat(turn[0]), s1 = shi_splat(turn[1]), minus_s1 = shi_splat(-turn[1]);
        total[SHI_COS1] = shi_madd(c1, s->cos1, shi_madd(minus_s1, s->sin1, total[SHI_COS1]));
        total[SHI_SIN1] = shi_madd(s1, s->cos1, shi_madd(c1, s->sin1, total[SHI_SIN1]));
    }
    if (order >= SH_L2) {
        const shi_v c2 = shi_splat(turn[2]), s2 = shi_splat(turn[3]), minus_s2 = shi_splat(-turn[3]);
        total[SHI_COS2] = shi_madd(c2, s->cos2, shi_madd(minus_s2, s->sin2, total[SHI_COS2]));
        total[SHI_SIN2] = shi_madd(s2, s->cos2, shi_madd(c2, s->sin2, total[SHI_SIN2]));
    }
}

/* Vectors after which interleaved channels fall on the same lanes again. */
SHI_INLINE int shi_phases(int interleave) {
    return SHI_LANES == 1 ? interleave : interleave == 3 ? 3 : 1;
}

/* Float sums of a group of rows: each of the moments of SHI_MOMENTS, by phase, in up to three frames of axes. */
typedef struct shi_group {
    int frames;
    shi_v moment[SHI_FRAMES][SHI_PHASES][SHI_MOMENTS];
    shi_v signs; /* the sign bits of all values read, where they are asked for */
} shi_group;

/* The sign bits of `count` floats, a multiple of SHI_LANES. */
SHI_INLINE shi_v shi_signs(const unsigned char *in, int count) {
    shi_v signs = shi_splat(0.0f);
    for (int i = 0; i < count; i += SHI_LANES)
        signs = shi_or(signs, shi_load(in + (size_t)i * sizeof(float)));
    return signs;
}

/* What comes next in memory: two rows and the bytes of each to ask for with every pass of a kernel's loop. Demand spread evenly, in
 * one direction, keeps more of it under way than a hardware prefetcher does for passes that go over a block by phase. */
typedef struct shi_next {
    const unsigned char *row[2];
    size_t step;
} shi_next;

/* So that the passes over a block ask for twice as many texels of each row as it has. */
SHI_INLINE shi_next shi_next_from(const shi_reader *reader, const unsigned char *a, const unsigned char *b) {
    const shi_layout *layout = &reader->layout;
    const shi_next next = { { a, b }, 2 * SHI_LANES * layout->pixel_size / (size_t)(layout->interleave * layout->planes) };
    return next;
}

SHI_INLINE void shi_next_ask(shi_next *next) {
    for (int r = 0; r < 2; r++) {
        shi_prefetch(next->row[r]);
        next->row[r] += next->step;
    }
}

/* Adds a block of two rows: here[r] and, half a turn further, opposite[r]. Two rows share the loads of the table. */
SHI_INLINE void shi_fold_block(int order, const unsigned char *const here[2], const unsigned char *const opposite[2], shi_next *next,
                               size_t vectors, int phases, const shi_columns *columns, const float turn[4],
                               shi_v total_a[SHI_PHASES][SHI_SUMS], shi_v total_b[SHI_PHASES][SHI_SUMS]) {
    const shi_v zero = shi_splat(0.0f);
    for (int phase = 0; phase < phases; phase++) {
        shi_fold_sums a = { zero, zero, zero, zero, zero }, b = a;
        for (size_t i = (size_t)phase; i < vectors; i += (size_t)phases) {
            const size_t at = i * sizeof(shi_v);
            const shi_v *table = columns->table[i];
            const shi_v here_a = shi_load(here[0] + at), opposite_a = shi_keep(shi_load(opposite[0] + at));
            const shi_v here_b = shi_load(here[1] + at), opposite_b = shi_keep(shi_load(opposite[1] + at));
            const shi_v even_a = shi_add(here_a, opposite_a), odd_a = shi_sub(here_a, opposite_a);
            const shi_v even_b = shi_add(here_b, opposite_b), odd_b = shi_sub(here_b, opposite_b);
            a.sum = shi_add(a.sum, even_a);
            b.sum = shi_add(b.sum, even_b);
            if (order >= SH_L1) {
                shi_madd_both(table[0], odd_a, odd_b, &a.cos1, &b.cos1);
                shi_madd_both(table[1], odd_a, odd_b, &a.sin1, &b.sin1);
            }
            if (order >= SH_L2) {
                shi_madd_both(table[2], even_a, even_b, &a.cos2, &b.cos2);
                shi_madd_both(table[3], even_a, even_b, &a.sin2, &b.sin2);
            }
            shi_next_ask(next);
        }
        shi_fold_turn(order, &a, turn, total_a[phase]);
        shi_fold_turn(order, &b, turn, total_b[phase]);
    }
}

/* Mean over a row's polar angle t of functions of it, times the row's share of the sphere. */
typedef struct shi_row_weights {
    double one, cos, sin, cos_cos, sin_cos;
} shi_row_weights;

/* The polar angle of an edge between rows, with its cosine and sine. */
typedef struct shi_edge {
    double angle, cos, sin;
} shi_edge;

SHI_INLINE shi_edge shi_edge_at(double angle) {
    const shi_edge edge = { angle, cos(angle), sin(angle) };
    return edge;
}

/* The edge one row further, by the addition theorem: good for a group of rows. */
SHI_INLINE shi_edge shi_edge_next(const shi_edge *edge, const shi_edge *step) {
    const shi_edge next = { edge->angle + step->angle, edge->cos * step->cos - edge->sin * step->sin,
                            edge->sin * step->cos + edge->cos * step->sin };
    return next;
}

/* Area texels: closed integrals from the row's upper edge to its lower. */
SHI_INLINE void shi_row_weights_area(const shi_edge *a, const shi_edge *b, shi_row_weights *w) {
    w->one = (a->cos - b->cos) / 2;
    w->cos = (b->sin * b->sin - a->sin * a->sin) / 4;
    w->sin = (b->angle - a->angle - (b->sin * b->cos - a->sin * a->cos)) / 4;
    w->cos_cos = (a->cos * a->cos * a->cos - b->cos * b->cos * b->cos) / 6;
    w->sin_cos = (b->sin * b->sin * b->sin - a->sin * a->sin * a->sin) / 6;
}

/* Point texels: Fejer's first rule, 1/H (1 - 2 sum_k cos(2 k t) / (4 k^2 - 1)), k <= K = H/2; exact for polynomials in cos t below
 * degree H. The cosines by their recurrence. K is W/2 + 1024 at most, exact below degree W + 2048: a narrow image takes time in
 * proportion to its texels, not to the square of its height. */
SHI_FUNCTION void shi_row_weights_point(int row, int width, int height, shi_row_weights *w) {
    const double t = SHI_PI * (row + 0.5) / height, c = cos(t), s = sin(t), cos2 = c * c - s * s;
    double sum = 0.5, previous = 1.0, current = cos2;
    for (int k = 1; k <= height / 2 && k <= width / 2 + 1024; k++) {
        const double next = 2.0 * cos2 * current - previous;
        sum -= current / (4.0 * k * k - 1.0);
        previous = current;
        current = next;
    }
    w->one = 2.0 * sum / height;
    w->cos = w->one * c;
    w->sin = w->one * s;
    w->cos_cos = w->one * c * c;
    w->sin_cos = w->one * s * c;
}

/* The moments that a row's five sums are spread to. */
enum { SHI_M_1, SHI_M_X, SHI_M_Y, SHI_M_Z, SHI_M_COS2, SHI_M_SIN2, SHI_M_XZ, SHI_M_YZ, SHI_M_ZZ };

SHI_INLINE void shi_row_spread(int order, const shi_row_weights *w, shi_v sums[SHI_SUMS], shi_v moment[SHI_MOMENTS]) {
    const shi_v sum = sums[SHI_SUM];
    moment[SHI_M_1] = shi_madd(shi_splat((float)w->one), sum, moment[SHI_M_1]);
    if (order >= SH_L1) {
        const shi_v sine = shi_splat((float)w->sin);
        moment[SHI_M_X] = shi_madd(sine, sums[SHI_COS1], moment[SHI_M_X]);
        moment[SHI_M_Y] = shi_madd(sine, sums[SHI_SIN1], moment[SHI_M_Y]);
        moment[SHI_M_Z] = shi_madd(shi_splat((float)w->cos), sum, moment[SHI_M_Z]);
    }
    if (order >= SH_L2) {
        const shi_v half = shi_splat((float)((w->one - w->cos_cos) / 2)), sin_cos = shi_splat((float)w->sin_cos);
        moment[SHI_M_COS2] = shi_madd(half, sums[SHI_COS2], moment[SHI_M_COS2]);
        moment[SHI_M_SIN2] = shi_madd(half, sums[SHI_SIN2], moment[SHI_M_SIN2]);
        moment[SHI_M_XZ] = shi_madd(sin_cos, sums[SHI_COS1], moment[SHI_M_XZ]);
        moment[SHI_M_YZ] = shi_madd(sin_cos, sums[SHI_SIN1], moment[SHI_M_YZ]);
        moment[SHI_M_ZZ] = shi_madd(shi_splat((float)w->cos_cos), sum, moment[SHI_M_ZZ]);
    }
}

/* The azimuth of a block's first column. */
typedef struct shi_azimuth {
    double cos, sin;
} shi_azimuth;

SHI_INLINE shi_azimuth shi_azimuth_next(shi_azimuth p, const shi_columns *columns) {
    const shi_azimuth next = { p.cos * columns->block_cos - p.sin * columns->block_sin,
                               p.sin * columns->block_cos + p.cos * columns->block_sin };
    return next;
}

/* Adds the block at column x of one or two rows from `row` on, and of what lies half a turn further if the row folds. */
SHI_INLINE void shi_fold_columns(int order, shi_reader *reader, const shi_columns *columns, int row, int rows, int x, int count,
                                 shi_azimuth p, shi_v total[2][SHI_PHASES][SHI_SUMS], shi_v *signs) {
    const int folds = reader->image->width % 2 == 0, further = folds ? reader->image->width / 2 + x : x;
    const int interleave = reader->layout.interleave, padded = (int)shi_round_up((size_t)count);
    const float turn[4] = { (float)p.cos, (float)p.sin, (float)(p.cos * p.cos - p.sin * p.sin), (float)(2.0 * p.cos * p.sin) };
    const unsigned char *here[2], *opposite[2];
    shi_scratch scratch[4];
    const int ahead = row + 3 < reader->image->height ? row + 2 : row;
    shi_next next = shi_next_from(reader, shi_texel(reader, ahead, 2 * x), shi_texel(reader, ahead + rows - 1, 2 * x));
    for (int r = 0; r < 2; r++) {
        here[r] = r < rows ? shi_read_block(reader, row + r, x, count, padded, &scratch[2 * r]) : here[0];
        opposite[r] = r < rows ? shi_read_block(reader, row + r, further, folds ? count : 0, padded, &scratch[2 * r + 1]) : opposite[0];
        if (reader->look_for_negative)
            *signs = shi_or(*signs, shi_or(shi_signs(here[r], padded * interleave), shi_signs(opposite[r], padded * interleave)));
    }
    for (int plane = 0; plane < reader->layout.planes; plane++) {
        shi_fold_block(order, here, opposite, &next, (size_t)(padded * interleave / SHI_LANES), shi_phases(interleave), columns, turn,
                       total[0] + plane, total[1] + plane);
        for (int r = 0; r < 2; r++) {
            here[r] += SHI_BLOCK * sizeof(float);
            opposite[r] += SHI_BLOCK * sizeof(float);
        }
    }
}

/* Sums one or two rows over their columns, and spreads the sums into the group. */
SHI_INLINE void shi_fold_rows(int order, shi_reader *reader, const shi_columns *columns, int row, int rows, const shi_row_weights *w,
                              shi_group *group) {
    const int width = reader->image->width, end = width % 2 ? width : width / 2;
    const int vectors = reader->layout.planes + shi_phases(reader->layout.interleave) - 1; /* one of the two is 1 */
    shi_azimuth p = { 1.0, 0.0 };
    for (int x = 0; x < end;) {
        const int stop = end - x > SHI_CHAIN * SHI_BLOCK ? x + SHI_CHAIN * SHI_BLOCK : end;
        shi_v total[2][SHI_PHASES][SHI_SUMS];
        for (int v = 0; v < vectors; v++)
            for (int i = 0; i < SHI_SUMS; i++)
                total[0][v][i] = total[1][v][i] = shi_splat(0.0f);
        for (; x < stop; x += SHI_BLOCK, p = shi_azimuth_next(p, columns))
            shi_fold_columns(order, reader, columns, row, rows, x, stop - x < SHI_BLOCK ? stop - x : SHI_BLOCK, p, total, &group->signs);
        for (int r = 0; r < rows; r++)
            for (int v = 0; v < vectors; v++)
                shi_row_spread(order, &w[r], total[r][v], group->moment[0][v]);
    }
}

SHI_FUNCTION void shi_group_clear(int frames, shi_group *group) {
    group->frames = frames;
    group->signs = shi_splat(0.0f);
    for (int frame = 0; frame < frames; frame++)
        for (int phase = 0; phase < SHI_PHASES; phase++)
            for (int i = 0; i < SHI_MOMENTS; i++)
                group->moment[frame][phase][i] = shi_splat(0.0f);
}

/* Whether any value read had its sign bit set. */
SHI_INLINE int shi_any_sign(shi_v signs) {
    uint32_t bits[SHI_LANES], any = 0;
    shi_store(bits, signs);
    for (int i = 0; i < SHI_LANES; i++)
        any |= bits[i];
    return (any >> 31) != 0;
}

/* A group's moments by frame and colour channel, in double; returns 0 if one is not finite. */
SHI_FUNCTION int shi_group_sum(int order, const shi_layout *layout, const shi_group *group, double moment[][3][SHI_MOMENTS]) {
    const int interleave = layout->interleave, phases = shi_phases(interleave);
    int finite = 1;
    for (int f = 0; f < group->frames; f++)
        for (int i = 0; i < SH_COUNT(order); i++) {
            double sum[SHI_PHASES] = { 0 };
            for (int plane = 0; plane < layout->planes; plane++) {
                float lanes[SHI_PHASES * SHI_LANES];
                for (int phase = 0; phase < phases; phase++)
                    shi_store(lanes + phase * SHI_LANES, group->moment[f][plane + phase][i]);
                for (int j = 0; j < phases * SHI_LANES; j += interleave)
                    for (int k = 0; k < interleave; k++)
                        sum[plane + k] += (double)lanes[j + k];
            }
            for (int k = 0; k < layout->channels; k++) {
                const float rounded = (float)sum[k];
                finite &= shi_is_finite(&rounded);
                moment[f][k][i] = sum[k];
            }
        }
    return finite;
}

enum { SHI_ATTEMPTS = 3 };

/* Values are looked at one by one only where the sums of a group say that something is wrong with one of them: in a second attempt;
 * and in a third they are scaled down, where finite values overflow. */
SHI_FUNCTION void shi_group_begin(shi_reader *reader, int attempt, const sh_report *before, int frames, shi_group *group) {
    shi_group_clear(frames, group);
    reader->report = *before;
    reader->careful = attempt > 0;
    reader->scale = attempt < 2 ? 1.0f : 1.0f / 16777216.0f; /* 2^-24 */
}

/* Whether the group's moments are good. */
SHI_FUNCTION int shi_group_end(int order, const shi_reader *reader, const shi_group *group, double moment[][3][SHI_MOMENTS]) {
    return shi_group_sum(order, &reader->layout, group, moment) && (reader->careful || !shi_any_sign(group->signs));
}

/* Adds a group's moments of one channel to the nine sums. */
SHI_INLINE void shi_equirect_add(int order, const shi_reader *reader, const shi_columns *columns, const double moment[SHI_MOMENTS],
                                   sh_accum *accum) {
    const double scale = (double)reader->scale, sense = reader->flags & SH_CLOCKWISE ? -1.0 : 1.0;
    const double f0 = columns->mean[0] / scale, f1 = columns->mean[1] / scale, f2 = columns->mean[2] / scale;
    const double all = f0 * moment[SHI_M_1];
    double *sum = accum->sum;
    sum[SH_R0] += all;
    if (order >= SH_L1) {
        sum[SH_X] += f1 * moment[SHI_M_X];
        sum[SH_Y] += sense * f1 * moment[SHI_M_Y];
        sum[SH_Z] += f0 * moment[SHI_M_Z];
    }
    if (order >= SH_L2) {
        const double zz = f0 * moment[SHI_M_ZZ], cos2 = f2 * moment[SHI_M_COS2];
        sum[SH_XX] += (all - zz) / 2 + cos2 - all / 3;
        sum[SH_XY] += sense * f2 * moment[SHI_M_SIN2];
        sum[SH_XZ] += f1 * moment[SHI_M_XZ];
        sum[SH_YY] += (all - zz) / 2 - cos2 - all / 3;
        sum[SH_YZ] += sense * f1 * moment[SHI_M_YZ];
    }
}

/* The arguments of a projection. */
typedef struct shi_rows {
    const sh_image *image;
    unsigned flags;
    int first, count;
    sh_accum *accum;
    sh_report *report;
} shi_rows;

/* Weights of `count` rows from `row` on, at most SHI_GROUP. */
SHI_FUNCTION void shi_row_weights_init(int row, int count, const sh_image *image, int point, shi_row_weights *w) {
    const int height = image->height;
    const shi_edge step = shi_edge_at(SHI_PI / height);
    shi_edge upper = shi_edge_at(row * step.angle);
    for (int r = 0; r < count; r++) {
        const shi_edge lower = shi_edge_next(&upper, &step);
        if (point)
            shi_row_weights_point(row + r, image->width, height, &w[r]);
        else
            shi_row_weights_area(&upper, &lower, &w[r]);
        upper = lower;
    }
}

SHI_FUNCTION void shi_report_add(const shi_reader *reader, uint64_t texels, sh_report *report) {
    if (report) {
        report->texels += texels;
        report->nonfinite += reader->report.nonfinite;
        report->negative += reader->report.negative;
    }
}

/* What can be said of a job without looking at its format. */
SHI_FUNCTION int shi_rows_check(int order, const shi_rows *job, int known_flags) {
    if (!shi_order_ok(order) || !job->image || !job->accum || job->flags & ~(unsigned)known_flags)
        return SH_ERROR_ARGUMENT;
    const int height = job->image->height;
    return job->first < 0 || job->count < 0 || job->count > height || job->first > height - job->count ? SH_ERROR_SIZE : SH_OK;
}

/* Coefficients and report from the sums over a whole image; nothing where there was an error. */
SHI_INLINE int shi_project_finish(int status, int order, const sh_image *image, const sh_accum *accum, const sh_report *found, float *c,
                                  sh_report *report) {
    if (status == SH_OK) {
        sh_accum_finish(order, sh_image_channels(image), accum, c);
        if (report)
            *report = *found;
    }
    return status;
}

SHI_INLINE int shi_equirect_rows(int order, const shi_rows *job) {
    const sh_image *image = job->image;
    const int end = job->first + job->count, point = (job->flags & SH_POINT_TEXELS) != 0;
    shi_reader reader;
    shi_columns columns;
    const int status = shi_reader_init(image, 1, job->flags, job->report, &reader);
    if (status != SH_OK)
        return status;
    shi_columns_init(image->width, reader.layout.interleave, point, &columns);
    const int group_rows = image->width > SHI_CHAIN * SHI_BLOCK ? 2 : SHI_GROUP; /* long rows: short chains of float sums */
    for (int row = job->first; row < end; row += group_rows) {
        const int rows = end - row < group_rows ? end - row : group_rows;
        double moment[1][3][SHI_MOMENTS];
        shi_row_weights w[SHI_GROUP];
        shi_row_weights_init(row, rows, image, point, w);
        const sh_report before = reader.report;
        for (int attempt = 0; attempt < SHI_ATTEMPTS; attempt++) {
            shi_group group;
            shi_group_begin(&reader, attempt, &before, 1, &group);
            for (int r = 0; r < rows; r += 2)
                shi_fold_rows(order, &reader, &columns, row + r, rows - r < 2 ? 1 : 2, w + r, &group);
            if (shi_group_end(order, &reader, &group, moment))
                break;
        }
        for (int k = 0; k < reader.layout.channels; k++) {
            shi_equirect_add(order, &reader, &columns, moment[0][k], job->accum + k);
            for (int r = 0; r < rows; r++)
                job->accum[k].weight += w[r].one;
        }
    }
    shi_report_add(&reader, (uint64_t)job->count * (uint64_t)image->width, job->report);
    return SH_OK;
}
SHI_FUNCTION int shi_equirect_rows_l0(const shi_rows *job) { return shi_equirect_rows(SH_L0, job); }
SHI_FUNCTION int shi_equirect_rows_l1(const shi_rows *job) { return shi_equirect_rows(SH_L1, job); }
SHI_FUNCTION int shi_equirect_rows_l2(const shi_rows *job) { return shi_equirect_rows(SH_L2, job); }

SHI_INLINE int sh_project_equirect_rows(int order, const sh_image *image, unsigned flags, int first_row, int row_count,
                                        sh_accum *accum, sh_report *report) {
    const shi_rows job = { image, flags, first_row, row_count, accum, report };
    const int status = shi_rows_check(order, &job, SH_CLAMP_NEGATIVE | SH_POINT_TEXELS | SH_CLOCKWISE);
    if (status != SH_OK)
        return status;
    return order == SH_L0 ? shi_equirect_rows_l0(&job) : order == SH_L1 ? shi_equirect_rows_l1(&job) : shi_equirect_rows_l2(&job);
}

SHI_INLINE int sh_project_equirect(int order, const sh_image *image, unsigned flags, float *c, sh_report *report) {
    sh_accum accum[3];
    sh_report found = { 0, 0, 0 };
    sh_accum_clear(3, accum);
    const int status = !image || !c ? SH_ERROR_ARGUMENT
                                    : sh_project_equirect_rows(order, image, flags, 0, image->height, accum, report ? &found : NULL);
    return shi_project_finish(status, order, image, accum, &found, c, report);
}

/* ---- Cube and octahedral maps ---------------------------------------------------------------------------------------------------
 * A row of texels, or a part of it, lies on a plane: its directions are (P + u Q) / rho for fixed P and Q. So it needs five sums over
 * its texels: w, w / rho, w u / rho, w / rho^2, w u / rho^2, where w is the texel's share of the sphere; w u^2 / rho^2 follows from
 * |P + u Q|^2 = rho^2. The factors of a row serve all rows that differ by the sign of v, and on a cube all faces. */

enum { SHI_W, SHI_WR, SHI_WRU, SHI_WRR, SHI_WRRU };

/* The plane (P + u Q) / rho of a row's part, as the factors by which its sums make the moments: x, y, z from w / rho and w u / rho;
 * xx, xy, xz, yy, yz from w, w / rho^2 and w u / rho^2. */
typedef struct shi_plane {
    float first[3][2], second[5][3];
} shi_plane;

SHI_FUNCTION shi_plane shi_plane_make(const double p[3], const double q[3]) {
    const double pp = shi_dot3d(p, p), qq = shi_dot3d(q, q), pq = shi_dot3d(p, q);
    shi_plane plane;
    for (int i = 0; i < 3; i++) {
        plane.first[i][0] = (float)p[i];
        plane.first[i][1] = (float)q[i];
    }
    for (int m = 0; m < 5; m++) { /* P P' wrr + (P Q' + Q P') wrru + Q Q' (w - |P|^2 wrr - 2 P.Q wrru) / |Q|^2 */
        const int i = m / 3, j = m - 2 * i;
        const double square = q[i] * q[j] / qq;
        plane.second[m][0] = (float)square;
        plane.second[m][1] = (float)(p[i] * p[j] - square * pp);
        plane.second[m][2] = (float)(p[i] * q[j] + q[i] * p[j] - 2.0 * square * pq);
    }
    return plane;
}

/* Factors of a block of texels: a vector of each of the five for each vector of floats, side by side. */
typedef struct shi_factors {
    shi_v table[SHI_BLOCK * 4 / SHI_LANES][SHI_SUMS];
} shi_factors;

/* Mean of rho^-3 over the square of half-width e <= 1/16 about (u, v), rho^2 = 1 + u^2 + v^2: its Taylor series to e^4, or e^2 where
 * that is enough, off by < 1e-7 of itself. t is 1 / rho^2, r is 1 / rho. */
SHI_INLINE shi_v shi_cube_weight(shi_v u, shi_v v, shi_v t, shi_v r, float e) {
    const shi_v ee = shi_splat(e * e), e2 = shi_mul(t, shi_madd(t, shi_splat(-2.5f), shi_splat(1.5f)));
    if (e <= 1.0f / 64)
        return shi_mul(shi_mul(t, r), shi_madd(ee, e2, shi_splat(1.0f)));
    const shi_v p = shi_mul(u, u), q = shi_mul(v, v), pq = shi_mul(p, q), s = shi_add(p, q);
    const shi_v squares = shi_madd(s, s, shi_mul(shi_splat(-2.0f), pq)); /* u^4 + v^4 */
    /* ((f_uuuu + f_vvvv) / 120 + f_uuvv / 36) / f */
    const shi_v quartic = shi_madd(shi_splat(945.0f / 120), squares, shi_mul(shi_splat(945.0f / 36), pq));
    const shi_v quadratic = shi_madd(shi_mul(t, t), quartic, shi_mul(t, shi_mul(s, shi_splat(-630.0f / 120 - 105.0f / 36))));
    const shi_v e4 = shi_mul(shi_mul(t, t), shi_add(quadratic, shi_splat(90.0f / 120 + 15.0f / 36)));
    return shi_mul(shi_mul(t, r), shi_madd(ee, shi_madd(ee, e4, e2), shi_splat(1.0f)));
}

/* The same for the octahedron: rho^2 = a^2 + b^2 + (1 - a - b)^2, a and b the absolute values of u and v; beyond the fold a + b = 1
 * the map is its own mirror image. A texel cut by the fold counts as the triangle before it. To e^2: off by < 5e-6 for e <= 1/64. */
SHI_INLINE shi_v shi_octahedron_weight(shi_v u, shi_v v, float e) {
    const shi_v one = shi_splat(1.0f), minus = shi_splat(-1.0f), half = shi_splat(0.5f * e);
    const shi_v au = shi_abs(u), av = shi_abs(v), over = shi_sub(shi_add(au, av), one);
    const shi_m beyond = shi_less(half, over), cut = shi_less(shi_abs(over), half);
    const shi_v shift = shi_select(cut, shi_splat(e / 3), shi_splat(0.0f)); /* to the triangle's centroid */
    const shi_v a = shi_sub(shi_select(beyond, shi_sub(one, av), au), shift), b = shi_sub(shi_select(beyond, shi_sub(one, au), av), shift);
    const shi_v c = shi_sub(shi_sub(one, a), b), g = shi_madd(a, a, shi_madd(b, b, shi_mul(c, c)));
    const shi_v t = shi_div(one, g), ga = shi_sub(a, c), gb = shi_sub(b, c); /* half the derivatives of g */
    /* f_aa + f_bb and f_ab, over f = g^(-3/2) */
    const shi_v laplacian = shi_mul(t, shi_madd(shi_mul(shi_splat(15.0f), t), shi_madd(ga, ga, shi_mul(gb, gb)), shi_splat(-12.0f)));
    const shi_v mixed = shi_mul(t, shi_madd(shi_mul(shi_splat(15.0f), t), shi_mul(ga, gb), shi_splat(-3.0f)));
    const shi_v triangle = shi_mul(shi_splat(e * e / 9), shi_madd(minus, mixed, laplacian));
    const shi_v series = shi_select(cut, triangle, shi_mul(shi_splat(e * e / 6), laplacian));
    return shi_mul(shi_mul(t, shi_sqrt(t)), shi_add(one, series));
}

/* A vector of one value per pixel to factor `f` of the interleaved floats. */
SHI_INLINE void shi_expand(shi_v a, int interleave, int f, shi_v table[][SHI_SUMS]) {
    if (interleave == 1) {
        table[0][f] = a;
    } else if (interleave == 3) {
        table[0][f] = shi_repeat3(a, 0);
        table[1][f] = shi_repeat3(a, 1);
        table[2][f] = shi_repeat3(a, 2);
    } else {
        float pixel[SHI_LANES], repeated[4 * SHI_LANES];
        shi_store(pixel, a);
        for (int i = 0; i < 4 * SHI_LANES; i++)
            repeated[i] = pixel[i / 4];
        for (int i = 0; i < 4; i++)
            table[i][f] = shi_load(repeated + i * SHI_LANES);
    }
}

enum { SHI_CUBE, SHI_OCTAHEDRON };

/* The weight of a texel of half-width parts * e, over its area / (4 pi): that of parts x parts squares of half-width e, added. */
SHI_INLINE shi_v shi_texel_weight(int kind, int parts, shi_v u, shi_v v, shi_v t, shi_v r, float e) {
    if (parts == 1)
        return kind == SHI_CUBE ? shi_cube_weight(u, v, t, r, e) : shi_octahedron_weight(u, v, e);
    const shi_v one = shi_splat(1.0f);
    shi_v w = shi_splat(0.0f);
    for (int j = 0; j < parts * parts; j++) {
        const shi_v pu = shi_add(u, shi_splat((float)(2 * (j % parts) + 1 - parts) * e));
        const shi_v pv = shi_add(v, shi_splat((float)(2 * (j / parts) + 1 - parts) * e));
        const shi_v pt = shi_div(one, shi_madd(pu, pu, shi_madd(pv, pv, one)));
        w = shi_add(w, kind == SHI_CUBE ? shi_cube_weight(pu, pv, pt, shi_sqrt(pt), e) : shi_octahedron_weight(pu, pv, e));
    }
    return w;
}

/* The factors of texels [x, x + count) of row y of a size x size map; returns the texels' share of the sphere. Texels of small maps
 * are divided until the series holds. */
SHI_INLINE double shi_factors_init(int order, int kind, int size, int y, int x, int count, int interleave, shi_factors *factors) {
    const int fine = kind == SHI_CUBE ? 16 : 64, halves = size % 2 && kind == SHI_OCTAHEDRON ? 2 : 1;
    const int parts = halves * (size < fine ? (fine + size - 1) / size : 1); /* the octahedron's axes and fold lie between parts */
    const float unit = 1.0f / (float)size, e = unit / (float)parts;
    const float area = (float)(1.0 / (SHI_PI * (double)size * (double)size * (double)parts * (double)parts)); /* (2 e)^2 / (4 pi) */
    const float vy = (float)(2 * y + 1 - size) * unit;
    float lane[SHI_LANES], weight[SHI_LANES];
    shi_v whole = shi_splat(0.0f); /* weights of whole vectors */
    double share = 0.0;
    for (int i = 0; i < SHI_LANES; i++)
        lane[i] = (float)(2 * i + 1 - size);
    for (int i = 0; i < count; i += SHI_LANES) {
        const shi_v u = shi_mul(shi_add(shi_load(lane), shi_splat((float)(2 * (x + i)))), shi_splat(unit)), v = shi_splat(vy);
        const shi_v au = shi_abs(u), av = shi_abs(v), one = shi_splat(1.0f);
        const shi_v beyond_x = shi_sub(one, av), beyond_y = shi_sub(one, au), z = shi_sub(shi_sub(one, au), av);
        const shi_m beyond = shi_less(z, shi_splat(0.0f));
        const shi_v px = kind == SHI_CUBE ? u : shi_select(beyond, beyond_x, au), py = kind == SHI_CUBE ? v : shi_select(beyond, beyond_y, av);
        const shi_v pz = kind == SHI_CUBE ? one : z, g = shi_madd(px, px, shi_madd(py, py, shi_mul(pz, pz)));
        const shi_v t = shi_div(one, g), r = shi_sqrt(t);
        const shi_v w = shi_mul(shi_texel_weight(kind, parts, u, v, t, r, e), shi_splat(area));
        if (count - i >= SHI_LANES) {
            whole = shi_add(whole, w);
        } else {
            shi_store(weight, w);
            for (int j = 0; j < count - i; j++)
                share += (double)weight[j];
        }
        const shi_v wr = shi_mul(w, r), wrr = shi_mul(w, t);
        shi_v(*out)[SHI_SUMS] = factors->table + i * interleave / SHI_LANES;
        shi_expand(w, interleave, SHI_W, out);
        if (order >= SH_L1) {
            shi_expand(wr, interleave, SHI_WR, out);
            shi_expand(shi_mul(wr, u), interleave, SHI_WRU, out);
        }
        if (order >= SH_L2) {
            shi_expand(wrr, interleave, SHI_WRR, out);
            shi_expand(shi_mul(wrr, u), interleave, SHI_WRRU, out);
        }
    }
    shi_store(weight, whole);
    for (int i = 0; i < SHI_LANES; i++)
        share += (double)weight[i];
    return share;
}

/* Adds a block of two rows that share their factors. */
SHI_INLINE void shi_plane_block(int order, const unsigned char *row_a, const unsigned char *row_b, size_t vectors, int phases,
                                const shi_factors *factors, shi_v total_a[SHI_PHASES][SHI_SUMS], shi_v total_b[SHI_PHASES][SHI_SUMS]) {
    for (int phase = 0; phase < phases; phase++) {
        shi_v *ta = total_a[phase], *tb = total_b[phase];
        shi_v a[SHI_SUMS] = { ta[0], ta[1], ta[2], ta[3], ta[4] }, b[SHI_SUMS] = { tb[0], tb[1], tb[2], tb[3], tb[4] };
        for (size_t i = (size_t)phase; i < vectors; i += (size_t)phases) {
            const shi_v *f = factors->table[i];
            const shi_v texels_a = shi_load(row_a + i * sizeof(shi_v)), texels_b = shi_load(row_b + i * sizeof(shi_v));
            shi_madd_both(f[SHI_W], texels_a, texels_b, &a[SHI_W], &b[SHI_W]);
            if (order >= SH_L1) {
                shi_madd_both(f[SHI_WR], texels_a, texels_b, &a[SHI_WR], &b[SHI_WR]);
                shi_madd_both(f[SHI_WRU], texels_a, texels_b, &a[SHI_WRU], &b[SHI_WRU]);
            }
            if (order >= SH_L2) {
                shi_madd_both(f[SHI_WRR], texels_a, texels_b, &a[SHI_WRR], &b[SHI_WRR]);
                shi_madd_both(f[SHI_WRRU], texels_a, texels_b, &a[SHI_WRRU], &b[SHI_WRRU]);
            }
        }
        for (int i = 0; i < SHI_SUMS; i++) {
            ta[i] = a[i];
            tb[i] = b[i];
        }
    }
}

SHI_INLINE void shi_plane_spread(int order, const shi_plane *plane, const shi_v s[SHI_SUMS], shi_v moment[SHI_MOMENTS]) {
    moment[SH_R0] = shi_add(moment[SH_R0], s[SHI_W]);
    if (order >= SH_L1)
        for (int i = 0; i < 3; i++) {
            const float *f = plane->first[i];
            moment[SH_X + i] = shi_madd(shi_splat(f[0]), s[SHI_WR], shi_madd(shi_splat(f[1]), s[SHI_WRU], moment[SH_X + i]));
        }
    if (order >= SH_L2)
        for (int i = 0; i < 5; i++) {
            const float *f = plane->second[i];
            const shi_v sum = shi_madd(shi_splat(f[0]), s[SHI_W], moment[SH_XX + i]);
            moment[SH_XX + i] = shi_madd(shi_splat(f[1]), s[SHI_WRR], shi_madd(shi_splat(f[2]), s[SHI_WRRU], sum));
        }
}

/* Sums columns [begin, end) of row y of an octahedral map and, if `mirrored`, of row size - 1 - y, which lie on the planes `plane`.
 * Returns their share of the sphere. */
SHI_INLINE double shi_octahedron_part(int order, shi_reader *reader, int y, int mirrored, int begin, int end, const shi_plane plane[2],
                                      shi_group *group) {
    const int size = reader->image->width, interleave = reader->layout.interleave, planes = reader->layout.planes;
    const int phases = shi_phases(interleave);
    shi_v total[2][SHI_PHASES][SHI_SUMS];
    shi_scratch scratch[2];
    double share = 0.0;
    for (int phase = 0; phase < planes + phases - 1; phase++)
        for (int i = 0; i < SHI_SUMS; i++)
            total[0][phase][i] = total[1][phase][i] = shi_splat(0.0f);
    for (int x = begin; x < end; x += SHI_BLOCK) {
        const int count = end - x < SHI_BLOCK ? end - x : SHI_BLOCK, padded = (int)shi_round_up((size_t)count);
        shi_factors factors;
        share += shi_factors_init(order, SHI_OCTAHEDRON, size, y, x, count, interleave, &factors);
        const unsigned char *a = shi_read_block(reader, y, x, count, padded, &scratch[0]), *b = a;
        if (mirrored)
            b = shi_read_block(reader, size - 1 - y, x, count, padded, &scratch[1]);
        if (reader->look_for_negative)
            group->signs = shi_or(group->signs, shi_or(shi_signs(a, padded * interleave), shi_signs(b, padded * interleave)));
        for (int p = 0; p < planes; p++, a += SHI_BLOCK * sizeof(float), b += SHI_BLOCK * sizeof(float))
            shi_plane_block(order, a, b, (size_t)(padded * interleave / SHI_LANES), phases, &factors, total[0] + p, total[1] + p);
    }
    for (int side = 0; side <= mirrored; side++)
        for (int phase = 0; phase < planes + phases - 1; phase++)
            shi_plane_spread(order, &plane[side], total[side][phase], group->moment[0][phase]);
    return (1 + mirrored) * share;
}

/* The plane of the octahedron's row v where u has the sign `side`: within the fold, |u| + |v| <= 1, or beyond it. */
SHI_FUNCTION shi_plane shi_octahedron_plane(double v, int side, int beyond) {
    const double k = v < 0 ? 1 + v : 1 - v, sv = v < 0 ? -1 : 1;
    const double p[3] = { beyond ? k * side : 0.0, beyond ? sv : v, k };
    const double q[3] = { beyond ? 0.0 : 1.0, beyond ? -side * sv : 0.0, (double)-side };
    return shi_plane_make(p, q);
}

SHI_INLINE double shi_octahedron_row(int order, shi_reader *reader, int y, int mirrored, shi_group *group) {
    const int size = reader->image->width, a = 2 * y + 1 > size ? 2 * y + 1 - size : size - 2 * y - 1; /* a / size = |v| */
    const double v = (2.0 * y + 1.0 - size) / size;
    const int edge[5] = { 0, a / 2, size / 2, size - a / 2, size }; /* columns where the plane changes */
    double share = 0.0;
    for (int i = 0; i < 4; i++) {
        const int side = i < 2 ? -1 : 1, beyond = i == 0 || i == 3;
        const shi_plane plane[2] = { shi_octahedron_plane(v, side, beyond), shi_octahedron_plane(-v, side, beyond) };
        share += shi_octahedron_part(order, reader, y, mirrored, edge[i], edge[i + 1], plane, group);
    }
    return share;
}

/* On a cube, four rows at a time: rows v and -v of two opposite faces. With C the direction of the first face's centre, and Q and V of
 * its u and v, the directions are (C + v V + u Q) / rho, and on the opposite face the same but for two signs: C's and Q's (faces x and
 * z), or C's alone (faces y, once rows v and -v of the second face have changed places). So their sums and differences by v and by
 * face need eight sums in place of twenty. One frame of axes Q, V, C for each pair of faces. */
typedef struct shi_frame {
    signed char axis[3], sign[3]; /* of Q, V, C */
    signed char q_flips, swapped; /* on the opposite face */
} shi_frame;

SHI_INLINE const shi_frame *shi_frame_at(int i) {
    static const shi_frame frames[SHI_FRAMES] = {
        { { 2, 1, 0 }, { -1, -1, 1 }, 1, 0 },
        { { 0, 2, 1 }, { 1, 1, 1 }, 0, 1 },
        { { 0, 1, 2 }, { 1, -1, 1 }, 1, 0 },
    };
    return &frames[i];
}

/* The eight sums, and the moments of SHI_MOMENTS in a frame, as an order is a prefix. */
enum { SHI_F_1, SHI_F_Q, SHI_F_V, SHI_F_C, SHI_F_CC, SHI_F_CQ, SHI_F_CV, SHI_F_QV, SHI_FRAME_SUMS, SHI_F_VV = SHI_FRAME_SUMS };

/* Adds a block of four rows: v and -v of the first face, v and -v of the second. */
SHI_INLINE void shi_cube_block(int order, int q_flips, const unsigned char *const row[4], shi_next *next, size_t vectors, int phases,
                               const shi_factors *factors, shi_v total[SHI_PHASES][SHI_FRAME_SUMS]) {
    for (int phase = 0; phase < phases; phase++) {
        shi_v *t = total[phase];
        shi_v one = t[SHI_F_1], q = t[SHI_F_Q], v = t[SHI_F_V], c = t[SHI_F_C];
        shi_v cc = t[SHI_F_CC], cq = t[SHI_F_CQ], cv = t[SHI_F_CV], qv = t[SHI_F_QV];
        for (size_t i = (size_t)phase; i < vectors; i += (size_t)phases) {
            const size_t at = i * sizeof(shi_v);
            const shi_v *f = factors->table[i];
            const shi_v a = shi_load(row[0] + at), b = shi_keep(shi_load(row[1] + at));
            const shi_v sum_a = shi_add(a, b), difference_a = shi_sub(a, b);
            const shi_v d = shi_load(row[2] + at), e = shi_keep(shi_load(row[3] + at));
            const shi_v sum_b = shi_add(d, e), difference_b = shi_sub(d, e);
            const shi_v sum_even = shi_add(sum_a, sum_b), sum_odd = shi_sub(sum_a, sum_b);
            const shi_v difference_even = shi_add(difference_a, difference_b), difference_odd = shi_sub(difference_a, difference_b);
            one = shi_madd(f[SHI_W], sum_even, one);
            if (order >= SH_L1) {
                shi_madd_both(f[SHI_WR], difference_even, sum_odd, &v, &c);
                q = shi_madd(f[SHI_WRU], q_flips ? sum_odd : sum_even, q);
            }
            if (order >= SH_L2) {
                shi_madd_both(f[SHI_WRR], sum_even, difference_odd, &cc, &cv);
                shi_madd_both(f[SHI_WRRU], q_flips ? sum_even : sum_odd, q_flips ? difference_odd : difference_even, &cq, &qv);
            }
            shi_next_ask(next);
        }
        t[SHI_F_1] = one;
        t[SHI_F_Q] = q;
        t[SHI_F_V] = v;
        t[SHI_F_C] = c;
        t[SHI_F_CC] = cc;
        t[SHI_F_CQ] = cq;
        t[SHI_F_CV] = cv;
        t[SHI_F_QV] = qv;
    }
}

/* Adds the sums of row v to a frame's moments. */
SHI_INLINE void shi_cube_spread(int order, float v, const shi_v s[SHI_FRAME_SUMS], shi_v moment[SHI_MOMENTS]) {
    const shi_v v1 = shi_splat(v), v2 = shi_splat(v * v);
    moment[SHI_F_1] = shi_add(moment[SHI_F_1], s[SHI_F_1]);
    if (order >= SH_L1) {
        moment[SHI_F_Q] = shi_add(moment[SHI_F_Q], s[SHI_F_Q]);
        moment[SHI_F_V] = shi_madd(v1, s[SHI_F_V], moment[SHI_F_V]);
        moment[SHI_F_C] = shi_add(moment[SHI_F_C], s[SHI_F_C]);
    }
    if (order >= SH_L2) {
        moment[SHI_F_CC] = shi_add(moment[SHI_F_CC], s[SHI_F_CC]);
        moment[SHI_F_CQ] = shi_add(moment[SHI_F_CQ], s[SHI_F_CQ]);
        moment[SHI_F_CV] = shi_madd(v1, s[SHI_F_CV], moment[SHI_F_CV]);
        moment[SHI_F_QV] = shi_madd(v1, s[SHI_F_QV], moment[SHI_F_QV]);
        moment[SHI_F_VV] = shi_madd(v2, s[SHI_F_CC], moment[SHI_F_VV]);
    }
}

/* Adds the block at column x of row y of a pair of faces and, if `mirrored`, of row size - 1 - y; black otherwise. */
SHI_INLINE void shi_cube_columns(int order, shi_reader *reader, const sh_image *face, int frame, int y, int mirrored, int x, int count,
                                 const shi_factors *factors, shi_v total[SHI_PHASES][SHI_FRAME_SUMS], shi_v *signs) {
    static const float black[SHI_BLOCK * 4] = { 0 };
    const shi_frame *f = shi_frame_at(frame);
    const int size = face->width, interleave = reader->layout.interleave, phases = shi_phases(interleave);
    const int padded = (int)shi_round_up((size_t)count), values = padded * interleave;
    /* Of the next rows, a block asks for two of four, for itself and its neighbour. */
    const int beyond = mirrored && x / SHI_BLOCK % 2, ahead = beyond ? size - 2 - y : y + 1 < size ? y + 1 : y;
    const unsigned char *row[4], *ask[2];
    shi_scratch scratch[4];
    for (int i = 0; i < 4; i++) {
        const int side = i % 2 != (i / 2 && f->swapped);
        row[i] = (const unsigned char *)black;
        shi_reader_use(reader, face + 2 * frame + i / 2);
        if (!side || mirrored)
            row[i] = shi_read_block(reader, side ? size - 1 - y : y, x, count, padded, &scratch[i]);
        if (reader->look_for_negative)
            *signs = shi_or(*signs, shi_signs(row[i], values));
        ask[i / 2] = shi_texel(reader, ahead, x - (beyond ? SHI_BLOCK : 0));
    }
    shi_next next = shi_next_from(reader, ask[0], ask[1]);
    for (int p = 0; p < reader->layout.planes; p++) {
        if (f->q_flips)
            shi_cube_block(order, 1, row, &next, (size_t)(values / SHI_LANES), phases, factors, total + p);
        else
            shi_cube_block(order, 0, row, &next, (size_t)(values / SHI_LANES), phases, factors, total + p);
        for (int i = 0; i < 4; i++)
            if (row[i] != (const unsigned char *)black)
                row[i] += SHI_BLOCK * sizeof(float);
    }
}

/* Row y of all faces and, if `mirrored`, row size - 1 - y as well. Returns their share of the sphere. */
SHI_INLINE double shi_cube_row(int order, shi_reader *reader, const sh_image *face, int y, int mirrored, shi_group *group) {
    const int size = face->width, vectors = reader->layout.planes + shi_phases(reader->layout.interleave) - 1;
    const float v = (float)((2.0 * y + 1.0 - size) / size);
    shi_v total[SHI_FRAMES][SHI_PHASES][SHI_FRAME_SUMS];
    double share = 0.0;
    for (int frame = 0; frame < SHI_FRAMES; frame++)
        for (int i = 0; i < vectors; i++)
            for (int j = 0; j < SHI_FRAME_SUMS; j++)
                total[frame][i][j] = shi_splat(0.0f);
    for (int x = 0; x < size; x += SHI_BLOCK) {
        const int count = size - x < SHI_BLOCK ? size - x : SHI_BLOCK;
        shi_factors factors;
        share += shi_factors_init(order, SHI_CUBE, size, y, x, count, reader->layout.interleave, &factors);
        for (int frame = 0; frame < SHI_FRAMES; frame++)
            shi_cube_columns(order, reader, face, frame, y, mirrored, x, count, &factors, total[frame], &group->signs);
    }
    for (int frame = 0; frame < SHI_FRAMES; frame++)
        for (int i = 0; i < vectors; i++)
            shi_cube_spread(order, v, total[frame][i], group->moment[frame][i]);
    return 6 * (1 + mirrored) * share;
}

/* A frame's moments, in its axes, to those of SHI_MOMENTS in x, y, z, added. */
SHI_FUNCTION void shi_frame_turn(const shi_frame *frame, const double m[SHI_MOMENTS], double moment[SHI_MOMENTS]) {
    const double qq = m[SHI_F_1] - m[SHI_F_CC] - m[SHI_F_VV];
    const double second[3][3] = { { qq, m[SHI_F_QV], m[SHI_F_CQ] },
                                  { m[SHI_F_QV], m[SHI_F_VV], m[SHI_F_CV] },
                                  { m[SHI_F_CQ], m[SHI_F_CV], m[SHI_F_CC] } };
    int at[3] = { 0, 0, 0 }; /* which axis of the frame lies along x, y, z */
    for (int i = 0; i < 3; i++)
        at[frame->axis[i]] = i;
    moment[SH_R0] += m[SHI_F_1];
    for (int i = 0; i < 3; i++)
        moment[SH_X + i] += frame->sign[at[i]] * m[SHI_F_Q + at[i]];
    for (int i = 0; i < 5; i++) {
        const int a = at[i / 3], b = at[i - i / 3 * 2];
        moment[SH_XX + i] += frame->sign[a] * frame->sign[b] * second[a][b];
    }
}

/* Adds a group's moments of one channel to the nine sums. */
SHI_FUNCTION void shi_plane_finish(int order, double scale, const double moment[SHI_MOMENTS], sh_accum *accum) {
    for (int i = 0; i < SH_COUNT(order); i++)
        accum->sum[i] += (moment[i] - (i == SH_XX || i == SH_YY ? moment[SH_R0] / 3 : 0.0)) / scale;
}

/* Rows [first, last), each together with its mirror image where that is one of the job's; where the mirror image came first, the row is
 * done. Returns their share of the sphere. */
SHI_INLINE double shi_plane_group(int order, int kind, shi_reader *reader, const shi_rows *job, int first, int last, shi_group *group) {
    const int size = job->image->width, end = job->first + job->count;
    double share = 0.0;
    for (int y = first; y < last; y++) {
        const int mirror = size - 1 - y, mirrored = mirror > y && mirror < end;
        if (mirror >= job->first && mirror < y)
            continue;
        share += kind == SHI_CUBE ? shi_cube_row(order, reader, job->image, y, mirrored, group)
                                  : shi_octahedron_row(order, reader, y, mirrored, group);
    }
    return share;
}

SHI_INLINE int shi_plane_rows(int order, int kind, const shi_rows *job) {
    const int images = kind == SHI_CUBE ? 6 : 1, frames = kind == SHI_CUBE ? SHI_FRAMES : 1, end = job->first + job->count;
    shi_reader reader;
    const int status = shi_reader_init(job->image, images, job->flags, job->report, &reader);
    if (status != SH_OK)
        return status;
    if (job->image->width != job->image->height)
        return SH_ERROR_SIZE;
    /* Lanes share what rounding does to a long sum. An octahedral map has one in place of a cube's three times eight. */
    const int group_rows = kind == SHI_CUBE && SHI_LANES > 1 ? SHI_GROUP : 1;
    for (int y = job->first; y < end; y += group_rows) {
        const int last = end - y < group_rows ? end : y + group_rows;
        const sh_report before = reader.report;
        double moment[SHI_FRAMES][3][SHI_MOMENTS] = { { { 0 } } }, share = 0.0;
        for (int attempt = 0; attempt < SHI_ATTEMPTS; attempt++) {
            shi_group group;
            shi_group_begin(&reader, attempt, &before, frames, &group);
            share = shi_plane_group(order, kind, &reader, job, y, last, &group);
            if (shi_group_end(order, &reader, &group, moment))
                break;
        }
        for (int k = 0; k < reader.layout.channels; k++) {
            double turned[SHI_MOMENTS] = { 0 };
            for (int f = 0; kind == SHI_CUBE && f < frames; f++)
                shi_frame_turn(shi_frame_at(f), moment[f][k], turned);
            shi_plane_finish(order, (double)reader.scale, kind == SHI_CUBE ? turned : moment[0][k], job->accum + k);
            job->accum[k].weight += share;
        }
    }
    shi_report_add(&reader, (uint64_t)images * (uint64_t)job->count * (uint64_t)job->image->width, job->report);
    return SH_OK;
}
SHI_FUNCTION int shi_cube_rows_l0(const shi_rows *job) { return shi_plane_rows(SH_L0, SHI_CUBE, job); }
SHI_FUNCTION int shi_cube_rows_l1(const shi_rows *job) { return shi_plane_rows(SH_L1, SHI_CUBE, job); }
SHI_FUNCTION int shi_cube_rows_l2(const shi_rows *job) { return shi_plane_rows(SH_L2, SHI_CUBE, job); }
SHI_FUNCTION int shi_octahedron_rows_l0(const shi_rows *job) { return shi_plane_rows(SH_L0, SHI_OCTAHEDRON, job); }
SHI_FUNCTION int shi_octahedron_rows_l1(const shi_rows *job) { return shi_plane_rows(SH_L1, SHI_OCTAHEDRON, job); }
SHI_FUNCTION int shi_octahedron_rows_l2(const shi_rows *job) { return shi_plane_rows(SH_L2, SHI_OCTAHEDRON, job); }

SHI_INLINE int sh_project_cubemap_rows(int order, const sh_image face[6], unsigned flags, int first_row, int row_count, sh_accum *accum,
                                       sh_report *report) {
    const shi_rows job = { face, flags, first_row, row_count, accum, report };
    const int status = shi_rows_check(order, &job, SH_CLAMP_NEGATIVE);
    if (status != SH_OK)
        return status;
    return order == SH_L0 ? shi_cube_rows_l0(&job) : order == SH_L1 ? shi_cube_rows_l1(&job) : shi_cube_rows_l2(&job);
}

SHI_INLINE int sh_project_octahedral_rows(int order, const sh_image *image, unsigned flags, int first_row, int row_count,
                                          sh_accum *accum, sh_report *report) {
    const shi_rows job = { image, flags, first_row, row_count, accum, report };
    const int status = shi_rows_check(order, &job, SH_CLAMP_NEGATIVE);
    if (status != SH_OK)
        return status;
    return order == SH_L0 ? shi_octahedron_rows_l0(&job) : order == SH_L1 ? shi_octahedron_rows_l1(&job) : shi_octahedron_rows_l2(&job);
}

SHI_INLINE int sh_project_cubemap(int order, const sh_image face[6], unsigned flags, float *c, sh_report *report) {
    sh_accum accum[3];
    sh_report found = { 0, 0, 0 };
    sh_accum_clear(3, accum);
    const int status = !face || !c ? SH_ERROR_ARGUMENT
                                   : sh_project_cubemap_rows(order, face, flags, 0, face->height, accum, report ? &found : NULL);
    return shi_project_finish(status, order, face, accum, &found, c, report);
}

SHI_INLINE int sh_project_octahedral(int order, const sh_image *image, unsigned flags, float *c, sh_report *report) {
    sh_accum accum[3];
    sh_report found = { 0, 0, 0 };
    sh_accum_clear(3, accum);
    const int status = !image || !c ? SH_ERROR_ARGUMENT
                                    : sh_project_octahedral_rows(order, image, flags, 0, image->height, accum, report ? &found : NULL);
    return shi_project_finish(status, order, image, accum, &found, c, report);
}

/* ---- Batches of bounded irradiance and of the other models ----------------------------------------------------------------------
 * A channel's prepared model is splatted once per block; what it is decides the kernel. */

/* The bits of each float. */
SHI_INLINE shi_i shi_as_int(shi_v a) {
    float lanes[SHI_LANES];
    shi_store(lanes, a);
    return shi_iload32(lanes);
}

/* log2 of normal a > 0, error < 2e-7 for a in [1/2, 1], else 2 ulp: a = 2^e m, m in [1, 2), and log2 m = 1/2 + 2 atanh(s) / ln 2
 * for s = (m - sqrt 2) / (m + sqrt 2), |s| < .172, by its series up to s^7. */
SHI_INLINE shi_v shi_log2(shi_v a) {
    const shi_i bits = shi_as_int(a);
    const shi_v e = shi_to_float(shi_iadd(shi_shr(bits, 23), -127)), m = shi_as_float(shi_iadd(shi_iand(bits, 0x7fffff), 0x3f800000));
    const shi_v root = shi_splat(1.41421356f); /* sqrt 2 */
    const shi_v s = shi_div(shi_sub(m, root), shi_add(m, root)), s2 = shi_mul(s, s);
    const float k = 2.88539008f; /* 2 / ln 2 */
    shi_v sum = shi_madd(s2, shi_splat(k / 7.0f), shi_splat(k / 5.0f));
    sum = shi_madd(s2, sum, shi_splat(k / 3.0f));
    sum = shi_madd(s2, sum, shi_splat(k));
    return shi_add(e, shi_madd(s, sum, shi_splat(0.5f)));
}

/* 2^a for a in [-126, 126], relative error < 3e-7: 2^n times the exponential series up to the sixth power, n the nearest
 * integer, which the addition of 1.5 * 2^23 leaves in the low bits. */
SHI_INLINE shi_v shi_exp2(shi_v a) {
    const shi_i n = shi_iadd(shi_as_int(shi_add(a, shi_splat(12582912.0f))), -0x4b400000);
    const shi_v f = shi_mul(shi_splat(0.693147181f), shi_sub(a, shi_to_float(n))); /* ln 2 */
    shi_v sum = shi_madd(f, shi_splat(1.0f / 720.0f), shi_splat(1.0f / 120.0f));
    sum = shi_madd(f, sum, shi_splat(1.0f / 24.0f));
    sum = shi_madd(f, sum, shi_splat(1.0f / 6.0f));
    sum = shi_madd(f, sum, shi_splat(0.5f));
    sum = shi_madd(f, sum, shi_splat(1.0f));
    sum = shi_madd(f, sum, shi_splat(1.0f));
    return shi_mul(sum, shi_as_float(shi_shl(shi_iadd(n, 127), 23)));
}

/* q^p for q in [0, 1], p in [1, 3]: below 2^-42, where it is under 3e-13, q counts as 2^-42. */
SHI_INLINE shi_v shi_power(shi_v q, shi_v p) {
    return shi_exp2(shi_mul(p, shi_log2(shi_max(q, shi_splat(1.0f / 4398046511104.0f)))));
}

typedef struct shi_model {
    shi_v scale, r1[3], r2[6], even[4];
} shi_model;

SHI_INLINE void shi_model_splat(const sh_closure *p, shi_model *m) {
    m->scale = shi_splat(p->scale);
    for (int i = 0; i < 3; i++)
        m->r1[i] = shi_splat(p->r1[i]);
    for (int i = 0; i < 6; i++)
        m->r2[i] = shi_splat(p->r2[i]);
    for (int i = 0; i < 4; i++)
        m->even[i] = shi_splat(p->even[i]);
}

SHI_INLINE shi_v shi_dot_v(shi_v ax, shi_v ay, shi_v az, shi_v x, shi_v y, shi_v z) {
    return shi_madd(ax, x, shi_madd(ay, y, shi_mul(az, z)));
}

/* scale times: the even part, clamped to [lower, sqrt(upper)], and v. */
SHI_INLINE shi_v shi_clamped_v(const shi_model *m, shi_v v, shi_v even, shi_v lower, shi_v upper) {
    return shi_mul(m->scale, shi_add(shi_max(shi_min(even, shi_sqrt(upper)), lower), v));
}

/* What the functions above evaluate, for a literal model. */
SHI_INLINE shi_v shi_model_v(int model, const shi_model *m, shi_v x, shi_v y, shi_v z) {
    const shi_v *k = m->even, *a = m->r2, v = shi_dot_v(m->r1[0], m->r1[1], m->r1[2], x, y, z), zero = shi_splat(0.0f);
    if (model == SHI_GEOMERICS) {
        const shi_v q = shi_max(shi_min(shi_add(v, shi_splat(0.5f)), shi_splat(1.0f)), zero);
        return shi_mul(m->scale, shi_madd(k[1], shi_power(q, k[2]), shi_add(k[0], shi_sub(v, v)))); /* v - v: NaN stays */
    }
    if (model == SHI_ZH3)
        return shi_max(zero, shi_mul(m->scale, shi_madd(v, shi_madd(k[2], v, k[1]), k[0])));
    if (model == SHI_CLOSURE_L1 || model == SHI_CLOSURE_L1_BOUNDED) {
        const shi_v t = shi_mul(v, v);
        if (model == SHI_CLOSURE_L1)
            return shi_mul(m->scale, shi_add(shi_madd(shi_madd(shi_add(t, k[2]), t, k[1]), t, k[0]), v));
        const shi_v even = shi_madd(shi_madd(shi_madd(shi_splat(3003.0f / 65536.0f), t, k[2]), t, k[1]), t, k[0]);
        return shi_clamped_v(m, v, even, shi_abs(v), shi_add(k[3], t));
    }
    const shi_v ax = shi_dot_v(a[0], a[1], a[2], x, y, z), ay = shi_dot_v(a[1], a[3], a[4], x, y, z);
    const shi_v az = shi_dot_v(a[2], a[4], a[5], x, y, z), q = shi_dot_v(ax, ay, az, x, y, z);
    if (model == SHI_LINEAR)
        return shi_max(zero, shi_add(shi_add(k[0], v), q));
    const shi_v aa = shi_dot_v(ax, ay, az, ax, ay, az), m2 = shi_madd(shi_splat(2.0f), q, k[3]);
    const shi_v outer = shi_madd(shi_splat(-819.0f / 256.0f), q, shi_splat(15.0f / 16.0f));
    const shi_v inner = shi_madd(shi_madd(shi_splat(3003.0f / 1024.0f), q, shi_splat(-105.0f / 64.0f)), q, k[1]);
    const shi_v even = shi_madd(aa, outer, shi_madd(q, inner, k[0]));
    const shi_v lower = shi_max(shi_abs(v), m2);
    if (model == SHI_CLOSURE_L2)
        return shi_mul(m->scale, shi_add(shi_max(even, lower), v));
    return shi_clamped_v(m, v, even, lower, shi_max(shi_mul(k[2], m2), zero));
}

SHI_INLINE void shi_model_loop(int model, const sh_closure *p, const float *x, const float *y, const float *z, float *out,
                               size_t count) {
    shi_model m;
    shi_model_splat(p, &m);
    for (size_t i = 0; i < count; i += SHI_LANES)
        shi_store(out + i, shi_model_v(model, &m, shi_load(x + i), shi_load(y + i), shi_load(z + i)));
}

/* One channel of `count` normals, a multiple of SHI_LANES, by the models that an order and a family can have. */
SHI_FUNCTION void shi_run_linear(const sh_closure *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    shi_model_loop(SHI_LINEAR, p, x, y, z, out, count);
}

SHI_FUNCTION void shi_run_closure_l1(const sh_closure *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    switch (p->model) {
    case SHI_CLOSURE_L1: shi_model_loop(SHI_CLOSURE_L1, p, x, y, z, out, count); break;
    case SHI_CLOSURE_L1_BOUNDED: shi_model_loop(SHI_CLOSURE_L1_BOUNDED, p, x, y, z, out, count); break;
    default: shi_run_linear(p, x, y, z, out, count); break;
    }
}

SHI_FUNCTION void shi_run_closure_l2(const sh_closure *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    switch (p->model) {
    case SHI_CLOSURE_L2: shi_model_loop(SHI_CLOSURE_L2, p, x, y, z, out, count); break;
    case SHI_CLOSURE_L2_BOUNDED: shi_model_loop(SHI_CLOSURE_L2_BOUNDED, p, x, y, z, out, count); break;
    default: shi_run_linear(p, x, y, z, out, count); break;
    }
}

SHI_FUNCTION void shi_run_geomerics(const sh_closure *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    if (p->model == SHI_GEOMERICS)
        shi_model_loop(SHI_GEOMERICS, p, x, y, z, out, count);
    else
        shi_run_linear(p, x, y, z, out, count);
}

SHI_FUNCTION void shi_run_zh3(const sh_closure *p, const float *x, const float *y, const float *z, float *out, size_t count) {
    if (p->model == SHI_ZH3)
        shi_model_loop(SHI_ZH3, p, x, y, z, out, count);
    else
        shi_run_linear(p, x, y, z, out, count);
}

enum { SHI_FAMILY_CLOSURE, SHI_FAMILY_GEOMERICS, SHI_FAMILY_ZH3 };

SHI_INLINE void shi_run_model(int order, int family, const sh_closure *p, const float *x, const float *y, const float *z, float *out,
                              size_t count) {
    if (family == SHI_FAMILY_GEOMERICS)
        shi_run_geomerics(p, x, y, z, out, count);
    else if (family == SHI_FAMILY_ZH3)
        shi_run_zh3(p, x, y, z, out, count);
    else if (order == SH_L0)
        shi_run_linear(p, x, y, z, out, count);
    else if (order == SH_L1)
        shi_run_closure_l1(p, x, y, z, out, count);
    else
        shi_run_closure_l2(p, x, y, z, out, count);
}

SHI_INLINE void shi_prepare_model(int order, int family, const float *c, sh_closure *out) {
    if (family == SHI_FAMILY_GEOMERICS)
        shi_prepare_geomerics(c, out);
    else if (family == SHI_FAMILY_ZH3)
        shi_prepare_zh3(c, out);
    else
        shi_prepare_closure(order, c, 0, out);
}

/* Where a batch's models come from: prepared by the caller; or coefficients, prepared once where there are few channels, else as
 * each block needs them. */
typedef struct shi_source {
    const float *c;
    const sh_closure *prepared;
    sh_closure kept[SH_MAX_CHANNELS];
} shi_source;

SHI_INLINE void shi_source_init(int order, int family, int channels, const float *c, const sh_closure *prepared, shi_source *s) {
    s->c = c;
    s->prepared = prepared;
    if (!prepared && channels <= SH_MAX_CHANNELS) {
        for (int k = 0; k < channels; k++)
            shi_prepare_model(order, family, c + k * SH_COUNT(order), s->kept + k);
        s->prepared = s->kept;
    }
}

SHI_INLINE const sh_closure *shi_source_get(int order, int family, const shi_source *s, int channel, sh_closure *scratch) {
    if (s->prepared)
        return s->prepared + channel;
    shi_prepare_model(order, family, s->c + channel * SH_COUNT(order), scratch);
    return scratch;
}

SHI_INLINE void shi_models_soa(int order, int family, int channels, const float *c, const sh_closure *prepared, const float *x,
                               const float *y, const float *z, float *out, size_t count) {
    const size_t total = (size_t)channels * count;
    const int copy = shi_overlaps_any(x, y, z, count, out, total);
    shi_source source;
    shi_source_init(order, family, channels, c, prepared, &source);
    for (size_t i = 0; i < count; i += SHI_BATCH) {
        const size_t n = shi_at_most(count - i, SHI_BATCH), whole = copy ? 0 : n / SHI_LANES * SHI_LANES, rest = n - whole;
        shi_block block;
        if (rest)
            shi_block_copy(x + i + whole, y + i + whole, z + i + whole, rest, &block);
        for (int k = 0; k < channels; k++) {
            sh_closure scratch;
            const sh_closure *p = shi_source_get(order, family, &source, k, &scratch);
            float *to = out + (size_t)k * count + i;
            if (whole)
                shi_run_model(order, family, p, x + i, y + i, z + i, to, whole);
            if (rest) {
                shi_run_model(order, family, p, block.x, block.y, block.z, block.out, shi_round_up(rest));
                memcpy(to + whole, block.out, rest * sizeof *to);
            }
        }
    }
}

SHI_INLINE void shi_models_aos(int order, int family, int channels, const float *c, const sh_closure *prepared, const float *n,
                               size_t n_stride, float *out, size_t out_stride, size_t count) {
    const size_t in_step = n_stride ? n_stride : 3 * sizeof *n;
    const size_t out_step = out_stride ? out_stride : (size_t)channels * sizeof *out;
    shi_source source;
    shi_source_init(order, family, channels, c, prepared, &source);
    for (size_t i = 0; i < count; i += SHI_BATCH) {
        const size_t some = shi_at_most(count - i, SHI_BATCH);
        const unsigned char *in = (const unsigned char *)n + i * in_step;
        unsigned char *to = (unsigned char *)out + i * out_step;
        shi_block block;
        shi_block_gather(in, in_step, some, &block);
        for (int k = 0; k < channels; k++) {
            sh_closure scratch;
            const sh_closure *p = shi_source_get(order, family, &source, k, &scratch);
            shi_run_model(order, family, p, block.x, block.y, block.z, block.out, shi_round_up(some));
            shi_block_scatter(&block, some, to + (size_t)k * sizeof *out, out_step);
        }
    }
}

SHI_INLINE void sh_irradiance_closure_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                            float *out, size_t count) {
    shi_models_soa(order, SHI_FAMILY_CLOSURE, channels, c, NULL, x, y, z, out, count);
}

SHI_INLINE void sh_closure_irradiance_batch(int order, int channels, const sh_closure *closure, const float *x, const float *y,
                                            const float *z, float *out, size_t count) {
    shi_models_soa(order, SHI_FAMILY_CLOSURE, channels, NULL, closure, x, y, z, out, count);
}

SHI_INLINE void sh_irradiance_geomerics_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                              float *out, size_t count) {
    shi_models_soa(order, SHI_FAMILY_GEOMERICS, channels, c, NULL, x, y, z, out, count);
}

SHI_INLINE void sh_irradiance_zh3_batch(int order, int channels, const float *c, const float *x, const float *y, const float *z,
                                        float *out, size_t count) {
    shi_models_soa(order, SHI_FAMILY_ZH3, channels, c, NULL, x, y, z, out, count);
}

SHI_INLINE void sh_irradiance_closure_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                                size_t out_stride, size_t count) {
    shi_models_aos(order, SHI_FAMILY_CLOSURE, channels, c, NULL, n, n_stride, out, out_stride, count);
}

SHI_INLINE void sh_closure_irradiance_batch_aos(int order, int channels, const sh_closure *closure, const float *n, size_t n_stride,
                                                float *out, size_t out_stride, size_t count) {
    shi_models_aos(order, SHI_FAMILY_CLOSURE, channels, NULL, closure, n, n_stride, out, out_stride, count);
}

SHI_INLINE void sh_irradiance_geomerics_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                                  size_t out_stride, size_t count) {
    shi_models_aos(order, SHI_FAMILY_GEOMERICS, channels, c, NULL, n, n_stride, out, out_stride, count);
}

SHI_INLINE void sh_irradiance_zh3_batch_aos(int order, int channels, const float *c, const float *n, size_t n_stride, float *out,
                                            size_t out_stride, size_t count) {
    shi_models_aos(order, SHI_FAMILY_ZH3, channels, c, NULL, n, n_stride, out, out_stride, count);
}
#endif /* SH_NO_BATCH */

#endif /* SH_H */

/* MIT License
 *
 * Copyright (c) 2026 the sh.h authors
 *
 * Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated documentation files
 * (the "Software"), to deal in the Software without restriction, including without limitation the rights to use, copy, modify, merge,
 * publish, distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do
 * so, subject to the following conditions:
 *
 * The above copyright notice and this permission notice shall be included in all copies or substantial portions of the Software.
 *
 * THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF
 * MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE
 * FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN
 * CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE. */
