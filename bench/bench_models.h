/* bench_models.h - the model chart: time per RGB normal against mean RMS error, a point per model of irradiance, over a suite of lights:
 * analytic ones, and panoramas (PFM) from the command line. Errors are relative to R0 of the channel. */
#ifndef BENCH_MODELS_H
#define BENCH_MODELS_H

#include "../tests/envs.h"
#include "bench_eval.h"

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

/* The fastest of many turns. */
static inline double models_time(int which, const models_chart *chart) {
    double fastest = 1e30;
    float c[27];
    eval_light(SH_L2, 0, c);
    for (int turn = 0; turn < 200; turn++) {
        const double start = bench_now();
        for (int i = 0; i < 8; i++)
            models_run(which, c, chart);
        const double seconds = (bench_now() - start) / (8 * (int)MODELS_NORMALS);
        fastest = seconds < fastest ? seconds : fastest;
    }
    return 1e9 * fastest;
}

/* Logarithmic in time, linear in error. */
static inline void models_write(const models_chart *chart, FILE *file) {
    double slowest = 1.0, largest = 0.0;
    for (int i = 0; i < MODELS_COUNT; i++) {
        slowest = chart->entry[i].ns > slowest ? chart->entry[i].ns : slowest;
        largest = chart->entry[i].error > largest ? chart->entry[i].error : largest;
    }
    const double x0 = 70, x1 = 730, y0 = 430, y1 = 50, low = log10(0.1), high = log10(slowest) + 0.25, top = 1.1 * largest;
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 490\" font-family=\"sans-serif\" font-size=\"13\">\n"
            "<rect width=\"800\" height=\"490\" fill=\"white\"/>\n"
            "<text x=\"70\" y=\"28\" font-size=\"16\">Models of irradiance: mean RMS error over %d channels of lights, against "
            "time (%s)</text>\n"
            "<text x=\"400\" y=\"478\" text-anchor=\"middle\">ns per RGB normal</text>\n"
            "<text x=\"18\" y=\"240\" text-anchor=\"middle\" transform=\"rotate(-90 18 240)\">RMS error / R0</text>\n",
            chart->channels, SH_SIMD_NAME);
    for (double t = 0.1; log10(t) < high; t *= 10.0)
        for (int m = 1; m <= 5; m += m == 1 ? 1 : 3) {
            const double x = x0 + (log10(t * m) - low) / (high - low) * (x1 - x0);
            if (x <= x1 + 1)
                fprintf(
                    file,
                    "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n",
                    x, y0, y1, x, y0 + 20, t * m);
        }
    for (int i = 0; i * 0.1 <= top; i++) {
        const double y = y0 - i * 0.1 / top * (y0 - y1);
        fprintf(file, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.1f</text>\n",
                x0, y, x1, x0 - 8, y + 4, i * 0.1);
    }
    for (int i = 0; i < MODELS_COUNT; i++) {
        const models_entry *e = &chart->entry[i];
        const double x = x0 + (log10(e->ns) - low) / (high - low) * (x1 - x0), y = y0 - e->error / top * (y0 - y1);
        const int closure = strstr(e->name, "closure") != NULL, right = x > x1 - 100;
        fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/>", x, y, closure ? "#c2410c" : "#1d4ed8");
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\"%s>%s %.3f</text>\n", right ? x : x + 8, closure ? y + 15 : y - 7,
                right ? " text-anchor=\"middle\"" : "", e->name, e->error);
    }
    fprintf(file, "</svg>\n");
}

/* Draws the chart and prints its numbers; 0, or the index + 1 of a panorama that cannot be read. */
static inline int bench_models(FILE *file, const char *const *env, int env_count) {
    static const char *const name[MODELS_COUNT] = { "L0",        "L1 linear",           "ZH3",       "Geomerics", "L1 closure",
                                                    "L2 linear", "L2 bounded (scalar)", "L2 closure" };
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
    models_write(&chart, file);
    bench_free_all();
    return 0;
}

#endif /* BENCH_MODELS_H */
