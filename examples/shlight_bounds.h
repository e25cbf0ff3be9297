/* shlight_bounds.h - what the coefficients prove: a card for each order shows, along a great circle of normals through the light, the true
 * irradiance, two reconstructions, and the band that sh_irradiance_bounds says the truth must lie in. All channels are summed to their
 * luminance, which is a light like any other: its moments are the same sum. */
#ifndef SHLIGHT_BOUNDS_H
#define SHLIGHT_BOUNDS_H

#include "shlight_card.h"
#include "shlight_scene.h"

enum {
    PLOT_LEFT = LIT + 26, /* of the plot; the numbers of its axis are left of it */
    PLOT_WIDTH = HEAT + PAIR - PLOT_LEFT,
    PLOT_HEIGHT = 232,
    BOUNDS_CARD = PLOT_HEIGHT + 2 * PAD + 40
};

enum { BAND_COLOUR = 0x5a6270, GRID_COLOUR = 0x34373c, LINEAR_COLOUR = 0x8b9cff, CLOSURE_COLOUR = 0xfb9b06 };

enum { CURVE_TRUTH, CURVE_LINEAR, CURVE_CLOSURE, CURVE_LOW, CURVE_HIGH, CURVES };

/* Irradiance over R0 of the luminance, for the normal of each column of the plot. */
typedef struct bounds_curves {
    float value[CURVES][PLOT_WIDTH];
} bounds_curves;

/* How much of each channel, in its unit, is in a luminance whose R0 is 1: ITU-R BT.709; of a single channel, all. */
static void bounds_luminance(const scene *s, float share[3]) {
    static const float luminance[3] = { 0.2126f, 0.7152f, 0.0722f };
    const int channels = s->image.channels;
    float total = 0.0f;
    for (int k = 0; k < channels; k++) {
        share[k] = s->weight[k] * (channels == 3 ? luminance[k] : 1.0f);
        total += share[k];
    }
    for (int k = 0; k < channels; k++)
        share[k] = total > 0.0f ? share[k] / total : 0.0f;
}

/* The normal of a column: from -180 to 180 degrees from the average direction of the light, first over the zenith. */
static void bounds_normal(const scene *s, int column, float n[3]) {
    const float angle = acosf(-1.0f) * (2.0f * ((float)column + 0.5f) / PLOT_WIDTH - 1.0f);
    float dir[3], over[3] = { 0.0f, 0.0f, 1.0f };
    if (!scene_main_direction(s, dir))
        dir[0] = 1.0f;
    if (fabsf(dir[2]) > 0.999f) {
        over[0] = 1.0f;
        over[2] = 0.0f;
    }
    const float along = shlight_dot(over, dir);
    for (int axis = 0; axis < 3; axis++)
        over[axis] -= along * dir[axis];
    const float length = sqrtf(shlight_dot(over, over));
    for (int axis = 0; axis < 3; axis++)
        n[axis] = cosf(angle) * dir[axis] + sinf(angle) / length * over[axis];
}

static void bounds_trace(const scene *s, int order, bounds_curves *curves) {
    float share[3], c[SH_COUNT(SH_L2)] = { 0.0f }, n[3], truth[3];
    bounds_luminance(s, share);
    for (int k = 0; k < s->image.channels; k++)
        sh_madd(order, s->relative + k * SH_COUNT(s->order), share[k], c);
    for (int i = 0; i < PLOT_WIDTH; i++) {
        bounds_normal(s, i, n);
        shlight_irradiance(s->blocks, n, truth);
        curves->value[CURVE_TRUTH][i] = 0.0f;
        for (int k = 0; k < s->image.channels; k++)
            curves->value[CURVE_TRUTH][i] += share[k] * truth[k];
        curves->value[CURVE_LINEAR][i] = sh_irradiance(order, c, n);
        curves->value[CURVE_CLOSURE][i] = sh_irradiance_closure(order, c, n);
        sh_irradiance_bounds(order, c, n, &curves->value[CURVE_LOW][i], &curves->value[CURVE_HIGH][i]);
    }
}

