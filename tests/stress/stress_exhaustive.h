/* stress_exhaustive.h - bounds of approximations by looking at every argument there is, or at an even selection of them. */
#ifndef STRESS_EXHAUSTIVE_H
#define STRESS_EXHAUSTIVE_H

#include "stress_coefficients.h"
#include "stress_images.h"

static inline float stress_float(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline uint32_t stress_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* One texel is a panorama of one value: R0. */
static inline float stress_texel(const void *pixel, sh_format format, int channels, int k, uint64_t *nonfinite) {
    const sh_image image = { pixel, 1, 1, 0, channels, format };
    sh_report report = { 0, 0, 0 };
    float c[3] = { -1.0f, -1.0f, -1.0f };
    sh_project_equirect(SH_L0, &image, 0, c, &report);
    *nonfinite += report.nonfinite;
    return c[k];
}

/* Each prints its row: what, how many arguments, the claim, the worst; and returns whether it holds. */
static inline int stress_proof(const char *what, const char *arguments, const char *claim, double worst, double limit) {
    stress_print_cell(what);
    stress_print_cell(arguments);
    stress_print_cell(claim);
    printf("| %s%.2g%s |\n", worst <= limit ? "" : "**", worst, worst <= limit ? "" : "**");
    return worst <= limit;
}

static inline int stress_half_decode(void) {
    uint64_t nonfinite = 0, expected = 0;
    double worst = 0.0;
    for (uint32_t h = 0; h < 65536; h++) {
        const uint16_t word = (uint16_t)h;
        const long double value = oracle_half(h);
        const uint16_t packed[2] = { word, 0 };
        float c = stress_texel(&word, SH_F16, 1, 0, &nonfinite), unpacked = 0.0f;
        const int finite = value - value == 0.0L;
        expected += !finite;
        if (finite) {
            sh_unpack_half(SH_L0, 1, packed, &unpacked);
            worst = fmax(worst, (double)(fabsl((long double)unpacked - value)));
        }
        worst = fmax(worst,
                     (double)(fabsl((long double)c - (finite ? value : 0.0L)) / (finite && value != 0.0L ? fabsl(value) : 1.0L)));
    }
    return stress_proof("half to float, as a texel and by sh_unpack_half", "all 65 536", "exact; what is not finite is counted",
                        nonfinite == expected ? worst : 1.0, 1e-7);
}

/* The nearest half by the definition of rounding: to a multiple of 2^-24, or of 2^(e - 10); ties to even. */
static inline double stress_nearest_half(double x) {
    int exponent;
    frexp(x, &exponent);
    const int step = exponent - 11 > -24 ? exponent - 11 : -24;
    return ldexp(rint(ldexp(x, -step)), step);
}

/* Of `stride`-th floats below 65520, above which the nearest half is infinite. */
static inline int stress_half_encode(uint32_t stride, const char *arguments) {
    const uint32_t end = stress_bits(65520.0f);
    double worst = 0.0;
    for (uint32_t bits = 0; bits < end; bits += stride) {
        const double x = (double)stress_float(bits);
        const uint16_t half = shi_to_half((float)x);
        const double found = (double)shi_from_half(half), best = stress_nearest_half(x);
        worst = fmax(worst, fabs(found - best));
        if (shi_to_half(-(float)x) != (uint16_t)(half | 0x8000u))
            worst = 1.0;
    }
    return stress_proof("float to half", arguments, "the nearest, ties to even", worst, 0.0);
}

static inline int stress_texel_formats(void) {
    double worst = 0.0;
    uint64_t nonfinite = 0;
    for (int byte = 0; byte < 256; byte++) {
        const unsigned char texel = (unsigned char)byte;
        const long double value = oracle_srgb((unsigned)byte);
        worst = fmax(worst, (double)(fabsl((long double)stress_texel(&texel, SH_SRGB8, 1, 0, &nonfinite) - value) /
                                     (value > 0.0L ? value : 1.0L)));
    }
    for (uint32_t word = 0; word < 65536; word++) { /* mantissa, exponent */
        const unsigned char rgbe[4] = { 0, (unsigned char)(word >> 8), 1, (unsigned char)(word & 255u) };
        const uint32_t shared = (word >> 7) << 9 | (word & 31u) << 27;
        const sh_image a = { rgbe, 1, 1, 0, 3, SH_RGBE8 }, b = { &shared, 1, 1, 0, 3, SH_RGB9E5 };
        long double value[3];
        oracle_texel(&a, 0, 0, value);
        worst = fmax(worst, (double)(fabsl((long double)stress_texel(rgbe, SH_RGBE8, 3, 1, &nonfinite) - value[1]) /
                                     (value[1] > 1e-37L ? value[1] : 1e-37L)));
        oracle_texel(&b, 0, 0, value);
        worst = fmax(worst, (double)(fabsl((long double)stress_texel(&shared, SH_RGB9E5, 3, 1, &nonfinite) - value[1]) /
                                     (value[1] > 0.0L ? value[1] : 1.0L)));
    }
    return stress_proof("sRGB bytes, RGBE8, RGB9E5 as a texel", "all 256; all pairs of a mantissa and an exponent",
                        "1 ulp, relative (sRGB: 1.2e-7)", worst, 1.2e-7);
}

static inline int stress_vmf_floats(uint32_t stride, const char *arguments) {
    const uint32_t begin = stress_bits(1e-6f), end = stress_bits(1e6f);
    long double worst = 0.0L;
    for (uint32_t bits = begin; bits < end; bits += stride) {
        long double expected[3], mean, facing;
        float zonal[3];
        stress_vmf((long double)stress_float(bits), expected, &mean, &facing);
        sh_zonal_vmf(stress_float(bits), zonal);
        for (int l = 1; l < 3; l++)
            worst = fmaxl(worst, fabsl((long double)zonal[l] - expected[l]) / expected[l]);
    }
    return stress_proof("von Mises-Fisher series and closed form", arguments, "half an ulp, 6e-8 relative", (double)worst, 6.1e-8);
}

static inline int stress_ggx_floats(uint32_t stride, const char *arguments) {
    const uint32_t begin = stress_bits(1e-6f), end = stress_bits(1.0f);
    long double worst = 0.0L;
    for (uint32_t bits = begin; bits <= end; bits += stride) {
        long double expected[3];
        float zonal[3];
        stress_ggx((long double)stress_float(bits), expected);
        sh_zonal_ggx(stress_float(bits), zonal);
        for (int l = 1; l < 3; l++)
            worst = fmaxl(worst, fabsl((long double)zonal[l] - expected[l]));
    }
    return stress_proof("GGX integrals, series and closed form", arguments, "1e-7", (double)worst, 1e-7);
}

/* cos(acos(r) / 3) */
static inline int stress_cos_third(int count, const char *arguments) {
    long double worst = 0.0L;
    for (int i = 0; i <= count; i++) {
        const double r = (double)i / count;
        worst = fmaxl(worst, fabsl((long double)shi_cos_third(r) - cosl(acosl((long double)r) / 3.0L)));
    }
    return stress_proof("cos(acos(r) / 3), of eigenvalues", arguments, "2e-10", (double)worst, 2e-10);
}

/* The batch's logarithm and exponential, on `stride`-th floats of their domains. */
static inline int stress_power_floats(uint32_t stride, const char *arguments) {
    const uint32_t least = stress_bits(1.0f / 4398046511104.0f), one = stress_bits(1.0f), most = stress_bits(126.0f),
                   small = stress_bits(1e-9f);
    double worst = 0.0, ulps = 0.0;
    float lanes[SHI_LANES];
    for (uint32_t bits = least; bits <= one; bits += stride) {
        const double x = (double)stress_float(bits), exact = log2(x);
        int exponent;
        frexp(exact, &exponent);
        shi_store(lanes, shi_log2(shi_splat((float)x)));
        const double error = fabs((double)lanes[0] - exact);
        if (x >= 0.5)
            worst = fmax(worst, error);
        else
            ulps = fmax(ulps, ldexp(error, 24 - exponent));
    }
    int holds = stress_proof("log2 of the batches, from 1/2 to 1", arguments, "3e-7", worst, 3e-7);
    holds &= stress_proof("log2 of the batches, from 2^-42 to 1/2", arguments, "2 ulp", ulps, 2.0);
    worst = 0.0;
    for (uint32_t bits = small; bits <= most; bits += stride)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double x = sign * (double)stress_float(bits), exact = exp2(x);
            shi_store(lanes, shi_exp2(shi_splat((float)x)));
            worst = fmax(worst, fabs((double)lanes[0] - exact) / exact);
        }
    return holds & stress_proof("2^x of the batches, |x| from 1e-9 to 126", arguments, "3e-7 relative", worst, 3e-7);
}

