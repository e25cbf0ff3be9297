/* bench_models.h - the model chart: time per RGB normal against mean RMS error, a point per model of irradiance, over a suite of lights:
 * analytic ones, and panoramas (PFM) from the command line. Errors are relative to R0 of the channel. */
#ifndef BENCH_MODELS_H
#define BENCH_MODELS_H

#include "../tests/envs.h"
#include "bench_eval.h"
#include "bench_svg.h"

enum { MODELS_COUNT = 8, MODELS_NORMALS = 1024, MODELS_LIGHTS = 6 };

typedef struct models_entry {
    const char *name;
    int order;
    double ns, error; /* error: summed over channels */
} models_entry;

typedef struct models_chart {
    models_entry entry[MODELS_COUNT];
    float *normals; /* x, y, z */
    float *out;
    int channels; /* of all lights so far */
} models_chart;

/* One RGB probe by model `which`. */
static inline void models_run(int which, const float l2[27], const models_chart *chart) {
    const float *x = chart->normals, *y = x + MODELS_NORMALS, *z = y + MODELS_NORMALS;
    const size_t count = MODELS_NORMALS;
    float l1[12], l0[3], *out = chart->out;
    sh_truncate(SH_L2, 3, l2, SH_L1, l1);
    sh_truncate(SH_L2, 3, l2, SH_L0, l0);
    switch (which) {
    case 0:
        sh_irradiance_batch(SH_L0, 3, l0, x, y, z, out, count);
        break;
    case 1:
        sh_irradiance_batch(SH_L1, 3, l1, x, y, z, out, count);
        break;
    case 2:
        sh_irradiance_zh3_batch(SH_L1, 3, l1, x, y, z, out, count);
        break;
    case 3:
        sh_irradiance_geomerics_batch(SH_L1, 3, l1, x, y, z, out, count);
        break;
    case 4:
        sh_irradiance_closure_batch(SH_L1, 3, l1, x, y, z, out, count);
        break;
    case 5:
        sh_irradiance_batch(SH_L2, 3, l2, x, y, z, out, count);
        break;
    case 6: /* no batch: the bounds are for showing and testing */
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 3; k++) {
                const float n[3] = { x[i], y[i], z[i] }, *c = l2 + 9 * k;
                float lo, hi;
                sh_irradiance_bounds(SH_L2, c, n, &lo, &hi);
                out[k * count + i] = fmaxf(lo, fminf(hi, sh_irradiance(SH_L2, c, n)));
            }
        break;
    default:
        sh_irradiance_closure_batch(SH_L2, 3, l2, x, y, z, out, count);
        break;
    }
}

/* Adds the errors of all models for one light. Linear models count as clamped at 0. */
static inline void models_add_light(const envs_light *light, models_chart *chart) {
    static double truth[MODELS_NORMALS][3];
    float c[27];
    for (int k = 0; k < 3; k++)
        envs_moments(light, k, c + 9 * k);
    for (int i = 0; i < MODELS_NORMALS; i++) {
        const float n[3] = { chart->normals[i], chart->normals[MODELS_NORMALS + i], chart->normals[2 * MODELS_NORMALS + i] };
        envs_irradiance(light, n, truth[i]);
    }
    for (int which = 0; which < MODELS_COUNT; which++) {
        models_run(which, c, chart);
        for (int k = 0; k < 3; k++) {
            double square = 0.0;
            for (int i = 0; i < MODELS_NORMALS; i++) {
                const double value = (double)chart->out[k * MODELS_NORMALS + i], error = (value > 0.0 ? value : 0.0) - truth[i][k];
                square += error * error;
            }
            chart->entry[which].error += sqrt(square / (int)MODELS_NORMALS) / (double)c[9 * k];
        }
    }
    chart->channels += 3;
}

/* Analytic lights, a variant per channel: a sun; a sun under a sky; a cap; two suns; a ring; a gradient. */
static inline double models_radiance(int light, int channel, const float d[3]) {
    const double x = (double)d[0], y = (double)d[1], z = (double)d[2], strong = 1.0 + channel;
    const double sun = 0.48 * x + 0.36 * y + 0.8 * z, other = -0.8 * x + 0.6 * z;
    switch (light) {
    case 0:
        return sun > 0.998 ? 1.0 : 0.0;
    case 1:
        return (sun > 0.998 ? 300.0 * strong : 0.0) + (z > 0.0 ? 1.0 : 0.2);
    case 2:
        return sun > 0.3 * channel ? 1.0 : 0.0;
    case 3:
        return (sun > 0.99 ? strong : 0.0) + (other > 0.99 ? 1.0 : 0.0);
    case 4:
        return fabs(sun) < 0.1 ? 1.0 : 0.02 * channel;
    default:
        return 1.0 + 0.3 * strong * z;
    }
}