/* The irradiance at the plot's edges, the same for all orders. */
typedef struct bounds_range {
    float low, high;
} bounds_range;

static void bounds_enclose(const bounds_curves *curves, bounds_range *range) {
    for (int which = 0; which < CURVES; which++)
        for (int i = 0; i < PLOT_WIDTH; i++) {
            range->low = fminf(range->low, 1.06f * curves->value[which][i]);
            range->high = fmaxf(range->high, 1.06f * curves->value[which][i]);
        }
}

static float bounds_y(const bounds_range *range, float value) {
    return (range->high - value) / (range->high - range->low) * PLOT_HEIGHT;
}

/* Fills the plot between two curves; the edges are covered exactly. */
static void bounds_fill(shlight_canvas *canvas, const bounds_range *range, const float *low, const float *high, int top,
                        unsigned colour, float alpha) {
    for (int i = 0; i < PLOT_WIDTH; i++) {
        const float upper = bounds_y(range, high[i]), lower = bounds_y(range, low[i]);
        for (int y = 0; y < PLOT_HEIGHT; y++) {
            const float cover = fminf(lower, (float)y + 1.0f) - fmaxf(upper, (float)y);
            shlight_blend(canvas, PLOT_LEFT + i, top + y, shlight_hex(colour), alpha * cover);
        }
    }
}

/* A line of a width along a curve, by each texel's distance from the tangent at its column. */
static void bounds_line(shlight_canvas *canvas, const bounds_range *range, const float *curve, int top, float width,
                        unsigned colour) {
    for (int i = 0; i < PLOT_WIDTH; i++) {
        const float y = bounds_y(range, curve[i]), before = bounds_y(range, curve[i > 0 ? i - 1 : i]);
        const float after = bounds_y(range, curve[i + 1 < PLOT_WIDTH ? i + 1 : i]), slope = 0.5f * (after - before);
        const float stretch = sqrtf(1.0f + slope * slope), reach = (0.5f * width + 1.0f) * stretch;
        for (int row = (int)(y - reach) - 1; row <= (int)(y + reach) + 1; row++)
            if (row >= 0 && row < PLOT_HEIGHT)
                shlight_blend(canvas, PLOT_LEFT + i, top + row, shlight_hex(colour),
                              0.5f + 0.5f * width - fabsf((float)row + 0.5f - y) / stretch);
    }
}

/* Lines at round values of irradiance and at quarter turns, with their numbers. */
static void bounds_grid(shlight_canvas *canvas, const bounds_range *range, int top) {
    static const char *const angle[5] = { "-180, facing away", "-90", "0, facing the light", "90", "180, facing away" };
    const float step = range->high - range->low > 2.5f ? 1.0f : 0.5f;
    for (int i = 0; (float)i * step <= range->high; i++) {
        const int y = top + (int)bounds_y(range, (float)i * step);
        char text[16];
        snprintf(text, sizeof text, "%g", (double)((float)i * step));
        shlight_rectangle(canvas, PLOT_LEFT, y, PLOT_WIDTH, 1, 0.0f, shlight_hex(i ? GRID_COLOUR : DIM));
        shlight_text(canvas, PLOT_LEFT - 10.0f - shlight_text_width(font_text, text), (float)y + 5.0f, font_text,
                     shlight_hex(PLAIN), text);
    }
    for (int i = 0; i < 5; i++) {
        const float x = PLOT_LEFT + 0.25f * (float)i * PLOT_WIDTH, width = shlight_text_width(font_text, angle[i]);
        const float left = i == 0 ? x : i == 4 ? x - width : x - 0.5f * width;
        shlight_rectangle(canvas, (int)x - (i == 4), top, 1, PLOT_HEIGHT, 0.0f, shlight_hex(GRID_COLOUR));
        shlight_text(canvas, left, (float)(top + PLOT_HEIGHT + 20), font_text, shlight_hex(PLAIN), angle[i]);
    }
    draw_centered(canvas, PLOT_LEFT + 0.5f * PLOT_WIDTH, (float)(top + PLOT_HEIGHT + 42), font_text, DIM,
                  "degrees between the normal and the average direction of the light, positive over the zenith");
}

