/* NaN, infinities, signalling NaN, negative zero, overflow: what each function makes of them. docs/accuracy.md has the table. */
#include <float.h>

#include "images.h"
#include "square_maps.h"

/* ---- NaN in, NaN out -------------------------------------------------------------------------------------------------------------
 * Every function of numbers, with the numbers that it reads: A, B sets of nine; a, b their first four; D, E unit vectors of three;
 * 1, 2, 3 scalars. */

enum { SET_A = 0, SET_B = 9, DIR_D = 18, DIR_E = 21, SCALAR = 24, INPUTS = 27, OUTPUTS = 32 };

typedef struct function {
    const char *name, *reads;
    int outputs;
    void (*run)(const float *in, float *out);
} function;

#define RUN(name) static void name(const float *in, float *out)
#define A (in + SET_A)
#define B (in + SET_B)
#define D (in + DIR_D)
#define E (in + DIR_E)
#define S(i) (in[SCALAR + (i) - 1])

RUN(run_basis) { sh_basis(SH_L2, D, out); }
RUN(run_add_sample) { memcpy(out, A, 36); sh_add_sample(SH_L2, D, S(1), out); }
RUN(run_scale) { sh_scale(SH_L2, A, S(1), out); }
RUN(run_madd) { memcpy(out, B, 36); sh_madd(SH_L2, A, S(1), out); }
RUN(run_lerp) { sh_lerp(SH_L2, A, B, S(1), out); }
RUN(run_dot) { out[0] = sh_dot(SH_L2, A, B); }
RUN(run_radiance) { out[0] = sh_radiance(SH_L2, A, D); }
RUN(run_irradiance) { out[0] = sh_irradiance(SH_L2, A, D); }
RUN(run_opposite) { out[0] = sh_irradiance_opposite(SH_L1, A, D, S(1)); }
RUN(run_ao) { out[0] = sh_irradiance_ao(SH_L2, A, D, S(1)); }
RUN(run_bounds_l1) { sh_irradiance_bounds(SH_L1, A, D, out, out + 1); }
RUN(run_bounds_l2) { sh_irradiance_bounds(SH_L2, A, D, out, out + 1); }
RUN(run_closure_l1) { out[0] = sh_irradiance_closure(SH_L1, A, D); }
RUN(run_closure_l2) { out[0] = sh_irradiance_closure(SH_L2, A, D); }
RUN(run_closure_floor) {
    sh_closure closure;
    sh_closure_prepare(SH_L2, 1, A, SH_AMBIENT_FLOOR, &closure);
    out[0] = sh_closure_irradiance(SH_L2, &closure, D);
}
RUN(run_closure_batch) { sh_irradiance_closure_batch(SH_L2, 1, A, D, D + 1, D + 2, out, 1); }
RUN(run_closure_batch_l1) { sh_irradiance_closure_batch_aos(SH_L1, 1, A, D, 0, out, 0, 1); }
RUN(run_geomerics) { out[0] = sh_irradiance_geomerics(A, D); }
RUN(run_zh3) { out[0] = sh_irradiance_zh3(A, D); }
RUN(run_geomerics_batch) { sh_irradiance_geomerics_batch(SH_L1, 1, A, D, D + 1, D + 2, out, 1); }
RUN(run_zh3_batch) { sh_irradiance_zh3_batch(SH_L1, 1, A, D, D + 1, D + 2, out, 1); }
RUN(run_zonal_ao) { sh_zonal_ao(S(1), out); }
RUN(run_zonal_cap) { sh_zonal_cap(S(1), out); }
RUN(run_zonal_vmf) { sh_zonal_vmf(S(1), out); }
RUN(run_zonal_hann) { sh_zonal_hann(S(1), out); }
RUN(run_zonal_lanczos) { sh_zonal_lanczos(S(1), out); }
RUN(run_zonal_laplacian) { sh_zonal_laplacian(S(1), out); }
RUN(run_zonal_cosine_power) { sh_zonal_cosine_power(S(1), out); }
RUN(run_zonal_ggx) { sh_zonal_ggx(S(1), out); }
RUN(run_zonal_sharpness) { sh_zonal_sharpness(S(1), out); }
RUN(run_convolve) { sh_convolve(SH_L2, A, &S(1), out); }
RUN(run_zonal_add) { memcpy(out, A, 36); sh_zonal_add(SH_L2, &S(1), D, 0.5f, out); }
RUN(run_radiance_zonal) { out[0] = sh_radiance_zonal(SH_L2, A, &S(1), D); }
RUN(run_directionality) { out[0] = sh_directionality(A); }
RUN(run_average_direction) { out[0] = sh_average_direction(A, out + 1); }
RUN(run_dominant) { sh_dominant_light(SH_L1, 1, A, out, out + 3, out + 4); }
RUN(run_min) {
    float at[3];
    out[0] = sh_min(SH_L2, A, at);
}
RUN(run_max) {
    float at[3];
    out[0] = sh_max(SH_L2, A, at);
}
RUN(run_irradiance_min) { out[0] = sh_irradiance_min(SH_L2, A, NULL); }
RUN(run_irradiance_max) { out[0] = sh_irradiance_max(SH_L2, A, NULL); }
RUN(run_ambient_floor) { out[0] = sh_ambient_floor(A); }
RUN(run_dering) { sh_dering(SH_L2, 1, A, SH_WINDOW_HANN, out); }
RUN(run_product) { sh_product(SH_L2, A, B, out); }
RUN(run_product_batch) { sh_product_batch(SH_L2, A, B, out, 1); }
RUN(run_rotate) { sh_rotate(SH_L2, A, B, out); }
RUN(run_rotate_batch) { sh_rotate_batch(SH_L2, A, B, out, 1); }
RUN(run_quaternion) { sh_rotation_from_quaternion(A, out); }
RUN(run_axes) { sh_z_up_to_y_up(SH_L2, A, out); }
RUN(run_reflect) { sh_reflect(D, E, out); }
RUN(run_ambient) { memcpy(out, A, 36); sh_add_ambient(SH_L2, 1, &S(1), out); }
RUN(run_directional) { memcpy(out, A, 36); sh_add_directional(SH_L2, 1, D, &S(1), out); }
RUN(run_hemisphere) { memcpy(out, A, 36); sh_add_hemisphere(SH_L2, 1, D, &S(1), &S(2), out); }
RUN(run_cap) { memcpy(out, A, 36); sh_add_cap(SH_L2, 1, D, S(1), SH_RADIANCE, &S(2), out); }
RUN(run_sphere) { memcpy(out, A, 36); sh_add_sphere(SH_L2, 1, D, S(1), SH_IRRADIANCE, &S(2), out); }
RUN(run_vmf) { memcpy(out, A, 36); sh_add_vmf(SH_L2, 1, D, S(1), SH_RADIANCE, &S(2), out); }
RUN(run_rectangle) { sh_add_rectangle(SH_L2, 1, A, D, E, &S(1), out); }
RUN(run_polygon) { sh_add_polygon(SH_L2, 1, A, 3, &S(1), out); }
RUN(run_disk) { sh_add_disk(SH_L2, 1, D, E, S(2), &S(1), out); }
RUN(run_segment) { sh_add_segment(SH_L2, 1, D, E, S(2), &S(1), out); }
RUN(run_spheres) {
    const float sphere[4] = { D[0], D[1], D[2], S(2) };
    sh_add_spheres(SH_L2, 1, sphere, &S(1), 1, 1e-3f, out);
}
RUN(run_to_orthonormal) { sh_to_orthonormal(SH_L2, A, SH_CONDON_SHORTLEY, out); }
RUN(run_from_orthonormal) { sh_from_orthonormal(SH_L2, A, 0, out); }
RUN(run_to_unity) { sh_to_unity(SH_L2, A, out); }
RUN(run_from_unity) { sh_from_unity(SH_L2, A, out); }
RUN(run_to_babylon) { sh_to_babylon(A, out); }
RUN(run_from_babylon) { sh_from_babylon(A, out); }
RUN(run_pack_shader) {
    float three[27];
    for (int k = 0; k < 3; k++)
        memcpy(three + 9 * k, A, 36);
    sh_pack_shader(three, out);
}
RUN(run_truncate) { sh_truncate(SH_L2, 1, A, SH_L2, out); }
RUN(run_interleave) { sh_interleave(SH_L2, 1, A, out); }
RUN(run_radiance_batch) { sh_radiance_batch(SH_L2, 1, A, D, D + 1, D + 2, out, 1); }
RUN(run_irradiance_batch) { sh_irradiance_batch_aos(SH_L2, 1, A, D, 0, out, 0, 1); }
RUN(run_probes_batch) { sh_irradiance_probes_batch(SH_L2, 1, A, D, D + 1, D + 2, out, 1); }
RUN(run_samples) { sh_project_samples(SH_L2, 1, D, D + 1, D + 2, &S(1), &S(2), 1, out); }
RUN(run_accum) {
    sh_accum accum;
    sh_accum_clear(1, &accum);
    sh_accum_sample(SH_L2, D, S(1), S(2), &accum);
    sh_accum_finish(SH_L2, 1, &accum, out);
}

