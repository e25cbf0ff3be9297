/* bench_svg.h - run time against error, log-log: a filled point per case, and its baseline as a hollow point at the end of a thin
 * line. Points are labelled directly, in the colour of their family. */
#ifndef BENCH_SVG_H
#define BENCH_SVG_H

#include "bench_report.h"

enum { SVG_WIDTH = 1500, SVG_HEIGHT = 1000, SVG_LEFT = 80, SVG_RIGHT = 30, SVG_TOP = 84, SVG_BOTTOM = 64, SVG_FONT = 11 };

typedef struct svg_box {
    double x, y, width, height;
} svg_box;

/* Logarithmic axes; an error of 0 has a line of its own below the smallest decade. */
typedef struct svg_axes {
    int x0, x1, y0, y1; /* decades */
} svg_axes;

typedef struct svg_points {
    FILE *file;
    svg_axes axes;
    svg_box *taken; /* by points, baselines and labels */
    int taken_count;
} svg_points;

static inline double svg_x(const svg_axes *axes, double ns) {
    return SVG_LEFT + (log10(ns) - axes->x0) / (axes->x1 - axes->x0) * (SVG_WIDTH - SVG_LEFT - SVG_RIGHT);
}

/* NaN and infinity are at the top. */
static inline double svg_y(const svg_axes *axes, double error) {
    const double finite = error - error == 0 ? error : pow(10.0, axes->y1), lowest = axes->y0 - 1;
    const double decade = finite > 0 ? log10(finite) : axes->y0 - 0.5;
    return SVG_HEIGHT - SVG_BOTTOM - (decade - lowest) / (axes->y1 - lowest) * (SVG_HEIGHT - SVG_TOP - SVG_BOTTOM);
}

static inline void svg_include(double value, int *low, int *high) {
    if (!(value > 0) || value - value != 0)
        return;
    const int floor_decade = (int)floor(log10(value));
    *low = floor_decade < *low ? floor_decade : *low;
    *high = floor_decade + 1 > *high ? floor_decade + 1 : *high;
}

static inline svg_axes svg_find_axes(const bench_result *results, int count) {
    svg_axes axes = { 1000, -1000, 1000, -1000 };
    for (int i = 0; i < count; i++) {
        svg_include(results[i].ns, &axes.x0, &axes.x1);
        svg_include(results[i].baseline_ns, &axes.x0, &axes.x1);
        svg_include(results[i].error, &axes.y0, &axes.y1);
        svg_include(results[i].baseline_error, &axes.y0, &axes.y1);
    }
    if (axes.y0 > axes.y1) {
        axes.y0 = -8;
        axes.y1 = -5;
    }
    return axes;
}

/* ---- Text -------------------------------------------------------------------------------------------------------------------- */

static inline void svg_escaped(FILE *file, const char *text) {
    for (; *text; text++)
        switch (*text) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        default: fputc(*text >= 0x20 && *text < 0x7f ? *text : '?', file); break;
        }
}

static inline void svg_text(FILE *file, double x, double y, const char *attributes, const char *text) {
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    svg_escaped(file, text);
    fputs("</text>\n", file);
}

/* "irradiance L2 soa 1024" of "eval/irradiance/L2/rgb/soa/1024": without the topic, where there is more than that, and without what
 * nearly all have in common. */
static inline void svg_label(const char *name, char *label, size_t size) {
    const char *from =
        name[bench_family_length(name)] && strchr(name, '/') < name + bench_family_length(name) ? strchr(name, '/') + 1 : name;
    size_t n = 0;
    for (; *from && n + 1 < size; from++) {
        if (strncmp(from, "/rgb", 4) == 0 && (from[4] == '/' || from[4] == '\0'))
            from += 4;
        if (!*from)
            break;
        label[n++] = (char)(*from == '/' ? ' ' : *from);
    }
    label[n] = '\0';
}

/* Palette that stays apart for most kinds of colour vision, dark enough for text on white. */
static inline const char *svg_colour(int family) {
    static const char *const colours[] = { "#0b62a4", "#c2410c", "#0f766e", "#9d174d", "#4d7c0f", "#6d28d9", "#92400e", "#334155" };
    return colours[family % (int)(sizeof colours / sizeof colours[0])];
}

/* ---- Axes -------------------------------------------------------------------------------------------------------------------- */

static inline void svg_line(FILE *file, double x0, double y0, double x1, double y1, const char *attributes) {
    fprintf(file, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x0, y0, x1, y1, attributes);
}

