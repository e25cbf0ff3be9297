/* shlight_draw.h - a canvas in linear light and what shlight draws on it: rectangles, texels, and text in a stroke font made for it.
 * All edges are covered exactly to a fraction of a texel and blended in linear light; the sRGB curve comes last. */
#ifndef SHLIGHT_DRAW_H
#define SHLIGHT_DRAW_H

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct shlight_canvas {
    float (*texel)[3]; /* linear, 1 is white */
    int width, height;
} shlight_canvas;

typedef struct shlight_colour {
    float rgb[3]; /* linear */
} shlight_colour;

/* IEC 61966-2-1, both ways. */
static float shlight_from_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static float shlight_to_srgb(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
}

/* The colour that style sheets write as #rrggbb. */
static shlight_colour shlight_hex(unsigned rrggbb) {
    shlight_colour colour;
    for (int k = 0; k < 3; k++)
        colour.rgb[k] = shlight_from_srgb((float)(rrggbb >> (16 - 8 * k) & 255u) / 255.0f);
    return colour;
}

/* From 0, black, to 1, pale yellow, with lightness rising evenly. Ten stops of "inferno" by van der Walt and Smith (matplotlib, CC0). */
static shlight_colour shlight_heat(float t) {
    static const unsigned stop[10] = { 0x000004, 0x1b0c41, 0x4a0c6b, 0x781c6d, 0xa52c60,
                                       0xcf4446, 0xed6925, 0xfb9b06, 0xf7d13d, 0xfcffa4 };
    const float at = 9.0f * (t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t);
    const int i = at < 8.0f ? (int)at : 8;
    const float f = at - (float)i;
    shlight_colour colour;
    for (int k = 0; k < 3; k++) {
        const float a = (float)(stop[i] >> (16 - 8 * k) & 255u), b = (float)(stop[i + 1] >> (16 - 8 * k) & 255u);
        colour.rgb[k] = shlight_from_srgb((a + f * (b - a)) / 255.0f);
    }
    return colour;
}

/* Lays colour over a texel by the fraction alpha, clamped; outside the canvas nothing happens. */
static void shlight_blend(shlight_canvas *canvas, int x, int y, shlight_colour colour, float alpha) {
    if (x < 0 || y < 0 || x >= canvas->width || y >= canvas->height || !(alpha > 0.0f))
        return;
    float *texel = canvas->texel[(size_t)y * (size_t)canvas->width + (size_t)x];
    const float a = alpha < 1.0f ? alpha : 1.0f;
    for (int k = 0; k < 3; k++)
        texel[k] += a * (colour.rgb[k] - texel[k]);
}

/* How much of texel (x, y) a rectangle from (0, 0) with rounded corners covers. */
static float shlight_rounded(int x, int y, int width, int height, float radius) {
    const float dx = fabsf((float)x + 0.5f - 0.5f * (float)width) - (0.5f * (float)width - radius);
    const float dy = fabsf((float)y + 0.5f - 0.5f * (float)height) - (0.5f * (float)height - radius);
    return dx > 0.0f && dy > 0.0f ? 0.5f + radius - sqrtf(dx * dx + dy * dy) : 1.0f;
}

static void shlight_rectangle(shlight_canvas *canvas, int left, int top, int width, int height, float radius,
                              shlight_colour colour) {
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            shlight_blend(canvas, left + x, top + y, colour, shlight_rounded(x, y, width, height, radius));
}

/* A ring: a circle of radius r and line width w about (cx, cy). */
static void shlight_ring(shlight_canvas *canvas, float cx, float cy, float r, float w, shlight_colour colour) {
    const int reach = (int)(r + w) + 2;
    for (int y = (int)cy - reach; y <= (int)cy + reach; y++)
        for (int x = (int)cx - reach; x <= (int)cx + reach; x++) {
            const float dx = (float)x + 0.5f - cx, dy = (float)y + 0.5f - cy;
            shlight_blend(canvas, x, y, colour, 0.5f + 0.5f * w - fabsf(sqrtf(dx * dx + dy * dy) - r));
        }
}

