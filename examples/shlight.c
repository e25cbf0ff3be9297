/* shlight - projects a panorama to spherical harmonics, measures what each reconstruction of irradiance makes of it, and draws that.
 *
 *     shlight [PANORAMA.hdr|.pfm] [-o OUT.png] [--order N] [--models A,B] [--bounds] [--no-picture] [--quiet] [--help]
 *
 * Here: the models; the report; the command line. In the headers beside this file: shlight_scene.h projects and measures,
 * shlight_reference.h is the brute force, shlight_picture.h and shlight_bounds.h draw, shlight_image.h reads files, output_file.h
 * writes them, shlight_sky.h is the built-in sky.
 */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200112L /* NOLINT(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): the name is POSIX's */
#endif

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>

#include "sh.h"

#include "output_file.h"
#include "shlight_image.h"
#include "shlight_picture.h"
#include "shlight_png.h"
#include "shlight_scene.h"
#include "shlight_sky.h"

#if defined(_WIN32)
#include <io.h>
#elif defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

/* ---- The models: a row here is a row in the report and a card in the picture ----------------------------------------------------- */

static float evaluate_l0(const model_state *state, const float n[3]) {
    return sh_irradiance(SH_L0, state->c, n);
}

static float evaluate_l1(const model_state *state, const float n[3]) {
    return sh_irradiance(SH_L1, state->c, n);
}

static float evaluate_l1_clamped(const model_state *state, const float n[3]) {
    return fmaxf(0.0f, sh_irradiance(SH_L1, state->c, n));
}

static float evaluate_zh3(const model_state *state, const float n[3]) {
    return sh_irradiance_zh3(state->c, n);
}

static float evaluate_geomerics(const model_state *state, const float n[3]) {
    return sh_irradiance_geomerics(state->c, n);
}

static void prepare_closure_l1(const float *c, model_state *state) {
    sh_closure_prepare(SH_L1, 1, c, 0, &state->closure);
}

static float evaluate_closure_l1(const model_state *state, const float n[3]) {
    return sh_closure_irradiance(SH_L1, &state->closure, n);
}

static float evaluate_l2(const model_state *state, const float n[3]) {
    return sh_irradiance(SH_L2, state->c, n);
}

static float evaluate_l2_clamped(const model_state *state, const float n[3]) {
    return fmaxf(0.0f, sh_irradiance(SH_L2, state->c, n));
}

static float evaluate_l2_bounded(const model_state *state, const float n[3]) {
    float lo, hi;
    sh_irradiance_bounds(SH_L2, state->c, n, &lo, &hi);
    return fmaxf(lo, fminf(hi, sh_irradiance(SH_L2, state->c, n)));
}

static void prepare_closure_l2(const float *c, model_state *state) {
    sh_closure_prepare(SH_L2, 1, c, 0, &state->closure);
}

static void prepare_closure_floor(const float *c, model_state *state) {
    sh_closure_prepare(SH_L2, 1, c, SH_AMBIENT_FLOOR, &state->closure);
}

static float evaluate_closure_l2(const model_state *state, const float n[3]) {
    return sh_closure_irradiance(SH_L2, &state->closure, n);
}

/* Sorted by order. */
static const model models[] = {
    { "L0", "R0, the mean radiance", SH_L0, NULL, evaluate_l0 },
    { "L1 linear", "R0 + 2 R1.n", SH_L1, NULL, evaluate_l1 },
    { "L1 clamped", "max(0, L1 linear)", SH_L1, NULL, evaluate_l1_clamped },
    { "L1 ZH3", "L2 hallucinated along R1", SH_L1, NULL, evaluate_zh3 },
    { "L1 Geomerics", "R0 (a + (1-a)(p+1) q^p)", SH_L1, NULL, evaluate_geomerics },
    { "L1 closure", "bands up to 6 from R1, bounded", SH_L1, prepare_closure_l1, evaluate_closure_l1 },
    { "L2 linear", "R0 + 2 R1.n + 15/8 n'R2 n", SH_L2, NULL, evaluate_l2 },
    { "L2 clamped", "max(0, L2 linear)", SH_L2, NULL, evaluate_l2_clamped },
    { "L2 bounded", "L2 linear within proven bounds", SH_L2, NULL, evaluate_l2_bounded },
    { "L2 closure", "bands up to 6 from R2, bounded", SH_L2, prepare_closure_l2, evaluate_closure_l2 },
    { "L2 over floor", "L2 closure, ambient floor apart", SH_L2, prepare_closure_floor, evaluate_closure_l2 },
};

enum { MODELS = sizeof models / sizeof models[0] };

