/* shlight_png.h - makes 8-bit sRGB pictures into PNG (ISO/IEC 15948), compressed as one deflate block with fixed codes (RFC 1951). */
#ifndef SHLIGHT_PNG_H
#define SHLIGHT_PNG_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- Deflate -------------------------------------------------------------------------------------------------------------------- */

enum { SHLIGHT_WINDOW = 32768, SHLIGHT_MIN_MATCH = 3, SHLIGHT_MAX_MATCH = 258, SHLIGHT_CHAIN = 16, SHLIGHT_NONE = -1 };

typedef struct shlight_bits {
    unsigned char *at;
    uint32_t pending; /* bits not yet written, the oldest lowest */
    int count;
} shlight_bits;

/* Appends the low `count` bits of value, at most 24. */
static void shlight_put_bits(shlight_bits *out, uint32_t value, int count) {
    out->pending |= value << out->count;
    out->count += count;
    for (; out->count >= 8; out->count -= 8, out->pending >>= 8)
        *out->at++ = (unsigned char)out->pending;
}

/* Huffman codes go out from their highest bit. */
static void shlight_put_code(shlight_bits *out, uint32_t code, int count) {
    uint32_t reversed = 0;
    for (int i = 0; i < count; i++)
        reversed |= (code >> i & 1u) << (count - 1 - i);
    shlight_put_bits(out, reversed, count);
}

/* A literal byte, 256 for the end, or a length symbol, by the fixed code of RFC 1951, 3.2.6. */
static void shlight_put_symbol(shlight_bits *out, uint32_t symbol) {
    if (symbol < 144)
        shlight_put_code(out, 0x30 + symbol, 8);
    else if (symbol < 256)
        shlight_put_code(out, 0x190 + symbol - 144, 9);
    else if (symbol < 280)
        shlight_put_code(out, symbol - 256, 7);
    else
        shlight_put_code(out, 0xc0 + symbol - 280, 8);
}

/* A match of `length` bytes, 3 to 258, that lie `distance` back. RFC 1951, 3.2.5: each symbol covers a range, then extra bits. */
static void shlight_put_match(shlight_bits *out, uint32_t length, uint32_t distance) {
    uint32_t base = 3, symbol = 257, extra = 0;
    if (length == SHLIGHT_MAX_MATCH) {
        shlight_put_symbol(out, 285);
    } else {
        while (length >= base + (1u << extra)) {
            base += 1u << extra;
            if (++symbol >= 265 && (symbol - 261) % 4 == 0)
                extra++;
        }
        shlight_put_symbol(out, symbol);
        shlight_put_bits(out, length - base, (int)extra);
    }
    for (base = 1, symbol = 0, extra = 0; distance >= base + (1u << extra);) {
        base += 1u << extra;
        if (++symbol >= 4 && symbol % 2 == 0)
            extra++;
    }
    shlight_put_code(out, symbol, 5);
    shlight_put_bits(out, distance - base, (int)extra);
}

/* Where each three bytes were seen last: head by their hash, previous by position, SHLIGHT_NONE at the end. */
typedef struct shlight_history {
    int head[SHLIGHT_WINDOW], previous[SHLIGHT_WINDOW];
} shlight_history;

static uint32_t shlight_hash(const unsigned char *p) {
    return (((uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2]) * 2654435761u) >> 17;
}

static void shlight_remember(shlight_history *history, const unsigned char *data, int position) {
    const uint32_t hash = shlight_hash(data + position);
    history->previous[position % SHLIGHT_WINDOW] = history->head[hash];
    history->head[hash] = position;
}

/* The longest earlier match of what is at `position`; 0 if shorter than three bytes. */
static int shlight_longest(const shlight_history *history, const unsigned char *data, int size, int position, int *distance) {
    const int limit = size - position < SHLIGHT_MAX_MATCH ? size - position : SHLIGHT_MAX_MATCH;
    int best = 0;
    int candidate = history->head[shlight_hash(data + position)];
    for (int steps = 0; steps < SHLIGHT_CHAIN && candidate > position - SHLIGHT_WINDOW && candidate >= 0 && best < limit; steps++) {
        int length = 0;
        while (length < limit && data[candidate + length] == data[position + length])
            length++;
        if (length > best) {
            best = length;
            *distance = position - candidate;
        }
        candidate = history->previous[candidate % SHLIGHT_WINDOW];
    }
    return best < SHLIGHT_MIN_MATCH ? 0 : best;
}