/* Weights of texels: the sum of a row of one map where a single texel is 1. `rows` of every map size, all columns. */
static inline int stress_weights(const square_map *square, const int *sizes, int count, double limit, const char *what,
                                 const char *arguments) {
    double worst = 0.0;
    for (int s = 0; s < count; s++) {
        const int size = sizes[s], step = size <= 64 ? 1 : size / 13, across = size <= 256 ? 1 : 17;
        float *texels = (float *)calloc((size_t)size * (size_t)size, sizeof *texels);
        const sh_image one = { texels, size, size, 0, 1, SH_F32 };
        const sh_image face[6] = { one, one, one, one, one, one };
        if (!texels)
            exit(1);
        for (int y = 0; y < (size + 1) / 2; y += step)
            for (int x = 0; x < (size + 1) / 2; x += across) {
                sh_accum accum;
                float *texel = texels + (size_t)y * (size_t)size + x;
                sh_accum_clear(1, &accum);
                *texel = 1.0f;
                if (square->images == 6)
                    sh_project_cubemap_rows(SH_L0, face, 0, y, 1, &accum, NULL);
                else
                    sh_project_octahedral_rows(SH_L0, face, 0, y, 1, &accum, NULL);
                *texel = 0.0f;
                const long double weight = square_weight(square, size, x, y);
                worst = fmax(worst, (double)fabsl((long double)accum.sum[0] / square->images / weight - 1.0L));
            }
        free(texels);
    }
    return stress_proof(what, arguments, square->images == 6 ? "1e-6 of itself" : "5e-6 of itself", worst, limit);
}