static const function functions[] = {
    { "sh_basis", "D", 9, run_basis },
    { "sh_add_sample", "AD1", 9, run_add_sample },
    { "sh_scale", "A1", 9, run_scale },
    { "sh_madd", "AB1", 9, run_madd },
    { "sh_lerp", "AB1", 9, run_lerp },
    { "sh_dot", "AB", 1, run_dot },
    { "sh_radiance", "AD", 1, run_radiance },
    { "sh_irradiance", "AD", 1, run_irradiance },
    { "sh_irradiance_opposite", "D1", 1, run_opposite },
    { "sh_irradiance_ao", "AD1", 1, run_ao },
    { "sh_irradiance_bounds, L1", "aD", 2, run_bounds_l1 },
    { "sh_irradiance_bounds, L2", "AD", 2, run_bounds_l2 },
    { "sh_irradiance_closure, L1", "aD", 1, run_closure_l1 },
    { "sh_irradiance_closure, L2", "AD", 1, run_closure_l2 },
    { "sh_closure_irradiance, over the ambient floor", "AD", 1, run_closure_floor },
    { "sh_irradiance_closure_batch", "AD", 1, run_closure_batch },
    { "sh_irradiance_closure_batch_aos, L1", "aD", 1, run_closure_batch_l1 },
    { "sh_irradiance_geomerics", "aD", 1, run_geomerics },
    { "sh_irradiance_zh3", "aD", 1, run_zh3 },
    { "sh_irradiance_geomerics_batch", "aD", 1, run_geomerics_batch },
    { "sh_irradiance_zh3_batch", "aD", 1, run_zh3_batch },
    { "sh_zonal_ao", "1", 3, run_zonal_ao },
    { "sh_zonal_cap", "1", 3, run_zonal_cap },
    { "sh_zonal_vmf", "1", 3, run_zonal_vmf },
    { "sh_zonal_hann", "1", 3, run_zonal_hann },
    { "sh_zonal_lanczos", "1", 3, run_zonal_lanczos },
    { "sh_zonal_laplacian", "1", 3, run_zonal_laplacian },
    { "sh_zonal_cosine_power", "1", 3, run_zonal_cosine_power },
    { "sh_zonal_ggx", "1", 3, run_zonal_ggx },
    { "sh_zonal_sharpness", "1", 3, run_zonal_sharpness },
    { "sh_convolve", "A123", 9, run_convolve },
    { "sh_zonal_add", "AD123", 9, run_zonal_add },
    { "sh_radiance_zonal", "AD123", 1, run_radiance_zonal },
    { "sh_directionality", "a", 1, run_directionality },
    { "sh_average_direction", "x", 4, run_average_direction },
    { "sh_dominant_light", "a", 5, run_dominant },
    { "sh_min", "A", 1, run_min },
    { "sh_max", "A", 1, run_max },
    { "sh_irradiance_min", "A", 1, run_irradiance_min },
    { "sh_irradiance_max", "A", 1, run_irradiance_max },
    { "sh_ambient_floor", "A", 1, run_ambient_floor },
    { "sh_dering", "A", 9, run_dering },
    { "sh_product", "AB", 9, run_product },
    { "sh_product_batch", "AB", 9, run_product_batch },
    { "sh_rotate", "AB", 9, run_rotate },
    { "sh_rotate_batch", "AB", 9, run_rotate_batch },
    { "sh_rotation_from_quaternion", "a", 9, run_quaternion },
    { "sh_swap_axes", "A", 9, run_axes },
    { "sh_reflect", "DE", 3, run_reflect },
    { "sh_add_ambient", "A1", 9, run_ambient },
    { "sh_add_directional", "AD1", 9, run_directional },
    { "sh_add_hemisphere", "AD12", 9, run_hemisphere },
    { "sh_add_cap", "AD12", 9, run_cap },
    { "sh_add_sphere", "AD12", 9, run_sphere },
    { "sh_add_vmf", "AD12", 9, run_vmf },
    { "sh_add_rectangle", "DE1", 9, run_rectangle },
    { "sh_add_polygon", "A1", 9, run_polygon },
    { "sh_add_disk", "DE12", 9, run_disk },
    { "sh_add_segment", "DE12", 9, run_segment },
    { "sh_add_spheres", "D12", 9, run_spheres },
    { "sh_to_orthonormal", "A", 9, run_to_orthonormal },
    { "sh_from_orthonormal", "A", 9, run_from_orthonormal },
    { "sh_to_unity", "A", 9, run_to_unity },
    { "sh_from_unity", "A", 9, run_from_unity },
    { "sh_to_babylon", "A", 9, run_to_babylon },
    { "sh_from_babylon", "A", 9, run_from_babylon },
    { "sh_pack_shader", "A", 28, run_pack_shader },
    { "sh_truncate", "A", 9, run_truncate },
    { "sh_interleave", "A", 9, run_interleave },
    { "sh_radiance_batch", "AD", 1, run_radiance_batch },
    { "sh_irradiance_batch_aos", "AD", 1, run_irradiance_batch },
    { "sh_irradiance_probes_batch", "AD", 1, run_probes_batch },
    { "sh_project_samples", "D12", 9, run_samples },
    { "sh_accum_sample", "D12", 9, run_accum },
};