static inline void svg_draw_times(FILE *file, const svg_axes *axes) {
    const double bottom = SVG_HEIGHT - SVG_BOTTOM;
    for (int decade = axes->x0; decade <= axes->x1; decade++)
        for (int digit = 1; digit < (decade < axes->x1 ? 10 : 2); digit++) {
            const double ns = digit * pow(10.0, decade), x = svg_x(axes, ns);
            char text[32];
            svg_line(file, x, SVG_TOP, x, bottom, digit == 1 ? "stroke=\"#d0d0d0\"" : "stroke=\"#f0f0f0\"");
            snprintf(text, sizeof text, digit == 1 ? "%.*f ns" : "%.*f", decade < 0 ? -decade : 0, ns);
            if (digit == 1 || digit == 2 || digit == 5)
                svg_text(file, x, bottom + 18, digit == 1 ? "text-anchor=\"middle\"" : "text-anchor=\"middle\" fill=\"#888888\"",
                         text);
        }
    svg_text(file, (SVG_LEFT + SVG_WIDTH - SVG_RIGHT) / 2, bottom + 44, "text-anchor=\"middle\" font-size=\"14\"",
             "run time per item (direction, sample or texel)");
}

static inline void svg_draw_errors(FILE *file, const svg_axes *axes) {
    const double right = SVG_WIDTH - SVG_RIGHT, exact = svg_y(axes, 0.0);
    for (int decade = axes->y0; decade <= axes->y1; decade++) {
        const double y = svg_y(axes, pow(10.0, decade));
        char text[32];
        svg_line(file, SVG_LEFT, y, right, y, "stroke=\"#d0d0d0\"");
        snprintf(text, sizeof text, "1e%d", decade);
        svg_text(file, SVG_LEFT - 8, y + 4, "text-anchor=\"end\"", text);
    }
    svg_line(file, SVG_LEFT, exact, right, exact, "stroke=\"#d0d0d0\" stroke-dasharray=\"2 4\"");
    svg_text(file, SVG_LEFT - 8, exact + 4, "text-anchor=\"end\"", "exact");
    fprintf(file, "<g transform=\"translate(22 %d) rotate(-90)\">", (SVG_TOP + SVG_HEIGHT - SVG_BOTTOM) / 2);
    svg_text(file, 0, 0, "text-anchor=\"middle\" font-size=\"14\"", "largest error, of the mean radiance");
    fputs("</g>\n", file);
}

static inline void svg_draw_title(FILE *file, const bench_machine *machine) {
    char text[512];
    svg_text(file, SVG_LEFT, 30, "font-size=\"20\" font-weight=\"bold\"", "sh.h: run time against error");
    snprintf(text, sizeof text, "%s, %s %s, %s. One thread.", machine->cpu, machine->compiler, machine->flags, machine->simd);
    svg_text(file, SVG_LEFT, 50, "font-size=\"13\" fill=\"#555555\"", text);
    svg_text(file, SVG_LEFT, 68, "font-size=\"13\" fill=\"#555555\"",
             "Filled: sh.h. Hollow, at the other end of the line: the same work as engines write it today. Left is faster, down is "
             "more accurate.");
}

/* ---- Points and labels ------------------------------------------------------------------------------------------------------- */

static inline int svg_boxes_meet(const svg_box *a, const svg_box *b) {
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height && b->y < a->y + a->height;
}

static inline int svg_is_free(const svg_points *points, const svg_box *box) {
    if (box->x < SVG_LEFT || box->x + box->width > SVG_WIDTH - 2 || box->y < SVG_TOP ||
        box->y + box->height > SVG_HEIGHT - SVG_BOTTOM)
        return 0;
    for (int i = 0; i < points->taken_count; i++)
        if (svg_boxes_meet(box, &points->taken[i]))
            return 0;
    return 1;
}

static inline void svg_take(svg_points *points, double x, double y, double width, double height) {
    const svg_box box = { x, y, width, height };
    points->taken[points->taken_count++] = box;
}

/* The free place for a label nearest to a point: on growing rings, to the right first. Over everything if nothing is free. */
static inline svg_box svg_place(const svg_points *points, double x, double y, double width, double height) {
    enum { DIRECTIONS = 32, RINGS = 80 };
    for (int ring = 0; ring < RINGS; ring++)
        for (int i = 0; i < DIRECTIONS; i++) {
            const double radius = 8.0 + 5.0 * ring, angle = (i % 2 ? 1 : -1) * ((i + 1) / 2) * 2.0 * 3.14159265358979 / DIRECTIONS;
            const double c = cos(angle), s = sin(angle), to_x = x + radius * c, to_y = y + radius * s;
            /* The label's nearest edge is at the ring: its left edge to the right of the point, its middle above and below. */
            const svg_box box = { to_x - width * (1.0 - c) / 2, to_y - height * (1.0 - s) / 2, width, height };
            if (svg_is_free(points, &box))
                return box;
        }
    const svg_box box = { x + 8, y - height / 2, width, height };
    return box;
}