static inline void models_analytic(int which, envs_light *light) {
    memset(light, 0, sizeof *light);
    for (int i = 0; i < ENVS_TEXELS; i++) {
        envs_texel_direction(i, light->dir[i]);
        light->weight[i] = envs_area(i / ENVS_WIDTH, ENVS_WIDTH, ENVS_HEIGHT);
        for (int k = 0; k < 3; k++)
            light->value[k][i] = models_radiance(which, k, light->dir[i]);
    }
}

/* The fastest of many turns, each long enough for a slow clock. */
static inline double models_time(int which, const models_chart *chart) {
    enum { TURNS = 60, CALLS = 256 };
    double fastest = 1e30;
    float c[27];
    eval_light(SH_L2, 0, c);
    for (int turn = 0; turn < TURNS; turn++) {
        const double start = bench_now();
        for (int i = 0; i < CALLS; i++)
            models_run(which, c, chart);
        const double seconds = (bench_now() - start) / (CALLS * (int)MODELS_NORMALS);
        fastest = seconds < fastest ? seconds : fastest;
    }
    return 1e9 * fastest;
}

/* ---- The chart: logarithmic both ways, its points labelled directly ------------------------------------------------------------- */

enum { MODELS_WIDTH = 800, MODELS_HEIGHT = 500, MODELS_X0 = 70, MODELS_X1 = 770, MODELS_Y0 = 440, MODELS_Y1 = 88 };

/* What the axes begin and end with. */
typedef struct models_axes {
    double fastest, slowest, least, largest;
} models_axes;

static inline double models_x(const models_axes *axes, double ns) {
    return MODELS_X0 + log(ns / axes->fastest) / log(axes->slowest / axes->fastest) * (MODELS_X1 - MODELS_X0);
}

static inline double models_y(const models_axes *axes, double error) {
    return MODELS_Y0 - log(error / axes->least) / log(axes->largest / axes->least) * (MODELS_Y0 - MODELS_Y1);
}

static inline models_axes models_enclose(const models_chart *chart) {
    models_axes axes = { 0.5, 1.0, 0.5, 1.0 };
    for (int i = 0; i < MODELS_COUNT; i++) {
        axes.fastest = fmin(axes.fastest, 0.8 * chart->entry[i].ns);
        axes.slowest = fmax(axes.slowest, 2.0 * chart->entry[i].ns);
        axes.least = fmin(axes.least, 0.8 * chart->entry[i].error);
        axes.largest = fmax(axes.largest, 1.1 * chart->entry[i].error);
    }
    return axes;
}

static inline void models_grid(FILE *file, const models_axes *axes) {
    char text[32];
    for (double decade = 1e-4; decade < 1e4; decade *= 10.0)
        for (int digit = 1; digit <= 5; digit += digit == 1 ? 1 : 3) {
            const double value = digit * decade, x = models_x(axes, value), y = models_y(axes, value);
            snprintf(text, sizeof text, "%g", value);
            if (x >= MODELS_X0 && x <= MODELS_X1) {
                svg_line(file, x, MODELS_Y0, x, MODELS_Y1, "stroke=\"#e4e4e4\"");
                svg_text(file, x, MODELS_Y0 + 18, "text-anchor=\"middle\" fill=\"#555555\"", text);
            }
            if (y <= MODELS_Y0 && y >= MODELS_Y1) {
                svg_line(file, MODELS_X0, y, MODELS_X1, y, "stroke=\"#e4e4e4\"");
                svg_text(file, MODELS_X0 - 8, y + 4, "text-anchor=\"end\" fill=\"#555555\"", text);
            }
        }
    svg_text(file, (MODELS_X0 + MODELS_X1) / 2, MODELS_Y0 + 42, "text-anchor=\"middle\"",
             "ns per RGB normal, of a batch of 1024 (left is faster)");
    fprintf(file, "<g transform=\"translate(20 %d) rotate(-90)\">", (MODELS_Y0 + MODELS_Y1) / 2);
    svg_text(file, 0, 0, "text-anchor=\"middle\"", "RMS error, relative to R0 (down is more accurate)");
    fputs("</g>\n", file);
}

/* Whether no model is faster and more accurate than model i. */
static inline int models_on_front(const models_chart *chart, int i) {
    for (int j = 0; j < MODELS_COUNT; j++)
        if (chart->entry[j].ns < chart->entry[i].ns && chart->entry[j].error < chart->entry[i].error)
            return 0;
    return 1;
}