/* The canvas as bytes with the sRGB curve; rgb has 3 width height bytes. */
static void shlight_encode(const shlight_canvas *canvas, unsigned char *rgb) {
    const size_t texels = (size_t)canvas->width * (size_t)canvas->height;
    for (size_t i = 0; i < texels; i++)
        for (int k = 0; k < 3; k++) {
            const float v = canvas->texel[i][k] < 1.0f ? canvas->texel[i][k] : 1.0f;
            rgb[3 * i + (size_t)k] = (unsigned char)(255.0f * shlight_to_srgb(v > 0.0f ? v : 0.0f) + 0.5f);
        }
}

/* ---- Text -----------------------------------------------------------------------------------------------------------------------
 * A glyph is its pen strokes. A point is two hexadecimal digits, x from the left and y from below: 0 is the depth of a descender,
 * 3 the base line, 9 the height of x, b that of a capital. "mP" lifts the pen to P, "P" draws a line to it, "qCP" a parabola to P
 * with control point C. */
static const char *const shlight_glyphs[95] = {
    "",                                                    /* space */
    "m0b06m0303",                                          /* ! */
    "m0b09m2b29",                                          /* " */
    "m131bm333bm0545m0949",                                /* # */
    "m4aq3b2bq0b09q0727q4745q4323q1304m2c22",              /* $ */
    "m035bm1bq0b0aq0919q292aq2b1bm45q3534q3343q5354q5545", /* % */
    "m5308q0b1bq2b29q2716q0504q0313q4356",                 /* & */
    "m0b09",                                               /* ' */
    "m1cq0a07q0411",                                       /* ( */
    "m0cq1a17q1401",                                       /* ) */
    "m2b26m0a47m4a07",                                     /* * */
    "m0747m2925",                                          /* + */
    "m1301",                                               /* , */
    "m0737",                                               /* - */
    "m0303",                                               /* . */
    "m024c",                                               /* / */
    "m4549q4b2bq0b0905q0323q4345",                         /* 0 */
    "m193b33",                                             /* 1 */
    "m09q0b2bq4b49q4725q040343",                           /* 2 */
    "m09q0b2bq4b49q4727q4745q4323q0305",                   /* 3 */
    "m333b0545",                                           /* 4 */
    "m4b0b0828q484645q4323q0305",                          /* 5 */
    "m3bq090605q0323q434546q4828q0806",                    /* 6 */
    "m0b4b13",                                             /* 7 */
    "m27q0709q0b2bq4b49q4727q0705q0323q4345q4727",         /* 8 */
    "m13q454849q4b2bq0b0908q0626q4648",                    /* 9 */
    "m0303m0808",                                          /* : */
    "m1301m1818",                                          /* ; */
    "m3a0734",                                             /* < */
    "m0848m0545",                                          /* = */
    "m0a3704",                                             /* > */
    "m09q0b2bq4b49q472726m2323",                           /* ? */
    "m39q0b08q0526q3637m3936q4666q6a3aq0a07q0333",         /* @ */
    "m032b43m1636",                                        /* A */
    "m070b2bq4b49q4727070323q4345q4727",                   /* B */
    "m59q5b3b2bq0b0905q032333q5355",                       /* C */
    "m0b0323q535658q5b2b0b",                               /* D */
    "m4b0b0343m0737",                                      /* E */
    "m4b0b03m0737",                                        /* F */
    "m59q5b3b2bq0b0905q032333q53555737",                   /* G */
    "m0b03m5b53m0757",                                     /* H */
    "m0b03",                                               /* I */
    "m3b35q3313q0304",                                     /* J */
    "m0b03m4b06m1743",                                     /* K */
    "m0b0343",                                             /* L */
    "m030b366b63",                                         /* M */
    "m030b535b",                                           /* N */
    "m59q5b3b2bq0b0905q032333q535559",                     /* O */
    "m030b2bq4b49q472707",                                 /* P */
    "m59q5b3b2bq0b0905q032333q535559m3552",                /* Q */
    "m030b2bq4b49q472707m2743",                            /* R */
    "m4aq3b2bq0b09q0727q4745q4323q1304",                   /* S */
    "m0b4bm2b23",                                          /* T */
    "m0b05q0323q43454b",                                   /* U */
    "m0b234b",                                             /* V */
    "m0b133a536b",                                         /* W */
    "m0b43m034b",                                          /* X */
    "m0b274bm2723",                                        /* Y */
    "m0b4b0343",                                           /* Z */
    "m1c0c0111",                                           /* [ */
    "m0c42",                                               /* \ */
    "m0c1c1101",                                           /* ] */
    "m092b49",                                             /* ^ */
    "m0242",                                               /* _ */
    "m0c1a",                                               /* ` */
    "m4943m46q4929q0906q0323q4346",                        /* a */
    "m0b03m06q0929q4946q4323q0306",                        /* b */
    "m48q3929q0906q0323q3344",                             /* c */
    "m4b43m46q4929q0906q0323q4346",                        /* d */
    "m0646q4929q0906q0323q3344",                           /* e */
    "m1319q1b3bm0939",                                     /* f */
    "m4942q4020q1001m46q4929q0906q0323q4346",              /* g */
    "m0b03m06q0929q494643",                                /* h */
    "m0903m0b0b",                                          /* i */
    "m1912q1000m1b1b",                                     /* j */
    "m0b03m4905m1643",                                     /* k */
    "m0b04q0313",                                          /* l */
    "m0903m07q0929q393733m37q3959q696763",                 /* m */
    "m0903m06q0929q494643",                                /* n */
    "m46q4929q0906q0323q4346",                             /* o */
    "m0900m06q0929q4946q4323q0306",                        /* p */
    "m4940m46q4929q0906q0323q4346",                        /* q */
    "m0903m06q0939",                                       /* r */
    "m48q3929q0908q0626q4644q4323q1304",                   /* s */
    "m1b15q1333m0939",                                     /* t */
    "m0906q0323q4346m4943",                                /* u */
    "m092349",                                             /* v */
    "m0913385369",                                         /* w */
    "m0943m0349",                                          /* x */
    "m0923m4910",                                          /* y */
    "m09490343",                                           /* z */
    "m2cq1c19q1707q1715q1121",                             /* { */
    "m0c01",                                               /* | */
    "m0cq1c19q1727q1715q1101",                             /* } */
    "m06q0818q3648"                                        /* ~ */
};

