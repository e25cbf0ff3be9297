/* shlight_picture.h - the picture: a card for the panorama and its true irradiance, then one for each model with its error, then the
 * bounds. */
#ifndef SHLIGHT_PICTURE_H
#define SHLIGHT_PICTURE_H

#include "shlight_bounds.h"
#include "shlight_card.h"
#include "shlight_png.h"
#include "shlight_scene.h"

static const shlight_font font_title = { 19.0f, 0.13f };

/* A sphere seen from two opposite sides, its texels listed from the top left. */
typedef struct sphere {
    int count;
    int x[DISC], y[DISC];
    int mirror[DISC];  /* the texel as far from the bottom: seen from the back, its normal is the opposite */
    float cover[DISC]; /* less than 1 on the edge */
    float normal[2][DISC][3];
    float truth[2][DISC][3]; /* irradiance / pi by brute force */
    float front[3];          /* horizontal, towards who sees view 0 */
} sphere;

/* Looks at the front so that the light comes from 45 degrees to the left of the viewer, or from nowhere in particular. */
static void sphere_face_light(const scene *s, sphere *ball) {
    const float half = sqrtf(0.5f);
    float dir[3];
    scene_main_direction(s, dir);
    const float length = hypotf(dir[0], dir[1]), x = length > 1e-6f ? dir[0] / length : -1.0f;
    const float y = length > 1e-6f ? dir[1] / length : 0.0f;
    ball->front[0] = half * (x - y);
    ball->front[1] = half * (x + y);
    ball->front[2] = 0.0f;
}

/* The normal at (right, up) in the unit disc, on the side of view 0 or 1; outside it, that of the silhouette. */
static void sphere_normal(const sphere *ball, int view, float right, float up, float n[3]) {
    const float distance = sqrtf(right * right + up * up), shrink = distance > 1.0f ? 1.0f / distance : 1.0f;
    const float r = right * shrink, u = up * shrink, toward = sqrtf(fmaxf(0.0f, 1.0f - r * r - u * u));
    const float side = view == 0 ? 1.0f : -1.0f, fx = side * ball->front[0], fy = side * ball->front[1];
    n[0] = toward * fx - r * fy;
    n[1] = toward * fy + r * fx;
    n[2] = u;
}

static void sphere_init(const scene *s, sphere *ball) {
    int at[DISC]; /* each texel's place in the list */
    sphere_face_light(s, ball);
    ball->count = 0;
    for (int i = 0; i < DISC; i++) {
        const float right = ((float)(i % DIAMETER) + 0.5f) / RADIUS - 1.0f, up = 1.0f - ((float)(i / DIAMETER) + 0.5f) / RADIUS;
        const float cover = 0.5f + (1.0f - hypotf(right, up)) * RADIUS;
        if (cover <= 0.0f)
            continue;
        ball->x[ball->count] = i % DIAMETER;
        ball->y[ball->count] = i / DIAMETER;
        ball->cover[ball->count] = fminf(cover, 1.0f);
        for (int view = 0; view < 2; view++)
            sphere_normal(ball, view, right, up, ball->normal[view][ball->count]);
        at[i] = ball->count++;
    }
    for (int i = 0; i < ball->count; i++)
        ball->mirror[i] = at[(DIAMETER - 1 - ball->y[i]) * DIAMETER + ball->x[i]];
    for (int i = 0; i < ball->count; i++) {
        const float *n = ball->normal[0][i];
        shlight_irradiance(s->blocks, n, ball->truth[0][i]);
        shlight_irradiance_opposite(s->blocks, n, ball->truth[0][i], ball->truth[1][ball->mirror[i]]);
    }
}

/* What radiance or irradiance in units of the channels looks like. One exposure for the whole picture: the brightest irradiance is 0.8 in
 * linear light, and what is brighter bends smoothly towards 1. */
static shlight_colour expose(const scene *s, const float rgb[3]) {
    const float shown = 0.8f, gain = s->brightest > 0.0f ? shown / s->brightest : 1.0f;
    shlight_colour colour;
    for (int k = 0; k < 3; k++) {
        const int from = s->image.channels == 3 ? k : 0;
        const float v = gain * s->weight[from] * fmaxf(0.0f, rgb[from]);
        colour.rgb[k] = v < shown ? v : 1.0f - (1.0f - shown) * expf(-(v - shown) / (1.0f - shown));
    }
    return colour;
}

