/* shlight_image.h - reads Radiance pictures (.hdr, .pic) and portable float maps (.pfm) from memory, for shlight.
 *
 * Radiance: flat, old run-length and new run-length scanlines, all eight orientations of the resolution line, EXPOSURE and COLORCORR
 * divided out. Ward, "Real Pixels", Graphics Gems II, 1991; "Radiance File Formats". XYZE pixels are refused: their primaries and
 * white point would have to be guessed.
 * PFM: colour (PF) and grey (Pf), both byte orders, rows bottom to top; samples are multiplied by the magnitude of the scale.
 * Bytes after the picture are ignored: both formats allow them. No global state, C99.
 */
#ifndef SHLIGHT_IMAGE_H
#define SHLIGHT_IMAGE_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Limits on what a file may ask for, to be lowered by whoever has less memory: texels a side, bytes of decoded pixels. */
#ifndef SHLIGHT_MAX_SIDE
#define SHLIGHT_MAX_SIDE 32768
#endif
#ifndef SHLIGHT_MAX_BYTES
#define SHLIGHT_MAX_BYTES ((uint64_t)1 << 31)
#endif

typedef struct shlight_image {
    float *pixels; /* linear radiance, rows from the top down, columns from left to right, tight; free() it */
    int width, height;
    int channels;       /* 1 or 3 */
    const char *format; /* for people */
} shlight_image;

/* What is left to read. */
typedef struct shlight_bytes {
    const unsigned char *at, *end;
} shlight_bytes;

static size_t shlight_left(const shlight_bytes *in) {
    return (size_t)(in->end - in->at);
}

static int shlight_is_space(int c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\v' || c == '\f' || c == '\r';
}

/* Allocates pixels of the size in `image`; NULL, or what is wrong. */
static const char *shlight_allocate(shlight_image *image) {
    if (image->width < 1 || image->height < 1)
        return "width or height is not a positive number";
    if (image->width > SHLIGHT_MAX_SIDE || image->height > SHLIGHT_MAX_SIDE)
        return "too large: more than 32768 texels a side";
    const uint64_t bytes = (uint64_t)image->width * (uint64_t)image->height * (uint64_t)image->channels * sizeof(float);
    if (bytes > SHLIGHT_MAX_BYTES || bytes > SIZE_MAX)
        return "too large: more than 2 GiB of pixels";
    image->pixels = (float *)malloc((size_t)bytes);
    return image->pixels ? NULL : "not enough memory for its pixels";
}

/* A decimal number at *text, which moves past it. Numbers beyond a million read as one million: over every limit. -1: no digits. */
static int shlight_integer(const char **text) {
    int value = 0;
    if (**text < '0' || **text > '9')
        return -1;
    for (; **text >= '0' && **text <= '9'; ++*text)
        value = value > 99999 ? 1000000 : value * 10 + (**text - '0');
    return value;
}

/* A finite positive number at the start of text; 0 if there is none. *end, unless NULL, is where it ends. */
static float shlight_positive(const char *text, char **end) {
    char *stop;
    double value = strtod(text, &stop);
    if (end)
        *end = stop;
    return stop != text && value >= 1e-30 && value <= 1e30 ? (float)value : 0.0f;
}

/* ---- Radiance ------------------------------------------------------------------------------------------------------------------- */

/* Copies the next line, without its end and cut to `size`; 0 if there is none. */
static int shlight_line(shlight_bytes *in, char *line, size_t size) {
    if (in->at == in->end)
        return 0;
    const unsigned char *newline = (const unsigned char *)memchr(in->at, '\n', shlight_left(in));
    if (!newline)
        return 0;
    size_t length = (size_t)(newline - in->at);
    if (length && in->at[length - 1] == '\r')
        --length;
    if (length > size - 1)
        length = size - 1;
    memcpy(line, in->at, length);
    line[length] = '\0';
    in->at = newline + 1;
    return 1;
}

