/* bench_bounds.h - what the coefficients prove, drawn for lights that show where closures are good and where they fail: for the normals of
 * a great circle, the true irradiance, the bounds, the linear reconstruction and the closure. */
#ifndef BENCH_BOUNDS_H
#define BENCH_BOUNDS_H

#include "bench_svg.h"

enum { BOUNDS_SUNS = 160, BOUNDS_STEPS = 120, BOUNDS_PANELS = 8, BOUNDS_COLUMNS = 4 };
enum { BOUNDS_WIDTH = 212, BOUNDS_HEIGHT = 150, BOUNDS_STEP_X = 236, BOUNDS_STEP_Y = 226, BOUNDS_LEFT = 44, BOUNDS_TOP = 96 };

/* Constant light and suns. The normals are in the plane of x and z; angle 0 is +z. */
typedef struct bounds_light {
    int count;
    double ambient, dir[BOUNDS_SUNS][3], value[BOUNDS_SUNS]; /* value: mean radiance over the sphere */
} bounds_light;

static inline void bounds_add(double x, double y, double z, double value, bounds_light *light) {
    const double dir[3] = { x, y, z };
    memcpy(light->dir[light->count], dir, sizeof dir);
    light->value[light->count++] = value;
}

/* Suns evenly over the zone of the sphere where z is in [from, to]. */
static inline void bounds_add_zone(double from, double to, double value, bounds_light *light) {
    const int count = 128;
    for (int i = 0; i < count; i++) {
        const double z = from + (to - from) * (i + 0.5) / count, s = sqrt(1.0 - z * z),
                     angle = 2.39996322972865332 * i; /* golden */
        bounds_add(s * cos(angle), s * sin(angle), z, value / count, light);
    }
}

static inline const char *bounds_make(int which, bounds_light *light) {
    memset(light, 0, sizeof *light);
    switch (which) {
    case 0:
        bounds_add(0, 0, 1, 1.0, light);
        return "One sun: the bounds close";
    case 1:
        light->ambient = 0.4;
        bounds_add(0, 0, 1, 0.6, light);
        return "A sun, and ambient light";
    case 2:
        bounds_add_zone(0.0, 1.0, 1.0, light);
        return "A hemisphere";
    case 3:
        bounds_add(-0.70710678, 0, 0.70710678, 0.5, light);
        bounds_add(0.70710678, 0, 0.70710678, 0.5, light);
        return "Two suns, 90 degrees apart";
    case 4:
        bounds_add(0, 0, 1, 0.5, light);
        bounds_add(0, 0, -1, 0.5, light);
        return "Opposite suns: ambient, to L1";
    case 5:
        bounds_add_zone(-0.02, 0.02, 1.0, light);
        return "A ring";
    case 6:
        for (int axis = 0; axis < 3; axis++)
            for (int sign = -1; sign <= 1; sign += 2)
                bounds_add(sign * (axis == 0), sign * (axis == 1), sign * (axis == 2), 1.0 / 6.0, light);
        return "Six suns: ambient, to all nine";
    default:
        light->ambient = 0.55;
        bounds_add(0, 0, 1, 0.75, light);
        bounds_add(0, 0, -1, -0.3, light);
        return "Not a light: partly negative";
    }
}

static inline double bounds_truth(const bounds_light *light, const float n[3]) {
    double sum = light->ambient;
    for (int i = 0; i < light->count; i++) {
        const double *d = light->dir[i], cosine = d[0] * (double)n[0] + d[1] * (double)n[1] + d[2] * (double)n[2];
        sum += cosine > 0.0 ? 4.0 * cosine * light->value[i] : 0.0;
    }
    return sum;
}

static inline void bounds_moments(const bounds_light *light, float c[9]) {
    memset(c, 0, 9 * sizeof *c);
    c[SH_R0] = (float)light->ambient;
    for (int i = 0; i < light->count; i++) {
        const float dir[3] = { (float)light->dir[i][0], (float)light->dir[i][1], (float)light->dir[i][2] };
        sh_add_sample(SH_L2, dir, (float)light->value[i], c);
    }
}