static inline int stress_exhaustive(int quick) {
    static const int sizes[] = { 1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12,  13,   14,
                                 15, 16, 17, 24, 31, 32, 33, 48, 63, 64, 65, 128, 1024, 4096 };
    const int count = (int)(sizeof sizes / sizeof sizes[0]) - (quick ? 6 : 0);
    int bad = 0;
    bad += !stress_half_decode();
    bad += quick ? !stress_half_encode(1009, "every 1009th float") : !stress_half_encode(1, "all 2 398 076 928 below 65520");
    bad += !stress_texel_formats();
    bad += quick ? !stress_vmf_floats(100003, "every 100 003rd float, 1e-6 to 1e6")
                 : !stress_vmf_floats(61, "every 61st float, 1e-6 to 1e6");
    bad += quick ? !stress_ggx_floats(500009, "every 500 009th float, 1e-6 to 1")
                 : !stress_ggx_floats(499, "every 499th float, 1e-6 to 1");
    bad += quick ? !stress_cos_third(10000, "10 001 in [0, 1]") : !stress_cos_third(10000000, "10 000 001 in [0, 1]");
    bad += quick ? !stress_power_floats(10007, "every 10 007th float") : !stress_power_floats(1, "all floats");
    bad += !stress_weights(&stress_cube_map, sizes, count, 1e-6, "cube map weights", quick ? "sizes 1 to 48" : "sizes 1 to 4096");
    bad += !stress_weights(&stress_octahedron_map, sizes, count, 5e-6, "octahedral map weights",
                           quick ? "sizes 1 to 48" : "sizes 1 to 4096");
    return bad;
}

#endif /* STRESS_EXHAUSTIVE_H */