static uint32_t shlight_adler32(const unsigned char *data, size_t size) {
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < size; i++) {
        a = (a + data[i]) % 65521u;
        b = (b + a) % 65521u;
    }
    return b << 16 | a;
}

static unsigned char *shlight_put_32(unsigned char *at, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        *at++ = (unsigned char)(value >> shift);
    return at;
}

/* A zlib stream (RFC 1950) of `size` bytes at out, room for size * 9 / 8 + 16; returns its end. */
static unsigned char *shlight_zlib(const unsigned char *data, int size, shlight_history *history, unsigned char *out) {
    shlight_bits bits = { out, 0, 0 };
    memset(history->head, 0xff, sizeof history->head); /* all SHLIGHT_NONE */
    shlight_put_bits(&bits, 0x78, 8);
    shlight_put_bits(&bits, 0x9c, 8);
    shlight_put_bits(&bits, 3, 3); /* the last block, fixed codes */
    for (int position = 0; position < size;) {
        int distance = 0,
            length = size - position < SHLIGHT_MIN_MATCH ? 0 : shlight_longest(history, data, size, position, &distance);
        if (length)
            shlight_put_match(&bits, (uint32_t)length, (uint32_t)distance);
        else
            shlight_put_symbol(&bits, data[position]);
        for (length = length ? length : 1; length; length--, position++)
            if (size - position >= SHLIGHT_MIN_MATCH)
                shlight_remember(history, data, position);
    }
    shlight_put_symbol(&bits, 256);
    shlight_put_bits(&bits, 0, -bits.count & 7);
    return shlight_put_32(bits.at, shlight_adler32(data, (size_t)size));
}

/* ---- PNG ------------------------------------------------------------------------------------------------------------------------ */

/* Rows as PNG's filter 1 leaves them, each after its type: differences from the texel to the left, small where shading is smooth.
 * Choosing a filter for each row by the usual sum of magnitudes makes the pictures of shlight 7 % larger. */
static void shlight_filter_rows(const unsigned char *rgb, int width, int height, unsigned char *out) {
    for (int y = 0; y < height; y++) {
        *out++ = 1;
        for (int i = 0; i < 3 * width; i++, rgb++)
            *out++ = (unsigned char)(i < 3 ? rgb[0] : rgb[0] - rgb[-3]);
    }
}

static uint32_t shlight_crc32(const unsigned char *data, size_t size) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return ~crc;
}

/* Completes a chunk whose data, up to `end`, begin 8 bytes after `chunk`: length, type and check sum. Returns its end. */
static unsigned char *shlight_close_chunk(unsigned char *chunk, const char *type, unsigned char *end) {
    shlight_put_32(chunk, (uint32_t)(end - chunk - 8));
    memcpy(chunk + 4, type, 4);
    return shlight_put_32(end, shlight_crc32(chunk + 4, (size_t)(end - chunk - 4)));
}

/* The PNG of a picture of less than 600 million texels, from malloc; NULL: not enough memory. */
static unsigned char *shlight_png(const unsigned char *rgb, int width, int height, size_t *size) {
    static const unsigned char signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    const size_t raw = (3 * (size_t)width + 1) * (size_t)height;
    unsigned char *filtered = (unsigned char *)malloc(raw), *png = (unsigned char *)malloc(raw + raw / 8 + 256), *at = png;
    shlight_history *history = (shlight_history *)malloc(sizeof *history);
    if (filtered && png && history) {
        memcpy(at, signature, sizeof signature);
        at += sizeof signature;
        shlight_put_32(at + 8, (uint32_t)width);
        shlight_put_32(at + 12, (uint32_t)height);
        memcpy(at + 16, "\x08\x02\0\0", 5); /* 8 bits, RGB, deflate, the five filters, not interlaced */
        at = shlight_close_chunk(at, "IHDR", at + 21);
        at[8] = 0; /* perceptual */
        at = shlight_close_chunk(at, "sRGB", at + 9);
        shlight_filter_rows(rgb, width, height, filtered);
        at = shlight_close_chunk(at, "IDAT", shlight_zlib(filtered, (int)raw, history, at + 8));
        at = shlight_close_chunk(at, "IEND", at + 8);
        *size = (size_t)(at - png);
    } else {
        free(png);
        png = NULL;
    }
    free(history);
    free(filtered);
    return png;
}

#endif /* SHLIGHT_PNG_H */