/* EXPOSURE and COLORCORR may be repeated; their product must stay a number to divide by. */
static const char *shlight_exposure_error(const float exposure[3]) {
    for (int k = 0; k < 3; k++) {
        if (!(exposure[k] >= 1e-30f && exposure[k] <= 1e30f))
            return "EXPOSURE and COLORCORR in the Radiance header are out of range";
    }
    return NULL;
}

/* Reads the header's variables to the empty line that ends it; exposure[3] is what the pixels were multiplied by. */
static const char *shlight_hdr_header(shlight_bytes *in, float exposure[3]) {
    char line[256];
    exposure[0] = exposure[1] = exposure[2] = 1.0f;
    while (shlight_line(in, line, sizeof line)) {
        if (line[0] == '\0')
            return shlight_exposure_error(exposure);
        if (!strncmp(line, "FORMAT=", 7)) {
            const char *format = line + 7 + strspn(line + 7, " \t");
            if (!strncmp(format, "32-bit_rle_xyze", 15))
                return "XYZE pixels are not supported, RGBE are: convert it first";
            if (strncmp(format, "32-bit_rle_rgbe", 15) != 0)
                return "unknown FORMAT in the Radiance header";
        } else if (!strncmp(line, "EXPOSURE=", 9)) {
            float factor = shlight_positive(line + 9, NULL);
            if (factor == 0.0f)
                return "EXPOSURE in the Radiance header is not a positive number";
            for (int k = 0; k < 3; k++)
                exposure[k] *= factor;
        } else if (!strncmp(line, "COLORCORR=", 10)) {
            char *text = line + 10;
            for (int k = 0; k < 3; k++) {
                float factor = shlight_positive(text, &text);
                if (factor == 0.0f)
                    return "COLORCORR in the Radiance header is not three positive numbers";
                exposure[k] *= factor;
            }
        }
    }
    return "the Radiance header does not end";
}

/* Where scanline i, pixel j goes in the image: first + i * scanline + j * pixel, in texels. */
typedef struct shlight_scan {
    int scanlines, pixels;
    ptrdiff_t first, scanline, pixel;
} shlight_scan;

/* Reads a resolution line such as "-Y 512 +X 1024": the first axis is that of the scanlines, -Y is downwards. */
static const char *shlight_hdr_resolution(shlight_bytes *in, shlight_image *image, shlight_scan *scan) {
    static const char wrong[] = "its resolution line is not like -Y 512 +X 1024";
    char line[256], sign[2], axis[2];
    const char *text = line;
    ptrdiff_t step[2], first[2];
    int count[2];
    if (!shlight_line(in, line, sizeof line))
        return "no resolution line after the Radiance header";
    for (int k = 0; k < 2; k++) {
        sign[k] = *text++;
        if (sign[k] != '-' && sign[k] != '+')
            return wrong;
        axis[k] = *text++;
        if ((axis[k] != 'X' && axis[k] != 'Y') || *text++ != ' ')
            return wrong;
        count[k] = shlight_integer(&text);
        if (count[k] < 0 || (k == 0 && *text++ != ' '))
            return wrong;
    }
    if (axis[0] == axis[1])
        return wrong;
    image->width = count[axis[0] == 'X' ? 0 : 1];
    image->height = count[axis[0] == 'X' ? 1 : 0];
    for (int k = 0; k < 2; k++) {
        int forward = axis[k] == 'X' ? sign[k] == '+' : sign[k] == '-';
        ptrdiff_t stride = axis[k] == 'X' ? 1 : image->width;
        step[k] = forward ? stride : -stride;
        first[k] = forward ? 0 : (count[k] - 1) * stride;
    }
    scan->scanlines = count[0];
    scan->pixels = count[1];
    scan->first = first[0] + first[1];
    scan->scanline = step[0];
    scan->pixel = step[1];
    return NULL;
}

