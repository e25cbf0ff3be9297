/* Octahedral maps: orientation, texels cut by an axis or the fold, what square maps have in common; and one light in all three maps. */
#include "square_maps.h"

static int project(int order, const sh_image *image, unsigned flags, float *c, sh_report *report) {
    return sh_project_octahedral(order, image, flags, c, report);
}

static int project_rows(int order, const sh_image *image, unsigned flags, int first, int count, sh_accum *accum, sh_report *report) {
    return sh_project_octahedral_rows(order, image, flags, first, count, accum, report);
}

static const square_map octahedral = { "octahedral map", 1, project, project_rows, octahedron_point, octahedron_share, 5e-6L, 0 };

/* The middle is +z, the corners are -z; u points to +x, v to +y. */
static void orientation(void) {
    enum { SIZE = 101 };
    static const struct {
        int x, y;
        float dir[3];
    } places[] = {
        { 50, 50, { 0, 0, 1 } },   { 0, 0, { 0, 0, -1 } },  { 100, 0, { 0, 0, -1 } }, { 0, 100, { 0, 0, -1 } },
        { 100, 100, { 0, 0, -1 } }, { 100, 50, { 1, 0, 0 } }, { 0, 50, { -1, 0, 0 } }, { 50, 100, { 0, 1, 0 } },
        { 50, 0, { 0, -1, 0 } },
    };
    square_images all = square_create(&octahedral, SIZE, 1, SH_F32, test_tight);
    square_set_all(&all, 0, 0.0f);
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        float c[9];
        test_section("light at %d %d", places[i].x, places[i].y);
        test_image_set(&all.of[0], places[i].x, places[i].y, 0, 1.0f);
        EQUAL(sh_project_octahedral(SH_L2, all.image, 0, c, NULL), SH_OK);
        test_image_set(&all.of[0], places[i].x, places[i].y, 0, 0.0f);
        for (int axis = 0; axis < 3; axis++)
            NEAR(c[SH_X + axis] / c[SH_R0], places[i].dir[axis], 0.025); /* edges are half a texel off */
    }
    square_free(&all);
}

/* A border of repeated texels is left out by pixels and row_stride. */
static void border(void) {
    enum { SIZE = 16, WITH_BORDER = SIZE + 2 };
    square_images inner = square_random(&octahedral, SIZE, 3, 0.0, 1.0);
    square_images outer = square_random(&octahedral, WITH_BORDER, 3, 5.0, 6.0);
    float a[3 * 9], b[3 * 9];
    test_section("a border");
    for (int y = 0; y < SIZE; y++)
        memcpy(test_texel(&outer.of[0], 1, y + 1), test_texel(&inner.of[0], 0, y), SIZE * 12);
    const sh_image inside = { test_texel(&outer.of[0], 1, 1), SIZE, SIZE, WITH_BORDER * 12, 3, SH_F32 };
    EQUAL(sh_project_octahedral(SH_L2, inner.image, 0, a, NULL), SH_OK);
    EQUAL(sh_project_octahedral(SH_L2, &inside, 0, b, NULL), SH_OK);
    SAME_BITS(a, b, sizeof a);
    square_free(&inner);
    square_free(&outer);
}

/* ---- One light in all three maps ---- */

static int project_cube(int order, const sh_image *face, unsigned flags, float *c, sh_report *report) {
    return sh_project_cubemap(order, face, flags, c, report);
}

static void agreement(void) {
    const square_map cube = { "cube map", 6, project_cube, NULL, cube_point, NULL, 0.0L, 1 };
    for (int size = 32; size <= 128; size *= 2) {
        square_images octahedron = square_render(&octahedral, 2 * size, square_light, square_axis);
        square_images box = square_render(&cube, size, square_light, square_axis);
        test_image panorama = test_image_create(4 * size, 2 * size, 1, SH_F32, test_tight);
        float a[9], b[9], c[9];
        for (int n = 0; n < 8 * size * size; n++) {
            long double dir[3];
            oracle_equirect_direction(&panorama.image, 0, n % (4 * size), n / (4 * size), dir);
            test_image_set(&panorama, n % (4 * size), n / (4 * size), 0, (float)square_light(dir, square_axis));
        }
        test_section("a light in three maps, size %d", size);
        EQUAL(sh_project_octahedral(SH_L2, octahedron.image, 0, a, NULL), SH_OK);
        EQUAL(sh_project_cubemap(SH_L2, box.image, 0, b, NULL), SH_OK);
        EQUAL(sh_project_equirect(SH_L2, &panorama.image, SH_POINT_TEXELS, c, NULL), SH_OK);
        NEAR_ALL(a, c, 9, 1.0 / (2 * size) / (2 * size)); /* 1 / size^2 of a light of mean 1.4 */
        NEAR_ALL(b, c, 9, 1.0 / size / size);
        square_free(&octahedron);
        square_free(&box);
        test_image_free(&panorama);
    }
}

static void run_tests(void) {
    test_section("the octahedron's share");
    NEAR(octahedron_share(-1.0L, 1.0L, -1.0L, 1.0L), 1.0, 1e-14);
    NEAR(octahedron_share(0.0L, 1.0L, 0.0L, 1.0L), 0.25, 1e-14);
    orientation();
    border();
    agreement();
    square_run(&octahedral);
}