enum { BOUNDS_TRUTH, BOUNDS_LINEAR, BOUNDS_CLOSURE1, BOUNDS_CLOSURE2, BOUNDS_LOW1, BOUNDS_HIGH1, BOUNDS_LOW2, BOUNDS_HIGH2, BOUNDS_CURVES };

typedef double bounds_curve[BOUNDS_STEPS + 1];

static inline void bounds_evaluate(const bounds_light *light, bounds_curve curve[BOUNDS_CURVES]) {
    float c[9];
    bounds_moments(light, c);
    for (int i = 0; i <= BOUNDS_STEPS; i++) {
        const double angle = (2.0 * i / (int)BOUNDS_STEPS - 1.0) * 3.14159265358979324;
        const float n[3] = { (float)sin(angle), 0.0f, (float)cos(angle) };
        float lo[2], hi[2];
        for (int order = SH_L1; order <= SH_L2; order++)
            sh_irradiance_bounds(order, c, n, lo + order - 1, hi + order - 1);
        curve[BOUNDS_TRUTH][i] = bounds_truth(light, n);
        curve[BOUNDS_LINEAR][i] = (double)sh_irradiance(SH_L2, c, n);
        curve[BOUNDS_CLOSURE1][i] = (double)sh_irradiance_closure(SH_L1, c, n);
        curve[BOUNDS_CLOSURE2][i] = (double)sh_irradiance_closure(SH_L2, c, n);
        curve[BOUNDS_LOW1][i] = (double)lo[0];
        curve[BOUNDS_HIGH1][i] = (double)hi[0];
        curve[BOUNDS_LOW2][i] = (double)lo[1];
        curve[BOUNDS_HIGH2][i] = (double)hi[1];
    }
}

/* ---- Drawing: in a panel, irradiance from -0.6 to 4.2 -------------------------------------------------------------------------- */

static inline double bounds_y(double value) {
    return BOUNDS_HEIGHT * (4.2 - value) / 4.8;
}

/* The points of a curve, forwards or backwards. */
static inline void bounds_points(FILE *file, const bounds_curve curve, int backwards) {
    for (int i = 0; i <= BOUNDS_STEPS; i++) {
        const int at = backwards ? BOUNDS_STEPS - i : i;
        fprintf(file, "%.1f,%.1f ", (double)at * BOUNDS_WIDTH / BOUNDS_STEPS, bounds_y(curve[at]));
    }
}

static inline void bounds_band(FILE *file, const bounds_curve low, const bounds_curve high, const char *colour) {
    fputs("<polygon points=\"", file);
    bounds_points(file, low, 0);
    bounds_points(file, high, 1);
    fprintf(file, "\" fill=\"%s\"/>\n", colour);
}

static inline void bounds_line(FILE *file, const bounds_curve curve, const char *style) {
    fputs("<polyline points=\"", file);
    bounds_points(file, curve, 0);
    fprintf(file, "\" fill=\"none\" %s/>\n", style);
}

static const char *const bounds_colour[2] = { "#e8eaee", "#bcc3cf" };
static const char *const bounds_style[4] = { "stroke=\"#111111\" stroke-width=\"1.6\"", "stroke=\"#2563eb\" stroke-width=\"1.4\"",
                                             "stroke=\"#15803d\" stroke-width=\"1.3\" stroke-dasharray=\"2 2\"",
                                             "stroke=\"#ea6a0a\" stroke-width=\"1.8\" stroke-dasharray=\"5 2\"" };