/* New run-length coding: each of r, g, b, e as its own sequence of runs. The four bytes that announce it have been read. */
static const char *shlight_hdr_new_runs(shlight_bytes *in, unsigned char *rgbe, int count) {
    for (int component = 0; component < 4; component++) {
        for (int i = 0; i < count;) {
            if (shlight_left(in) < 2)
                return "shorter than its header says";
            const int code = *in->at++, length = code > 128 ? code - 128 : code;
            if (length == 0)
                return "an empty run in its run-length coding";
            if (length > count - i)
                return "a run in its run-length coding overruns the scanline";
            if (code > 128) {
                for (int k = 0; k < length; k++)
                    rgbe[4 * i++ + component] = *in->at;
                ++in->at;
            } else {
                if (shlight_left(in) < (size_t)length)
                    return "shorter than its header says";
                for (int k = 0; k < length; k++)
                    rgbe[4 * i++ + component] = *in->at++;
            }
        }
    }
    return NULL;
}

/* Flat pixels, and old run-length coding: (1, 1, 1, n) repeats the pixel before n times; n of those that follow it count 256-fold. */
static const char *shlight_hdr_old_runs(shlight_bytes *in, unsigned char *rgbe, int count) {
    int i = 0, shift = 0;
    while (i < count) {
        const unsigned char *p = in->at;
        if (shlight_left(in) < 4)
            return "shorter than its header says";
        in->at += 4;
        if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
            uint32_t length = shift < 32 ? (uint32_t)p[3] << shift : UINT32_MAX;
            if (i == 0)
                return "a run in its run-length coding has no pixel to repeat";
            if (length > (uint32_t)(count - i))
                return "a run in its run-length coding overruns the scanline";
            for (; length; --length, ++i)
                memcpy(rgbe + 4 * i, rgbe + 4 * i - 4, 4);
            shift += 8;
        } else {
            memcpy(rgbe + 4 * i++, p, 4);
            shift = 0;
        }
    }
    return NULL;
}

static const char *shlight_hdr_scanline(shlight_bytes *in, unsigned char *rgbe, int count) {
    const unsigned char *p = in->at;
    if (shlight_left(in) < 4)
        return "shorter than its header says";
    if (count < 8 || count > 32767 || p[0] != 2 || p[1] != 2 || p[2] > 127)
        return shlight_hdr_old_runs(in, rgbe, count);
    if ((p[2] << 8 | p[3]) != count)
        return "a scanline's length is not the width in its header";
    in->at += 4;
    return shlight_hdr_new_runs(in, rgbe, count);
}

/* Decodes all scanlines through rgbe, room for one. Radiance is mantissa * 2^(exponent - 136) / exposure; exponent 0 is black. */
static const char *shlight_hdr_pixels(shlight_bytes *in, const shlight_scan *scan, const float exposure[3], unsigned char *rgbe,
                                      shlight_image *image) {
    float scale[3][256];
    for (int k = 0; k < 3; k++) {
        scale[k][0] = 0.0f;
        for (int i = 1; i < 256; i++)
            scale[k][i] = (float)fmin(ldexp(1.0, i - 136) / (double)exposure[k], (double)FLT_MAX);
    }
    for (int i = 0; i < scan->scanlines; i++) {
        const char *error = shlight_hdr_scanline(in, rgbe, scan->pixels);
        if (error)
            return error;
        for (int j = 0; j < scan->pixels; j++) {
            float *texel = image->pixels + 3 * (scan->first + i * scan->scanline + j * scan->pixel);
            const unsigned char *p = rgbe + 4 * j;
            for (int k = 0; k < 3; k++)
                texel[k] = (float)p[k] * scale[k][p[3]];
        }
    }
    return NULL;
}

static const char *shlight_read_hdr(shlight_bytes in, shlight_image *image) {
    float exposure[3];
    shlight_scan scan;
    const char *error = shlight_hdr_header(&in, exposure);
    if (!error)
        error = shlight_hdr_resolution(&in, image, &scan);
    if (error)
        return error;
    image->channels = 3;
    image->format = "Radiance RGBE";
    if (scan.scanlines <= SHLIGHT_MAX_SIDE && shlight_left(&in) / 4 < (size_t)scan.scanlines)
        return "shorter than its header says";
    error = shlight_allocate(image);
    if (error)
        return error;
    unsigned char *rgbe = (unsigned char *)malloc((size_t)scan.pixels * 4);
    error = rgbe ? shlight_hdr_pixels(&in, &scan, exposure, rgbe, image) : "not enough memory for its pixels";
    free(rgbe);
    return error;
}