/* Whether `name` is the text from `begin` to `end`. */
static int is_name(const char *name, const char *begin, const char *end) {
    return strlen(name) == (size_t)(end - begin) && !strncmp(name, begin, (size_t)(end - begin));
}

/* The models of a list of names between commas, in its order; NULL: all up to `order`; "none": none. Returns how many, or -1 if there is
 * one that has no such name, is above `order` or named too often. */
static int choose_models(const char *list, int order, const model *chosen[MAX_MODELS]) {
    int count = 0;
    for (int i = 0; !list && i < MODELS && models[i].order <= order; i++)
        chosen[count++] = &models[i];
    if (!list || !strcmp(list, "none"))
        return count;
    for (const char *name = list, *end; name; name = *end ? end + 1 : NULL) {
        int i = 0;
        end = name + strcspn(name, ",");
        while (i < MODELS && !is_name(models[i].name, name, end))
            i++;
        if (i == MODELS || models[i].order > order || count == MAX_MODELS)
            return -1;
        chosen[count++] = &models[i];
    }
    return count;
}

/* ---- The report ------------------------------------------------------------------------------------------------------------------- */

static const char *const channel_name[2][3] = { { "grey", "", "" }, { "red", "green", "blue" } };

static void print_channels(const char *label, const float *value, int channels) {
    printf("%-18s", label);
    for (int k = 0; k < channels; k++)
        printf(" %15.9g", (double)value[k]);
    putchar('\n');
}

/* A direction, and the texel that shows it. */
static void print_direction(const scene *s, const char *label, const float dir[3]) {
    const double pi = acos(-1.0), turn = -atan2((double)dir[1], (double)dir[0]) / (2.0 * pi);
    const double polar = acos(fmax(-1.0, fmin(1.0, (double)dir[2])));
    printf("%-18s %15.6f %15.6f %15.6f   column %.0f, row %.0f\n", label, (double)dir[0], (double)dir[1], (double)dir[2],
           floor((turn - floor(turn)) * s->image.width), fmin(floor(polar / pi * s->image.height), s->image.height - 1));
}

static void print_coefficients(const scene *s) {
    static const char *const name[SH_COUNT(SH_L2)] = { "R0", "R1 x", "R1 y", "R1 z", "R2 xx", "R2 xy", "R2 xz", "R2 yy", "R2 yz" };
    const int channels = s->image.channels, stride = SH_COUNT(s->order);
    printf("\n%-18s", "coefficients");
    for (int k = 0; k < channels; k++)
        /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): an image has 1 or 3 channels */
        printf(" %15s", channel_name[channels == 3][k]);
    putchar('\n');
    for (int i = 0; i < stride; i++) {
        float value[3] = { 0 };
        for (int k = 0; k < channels; k++)
            value[k] = s->c[k * stride + i];
        print_channels(name[i], value, channels);
    }
}

/* What the first moments say: of each channel, and of all together. Needs L1. */
static void print_light(const scene *s) {
    const int channels = s->image.channels, stride = SH_COUNT(s->order);
    float directionality[3] = { 0 }, dir[3], intensity[3], ambient[3];
    for (int k = 0; k < channels; k++)
        directionality[k] = sh_directionality(s->c + k * stride);
    printf("\n");
    print_channels("directionality", directionality, channels);
    printf("\n%-18s %15s %15s %15s\n", "average direction", "x", "y", "z");
    for (int k = 0; k < channels; k++) {
        sh_average_direction(s->c + k * stride, dir);
        print_direction(s, channel_name[channels == 3][k], dir);
    }
    sh_dominant_light(s->order, channels, s->c, dir, intensity, ambient);
    printf("\ndominant light\n");
    print_direction(s, "direction", dir);
    print_channels("intensity", intensity, channels);
    print_channels("ambient", ambient, channels);
}

static void print_models(const scene *s) {
    printf("\nirradiance / pi against brute force over %d normals and all channels, relative to R0 of the channel\n", NORMALS);
    printf("%-18s %6s %10s %10s %10s\n", "model", "floats", "RMS error", "max error", "lowest");
    for (int i = 0; i < s->model_count; i++)
        printf("%-18s %6d %10.4f %10.4f %10.4f\n", s->models[i]->name, SH_COUNT(s->models[i]->order), s->error[i].rms,
               s->error[i].max, s->error[i].lowest);
}

static void print_bounds(const scene *s) {
    printf("\nproven bounds of irradiance / pi; brute force itself is uncertain by .001\n");
    printf("%-18s %6s %10s %13s\n", "order", "floats", "mean width", "truth beyond");
    for (int order = SH_L1; order <= s->order; order++)
        printf("L%-17d %6d %10.4f %13.4f\n", order, SH_COUNT(order), s->bounds[order].width, s->bounds[order].beyond);
}