/* Where the numbers of a letter are. */
static void range(char letter, int *first, int *count) {
    static const struct {
        char letter;
        int first, count;
    } ranges[] = { { 'A', SET_A, 9 }, { 'a', SET_A, 4 }, { 'x', SET_A + 1, 3 }, { 'B', SET_B, 9 },     { 'D', DIR_D, 3 },
                   { 'E', DIR_E, 3 }, { '1', SCALAR, 1 }, { '2', SCALAR + 1, 1 }, { '3', SCALAR + 2, 1 } };
    size_t i = 0;
    while (ranges[i].letter != letter)
        i++;
    *first = ranges[i].first;
    *count = ranges[i].count;
}

/* A sun and ambient light, or with R1 = 0; a matrix that is nearly a rotation; directions; scalars in (0, 1). */
static void good_input(int variant, float in[INPUTS]) {
    static const float suns[3][9] = { { 1.0f, 0.3f, -0.2f, 0.4f, 0.02f, -0.06f, 0.12f, -0.05f, -0.08f },
                                      { 1.0f, 0.0f, 0.0f, 0.0f, 0.1f, 0.0f, 0.0f, 0.1f, 0.0f },
                                      { 1.0f, 0.0f, 0.0f, 0.999f, -0.333f, 0.0f, 0.0f, -0.333f, 0.0f } };
    static const float turn[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f };
    static const float rest[9] = { 0.6f, 0.0f, 0.8f, 0.48f, 0.64f, 0.6f, 0.5f, 0.25f, 0.75f };
    memcpy(in + SET_A, suns[variant], sizeof suns[variant]);
    memcpy(in + SET_B, turn, sizeof turn);
    memcpy(in + DIR_D, rest, sizeof rest);
}

