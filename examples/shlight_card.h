/* shlight_card.h - what the parts of the picture have in common: the layout, the palette, cards and text on them. */
#ifndef SHLIGHT_CARD_H
#define SHLIGHT_CARD_H

#include <stdarg.h>
#include <stdio.h>

#include "shlight_draw.h"

enum {
    RADIUS = 84,                 /* of a sphere */
    DIAMETER = 2 * RADIUS,       /* of a sphere */
    DISC = DIAMETER * DIAMETER,  /* texels of a sphere, at most */
    MARGIN = 36,                 /* around everything */
    PAD = 22,                    /* around what a card holds */
    GAP = 16,                    /* between the spheres of a pair, and between cards */
    PAIR = 2 * DIAMETER + GAP,   /* a front and a back */
    LIT = MARGIN + PAD + 250,    /* left edges: lit spheres, */
    HEAT = LIT + PAIR + 3 * GAP, /* errors */
    WIDTH = HEAT + PAIR + PAD + MARGIN,
    CARD = DIAMETER + 2 * PAD, /* height of a row */
    HEADER = 104,
    CAPTIONS = 40,
    LEGEND = 84
};

static const shlight_font font_name = { 14.0f, 0.13f }, font_text = { 9.5f, 0.13f };

/* Palette, sRGB. */
enum { PAGE = 0x131416, CARD_COLOUR = 0x1d1f22, BRIGHT = 0xf2f2f0, PLAIN = 0xb9bcc2, DIM = 0x80848c, NEGATIVE = 0x4b5fd0 };

static void draw_card(shlight_canvas *canvas, int top, int height) {
    shlight_rectangle(canvas, MARGIN, top, WIDTH - 2 * MARGIN, height, 10.0f, shlight_hex(CARD_COLOUR));
}

/* Writes formatted text; returns where it ends. */
static float draw_text(shlight_canvas *canvas, int x, int base, shlight_font font, unsigned colour, const char *format, ...) {
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return shlight_text(canvas, (float)x, (float)base, font, shlight_hex(colour), text);
}

static void draw_centered(shlight_canvas *canvas, float x, float base, shlight_font font, unsigned colour, const char *text) {
    shlight_text(canvas, x - 0.5f * shlight_text_width(font, text), base, font, shlight_hex(colour), text);
}

#endif /* SHLIGHT_CARD_H */
