/* stress_svg.h - a plot of errors against counts, both in powers. */
#ifndef STRESS_SVG_H
#define STRESS_SVG_H

#include <math.h>
#include <stdio.h>

enum {
    SVG_WIDTH = 900,
    SVG_HEIGHT = 520,
    SVG_LEFT = 84,
    SVG_RIGHT = 40,
    SVG_TOP = 70,
    SVG_BOTTOM = 60,
    SVG_LOW = -10,
    SVG_HIGH = 0
};

/* Places of 2^bits and of an error; what is below the axis lies on it. */
static inline double svg_x(double bits, int first, int last) {
    const int width = SVG_WIDTH - SVG_LEFT - SVG_RIGHT, left = SVG_LEFT;
    return left + (bits - first) / (last - first) * width;
}

static inline double svg_y(double error) {
    const int height = SVG_HEIGHT - SVG_TOP - SVG_BOTTOM, top = SVG_TOP, high = SVG_HIGH, low = SVG_LOW;
    const double decade = error > 1e-10 ? log10(error) : low;
    return top + (high - decade) / (high - low) * height;
}

static inline void svg_axes(FILE *file, int first, int last) {
    for (int decade = SVG_LOW; decade <= SVG_HIGH; decade += 2) {
        const double y = svg_y(pow(10.0, decade));
        fprintf(file, "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" stroke=\"#dddddd\"/>\n", SVG_LEFT, y,
                SVG_WIDTH - SVG_RIGHT, y);
        fprintf(file, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">1e%d</text>\n", SVG_LEFT - 8, y + 4.0, decade);
    }
    for (int bits = first; bits <= last; bits += 2) {
        const double x = svg_x(bits, first, last);
        fprintf(file, "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#eeeeee\"/>\n", x, SVG_TOP, x,
                SVG_HEIGHT - SVG_BOTTOM);
        fprintf(file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">2<tspan dy=\"-6\" font-size=\"10\">%d</tspan></text>\n", x,
                SVG_HEIGHT - SVG_BOTTOM + 22, bits);
    }
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">number of samples</text>\n", SVG_WIDTH / 2, SVG_HEIGHT - 12);
    fprintf(
        file,
        "<text transform=\"translate(22 %d) rotate(-90)\" text-anchor=\"middle\">largest error of a coefficient, relative to R0</text>\n",
        SVG_HEIGHT / 2);
}

/* A line for each of three ways to add, labelled at its end. */
static inline void svg_errors(const char *path, const char *const *names, double error[3][40], int first, int last) {
    static const char *const colours[] = { "#c2410c", "#0b62a4", "#0f766e" };
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "cannot write %s\n", path);
        return;
    }
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"13\">\n",
            SVG_WIDTH, SVG_HEIGHT);
    fprintf(file, "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n");
    fprintf(
        file,
        "<text x=\"%d\" y=\"30\" font-size=\"18\" font-weight=\"bold\">Sums of up to 2<tspan dy=\"-7\" font-size=\"12\">%d</tspan>"
        "<tspan dy=\"7\" dx=\"5\">samples</tspan></text>\n",
        SVG_LEFT, last);
    fprintf(file,
            "<text x=\"%d\" y=\"50\" fill=\"#555555\">A float that has grown to 2<tspan dy=\"-6\" font-size=\"10\">24</tspan>"
            "<tspan dy=\"6\" dx=\"4\">times its terms no longer grows.</tspan></text>\n",
            SVG_LEFT);
    svg_axes(file, first, last);
    for (int way = 0; way < 3; way++) {
        fprintf(file, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"2\" points=\"", colours[way]);
        for (int bits = first; bits <= last; bits++)
            fprintf(file, "%.1f,%.1f ", svg_x(bits, first, last), svg_y(error[way][bits]));
        fprintf(file, "\"/>\n<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\" fill=\"%s\">%s</text>\n", SVG_WIDTH - SVG_RIGHT - 6,
                svg_y(error[way][last]) + (way == 1 ? 18.0 : -10.0), colours[way], names[way]);
    }
    fprintf(file, "</svg>\n");
    fclose(file);
}

#endif /* STRESS_SVG_H */