static float signalling_nan(void) {
    const uint32_t bits = 0x7fa00000u;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static int is_nan(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x7fffffffu) > 0x7f800000u;
}

/* Runs it; nothing is written after its outputs. */
static int any_nan(const function *f, const float *in) {
    float out[OUTPUTS + 1];
    int any = 0;
    for (int i = 0; i <= OUTPUTS; i++)
        out[i] = i < f->outputs ? 0.0f : 1.25f;
    f->run(in, out);
    for (int i = 0; i <= OUTPUTS; i++)
        if (i < f->outputs)
            any |= is_nan(out[i]);
        else
            NEAR(out[i], 1.25, 0);
    return any;
}

static void nan_in_nan_out(void) {
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        const function *f = &functions[i];
        for (int variant = 0; variant < 3; variant++)
            for (const char *letter = f->reads; *letter; letter++) {
                int first, count;
                range(*letter, &first, &count);
                for (int j = first; j < first + count; j++) {
                    float in[INPUTS];
                    good_input(variant, in);
                    test_section("%s, number %d of %c, variant %d", f->name, j - first, *letter, variant);
                    CHECK(!any_nan(f, in));
                    in[j] = (float)NAN;
                    CHECK(any_nan(f, in));
                    const float signalling = signalling_nan();
                    memcpy(in + j, &signalling, sizeof signalling);
                    CHECK(any_nan(f, in));
                    in[j] = -0.0f;
                    CHECK(!any_nan(f, in));
                }
            }
    }
}

/* ---- Decisions: a number that is not one never passes for little, or for light: its band is kept ---------------------------------- */