/* A name and, below it, the numbers. On the left of the point where another point is close on its right. */
static inline void models_label(FILE *file, const models_chart *chart, const models_axes *axes, int i) {
    const models_entry *e = &chart->entry[i];
    const double x = models_x(axes, e->ns), y = models_y(axes, e->error);
    int left = x > MODELS_X1 - 120;
    for (int j = 0; j < MODELS_COUNT; j++) {
        const double dx = models_x(axes, chart->entry[j].ns) - x, dy = models_y(axes, chart->entry[j].error) - y;
        left |= dx > 0.0 && dx < 120.0 && fabs(dy) < 30.0;
    }
    const char *outline = "stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\"";
    char text[64], style[192];
    snprintf(style, sizeof style, "text-anchor=\"%s\" %s font-weight=\"bold\" fill=\"%s\"", left ? "end" : "start", outline,
             strstr(e->name, "closure") ? "#c2410c" : "#1e3a5f");
    svg_text(file, left ? x - 10 : x + 10, y - 1, style, e->name);
    snprintf(style, sizeof style, "text-anchor=\"%s\" %s fill=\"#555555\" font-size=\"11\"", left ? "end" : "start", outline);
    snprintf(text, sizeof text, "%.3f, %.2f ns%s", e->error, e->ns, strstr(e->name, "bounded") ? ", no batch" : "");
    svg_text(file, left ? x - 10 : x + 10, y + 12, style, text);
}

/* The line joins the models that no other is better than in both respects. */
static inline void models_write(const models_chart *chart, int envs, FILE *file) {
    const models_axes axes = models_enclose(chart);
    char text[160];
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, sans-serif\" "
            "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            MODELS_WIDTH, MODELS_HEIGHT);
    svg_text(file, MODELS_X0, 30, "font-size=\"17\" font-weight=\"bold\"", "Models of irradiance: run time against error");
    snprintf(text, sizeof text, "Mean of %d channels, of %d analytic lights and %d panoramas. %s, one thread.", chart->channels,
             MODELS_LIGHTS, envs, SH_SIMD_NAME);
    svg_text(file, MODELS_X0, 50, "fill=\"#555555\"", text);
    svg_text(file, MODELS_X0, 67, "fill=\"#555555\"", "Joined: no other model is both faster and more accurate.");
    models_grid(file, &axes);
    double before_x = 0.0, before_y = 0.0;
    for (double ns = 0.0;;) {
        int next = -1;
        for (int i = 0; i < MODELS_COUNT; i++)
            if (models_on_front(chart, i) && chart->entry[i].ns > ns && (next < 0 || chart->entry[i].ns < chart->entry[next].ns))
                next = i;
        if (next < 0)
            break;
        const double x = models_x(&axes, chart->entry[next].ns), y = models_y(&axes, chart->entry[next].error);
        if (ns > 0.0)
            svg_line(file, before_x, before_y, x, y, "stroke=\"#c9a27e\" stroke-width=\"1.5\" stroke-dasharray=\"2 3\"");
        before_x = x;
        before_y = y;
        ns = chart->entry[next].ns;
    }
    for (int i = 0; i < MODELS_COUNT; i++) {
        const models_entry *e = &chart->entry[i];
        fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/>\n", models_x(&axes, e->ns), models_y(&axes, e->error),
                strstr(e->name, "closure") ? "#c2410c" : "#1e3a5f");
        models_label(file, chart, &axes, i);
    }
    fprintf(file, "</svg>\n");
}

/* Draws the chart and prints its numbers; 0, or the index + 1 of a panorama that cannot be read. */
static inline int bench_models(FILE *file, const char *const *env, int env_count) {
    static const char *const name[MODELS_COUNT] = { "L0",         "L1 linear", "ZH3",        "Geomerics",
                                                    "L1 closure", "L2 linear", "L2 bounded", "L2 closure" };
    static envs_light light;
    models_chart chart;
    memset(&chart, 0, sizeof chart);
    chart.normals = bench_alloc_floats(3 * MODELS_NORMALS);
    chart.out = bench_alloc_floats(3 * MODELS_NORMALS);
    for (uint32_t i = 0; i < MODELS_NORMALS; i++) {
        float n[3];
        sh_direction_fibonacci(i, MODELS_NORMALS, n);
        for (uint32_t k = 0; k < 3; k++)
            chart.normals[k * MODELS_NORMALS + i] = n[k];
    }
    for (int i = 0; i < MODELS_LIGHTS; i++) {
        models_analytic(i, &light);
        models_add_light(&light, &chart);
    }
    for (int i = 0; i < env_count; i++) {
        if (!envs_load(env[i], &light))
            return i + 1;
        models_add_light(&light, &chart);
    }
    printf("model                  ns/RGB normal   RMS error / R0, %d channels\n", chart.channels);
    for (int i = 0; i < MODELS_COUNT; i++) {
        models_entry *e = &chart.entry[i];
        e->name = name[i];
        e->error /= chart.channels;
        e->ns = models_time(i, &chart);
        printf("%-20s %10.3f %16.4f\n", e->name, e->ns, e->error);
    }
    models_write(&chart, env_count, file);
    bench_free_all();
    return 0;
}

#endif /* BENCH_MODELS_H */