static inline double svg_clamp(double x, double low, double high) {
    return x < low ? low : x > high ? high : x;
}

/* Writes a label near a point, with a line to it where it is not next to it. The white outline keeps it readable on lines. */
static inline void svg_draw_label(svg_points *points, double x, double y, const char *label, const char *style,
                                  const char *colour) {
    const svg_box box = svg_place(points, x, y, 0.56 * SVG_FONT * (double)strlen(label) + 4, SVG_FONT + 2);
    const double near_x = svg_clamp(x, box.x, box.x + box.width), near_y = svg_clamp(y, box.y, box.y + box.height);
    char attributes[256];
    if (hypot(near_x - x, near_y - y) > 12.0) {
        snprintf(attributes, sizeof attributes, "stroke=\"%s\" stroke-width=\"0.7\"", colour);
        svg_line(points->file, x, y, near_x, near_y, attributes);
    }
    snprintf(attributes, sizeof attributes, "fill=\"%s\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\" %s", colour,
             style);
    svg_text(points->file, box.x + 2, box.y + box.height - 3, attributes, label);
    svg_take(points, box.x, box.y, box.width, box.height);
}

static inline void svg_draw_pair(svg_points *points, const bench_result *result, const char *colour) {
    const double x = svg_x(&points->axes, result->ns), y = svg_y(&points->axes, result->error);
    const double bx = svg_x(&points->axes, result->baseline_ns), by = svg_y(&points->axes, result->baseline_error);
    char attributes[128];
    snprintf(attributes, sizeof attributes, "stroke=\"%s\" stroke-opacity=\"0.22\"", colour);
    svg_line(points->file, x, y, bx, by, attributes);
    fprintf(points->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"white\" stroke=\"%s\"/>\n", bx, by, colour);
    fprintf(points->file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", x, y, colour);
    svg_take(points, x - 5, y - 5, 10, 10);
    svg_take(points, bx - 4, by - 4, 8, 8);
}

/* Names the baseline of the family that `result` belongs to, at the slowest of its hollow points. */
static inline void svg_label_baseline(svg_points *points, const bench_result *results, int count, int first, const char *colour) {
    const bench_result *slowest = &results[first];
    for (int i = first; i < count && bench_same_family(results[i].test->name, results[first].test->name); i++)
        slowest = results[i].baseline_ns > slowest->baseline_ns ? &results[i] : slowest;
    svg_draw_label(points, svg_x(&points->axes, slowest->baseline_ns), svg_y(&points->axes, slowest->baseline_error),
                   slowest->test->baseline, "font-style=\"italic\"", colour);
}

/* Results of one family are neighbours. */
static inline int svg_starts_family(const bench_result *results, int i) {
    return i == 0 || !bench_same_family(results[i].test->name, results[i - 1].test->name);
}

static inline void svg_draw_all(svg_points *points, const bench_result *results, int count) {
    for (int i = 0, family = -1; i < count; i++) {
        family += svg_starts_family(results, i);
        svg_draw_pair(points, &results[i], svg_colour(family));
    }
    for (int i = 0, family = -1; i < count; i++) {
        char label[64];
        family += svg_starts_family(results, i);
        svg_label(results[i].test->name, label, sizeof label);
        svg_draw_label(points, svg_x(&points->axes, results[i].ns), svg_y(&points->axes, results[i].error), label, "",
                       svg_colour(family));
    }
    for (int i = 0, family = -1; i < count; i++)
        if (svg_starts_family(results, i))
            svg_label_baseline(points, results, count, i, svg_colour(++family));
}

static inline void bench_write_svg(FILE *file, const bench_machine *machine, const bench_result *results, int count) {
    svg_points points = { file, svg_find_axes(results, count), NULL, 0 };
    points.taken = (svg_box *)bench_check(malloc(4 * (size_t)count * sizeof(svg_box)));
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, sans-serif\" "
            "font-size=\"%d\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            SVG_WIDTH, SVG_HEIGHT, SVG_FONT);
    svg_draw_title(file, machine);
    svg_draw_times(file, &points.axes);
    svg_draw_errors(file, &points.axes);
    svg_draw_all(&points, results, count);
    fputs("</svg>\n", file);
    free(points.taken);
}

#endif /* BENCH_SVG_H */