/* One line of the legend: a piece of the curve, and its name. */
static void bounds_key(shlight_canvas *canvas, int base, unsigned colour, int height, const char *format, int order) {
    shlight_rectangle(canvas, MARGIN + PAD, base - 4 - height / 2, 24, height, 0.0f, shlight_hex(colour));
    draw_text(canvas, MARGIN + PAD + 36, base, font_text, PLAIN, format, order);
}

static void bounds_draw(shlight_canvas *canvas, const scene *s, int order, const bounds_curves *curves, const bounds_range *range,
                        int top) {
    const int text = MARGIN + PAD, plot = top + PAD;
    float zero[PLOT_WIDTH] = { 0.0f }, below[PLOT_WIDTH];
    for (int i = 0; i < PLOT_WIDTH; i++)
        below[i] = fminf(0.0f, curves->value[CURVE_LINEAR][i]);
    draw_card(canvas, top, BOUNDS_CARD);
    draw_text(canvas, text, top + 48, font_name, BRIGHT, "L%d bounds", order);
    draw_text(canvas, text, top + 74, font_text, DIM, "what %d floats prove, if no", SH_COUNT(order));
    draw_text(canvas, text, top + 94, font_text, DIM, "light is negative");
    bounds_key(canvas, top + 132, BAND_COLOUR, 12, "within the bounds", order);
    bounds_key(canvas, top + 154, BRIGHT, 3, "brute force", order);
    bounds_key(canvas, top + 176, CLOSURE_COLOUR, 3, "L%d closure", order);
    bounds_key(canvas, top + 198, LINEAR_COLOUR, 3, "L%d linear", order);
    draw_text(canvas, text, top + 240, font_text, DIM, "mean width");
    draw_text(canvas, text, top + 266, font_name, PLAIN, "%.4f", s->bounds[order].width);
    draw_text(canvas, text + 110, top + 240, font_text, DIM, "truth beyond");
    draw_text(canvas, text + 110, top + 266, font_name, PLAIN, "%.4f", s->bounds[order].beyond);
    bounds_grid(canvas, range, plot);
    bounds_fill(canvas, range, curves->value[CURVE_LOW], curves->value[CURVE_HIGH], plot, BAND_COLOUR, 0.6f);
    bounds_fill(canvas, range, below, zero, plot, NEGATIVE, 0.8f);
    bounds_line(canvas, range, curves->value[CURVE_LINEAR], plot, 2.0f, LINEAR_COLOUR);
    bounds_line(canvas, range, curves->value[CURVE_CLOSURE], plot, 2.4f, CLOSURE_COLOUR);
    bounds_line(canvas, range, curves->value[CURVE_TRUTH], plot, 2.0f, BRIGHT);
}

/* A card for L1 and, at that order, L2, from `top` downwards. */
static void draw_bounds(shlight_canvas *canvas, const scene *s, int top) {
    static bounds_curves curves[3];
    bounds_range range = { 0.0f, 1.0f };
    draw_centered(canvas, PLOT_LEFT + 0.5f * PLOT_WIDTH, (float)(top - 14), font_text, DIM,
                  "irradiance of the luminance, relative to R0");
    for (int order = SH_L1; order <= s->order; order++) {
        bounds_trace(s, order, &curves[order]);
        bounds_enclose(&curves[order], &range);
    }
    for (int order = SH_L1; order <= s->order; order++, top += BOUNDS_CARD + GAP)
        bounds_draw(canvas, s, order, &curves[order], &range, top);
}

#endif /* SHLIGHT_BOUNDS_H */
