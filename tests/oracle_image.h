/* oracle_image.h - images by definition, in long double: decoding of every format, and the moments of an equirectangular panorama.
 * Of sh.h, only the types and flags. */
#ifndef ORACLE_IMAGE_H
#define ORACLE_IMAGE_H

#include <stdint.h>
#include <string.h>

#include "oracle.h"
#include "sh.h"

/* ---- Texels ---- */

/* Sign, exponent and mantissa of an IEEE half. */
static inline long double oracle_half(unsigned bits) {
    const int exponent = (int)(bits >> 10 & 31u);
    const long double mantissa = (long double)(bits & 1023u), sign = bits >> 15 ? -1.0L : 1.0L;
    if (exponent == 31)
        return mantissa > 0.0L ? (long double)NAN : sign * (long double)INFINITY;
    return sign * (exponent == 0 ? ldexpl(mantissa, -24) : ldexpl(1024.0L + mantissa, exponent - 25));
}

/* IEC 61966-2-1: from a stored value in 0..255 to linear light. */
static inline long double oracle_srgb(unsigned byte) {
    const long double v = byte / 255.0L;
    return v <= 0.04045L ? v / 12.92L : powl((v + 0.055L) / 1.055L, 2.4L);
}

/* Colour channels in memory, 1 or 3. */
static inline int oracle_colours(const sh_image *image) {
    return image->channels == 1 ? 1 : 3;
}

/* Bytes of one texel. */
static inline size_t oracle_texel_size(const sh_image *image) {
    switch (image->format) {
    case SH_F32:
        return 4 * (size_t)image->channels;
    case SH_F16:
        return 2 * (size_t)image->channels;
    case SH_SRGB8:
        return (size_t)image->channels;
    default:
        return 4;
    }
}

static inline const unsigned char *oracle_texel_address(const sh_image *image, int x, int y) {
    const size_t size = oracle_texel_size(image), stride = image->row_stride ? image->row_stride : size * (size_t)image->width;
    return (const unsigned char *)image->pixels + stride * (size_t)y + size * (size_t)x;
}

/* The colours of one texel. */
static inline void oracle_texel(const sh_image *image, int x, int y, long double value[3]) {
    const unsigned char *byte = oracle_texel_address(image, x, y);
    uint32_t word = 0;
    if (image->format == SH_RGB9E5)
        memcpy(&word, byte, sizeof word);
    for (int k = 0; k < oracle_colours(image); k++) {
        float single;
        uint16_t half;
        switch (image->format) {
        case SH_F32:
            memcpy(&single, byte + 4 * k, sizeof single);
            value[k] = (long double)single;
            break;
        case SH_F16:
            memcpy(&half, byte + 2 * k, sizeof half);
            value[k] = oracle_half(half);
            break;
        case SH_RGBE8:
            value[k] = byte[3] == 0 ? 0.0L : ldexpl((long double)byte[k], (byte[3] < 255 ? byte[3] : 254) - 136);
            break;
        case SH_RGB9E5:
            value[k] = ldexpl((long double)(word >> 9 * k & 511u), (int)(word >> 27) - 24);
            break;
        case SH_SRGB8:
            value[k] = oracle_srgb(byte[k]);
            break;
        }
    }
}

/* ---- The equirectangular map ---- */

/* The direction of the centre of a texel. */
static inline void oracle_equirect_direction(const sh_image *image, unsigned flags, int x, int y, long double dir[3]) {
    const long double theta = oracle_pi * (y + 0.5L) / image->height, phi = 2.0L * oracle_pi * (x + 0.5L) / image->width;
    dir[0] = sinl(theta) * cosl(phi);
    dir[1] = sinl(theta) * (flags & SH_CLOCKWISE ? -sinl(phi) : sinl(phi));
    dir[2] = cosl(theta);
}

/* Sums over part of an axis of 1, c, s, cc, cs, ss, where c and s are the cosine and sine of its angle: what moments are products of. */
typedef struct oracle_trig {
    long double one, c, s, cc, cs, ss;
} oracle_trig;

static inline void oracle_trig_add(long double angle, long double weight, oracle_trig *sum) {
    const long double c = cosl(angle), s = sinl(angle);
    sum->one += weight;
    sum->c += weight * c;
    sum->s += weight * s;
    sum->cc += weight * c * c;
    sum->cs += weight * c * s;
    sum->ss += weight * s * s;
}

/* Weights of the first Fejer rule for `count` angles (i + 1/2) pi / count, as fractions of the sphere: half the integrals over
 * z = cos(angle) of the Lagrange polynomials of the nodes, in barycentric form. count <= ORACLE_MAX_NODES. */
