/* stress.h - the worst error of a function: what a case is, classes of input, a search that climbs towards the worst, a table.
 *
 * A case says what floats its function takes (slots), measures the error of one input against long double, and names the bound that
 * the contract in sh.h states. Everything is random with fixed seeds: the same on every machine up to the arithmetic measured. */
#ifndef STRESS_H
#define STRESS_H

#include "../lights.h"
#include "../oracle.h"
#include "../test.h"
#include "sh.h"

/* ---- What is measured ----------------------------------------------------------------------------------------------------------- */

typedef enum stress_unit {
    STRESS_ULP,      /* 2^-23 of the natural scale: the spacing of floats just above a power of two */
    STRESS_RELATIVE, /* the natural scale itself */
    STRESS_SHARE     /* the same, where the scale is all that the contract allows */
} stress_unit;

/* The error of one input: the largest of what is compared. `nan`: a result was NaN. */
typedef struct stress_measure {
    stress_unit unit;
    long double allowance; /* what underflow may cost */
    long double worst;
    int nan;
} stress_measure;

/* What products that underflow may cost: 2^-144 times 1 + the largest input, as sh.h says. */
static inline long double stress_allowance(const float *in, int count) {
    long double largest = 0.0L;
    for (int i = 0; i < count; i++)
        largest = fmaxl(largest, fabsl((long double)in[i]));
    return ldexpl(1.0L + largest, -144);
}

/* An error that is known as such: of a bound that is exceeded, for instance. */
static inline void stress_error(stress_measure *m, long double error, long double scale) {
    const long double rest = error - m->allowance, unit = m->unit == STRESS_ULP ? ldexpl(scale, -23) : scale;
    if (error - error != 0.0L)
        m->nan |= !(error > 0.0L);
    if (!(rest <= 0.0L))
        m->worst = fmaxl(m->worst, unit > 0.0L ? rest / unit : (long double)INFINITY);
}

static inline void stress_compare(stress_measure *m, float actual, long double expected, long double scale) {
    if (fabsl(expected) < (long double)FLT_MAX)
        stress_error(m, fabsl((long double)actual - expected), scale);
}

static inline void stress_compare_all(stress_measure *m, const float *actual, const long double *expected, int count,
                                      long double scale) {
    for (int i = 0; i < count; i++)
        stress_compare(m, actual[i], expected[i], scale);
}

/* Something that has to hold exactly. */
static inline void stress_require(stress_measure *m, int condition) {
    if (!condition)
        m->worst = (long double)INFINITY;
}

/* ---- Input ---------------------------------------------------------------------------------------------------------------------- */

typedef enum stress_kind {
    STRESS_END,
    STRESS_SET,       /* numbers of any size: coefficients, values */
    STRESS_LIGHT,     /* sets of nine coefficients of lights that are nowhere negative */
    STRESS_DIRECTION, /* unit vectors of three */
    STRESS_ROTATION,  /* unit quaternions */
    STRESS_POINT,     /* positions: their coordinates are of one size */
    STRESS_NUMBER,    /* numbers in [low, high] */
    STRESS_TEXELS     /* radiance, mostly positive */
} stress_kind;

typedef struct stress_slot {
    stress_kind kind;
    int count; /* floats */
    double low, high;
} stress_slot;

#define SET(count) { STRESS_SET, count, 0.0, 0.0 }
#define LIGHT(channels) { STRESS_LIGHT, 9 * (channels), 0.0, 0.0 }
#define DIRECTION { STRESS_DIRECTION, 3, 0.0, 0.0 }
#define DIRECTIONS(count) { STRESS_DIRECTION, 3 * (count), 0.0, 0.0 }
#define ROTATION { STRESS_ROTATION, 4, 0.0, 0.0 }
#define POINTS(count) { STRESS_POINT, 3 * (count), 0.0, 0.0 }
#define NUMBER(low, high) { STRESS_NUMBER, 1, low, high }
#define NUMBERS(count, low, high) { STRESS_NUMBER, count, low, high }
#define TEXELS(count) { STRESS_TEXELS, count, 0.0, 0.0 }

enum { STRESS_SLOTS = 5, STRESS_FLOATS = 640 };