static void decisions(void) {
    const float bad[3] = { (float)NAN, (float)INFINITY, -(float)INFINITY };
    for (int b = 0; b < 3; b++)
        for (int i = 0; i < 9; i++) {
            float in[INPUTS], sets[18];
            size_t index[1], first[4];
            good_input(0, in);
            in[i] = bad[b];
            memcpy(sets, in, 36);
            good_input(0, in);
            memcpy(sets + 9, in, 36);
            test_section("decisions, %g at %d", (double)bad[b], i);
            EQUAL(sh_order_needed(sets, 1e9f), i < 1 ? SH_L0 : i < 4 ? SH_L1 : SH_L2);
            EQUAL(sh_radiance_order_needed(sets, 1e9f), i < 1 ? SH_L0 : i < 4 ? SH_L1 : SH_L2);
            EQUAL(sh_is_grey(SH_L2, 2, sets, 1e9f), 0);
            if (b != 1 || i > 0)
                EQUAL(sh_is_realizable(SH_L2, sets), 0);
            sh_group_by_order(1, sets, 1, 1e9f, index, first);
            EQUAL(index[0], 0);
            EQUAL(first[i < 1 ? 1 : i < 4 ? 2 : 3] - first[i < 1 ? 0 : i < 4 ? 1 : 2], 1);
        }
    const float nan = (float)NAN;
    float budget = 1.0f, in[INPUTS];
    test_section("decisions, tolerance or light NaN");
    good_input(0, in);
    EQUAL(sh_skip_light(nan, &budget), 0);
    NEAR(budget, 1.0, 0);
    EQUAL(sh_skip_light((float)INFINITY, &budget), 0);
    budget = nan;
    EQUAL(sh_skip_light(0.0f, &budget), 0);
    EQUAL(sh_order_needed(in, nan), SH_L2);
    EQUAL(sh_is_grey(SH_L2, 2, in, nan), 0);
    EQUAL(sh_equirect_size_for(SH_L2, nan), 1 << 24);
    EQUAL(sh_cubemap_size_for(SH_L1, nan), 1 << 24);
    EQUAL(sh_equirect_size_for(SH_L2, 0.0f), 1 << 24);
    const float dim = 1e-9f;
    for (int i = 0; i < 4; i++) {
        float sphere[4] = { 0.0f, 0.0f, 10.0f, 1.0f }, c[9] = { 0 };
        test_section("decisions, sphere with NaN at %d", i);
        EQUAL(sh_add_spheres(SH_L2, 1, sphere, &dim, 1, 1e-3f, c), 0);
        sphere[i] = nan;
        EQUAL(sh_add_spheres(SH_L2, 1, sphere, &dim, 1, 1e-3f, c), 1);
    }
}

/* One bad vertex, or one bad number of a quaternion, spoils everything: nothing finite is left that could be wrong. */
static void all_nan(void) {
    const float one = 1.0f;
    for (int i = 0; i < 12; i++) {
        float vertices[12] = { 0.5f, 0.0f, 1.0f, 0.0f, 0.5f, 1.0f, -0.5f, 0.0f, 1.0f, 0.0f, -0.5f, 1.0f }, c[9] = { 0 };
        vertices[i] = (float)NAN;
        test_section("polygon with NaN at %d", i);
        EQUAL(sh_add_polygon(SH_L2, 1, vertices, 4, &one, c), SH_OK);
        for (int k = 0; k < 9; k++)
            CHECK(is_nan(c[k]));
    }
    for (int i = 0; i < 4; i++) {
        float q[4] = { 0 }, m[9];
        q[i] = (float)NAN;
        test_section("quaternion with NaN at %d", i);
        sh_rotation_from_quaternion(q, m);
        for (int k = 0; k < 9; k++)
            CHECK(is_nan(m[k]));
    }
}

/* A channel that is NaN has no say in the window of the others. */
static void dering_of_one(void) {
    float in[INPUTS], sets[18], out[18], alone[9];
    test_section("a NaN channel beside one that rings");
    good_input(2, in);
    memcpy(sets, in, 36);
    memcpy(sets + 9, in, 36);
    sets[3] = (float)NAN;
    sh_dering(SH_L2, 2, sets, SH_WINDOW_HANN, out);
    sh_dering(SH_L2, 1, in, SH_WINDOW_HANN, alone);
    SAME_BITS(out + 9, alone, sizeof alone);
    CHECK(alone[3] < in[3]);
}

/* ---- Batches: an item that is NaN costs no other ------------------------------------------------------------------------------- */

enum { ITEMS = 21, BAD_ITEM = 10 };

typedef void (*batch)(const float *sets, const float *x, const float *y, const float *z, float *out);

static void batch_radiance(const float *sets, const float *x, const float *y, const float *z, float *out) {
    sh_radiance_batch(SH_L2, 1, sets, x, y, z, out, ITEMS);
}
static void batch_closure(const float *sets, const float *x, const float *y, const float *z, float *out) {
    sh_irradiance_closure_batch(SH_L2, 1, sets, x, y, z, out, ITEMS);
}
static void batch_geomerics(const float *sets, const float *x, const float *y, const float *z, float *out) {
    sh_irradiance_geomerics_batch(SH_L1, 1, sets, x, y, z, out, ITEMS);
}
static void batch_probes(const float *sets, const float *x, const float *y, const float *z, float *out) {
    sh_irradiance_probes_batch(SH_L2, 1, sets, x, y, z, out, ITEMS);
}