static inline void oracle_fejer(int count, long double *weight) {
    const int gauss = count / 4 * 2 + 2; /* even, so that no Gauss node is the middle node at 0 */
    long double node[ORACLE_MAX_NODES], barycentric[ORACLE_MAX_NODES];
    long double gauss_node[ORACLE_MAX_NODES], gauss_weight[ORACLE_MAX_NODES];
    oracle_gauss(gauss, -1.0L, 1.0L, gauss_node, gauss_weight);
    for (int i = 0; i < count; i++) {
        const long double angle = oracle_pi * (i + 0.5L) / count;
        node[i] = cosl(angle);
        barycentric[i] = i % 2 == 0 ? sinl(angle) : -sinl(angle);
        weight[i] = 0.0L;
    }
    for (int g = 0; g < gauss; g++) {
        long double term[ORACLE_MAX_NODES], sum = 0.0L;
        for (int i = 0; i < count; i++)
            sum += term[i] = barycentric[i] / (gauss_node[g] - node[i]);
        for (int i = 0; i < count; i++)
            weight[i] += 0.5L * gauss_weight[g] * term[i] / sum;
    }
}

/* The rows (polar), or the columns, of an image, integrated over their extents; the polar axis weighs angles by half their sine. */
static inline void oracle_axis_area(int count, int polar, oracle_trig *axis) {
    const int nodes = count < 8 ? 24 : 10; /* enough for cos(2 angle) over a whole turn, and over an eighth of one */
    const long double width = (polar ? 1.0L : 2.0L) * oracle_pi / count;
    long double node[24], weight[24];
    oracle_gauss(nodes, 0.0L, width, node, weight);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < nodes; k++) {
            const long double angle = width * i + node[k];
            oracle_trig_add(angle, weight[k] * (polar ? 0.5L * sinl(angle) : 0.5L / oracle_pi), &axis[i]);
        }
}

/* The rows, or the columns, at their middles. */
static inline void oracle_axis_point(int count, int polar, oracle_trig *axis) {
    const long double width = (polar ? 1.0L : 2.0L) * oracle_pi / count;
    long double weight[ORACLE_MAX_NODES];
    if (polar)
        oracle_fejer(count, weight);
    for (int i = 0; i < count; i++)
        oracle_trig_add(width * (i + 0.5L), polar ? weight[i] : 1.0L / count, &axis[i]);
}

/* Free the result. */
static inline oracle_trig *oracle_axis(int count, int polar, unsigned flags) {
    oracle_trig *axis = (oracle_trig *)calloc((size_t)count, sizeof(oracle_trig));
    if (axis == NULL)
        exit(1);
    if (flags & SH_POINT_TEXELS)
        oracle_axis_point(count, polar, axis);
    else
        oracle_axis_area(count, polar, axis);
    return axis;
}

/* Solid angle times basis, over 4 pi, of the texel of a row and a column. */
static inline void oracle_texel_moments(const oracle_trig *row, const oracle_trig *column, unsigned flags, long double moment[9]) {
    const long double area = row->one * column->one, turn = flags & SH_CLOCKWISE ? -1.0L : 1.0L;
    const long double value[9] = { area,
                                   row->s * column->c,
                                   row->s * column->s * turn,
                                   row->c * column->one,
                                   row->ss * column->cc - area / 3.0L,
                                   row->ss * column->cs * turn,
                                   row->cs * column->c,
                                   row->ss * column->ss - area / 3.0L,
                                   row->cs * column->s * turn };
    for (int i = 0; i < 9; i++)
        moment[i] = value[i];
}

/* Moments of three channels; the mean of |radiance| of each, which errors are measured against; what the texels were. */
typedef struct oracle_projection {
    long double c[3][9], magnitude[3];
    unsigned long long texels, nonfinite, negative;
} oracle_projection;

/* Adds a texel with given solid angle moments. */
static inline void oracle_projection_add(const long double *value, int colours, const long double moment[9], unsigned flags,
                                         oracle_projection *projection) {
    int finite = 1, negative = 0;
    for (int k = 0; k < colours; k++) {
        finite &= value[k] - value[k] == 0.0L;
        negative |= value[k] < 0.0L;
    }
    projection->texels++;
    projection->nonfinite += !finite;
    projection->negative += finite && negative;
    for (int k = 0; finite && k < colours; k++) {
        const long double radiance = value[k] < 0.0L && flags & SH_CLAMP_NEGATIVE ? 0.0L : value[k];
        projection->magnitude[k] += moment[0] * fabsl(radiance);
        for (int i = 0; i < 9; i++)
            projection->c[k][i] += moment[i] * radiance;
    }
}

/* Projects rows [first, first + count) of an equirectangular panorama, with the meaning of sh_project_equirect_rows. */
static inline oracle_projection oracle_project_equirect_rows(const sh_image *image, unsigned flags, int first, int count) {
    oracle_projection projection;
    oracle_trig *rows = oracle_axis(image->height, 1, flags), *columns = oracle_axis(image->width, 0, flags);
    memset(&projection, 0, sizeof projection);
    for (int y = first; y < first + count; y++)
        for (int x = 0; x < image->width; x++) {
            long double value[3], moment[9];
            oracle_texel(image, x, y, value);
            oracle_texel_moments(&rows[y], &columns[x], flags, moment);
            oracle_projection_add(value, oracle_colours(image), moment, flags, &projection);
        }
    free(rows);
    free(columns);
    return projection;
}

static inline oracle_projection oracle_project_equirect(const sh_image *image, unsigned flags) {
    return oracle_project_equirect_rows(image, flags, 0, image->height);
}

#endif /* ORACLE_IMAGE_H */