static void print_report(const scene *s) {
    printf("panorama           %s\n", s->name);
    printf("format             %s, %d x %d\n", s->image.format, s->image.width, s->image.height);
    printf("texels             %llu: %llu not finite (left out), %llu negative (clamped to 0)\n",
           (unsigned long long)s->report.texels, (unsigned long long)s->report.nonfinite, (unsigned long long)s->report.negative);
    print_coefficients(s);
    if (s->order >= SH_L1)
        print_light(s);
    if (s->model_count)
        print_models(s);
    if (s->show_bounds)
        print_bounds(s);
}

/* ---- The command line -------------------------------------------------------------------------------------------------------------- */

enum { STATUS_OK = 0, STATUS_FAILED = 1, STATUS_BAD_INPUT = 2 };

static const char usage[] =
    "usage: shlight [PANORAMA.hdr|.pfm] [-o OUT.png] [--order N] [--models A,B] [--bounds] [--no-picture] [--quiet] [--help]\n"
    "\n"
    "Projects an equirectangular panorama to spherical harmonics, prints coefficients, light and the error of every\n"
    "reconstruction against brute-force irradiance, and draws that as spheres. Without a panorama: a built-in sky.\n"
    "\n"
    "  PANORAMA     Radiance .hdr (RGBE, flat or run-length) or .pfm (colour or grey); z up, columns to the right as a\n"
    "               camera sees them; at most 32768 texels a side and 2 GiB of pixels. Texels that are not finite are\n"
    "               left out, negative values count as 0; both are reported.\n"
    "  -o OUT.png   the picture's file, shlight.png by default; complete or untouched\n"
    "  --order N    the highest band, 0 to 2, by default 2\n"
    "  --models A,B only these models, by their names in the report, such as 'L1 closure,L2 closure'; none: no model\n"
    "  --bounds     also the bounds that 4 and 9 coefficients prove for the irradiance: their width in the report, and in\n"
    "               the picture a plot of them around the light, with the truth, the linear model and the closure\n"
    "  --no-picture only the report\n"
    "  --quiet      no progress on stderr (also none where stderr is not a terminal)\n"
    "  --help       this text\n"
    "\n"
    "exit status: 0 done; 1 the picture or the report could not be made or written; 2 bad arguments or panorama\n";

typedef struct options {
    const char *panorama, *output, *models;
    int order, bounds, no_picture, quiet, help;
} options;

static int stderr_is_terminal(void) {
#if defined(_WIN32)
    return _isatty(2);
#elif defined(__unix__) || defined(__APPLE__)
    return isatty(STDERR_FILENO);
#else
    return 0;
#endif
}

/* Overwrites the line of progress; an empty text clears it. */
static void progress(const options *o, const char *text) {
    if (!o->quiet && stderr_is_terminal())
        fprintf(stderr, "\r%-40s\r%s", "", text);
}

/* Prints exactly one line, in the place of the progress. */
static int fail(const options *o, int status, const char *format, ...) {
    char text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (char *c = text; *c; c++)
        if (*c == '\n' || *c == '\r')
            *c = '?';
    progress(o, "");
    fprintf(stderr, "shlight: %s\n", text);
    return status;
}

static int ends_in_png(const char *path) {
    const size_t length = strlen(path);
    return length > 4 && (!strcmp(path + length - 4, ".png") || !strcmp(path + length - 4, ".PNG"));
}

static int parse_options(int argc, char **argv, options *o) {
    for (int i = 1; i < argc; i++) {
        const char *a = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        /* NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): there is an argv[i] below argc */
        if (!strcmp(a, "--help") || !strcmp(a, "-h"))
            o->help = 1;
        else if (!strcmp(a, "--quiet"))
            o->quiet = 1;
        else if (!strcmp(a, "--bounds"))
            o->bounds = 1;
        else if (!strcmp(a, "--no-picture"))
            o->no_picture = 1;
        else if ((!strcmp(a, "-o") || !strcmp(a, "--order") || !strcmp(a, "--models")) && !value)
            return fail(o, STATUS_BAD_INPUT, "%s needs an argument (--help lists the options)", a);
        else if (!strcmp(a, "-o"))
            o->output = argv[++i];
        else if (!strcmp(a, "--models"))
            o->models = argv[++i];
        else if (!strcmp(a, "--order")) {
            if (!value || strlen(value) != 1 || value[0] < '0' || value[0] > '2')
                return fail(o, STATUS_BAD_INPUT, "--order %s: must be 0, 1 or 2", value);
            o->order = argv[++i][0] - '0';
        } else if (a[0] == '-')
            return fail(o, STATUS_BAD_INPUT, "unknown option %s (--help lists the options)", a);
        else if (o->panorama)
            return fail(o, STATUS_BAD_INPUT, "one panorama at a time: %s and %s", o->panorama, a);
        else
            o->panorama = a;
    }
    if (o->bounds && o->order == SH_L0)
        return fail(o, STATUS_BAD_INPUT, "--bounds needs order 1 or 2");
    if (!ends_in_png(o->output))
        return fail(o, STATUS_BAD_INPUT, "%s: the picture's name must end in .png", o->output);
    return STATUS_OK;
}