/* What an irradiance looks like; below zero in any channel it has a colour of its own. */
static shlight_colour paint_lit(const scene *s, const float *rgb) {
    for (int k = 0; k < s->image.channels; k++)
        if (rgb[k] < 0.0f)
            return shlight_hex(NEGATIVE);
    return expose(s, rgb);
}

static void draw_truth(shlight_canvas *canvas, const scene *s, const sphere *ball, int view, int left, int top) {
    for (int i = 0; i < ball->count; i++)
        shlight_blend(canvas, left + ball->x[i], top + ball->y[i], paint_lit(s, ball->truth[view][i]), ball->cover[i]);
}

/* A model's irradiance: four samples a texel, for the edge of what is below zero. */
static void draw_estimate(shlight_canvas *canvas, const scene *s, const sphere *ball, int view, const model *m,
                          const model_state *state, int left, int top) {
    for (int i = 0; i < ball->count; i++) {
        shlight_colour mean = { { 0.0f, 0.0f, 0.0f } };
        for (int sample = 0; sample < 4; sample++) {
            const float x = (float)ball->x[i] + (sample % 2 ? 0.75f : 0.25f), y = (float)ball->y[i] + (sample / 2 ? 0.75f : 0.25f);
            float n[3], rgb[3];
            sphere_normal(ball, view, x / RADIUS - 1.0f, 1.0f - y / RADIUS, n);
            for (int k = 0; k < s->image.channels; k++)
                rgb[k] = m->evaluate(&state[k], n);
            const shlight_colour colour = paint_lit(s, rgb);
            for (int k = 0; k < 3; k++)
                mean.rgb[k] += 0.25f * colour.rgb[k];
        }
        shlight_blend(canvas, left + ball->x[i], top + ball->y[i], mean, ball->cover[i]);
    }
}

/* The worst channel's error. The scale has the square root, to show both 0.01 and 1. */
static void draw_error(shlight_canvas *canvas, const scene *s, const sphere *ball, int view, const model *m,
                       const model_state *state, int left, int top) {
    for (int i = 0; i < ball->count; i++) {
        float worst = 0.0f;
        for (int k = 0; k < s->image.channels; k++) {
            const float estimate = m->evaluate(&state[k], ball->normal[view][i]);
            worst = fmaxf(worst, fabsf(estimate - ball->truth[view][i][k]));
        }
        shlight_blend(canvas, left + ball->x[i], top + ball->y[i], shlight_heat(sqrtf(worst)), ball->cover[i]);
    }
}

/* The texel of a PAIR wide thumbnail that shows a direction. */
static void thumbnail_position(const float dir[3], float *x, float *y) {
    const float pi = acosf(-1.0f), turn = -atan2f(dir[1], dir[0]) / (2.0f * pi);
    *x = (turn - floorf(turn)) * PAIR;
    *y = acosf(fmaxf(-1.0f, fminf(1.0f, dir[2]))) / pi * DIAMETER;
}

/* The panorama. -1: not enough memory. */
static int draw_thumbnail(shlight_canvas *canvas, const scene *s, int left, int top) {
    const size_t channels = (size_t)s->image.channels;
    float *texel = (float *)malloc(PAIR * DIAMETER * channels * sizeof *texel);
    const int failed = !texel || shlight_resample(&s->image, PAIR, DIAMETER, texel) != 0;
    for (int i = 0; !failed && i < PAIR * DIAMETER; i++) {
        float relative[3];
        for (size_t k = 0; k < channels; k++)
            relative[k] = (float)((double)texel[(size_t)i * channels + k] / s->unit[k]);
        shlight_blend(canvas, left + i % PAIR, top + i / PAIR, expose(s, relative),
                      shlight_rounded(i % PAIR, i / PAIR, PAIR, DIAMETER, 6.0f));
    }
    free(texel);
    return failed ? -1 : 0;
}