enum { SHLIGHT_CURVE_LINES = 6, SHLIGHT_GLYPH_LINES = 80 };

/* A glyph's strokes as straight lines, in the units of its points, y upwards from the base line. */
typedef struct shlight_lines {
    float from[SHLIGHT_GLYPH_LINES][2], to[SHLIGHT_GLYPH_LINES][2];
    int count;
    float width;
} shlight_lines;

static int shlight_hex_digit(char c) {
    return c <= '9' ? c - '0' : c - 'a' + 10;
}

static void shlight_read_point(const char *text, float point[2]) {
    point[0] = (float)shlight_hex_digit(text[0]);
    point[1] = (float)(shlight_hex_digit(text[1]) - 3);
}

static void shlight_add_line(shlight_lines *lines, const float from[2], const float to[2]) {
    if (lines->count == SHLIGHT_GLYPH_LINES)
        return;
    memcpy(lines->from[lines->count], from, sizeof lines->from[0]);
    memcpy(lines->to[lines->count++], to, sizeof lines->to[0]);
    lines->width = fmaxf(lines->width, fmaxf(from[0], to[0]));
}

static void shlight_add_curve(shlight_lines *lines, const float from[2], const float control[2], const float to[2]) {
    float a[2] = { from[0], from[1] };
    for (int i = 1; i <= SHLIGHT_CURVE_LINES; i++) {
        const float t = (float)i / SHLIGHT_CURVE_LINES, u = 1.0f - t;
        float b[2];
        for (int axis = 0; axis < 2; axis++)
            b[axis] = u * u * from[axis] + 2.0f * t * u * control[axis] + t * t * to[axis];
        shlight_add_line(lines, a, b);
        memcpy(a, b, sizeof a);
    }
}