typedef enum stress_class {
    STRESS_UNIFORM,
    STRESS_STRUCTURED,
    STRESS_CANCELLING,
    STRESS_WIDE,
    STRESS_TINY,
    STRESS_HUGE,
    STRESS_SUBNORMAL,
    STRESS_AXES,
    STRESS_OFF_UNIT,
    STRESS_ZERO,
    STRESS_CLASSES
} stress_class;

static const char *const stress_class_names[STRESS_CLASSES] = { "uniform",  "structured",    "cancelling", "1e-30 to 1e18",
                                                                "1e-30",    "1e18",          "subnormal",  "axes, diagonals",
                                                                "off unit", "zero direction" };

typedef struct stress_case {
    const char *name;
    const char *claim; /* the contract's words for `limit` */
    stress_unit unit;
    double limit;
    stress_slot slot[STRESS_SLOTS];
    void (*measure)(const float *in, stress_measure *m);
    int cost; /* an evaluation's, where that of an irradiance is 1 */
} stress_case;

static inline int stress_size(const stress_case *test) {
    int size = 0;
    for (int s = 0; s < STRESS_SLOTS && test->slot[s].kind != STRESS_END; s++)
        size += test->slot[s].count;
    return size;
}

static inline double stress_sign(void) {
    return test_below(2) ? 1.0 : -1.0;
}

static inline float stress_next(float x, int steps) {
    for (; steps > 0; steps--)
        x = nextafterf(x, (float)INFINITY);
    for (; steps < 0; steps++)
        x = nextafterf(x, -(float)INFINITY);
    return x;
}

/* What a class multiplies numbers of about 1 by. */
static inline double stress_magnitude(stress_class kind) {
    switch (kind) {
    case STRESS_WIDE:
        return pow(10.0, test_uniform(-30.0, 18.0));
    case STRESS_TINY:
        return 1e-30;
    case STRESS_HUGE:
        return 1e18;
    case STRESS_SUBNORMAL:
        return pow(10.0, test_uniform(-45.0, -37.5));
    default:
        return 1.0;
    }
}

static inline void stress_fill_set(stress_class kind, int count, float *out) {
    static const float structured[] = { 0.0f, 1.0f, -1.0f, 0.5f, -0.5f, 3.0f, 1.0f / 3.0f, 1.00000012f, 0.99999994f, -0.0f, 1e9f };
    const int single = test_below(count);
    for (int i = 0; i < count; i++) {
        out[i] = (float)(test_uniform(-1.0, 1.0) * stress_magnitude(kind));
        if (kind == STRESS_STRUCTURED)
            out[i] = count > 1 && i != single && test_below(2)
                         ? 0.0f
                         : structured[test_below((int)(sizeof structured / sizeof structured[0]))];
        if (kind == STRESS_CANCELLING && i % 2)
            out[i] = stress_next(-out[i - 1], test_below(5) - 2);
    }
}

static inline void stress_fill_light(stress_class kind, float out[9]) {
    static lights_light light;
    const double magnitude = stress_magnitude(kind);
    lights_random(kind == STRESS_STRUCTURED ? test_below(2) : kind == STRESS_CANCELLING ? 4 : test_below(LIGHTS_KINDS), &light);
    if (kind == STRESS_STRUCTURED || kind == STRESS_AXES)
        for (int i = 0; i < light.count && i < 2; i++)
            for (int j = 0; j < 3; j++)
                light.dir[i][j] = j == (test_below(3)) ? stress_sign() : 0.0;
    if (kind == STRESS_STRUCTURED || kind == STRESS_AXES)
        for (int i = 0; i < light.count && i < 2; i++) {
            const double length = sqrt(lights_dot(light.dir[i], light.dir[i]));
            for (int j = 0; j < 3; j++)
                light.dir[i][j] = length > 0.0 ? light.dir[i][j] / length : j == 2;
        }
    lights_moments(&light, magnitude, out);
}

/* A unit vector in floats; by class: an axis or a diagonal, one with its components off by an ulp, or zero. */
static inline void stress_fill_unit(stress_class kind, int count, float *out) {
    double v[4], length = 0.0;
    do {
        length = 0.0;
        for (int i = 0; i < count; i++) {
            v[i] = kind == STRESS_AXES ? test_below(3) - 1 : test_uniform(-1.0, 1.0);
            if (kind == STRESS_WIDE && test_below(3) == 0)
                v[i] = stress_sign() * pow(10.0, test_uniform(-45.0, 0.0));
            length += v[i] * v[i];
        }
    } while (length < 0.01 || length > 4.0);
    for (int i = 0; i < count; i++) {
        out[i] = kind == STRESS_ZERO ? 0.0f : (float)(v[i] / sqrt(length));
        if (kind == STRESS_OFF_UNIT)
            out[i] = stress_next(out[i], test_below(3) - 1);
    }
}