/* On the thumbnail: which sides of the spheres look where, and a ring at the average direction of the light. */
static void draw_directions(shlight_canvas *canvas, const scene *s, const sphere *ball, int left, int top) {
    static const char *const side[2] = { "front", "back" };
    const shlight_font outline = { font_text.size, 0.4f };
    float dir[3], x, y;
    for (int view = 0; view < 2; view++) {
        for (int axis = 0; axis < 3; axis++)
            dir[axis] = view == 0 ? ball->front[axis] : -ball->front[axis];
        const float half = 0.5f * shlight_text_width(font_text, side[view]) + 8.0f;
        thumbnail_position(dir, &x, &y);
        x = (float)left + fmaxf(half, fminf(x, PAIR - half));
        draw_centered(canvas, x, (float)(top + DIAMETER - 10), outline, PAGE, side[view]);
        draw_centered(canvas, x, (float)(top + DIAMETER - 10), font_text, BRIGHT, side[view]);
    }
    if (scene_main_direction(s, dir)) {
        thumbnail_position(dir, &x, &y);
        shlight_ring(canvas, (float)left + x, (float)top + y, 7.0f, 3.5f, shlight_hex(PAGE));
        shlight_ring(canvas, (float)left + x, (float)top + y, 7.0f, 1.5f, shlight_hex(BRIGHT));
    }
}

static void draw_model(shlight_canvas *canvas, const scene *s, const sphere *ball, const model *m, const model_error *e, int top) {
    const int text = MARGIN + PAD, count = SH_COUNT(m->order);
    model_state state[3];
    draw_card(canvas, top, CARD);
    draw_text(canvas, text, top + 48, font_name, BRIGHT, "%s", m->name);
    draw_text(canvas, text, top + 74, font_text, DIM, "%s", m->formula);
    draw_text(canvas, text, top + 94, font_text, DIM, "%d float%s a channel", count, count == 1 ? "" : "s");
    draw_text(canvas, text, top + 140, font_text, DIM, "RMS error");
    draw_text(canvas, text, top + 166, font_name, PLAIN, "%.4f", e->rms);
    draw_text(canvas, text + 110, top + 140, font_text, DIM, "max error");
    draw_text(canvas, text + 110, top + 166, font_name, PLAIN, "%.4f", e->max);
    for (int k = 0; k < s->image.channels; k++)
        scene_prepare(s, m, k, &state[k]);
    for (int view = 0; view < 2; view++) {
        draw_estimate(canvas, s, ball, view, m, state, LIT + view * (DIAMETER + GAP), top + PAD);
        draw_error(canvas, s, ball, view, m, state, HEAT + view * (DIAMETER + GAP), top + PAD);
    }
}

static void draw_captions(shlight_canvas *canvas, int base, int left, const char *what) {
    static const char *const side[2] = { "front", "back" };
    for (int view = 0; view < 2; view++) {
        char text[32];
        snprintf(text, sizeof text, "%s, %s", what, side[view]);
        draw_centered(canvas, (float)(left + view * (DIAMETER + GAP)) + 0.5f * DIAMETER, (float)base, font_text, DIM, text);
    }
}

/* The last part of a path, and of that only as much as fits beside the spheres. */
static void draw_file_name(shlight_canvas *canvas, const char *path, int x, int base) {
    char text[64];
    for (const char *c = path; *c; c++)
        if (*c == '/' || *c == '\\')
            path = c + 1;
    size_t length = strlen(path);
    const int cut = length > sizeof text - 4;
    length = cut ? sizeof text - 4 : length;
    memcpy(text, path, length); /* NOLINT(bugprone-not-null-terminated-result): the next line ends the string */
    memcpy(text + length, cut ? "..." : "\0\0\0", 4);
    while (length && shlight_text_width(font_text, text) > (float)(LIT - x - PAD))
        memcpy(text + --length, "...", 4);
    draw_text(canvas, x, base, font_text, DIM, "%s", text);
}

/* Title and first card: the truth, and the panorama that it comes from. -1: not enough memory. */
static int draw_reference(shlight_canvas *canvas, const scene *s, const sphere *ball) {
    static const char *const title[3] = { "What 1 coefficient keeps of the light", "What 1 and 4 coefficients keep of the light",
                                          "What 1, 4 and 9 coefficients keep of the light" };
    const int text = MARGIN + PAD, top = HEADER;
    draw_text(canvas, MARGIN, 54, font_title, BRIGHT, "%s", title[s->order]);
    shlight_text(canvas, (float)(WIDTH - MARGIN) - shlight_text_width(font_name, "shlight"), 54.0f, font_name, shlight_hex(DIM),
                 "shlight");
    draw_captions(canvas, top - 14, LIT, "irradiance");
    draw_centered(canvas, HEAT + 0.5f * PAIR, (float)(top - 14), font_text, DIM, "panorama");
    draw_card(canvas, top, CARD);
    draw_text(canvas, text, top + 48, font_name, BRIGHT, "Reference");
    draw_text(canvas, text, top + 74, font_text, DIM, "brute force over the texels");
    draw_file_name(canvas, s->name, text, top + 140);
    draw_text(canvas, text, top + 160, font_text, DIM, "%d x %d", s->image.width, s->image.height);
    for (int view = 0; view < 2; view++)
        draw_truth(canvas, s, ball, view, LIT + view * (DIAMETER + GAP), top + PAD);
    if (draw_thumbnail(canvas, s, HEAT, top + PAD) != 0)
        return -1;
    draw_directions(canvas, s, ball, HEAT, top + PAD);
    return 0;
}