/* What has no glyph is a box. Digits are equally wide. */
static void shlight_glyph_lines(char c, shlight_lines *lines) {
    const char *text = c >= ' ' && c <= '~' ? shlight_glyphs[c - ' '] : "m030b4b4303";
    float pen[2] = { 0.0f, 0.0f };
    lines->count = 0;
    lines->width = 0.0f;
    while (*text) {
        float control[2] = { 0.0f, 0.0f }, point[2];
        const char command = *text;
        if (command == 'q')
            shlight_read_point(text + 1, control);
        text += command == 'q' ? 3 : command == 'm';
        shlight_read_point(text, point);
        text += 2;
        if (command == 'q')
            shlight_add_curve(lines, pen, control, point);
        else if (command != 'm')
            shlight_add_line(lines, pen, point);
        memcpy(pen, point, sizeof pen);
    }
    if (c == ' ')
        lines->width = 1.5f;
    if (c >= '0' && c <= '9')
        lines->width = 4.0f;
}

static float shlight_distance(const float p[2], const float a[2], const float b[2]) {
    const float ab[2] = { b[0] - a[0], b[1] - a[1] }, ap[2] = { p[0] - a[0], p[1] - a[1] };
    const float square = ab[0] * ab[0] + ab[1] * ab[1];
    float t = square > 0.0f ? (ap[0] * ab[0] + ap[1] * ab[1]) / square : 0.0f;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    const float dx = ap[0] - t * ab[0], dy = ap[1] - t * ab[1];
    return sqrtf(dx * dx + dy * dy);
}

/* Size of text: the height of capitals, in texels. Letters are a little wider than their grid. */
typedef struct shlight_font {
    float size, weight; /* weight: width of the pen over the size */
} shlight_font;

static const float shlight_letter_stretch = 1.12f, shlight_letter_gap = 2.3f;

static float shlight_text_width(shlight_font font, const char *text) {
    float width = -shlight_letter_gap;
    for (; *text; text++) {
        shlight_lines lines;
        shlight_glyph_lines(*text, &lines);
        width += lines.width * shlight_letter_stretch + shlight_letter_gap;
    }
    return width * font.size / 8.0f;
}

/* One glyph, its origin at (x, base). */
static void shlight_glyph(shlight_canvas *canvas, const shlight_lines *lines, float x, float base, shlight_font font,
                          shlight_colour colour) {
    const float unit = font.size / 8.0f, half = 0.5f * font.weight * font.size;
    const int left = (int)floorf(x - half) - 1, right = (int)ceilf(x + lines->width * shlight_letter_stretch * unit + half) + 1;
    for (int py = (int)floorf(base - 10.0f * unit); py <= (int)ceilf(base + 4.0f * unit); py++)
        for (int px = left; px <= right; px++) {
            const float p[2] = { ((float)px + 0.5f - x) / unit, (base - (float)py - 0.5f) / unit };
            float distance = 1e9f;
            for (int i = 0; i < lines->count; i++) {
                const float a[2] = { lines->from[i][0] * shlight_letter_stretch, lines->from[i][1] };
                const float b[2] = { lines->to[i][0] * shlight_letter_stretch, lines->to[i][1] };
                distance = fminf(distance, shlight_distance(p, a, b));
            }
            shlight_blend(canvas, px, py, colour, half - distance * unit + 0.5f);
        }
}

/* Writes text from x on its base line; returns where it ends. */
static float shlight_text(shlight_canvas *canvas, float x, float base, shlight_font font, shlight_colour colour, const char *text) {
    const float unit = font.size / 8.0f;
    for (; *text; text++) {
        shlight_lines lines;
        shlight_glyph_lines(*text, &lines);
        shlight_glyph(canvas, &lines, x, base, font, colour);
        x += (lines.width * shlight_letter_stretch + shlight_letter_gap) * unit;
    }
    return x - shlight_letter_gap * unit;
}

#endif /* SHLIGHT_DRAW_H */