static inline float stress_fill_number(stress_class kind, double low, double high) {
    const double least = low > 1e-30 ? low : 1e-30;
    double x = test_uniform(low, high);
    if (kind == STRESS_STRUCTURED) {
        const double some[] = { low, high, 0.0, 1.0, 0.5, 2.0, 0.25, 1.0 - 1.0 / 16777216.0, 1.0 + 1.0 / 8388608.0 };
        x = some[test_below((int)(sizeof some / sizeof some[0]))];
    }
    if (kind == STRESS_WIDE || (kind == STRESS_UNIFORM && high > 1e6))
        x = exp(test_uniform(log(least), log(high > least ? high : least)));
    if (kind == STRESS_TINY || kind == STRESS_SUBNORMAL)
        x = low + test_uniform(0.0, 1.0) * (kind == STRESS_TINY ? 1e-30 : 1e-39);
    if (kind == STRESS_HUGE)
        x = high * (1.0 - 1e-3 * test_uniform(0.0, 1.0));
    return (float)(x < low ? low : x > high ? high : x);
}

/* Mostly as light is; one texel that outshines all others by 1e9; equal ones; cancelling signs. */
static inline void stress_fill_texels(stress_class kind, int count, float *out) {
    const double magnitude = kind == STRESS_WIDE ? 1.0 : stress_magnitude(kind), same = test_uniform(0.5, 1.0);
    for (int i = 0; i < count; i++) {
        out[i] = (float)(magnitude * test_uniform(0.0, 1.0) * (kind == STRESS_WIDE ? stress_magnitude(kind) : 1.0));
        if (kind == STRESS_STRUCTURED)
            out[i] = (float)same;
        if (kind == STRESS_CANCELLING)
            out[i] *= i % 2 ? -1.0f : 1.0f;
    }
    if (kind == STRESS_AXES)
        out[test_below(count)] = 1e9f;
}

static inline void stress_fill_slot(const stress_slot *slot, stress_class kind, float *out) {
    const double magnitude = stress_magnitude(kind == STRESS_WIDE && slot->kind == STRESS_POINT ? STRESS_UNIFORM : kind);
    const double scale = kind == STRESS_WIDE ? pow(10.0, test_uniform(-18.0, 18.0)) : magnitude;
    switch (slot->kind) {
    case STRESS_SET:
        stress_fill_set(kind, slot->count, out);
        break;
    case STRESS_LIGHT:
        for (int i = 0; i < slot->count; i += 9)
            stress_fill_light(kind, out + i);
        break;
    case STRESS_DIRECTION:
        for (int i = 0; i < slot->count; i += 3)
            stress_fill_unit(kind, 3, out + i);
        break;
    case STRESS_ROTATION:
        stress_fill_unit(kind, 4, out);
        break;
    case STRESS_POINT:
        stress_fill_set(kind == STRESS_STRUCTURED || kind == STRESS_CANCELLING ? kind : STRESS_UNIFORM, slot->count, out);
        for (int i = 0; i < slot->count; i++)
            out[i] = (float)((double)out[i] * scale);
        break;
    case STRESS_NUMBER:
        for (int i = 0; i < slot->count; i++)
            out[i] = stress_fill_number(kind, slot->low, slot->high);
        break;
    case STRESS_TEXELS:
        stress_fill_texels(kind, slot->count, out);
        break;
    case STRESS_END:
        break;
    }
}

static inline void stress_fill(const stress_case *test, stress_class kind, float *in) {
    for (int s = 0; s < STRESS_SLOTS && test->slot[s].kind != STRESS_END; s++) {
        stress_fill_slot(&test->slot[s], kind, in);
        in += test->slot[s].count;
    }
}

/* ---- The search ----------------------------------------------------------------------------------------------------------------- */

static inline float stress_nudge(float x) {
    switch (test_below(5)) {
    case 0:
        return stress_next(x, test_below(2) ? 1 : -1);
    case 1:
        return -x;
    case 2:
        return (float)((double)x * test_uniform(0.0, 2.0));
    default:
        return (float)((double)x * (1.0 + ldexp(test_uniform(-1.0, 1.0), -test_below(23))));
    }
}