/* The colour scale of errors, and what else needs a word. */
static void draw_legend(shlight_canvas *canvas, int top) {
    static const float tick[] = { 0.0f, 0.01f, 0.05f, 0.1f, 0.25f, 0.5f, 1.0f };
    static const char *const label[] = { "0", ".01", ".05", ".1", ".25", ".5", "1" };
    for (int x = 0; x < PAIR; x++)
        shlight_rectangle(canvas, HEAT + x, top, 1, 12, 0.0f, shlight_heat(((float)x + 0.5f) / PAIR));
    for (int i = 0; i < 7; i++)
        draw_centered(canvas, HEAT + sqrtf(tick[i]) * PAIR, (float)(top + 30), font_text, PLAIN, label[i]);
    draw_centered(canvas, HEAT + 0.5f * PAIR, (float)(top + 50), font_text, DIM, "error, relative to R0 of the channel");
    shlight_rectangle(canvas, LIT, top, 12, 12, 2.0f, shlight_hex(NEGATIVE));
    draw_text(canvas, LIT + 22, top + 11, font_text, DIM, "below zero");
}

/* Where the parts of the picture begin, from the top. */
typedef struct layout {
    int models, legend, bounds, height;
} layout;

static layout picture_layout(const scene *s) {
    const int reference_end = HEADER + CARD;
    layout at;
    at.models = reference_end + CAPTIONS;
    at.legend = at.models + s->model_count * (CARD + GAP) + 12;
    at.height = s->model_count ? at.legend - 12 + LEGEND : reference_end + MARGIN;
    at.bounds = (s->model_count ? at.height - 10 : reference_end) + CAPTIONS;
    if (s->show_bounds)
        at.height = at.bounds + s->order * (BOUNDS_CARD + GAP) - GAP + MARGIN;
    return at;
}

/* -1: not enough memory. */
static int draw_parts(shlight_canvas *canvas, const scene *s, const layout *at, sphere *ball) {
    sphere_init(s, ball);
    if (draw_reference(canvas, s, ball) != 0)
        return -1;
    if (s->model_count) {
        draw_captions(canvas, at->models - 14, LIT, "irradiance");
        draw_captions(canvas, at->models - 14, HEAT, "error");
        draw_legend(canvas, at->legend);
    }
    for (int i = 0; i < s->model_count; i++)
        draw_model(canvas, s, ball, s->models[i], &s->error[i], at->models + i * (CARD + GAP));
    if (s->show_bounds)
        draw_bounds(canvas, s, at->bounds);
    return 0;
}

/* The whole picture as PNG bytes; NULL: not enough memory. */
static unsigned char *draw_picture(const scene *s, size_t *size) {
    const layout at = picture_layout(s);
    unsigned char *png = NULL;
    shlight_canvas canvas = { NULL, WIDTH, at.height };
    const size_t texels = (size_t)canvas.width * (size_t)canvas.height;
    canvas.texel = (float(*)[3])malloc(texels * sizeof *canvas.texel);
    sphere *ball = (sphere *)malloc(sizeof *ball);
    unsigned char *rgb = (unsigned char *)malloc(3 * texels);
    if (canvas.texel && ball && rgb) {
        memset(canvas.texel, 0, texels * sizeof *canvas.texel);
        shlight_rectangle(&canvas, 0, 0, canvas.width, canvas.height, 0.0f, shlight_hex(PAGE));
        const int failed = draw_parts(&canvas, s, &at, ball);
        shlight_encode(&canvas, rgb);
        png = failed ? NULL : shlight_png(rgb, canvas.width, canvas.height, size);
    }
    free(rgb);
    free(ball);
    free(canvas.texel);
    return png;
}

#endif /* SHLIGHT_PICTURE_H */