static void one_item(void) {
    static const batch batches[] = { batch_radiance, batch_closure, batch_geomerics, batch_probes };
    float in[INPUTS], sets[9 * ITEMS], dir[3][ITEMS], good[ITEMS], out[ITEMS];
    good_input(0, in);
    for (int i = 0; i < ITEMS; i++) {
        float d[3];
        memcpy(sets + 9 * i, in, 36);
        test_direction(d);
        for (int k = 0; k < 3; k++)
            dir[k][i] = d[k];
    }
    for (size_t b = 0; b < sizeof batches / sizeof batches[0]; b++)
        for (int k = 0; k < 3; k++) {
            const float kept = dir[k][BAD_ITEM];
            test_section("batch %d, one normal NaN", (int)b);
            batches[b](sets, dir[0], dir[1], dir[2], good);
            dir[k][BAD_ITEM] = (float)NAN;
            batches[b](sets, dir[0], dir[1], dir[2], out);
            dir[k][BAD_ITEM] = kept;
            CHECK(is_nan(out[BAD_ITEM]));
            out[BAD_ITEM] = good[BAD_ITEM];
            SAME_BITS(out, good, sizeof good);
        }
}

/* ---- Infinite and extreme arguments that have a meaning ------------------------------------------------------------------------ */

static void infinite_arguments(void) {
    const float inf = (float)INFINITY, whole[3] = { 1.0f, 1.0f, 1.0f }, none[3] = { 1.0f, 0.0f, 0.0f }, dir[3] = { 0.0f, 0.0f, 1.0f };
    float zonal[3], c[9] = { 0 };
    test_section("infinite widths, sharpness, exponents");
    sh_zonal_vmf(inf, zonal);
    NEAR_ALL(zonal, whole, 3, 0);
    sh_zonal_cosine_power(inf, zonal);
    NEAR_ALL(zonal, whole, 3, 0);
    sh_zonal_hann(inf, zonal);
    NEAR_ALL(zonal, whole, 3, 0);
    sh_zonal_lanczos(inf, zonal);
    NEAR_ALL(zonal, whole, 3, 0);
    sh_zonal_laplacian(inf, zonal);
    NEAR_ALL(zonal, none, 3, 0);
    sh_zonal_hann(-1.0f, zonal);
    NEAR_ALL(zonal, none, 3, 0);
    sh_zonal_lanczos(0.0f, zonal);
    NEAR_ALL(zonal, none, 3, 0);
    sh_zonal_ggx(inf, zonal);
    NEAR(zonal[1], 2.0 / 3.0, 1e-7);
    test_section("lights of no size");
    const float one = 1.0f, side[3] = { 1.0f, 0.0f, 1.0f };
    sh_add_segment(SH_L2, 1, dir, dir, 1.0f, &one, c);
    sh_add_segment(SH_L2, 1, dir, side, 0.0f, &one, c);
    sh_add_disk(SH_L2, 1, dir, dir, -1.0f, &one, c);
    for (int i = 0; i < 9; i++)
        NEAR(c[i], 0, 0);
}

/* ---- Storage: what is not finite is stored as 0 and leaves the rest alone ------------------------------------------------------ */