/* A turn by a small angle, or an ulp of one component as long as the length stays 1 to 2e-7. */
static inline void stress_nudge_unit(int count, float *v) {
    float moved[4];
    double length = 0.0;
    const int one = test_below(3) == 0, which = test_below(count);
    const double amount = ldexp(1.0, -test_below(24));
    for (int i = 0; i < count; i++) {
        moved[i] = one ? (i == which ? stress_next(v[i], test_below(2) ? 1 : -1) : v[i])
                       : (float)((double)v[i] + amount * test_uniform(-1.0, 1.0));
        length += (double)moved[i] * (double)moved[i];
    }
    length = sqrt(length);
    if (!(length > 1e-3) || (one && fabs(length - 1.0) > 2e-7))
        return;
    for (int i = 0; i < count; i++)
        v[i] = one ? moved[i] : (float)((double)moved[i] / length);
}

/* Towards another light, by a little or by much; or an ulp of one coefficient. */
static inline void stress_nudge_light(float c[9]) {
    float other[9];
    const double t = ldexp(test_uniform(0.0, 1.0), -test_below(24)), size = (double)c[SH_R0];
    if (test_below(3) == 0) {
        const int i = test_below(9);
        c[i] = stress_next(c[i], test_below(2) ? 1 : -1);
        return;
    }
    stress_fill_light(STRESS_UNIFORM, other);
    for (int i = 0; i < 9; i++)
        c[i] = (float)((1.0 - t) * (double)c[i] + t * size * (double)other[i]);
}

static inline void stress_nudge_slot(const stress_slot *slot, float *in) {
    const int i = test_below(slot->count);
    switch (slot->kind) {
    case STRESS_LIGHT:
        stress_nudge_light(in + i / 9 * 9);
        break;
    case STRESS_DIRECTION:
        stress_nudge_unit(3, in + i / 3 * 3);
        break;
    case STRESS_ROTATION:
        stress_nudge_unit(4, in);
        break;
    case STRESS_NUMBER: {
        const float x = test_below(8) ? stress_nudge(in[i]) : stress_fill_number(STRESS_UNIFORM, slot->low, slot->high);
        in[i] = (double)x < slot->low ? (float)slot->low : (double)x > slot->high ? (float)slot->high : x;
        break;
    }
    default:
        in[i] = test_below(16) ? stress_nudge(in[i]) : in[test_below(slot->count)];
        if (!(fabsf(in[i]) <= 1e18f))
            in[i] = 1e18f;
    }
}

static inline void stress_nudge_input(const stress_case *test, float *in) {
    int slots = 0;
    while (slots < STRESS_SLOTS && test->slot[slots].kind != STRESS_END)
        slots++;
    for (int changes = 1 + test_below(3); changes > 0; changes--) {
        const int chosen = test_below(slots);
        int at = 0;
        for (int s = 0; s < chosen; s++)
            at += test->slot[s].count;
        stress_nudge_slot(&test->slot[chosen], in + at);
    }
}

/* One input of which much is known. */
typedef struct stress_found {
    long double error;
    int nan;
    stress_class kind;
    float in[STRESS_FLOATS];
} stress_found;

enum { STRESS_KEPT = 6 };

/* What a search found: the worst of uniform input, the worst of all and the inputs that are to be climbed from. */
typedef struct stress_search {
    long double uniform, worst;
    int nan, climbed; /* climbed: the worst was found by climbing from `kind` */
    stress_class kind;
    stress_found kept[STRESS_KEPT];
    float in[STRESS_FLOATS]; /* the worst */
} stress_search;

static inline long double stress_evaluate(const stress_case *test, const float *in, int *nan) {
    stress_measure m = { test->unit, stress_allowance(in, stress_size(test)), 0.0L, 0 };
    test->measure(in, &m);
    *nan |= m.nan;
    return m.worst;
}

static inline void stress_note(stress_search *search, const float *in, int size, long double error, stress_class kind,
                               int climbed) {
    if (!(error > search->worst))
        return;
    search->worst = error;
    search->kind = kind;
    search->climbed = climbed;
    memcpy(search->in, in, (size_t)size * sizeof *in);
}