/* ---- PFM ------------------------------------------------------------------------------------------------------------------------ */

/* Copies the next word, and steps over the one white space that ends it; 0 if there is none, or it does not fit. */
static int shlight_word(shlight_bytes *in, char *word, size_t size) {
    size_t length = 0;
    while (in->at < in->end && shlight_is_space(*in->at))
        ++in->at;
    for (; in->at < in->end && !shlight_is_space(*in->at); ++in->at) {
        if (length == size - 1)
            return 0;
        word[length++] = (char)*in->at;
    }
    if (length == 0 || in->at == in->end)
        return 0;
    if (*in->at++ == '\r' && in->at < in->end && *in->at == '\n')
        ++in->at;
    word[length] = '\0';
    return 1;
}

static int shlight_word_integer(shlight_bytes *in) {
    char word[32];
    const char *text = word;
    int value = shlight_word(in, word, sizeof word) ? shlight_integer(&text) : -1;
    return value >= 0 && *text == '\0' ? value : -1;
}

static float shlight_float(const unsigned char *p, int little) {
    uint32_t bits = little ? (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0]
                           : (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static const char *shlight_read_pfm(shlight_bytes in, shlight_image *image) {
    char word[64], *end;
    const char *error;
    image->channels = in.at[1] == 'F' ? 3 : 1;
    in.at += 2;
    image->width = shlight_word_integer(&in);
    image->height = shlight_word_integer(&in);
    if (image->width < 0 || image->height < 0)
        return "the PFM header has no width and height";
    if (!shlight_word(&in, word, sizeof word))
        return "the PFM header has no scale";
    const int little = word[0] == '-';
    const float scale = shlight_positive(word + little, &end);
    if (scale == 0.0f || *end)
        return "the scale in the PFM header is not a number other than 0";
    image->format = image->channels == 3 ? (little ? "PFM colour, little-endian" : "PFM colour, big-endian")
                                         : (little ? "PFM grey, little-endian" : "PFM grey, big-endian");
    const size_t row = (size_t)image->width * (size_t)image->channels;
    if (image->width > 0 && image->width <= SHLIGHT_MAX_SIDE && shlight_left(&in) / (4 * row) < (size_t)image->height &&
        image->height <= SHLIGHT_MAX_SIDE)
        return "shorter than its header says";
    error = shlight_allocate(image);
    if (error)
        return error;
    for (int y = image->height - 1; y >= 0; y--) {
        float *out = image->pixels + (size_t)y * row;
        for (size_t i = 0; i < row; i++, in.at += 4)
            out[i] = scale * shlight_float(in.at, little);
    }
    return NULL;
}

/* Reads a picture of either format, told apart by its first bytes. Returns 0 and fills `out`, whose pixels the caller frees; or
 * returns -1, leaves nothing to free, and points *error to a phrase that says what is wrong with the file. */
static int shlight_read(const unsigned char *bytes, size_t size, shlight_image *out, const char **error) {
    shlight_bytes in;
    in.at = bytes;
    in.end = bytes + size;
    memset(out, 0, sizeof *out);
    if (size == 0)
        *error = "empty";
    else if (size >= 2 && bytes[0] == '#' && bytes[1] == '?')
        *error = shlight_read_hdr(in, out);
    else if (size >= 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') && shlight_is_space(bytes[2]))
        *error = shlight_read_pfm(in, out);
    else
        *error = "neither a Radiance picture (.hdr) nor a portable float map (.pfm)";
    if (!*error)
        return 0;
    free(out->pixels);
    out->pixels = NULL;
    return -1;
}

#endif /* SHLIGHT_IMAGE_H */