/* The bytes of a file, from malloc; or NULL, and *error says why. */
static unsigned char *read_file(const char *path, size_t *size, const char **error) {
    const size_t limit = (size_t)SHLIGHT_MAX_BYTES + 65536;
    size_t capacity = 0;
    unsigned char *bytes = NULL;
    errno = 0;
    FILE *file = fopen(path, "rb");
    *size = 0;
    *error = file ? NULL : strerror(errno);
    while (!*error && *size == capacity) {
        capacity = capacity < limit / 2 ? 2 * capacity + 65536 : limit + 1;
        unsigned char *larger = (unsigned char *)realloc(bytes, capacity);
        if (larger) {
            bytes = larger;
            *size += fread(bytes + *size, 1, capacity - *size, file);
            *error = ferror(file) ? strerror(errno) : *size > limit ? "too large: more than 2 GiB" : NULL;
        } else {
            *error = "not enough memory for the file";
        }
    }
    if (file)
        fclose(file);
    if (!*error)
        return bytes;
    free(bytes);
    return NULL;
}

static int unknown_model(const options *o) {
    char names[256] = "";
    for (int i = 0; i < MODELS && models[i].order <= o->order; i++) {
        const size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", i ? ", " : "", models[i].name);
    }
    return fail(o, STATUS_BAD_INPUT, "--models %s: the models of order %d are %s", o->models, o->order, names);
}

static int load(const options *o, scene *s) {
    const char *error = NULL;
    s->name = o->panorama ? o->panorama : "built-in sky";
    s->order = o->order;
    s->show_bounds = o->bounds;
    s->model_count = choose_models(o->models, o->order, s->models);
    if (s->model_count < 0)
        return unknown_model(o);
    if (o->panorama) {
        size_t size;
        unsigned char *bytes = read_file(o->panorama, &size, &error);
        if (bytes)
            shlight_read(bytes, size, &s->image, &error);
        free(bytes);
    } else {
        error = shlight_sky(&s->image);
    }
    if (!error)
        error = scene_project(s);
    return error ? fail(o, o->panorama ? STATUS_BAD_INPUT : STATUS_FAILED, "%s: %s", s->name, error) : STATUS_OK;
}

static int save(const options *o, const scene *s) {
    size_t size = 0;
    unsigned char *png = draw_picture(s, &size);
    output_file out;
    int error = png ? output_open(o->output, &out) : ENOMEM;
    if (!error) {
        fwrite(png, 1, size, out.file);
        error = output_close(&out, 1);
    }
    free(png);
    return error ? fail(o, STATUS_FAILED, "%s: cannot write the picture: %s", o->output, strerror(error)) : STATUS_OK;
}

static int run(const options *o, scene *s) {
    progress(o, "reading the panorama");
    int status = load(o, s);
    if (status != STATUS_OK)
        return status;
    progress(o, "adding up every texel for every normal");
    if (scene_measure(s) != 0)
        return fail(o, STATUS_FAILED, "not enough memory");
    progress(o, "drawing");
    status = o->no_picture ? STATUS_OK : save(o, s);
    if (status != STATUS_OK)
        return status;
    progress(o, "");
    print_report(s);
    if (!o->no_picture)
        printf("\npicture            %s\n", o->output);
    return fflush(stdout) == 0 && !ferror(stdout) ? STATUS_OK : fail(o, STATUS_FAILED, "the report could not be written");
}

int main(int argc, char **argv) {
    options o = { NULL, "shlight.png", NULL, SH_L2, 0, 0, 0, 0 };
    scene s = { 0 };
    int status = parse_options(argc, argv, &o);
    if (status == STATUS_OK && o.help)
        status = fputs(usage, stdout) >= 0 && fflush(stdout) == 0 ? STATUS_OK : fail(&o, STATUS_FAILED, "the help could not be written");
    else if (status == STATUS_OK)
        status = run(&o, &s);
    scene_free(&s);
    return status;
}