static inline void stress_keep(stress_search *search, const float *in, int size, long double error, stress_class kind) {
    int least = 0;
    for (int i = 1; i < STRESS_KEPT; i++)
        if (search->kept[i].error < search->kept[least].error)
            least = i;
    if (!(error > search->kept[least].error))
        return;
    search->kept[least].error = error;
    search->kept[least].kind = kind;
    memcpy(search->kept[least].in, in, (size_t)size * sizeof *in);
}

/* `count` inputs of each class, and then as many steps from each of those kept. */
static inline void stress_run(const stress_case *test, int count, stress_search *search) {
    const int size = stress_size(test);
    float in[STRESS_FLOATS];
    memset(search, 0, sizeof *search);
    for (int kind = 0; kind < STRESS_CLASSES; kind++)
        for (int i = 0; i < count; i++) {
            stress_fill(test, (stress_class)kind, in);
            const long double found = stress_evaluate(test, in, &search->nan);
            const long double error = kind == STRESS_ZERO ? 0.0L : found; /* not a direction: only NaN counts */
            if (kind == STRESS_UNIFORM)
                search->uniform = fmaxl(search->uniform, error);
            stress_note(search, in, size, error, (stress_class)kind, 0);
            stress_keep(search, in, size, error, (stress_class)kind);
        }
    for (int k = 0; k < STRESS_KEPT; k++) {
        stress_found *found = &search->kept[k];
        for (int i = 0; i < count && found->error > 0.0L; i++) {
            memcpy(in, found->in, (size_t)size * sizeof *in);
            stress_nudge_input(test, in);
            const long double error = stress_evaluate(test, in, &search->nan);
            stress_note(search, in, size, error, found->kind, 1);
            if (error >= found->error) {
                found->error = error;
                memcpy(found->in, in, (size_t)size * sizeof *in);
            }
        }
    }
}

/* ---- The table ------------------------------------------------------------------------------------------------------------------ */

static inline void stress_print_error(stress_unit unit, long double error) {
    printf(unit == STRESS_ULP ? "%.2f ulp" : unit == STRESS_RELATIVE ? "%.1e" : "%.2f of it", (double)error);
}

/* A cell of a table, where | separates cells. */
static inline void stress_print_cell(const char *text) {
    printf("| ");
    for (; *text; text++)
        printf(*text == '|' ? "\\|" : "%c", *text);
    printf(" ");
}

/* What a class means to a case. */
static inline const char *stress_class_name(const stress_case *test, stress_class kind) {
    int directed = 0;
    for (int s = 0; s < STRESS_SLOTS; s++) {
        const stress_kind slot = test->slot[s].kind;
        directed |= slot == STRESS_DIRECTION || slot == STRESS_ROTATION || (slot == STRESS_LIGHT && kind == STRESS_AXES);
        if (slot == STRESS_TEXELS && kind == STRESS_AXES)
            return "one sun of 1e9";
        if (slot == STRESS_TEXELS && kind == STRESS_STRUCTURED)
            return "equal texels";
    }
    return stress_class_names[kind >= STRESS_AXES && !directed ? STRESS_UNIFORM : kind];
}

/* Runs a case and prints its row; returns whether the claim holds. */
static inline int stress_row(const stress_case *test, int count) {
    static stress_search search;
    const int some = count / test->cost > 8 ? count / test->cost : 8;
    uint64_t seed = 5381;
    for (const char *p = test->name; *p; p++)
        seed = seed * 33 + (unsigned char)*p;
    test_seed(seed);
    stress_run(test, some, &search);
    const int holds = !search.nan && search.worst <= (long double)test->limit;
    stress_print_cell(test->name);
    stress_print_cell(test->claim);
    printf("| ");
    stress_print_error(test->unit, search.uniform);
    printf(" | %s", holds ? "" : "**");
    stress_print_error(test->unit, search.worst);
    printf("%s | ", holds ? "" : search.nan ? " NaN**" : "**");
    if (search.worst > 0.0L)
        printf("%s%s", stress_class_name(test, search.kind), search.climbed ? ", climbed" : "");
    printf(" |\n");
    if (!holds) {
        fprintf(stderr, "%s:", test->name);
        for (int i = 0; i < stress_size(test) && i < 40; i++)
            fprintf(stderr, " %.9g", (double)search.in[i]);
        fprintf(stderr, "\n");
    }
    return holds;
}

#endif /* STRESS_H */