static inline void bounds_panel(FILE *file, int which) {
    static const char *const angle[3] = { "-180", "0", "180" };
    bounds_light light;
    bounds_curve curve[BOUNDS_CURVES];
    const char *name = bounds_make(which, &light);
    bounds_evaluate(&light, curve);
    fprintf(file, "<g transform=\"translate(%d %d)\">\n", BOUNDS_LEFT + which % BOUNDS_COLUMNS * BOUNDS_STEP_X,
            BOUNDS_TOP + which / BOUNDS_COLUMNS * BOUNDS_STEP_Y);
    svg_text(file, 0, -10, "font-size=\"13\"", name);
    bounds_band(file, curve[BOUNDS_LOW1], curve[BOUNDS_HIGH1], bounds_colour[0]);
    bounds_band(file, curve[BOUNDS_LOW2], curve[BOUNDS_HIGH2], bounds_colour[1]);
    for (int i = 0; i <= 4; i++) {
        char text[8];
        snprintf(text, sizeof text, "%d", i);
        svg_line(file, 0, bounds_y(i), BOUNDS_WIDTH, bounds_y(i),
                 i ? "stroke=\"#000000\" stroke-opacity=\"0.07\"" : "stroke=\"#888888\"");
        svg_text(file, -6, bounds_y(i) + 4, "text-anchor=\"end\" fill=\"#555555\"", text);
    }
    for (int i = 0; i < 3; i++)
        svg_text(file, 0.5 * i * BOUNDS_WIDTH, BOUNDS_HEIGHT + 14,
                 i == 0   ? "fill=\"#555555\""
                 : i == 1 ? "text-anchor=\"middle\" fill=\"#555555\""
                          : "text-anchor=\"end\" fill=\"#555555\"",
                 angle[i]);
    bounds_line(file, curve[BOUNDS_LINEAR], bounds_style[1]);
    bounds_line(file, curve[BOUNDS_TRUTH], bounds_style[0]);
    bounds_line(file, curve[BOUNDS_CLOSURE1], bounds_style[2]);
    bounds_line(file, curve[BOUNDS_CLOSURE2], bounds_style[3]);
    fputs("</g>\n", file);
}

/* One line of the legend, a line or a patch, at x; its text ends about 7 units a letter later. */
static inline void bounds_key(FILE *file, double x, const char *patch, const char *style, const char *text) {
    if (patch)
        fprintf(file, "<rect x=\"%.0f\" y=\"40\" width=\"24\" height=\"13\" fill=\"%s\"/>\n", x, patch);
    else
        svg_line(file, x, 47, x + 24, 47, style);
    svg_text(file, x + 31, 51, "font-size=\"13\"", text);
}

static inline void bench_bounds(FILE *file) {
    const int width = BOUNDS_LEFT + BOUNDS_COLUMNS * BOUNDS_STEP_X, rows = BOUNDS_PANELS / BOUNDS_COLUMNS;
    const int height = BOUNDS_TOP + rows * BOUNDS_STEP_Y - 28;
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, sans-serif\" "
            "font-size=\"11\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            width, height);
    svg_text(file, BOUNDS_LEFT, 26, "font-size=\"17\" font-weight=\"bold\"",
             "What the coefficients prove: irradiance / pi around a light of mean radiance 1");
    bounds_key(file, BOUNDS_LEFT, NULL, bounds_style[0], "true irradiance");
    bounds_key(file, BOUNDS_LEFT + 160, bounds_colour[0], "", "L1 bounds");
    bounds_key(file, BOUNDS_LEFT + 285, bounds_colour[1], "", "L2 bounds");
    bounds_key(file, BOUNDS_LEFT + 410, NULL, bounds_style[1], "L2 linear");
    bounds_key(file, BOUNDS_LEFT + 525, NULL, bounds_style[2], "L1 closure");
    bounds_key(file, BOUNDS_LEFT + 645, NULL, bounds_style[3], "L2 closure");
    for (int i = 0; i < BOUNDS_PANELS; i++)
        bounds_panel(file, i);
    svg_text(file, BOUNDS_LEFT + 0.5 * (width - BOUNDS_LEFT), height - 10,
             "text-anchor=\"middle\" font-size=\"12\" fill=\"#555555\"",
             "angle of the normal, in degrees; 0 faces the light, or its axis");
    fputs("</svg>\n", file);
}

#endif /* BENCH_BOUNDS_H */