static void storage(void) {
    const float bad[4] = { (float)NAN, (float)INFINITY, -(float)INFINITY, signalling_nan() };
    for (int b = 0; b < 4; b++)
        for (int i = 0; i < 9; i++) {
            float in[INPUTS], out[9], r0;
            uint16_t half[10];
            uint8_t ratio8[8];
            uint32_t ratio10[3];
            good_input(0, in);
            memcpy(in + i, bad + b, sizeof bad[b]);
            test_section("storage of %g at %d", (double)bad[b], i);
            sh_pack_half(SH_L2, 1, in, half);
            sh_unpack_half(SH_L2, 1, half, out);
            for (int k = 0; k < 9; k++)
                NEAR(out[k], k == i ? 0.0f : in[k], 0.0005);
            sh_pack_unorm8(SH_L2, 1, in, &r0, ratio8);
            sh_unpack_unorm8(SH_L2, 1, &r0, ratio8, out);
            for (int k = 1; k < 9 && i > 0; k++)
                NEAR(out[k], k != i ? in[k] : 0.0f, k == i ? 1.0 : 0.004); /* clamped to the range of ratios */
            sh_pack_unorm10(SH_L2, 1, in, &r0, ratio10);
            sh_unpack_unorm10(SH_L2, 1, &r0, ratio10, out);
            for (int k = 1; k < 9 && i > 0; k++)
                CHECK(fabsf(out[k]) <= 1.0f);
        }
    /* Halves themselves would overflow at 65520 and vanish below 3e-8: the common exponent keeps both. */
    const float sizes[] = { 1e-45f, 1e-38f, 1e-9f, 65504.0f, 65520.0f, 1e9f, 1e18f, 3e38f };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        float set[9] = { 0 }, out[9];
        uint16_t half[10];
        set[0] = sizes[s];
        set[3] = -sizes[s];
        test_section("halves of %g", (double)sizes[s]);
        sh_pack_half(SH_L2, 1, set, half);
        sh_unpack_half(SH_L2, 1, half, out);
        NEAR_ALL(out, set, 9, (double)sizes[s] / 1024.0 + 1e-45);
    }
}

/* ---- Samples and fits --------------------------------------------------------------------------------------------------------- */

static void bad_value(const float dir[3], float *value, void *user) {
    (void)user;
    value[0] = dir[2] > 0.5f ? (float)NAN : 1.0f;
    value[1] = 1.0f;
}

/* Samples are not looked at: one that is NaN costs its channel, and no other. */
static void samples(void) {
    enum { N = 40 };
    float x[N], y[N], z[N], value[2 * N], c[18], before[18];
    test_section("samples");
    for (int i = 0; i < N; i++) {
        float dir[3];
        sh_direction_fibonacci((uint32_t)i, N, dir);
        x[i] = dir[0];
        y[i] = dir[1];
        z[i] = dir[2];
        value[i] = value[N + i] = 1.0f;
    }
    value[7] = (float)NAN;
    EQUAL(sh_project_samples(SH_L2, 2, x, y, z, value, NULL, N, c), SH_OK);
    for (int i = 0; i < 9; i++) {
        CHECK(is_nan(c[i]));
        CHECK(!is_nan(c[9 + i]));
    }
    EQUAL(sh_fit_samples(SH_L2, 2, x, y, z, value, NULL, N, NULL, 0.0f, c), SH_OK);
    for (int i = 0; i < 9; i++) {
        CHECK(is_nan(c[i]));
        CHECK(!is_nan(c[9 + i]));
    }
    EQUAL(sh_project_function(SH_L2, 2, bad_value, NULL, 4, c), SH_OK);
    CHECK(is_nan(c[0]));
    NEAR(c[9], 1.0, 1e-6);
    memcpy(before, c, sizeof c);
    x[3] = (float)INFINITY;
    EQUAL(sh_fit_samples(SH_L2, 2, x, y, z, value, NULL, N, NULL, 0.0f, c), SH_ERROR_ARGUMENT);
    SAME_BITS(c, before, sizeof c);
}

/* ---- Images: one bad texel never costs more than itself ------------------------------------------------------------------------ */

enum { SIDE = 8 };

/* Any of the three maps, of SIDE rows, from one run of texels. */
static int project(int map, const void *texels, sh_format format, int channels, unsigned flags, float *c, sh_report *report) {
    const size_t size = format == SH_F16 ? 2 : 4, face_bytes = SIDE * SIDE * (size_t)channels * size;
    sh_image face[6];
    for (int i = 0; i < 6; i++) {
        const unsigned char *first = (const unsigned char *)texels + (map == 1 ? (size_t)i * face_bytes : 0);
        const sh_image one = { first, map ? (int)SIDE : 2 * SIDE, SIDE, 0, channels, format };
        face[i] = one;
    }
    return map == 0   ? sh_project_equirect(SH_L2, face, flags, c, report)
           : map == 1 ? sh_project_cubemap(SH_L2, face, flags, c, report)
                      : sh_project_octahedral(SH_L2, face, flags, c, report);
}

static int texels_of(int map) {
    return map == 0 ? 2 * SIDE * SIDE : map == 1 ? 6 * SIDE * SIDE : SIDE * SIDE;
}

static void bad_texels(void) {
    const float bad[4] = { (float)NAN, (float)INFINITY, -(float)INFINITY, signalling_nan() };
    float texels[6 * SIDE * SIDE * 3], c[27], expected[27];
    for (int map = 0; map < 3; map++)
        for (int i = 0; i < 200; i++) {
            const int at = test_below(texels_of(map)), channel = test_below(3);
            sh_report report = { 0, 0, 0 };
            test_section("map %d, %g at %d of texel %d", map, (double)bad[i % 4], channel, at);
            test_fill(texels, (size_t)(3 * texels_of(map)), 0.5, 1.0);
            for (int k = 0; k < 3; k++)
                texels[3 * at + k] = 0.0f;
            EQUAL(project(map, texels, SH_F32, 3, 0, expected, NULL), SH_OK);
            texels[3 * at + (channel + 1) % 3] = 0.7f; /* left out whole */
            memcpy(texels + 3 * at + channel, bad + i % 4, sizeof bad[0]);
            EQUAL(project(map, texels, SH_F32, 3, 0, c, &report), SH_OK);
            NEAR_ALL(c, expected, 27, 1e-6);
            EQUAL(report.nonfinite, 1);
            EQUAL(report.negative, 0);
            EQUAL(report.texels, texels_of(map));
            EQUAL(project(map, texels, SH_F32, 3, SH_CLAMP_NEGATIVE, c, NULL), SH_OK);
            NEAR_ALL(c, expected, 27, 1e-6);
        }
}

/* Negative values are kept, or count as 0; -0 is not negative. */
static void negative_texels(void) {
    float texels[6 * SIDE * SIDE], c[9], kept[9], clamped[9], black[9];
    for (int map = 0; map < 3; map++) {
        const int at = test_below(texels_of(map));
        sh_report report;
        test_section("map %d, negative texel %d", map, at);
        test_fill(texels, (size_t)texels_of(map), 0.5, 1.0);
        texels[at] = 0.0f;
        EQUAL(project(map, texels, SH_F32, 1, 0, black, NULL), SH_OK);
        texels[at] = -0.0f;
        EQUAL(project(map, texels, SH_F32, 1, 0, c, &report), SH_OK);
        EQUAL(report.negative, 0);
        NEAR_ALL(c, black, 9, 1e-7);
        texels[at] = -3.0f;
        EQUAL(project(map, texels, SH_F32, 1, 0, kept, &report), SH_OK);
        EQUAL(report.negative, 1);
        CHECK(kept[0] < black[0]);
        EQUAL(project(map, texels, SH_F32, 1, SH_CLAMP_NEGATIVE, clamped, &report), SH_OK);
        EQUAL(report.negative, 1);
        NEAR_ALL(clamped, black, 9, 1e-6);
    }
}

/* Halves: the largest, infinity, NaN, subnormal. Floats whose sum overflows. */
static void extreme_texels(void) {
    uint16_t half[6 * SIDE * SIDE];
    float texels[6 * SIDE * SIDE], c[9];
    for (int map = 0; map < 3; map++) {
        const int count = texels_of(map);
        sh_report report;
        for (int i = 0; i < count; i++)
            half[i] = 0x7bff; /* 65504 */
        test_section("map %d, largest halves", map);
        EQUAL(project(map, half, SH_F16, 1, 0, c, &report), SH_OK);
        NEAR(c[0], 65504.0, 0.1);
        EQUAL(report.nonfinite, 0);
        half[0] = 0x7c00;
        half[1] = 0xfc00;
        half[2] = 0x7e00;
        half[3] = 0x7d01;
        EQUAL(project(map, half, SH_F16, 1, 0, c, &report), SH_OK);
        EQUAL(report.nonfinite, 4);
        CHECK(c[0] < 65504.0f && c[0] > 50000.0f);
        for (int i = 0; i < count; i++)
            half[i] = 1; /* 2^-24 */
        EQUAL(project(map, half, SH_F16, 1, 0, c, NULL), SH_OK);
        RELATIVE(c[0], 5.9604644775390625e-8, 1e-6);
        const float sizes[] = { 3.4e38f, 1e18f, 1e-30f, 1e-38f };
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
            test_section("map %d, texels of %g", map, (double)sizes[s]);
            for (int i = 0; i < count; i++)
                texels[i] = sizes[s];
            EQUAL(project(map, texels, SH_F32, 1, 0, c, &report), SH_OK);
            RELATIVE(c[0], sizes[s], 1e-6);
            EQUAL(report.nonfinite, 0);
            for (int i = 1; i < 9; i++)
                NEAR(c[i], 0, (map == 2 ? 2e-3 : 2e-6) * (double)sizes[s] + 1e-42); /* few texels at their centres: not even */
        }
    }
}

static void run_tests(void) {
    nan_in_nan_out();
    decisions();
    all_nan();
    dering_of_one();
    one_item();
    infinite_arguments();
    storage();
    samples();
    bad_texels();
    negative_texels();
    extreme_texels();
}
