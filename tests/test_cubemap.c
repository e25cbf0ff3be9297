/* Cube maps: order and orientation of the faces, and what square maps have in common. */
#include "square_maps.h"

static int project(int order, const sh_image *face, unsigned flags, float *c, sh_report *report) {
    return sh_project_cubemap(order, face, flags, c, report);
}

static int project_rows(int order, const sh_image *face, unsigned flags, int first, int count, sh_accum *accum, sh_report *report) {
    return sh_project_cubemap_rows(order, face, flags, first, count, accum, report);
}

static const square_map cube = { "cube map", 6, project, project_rows, cube_point, cube_share, 1e-6L, 1 };

/* The closed form: the solid angle from the middle of a face to (u, v) is atan(u v / sqrt(1 + u^2 + v^2)). */
static long double strip(long double v) {
    return atan2l(v, sqrtl(2.0L + v * v)) / (2.0L * oracle_pi); /* of u from -1 to 1, v from 0 */
}

static void closed_form(void) {
    static const int sizes[] = { 1, 2, 5, 16, 64, 1024, 8192 };
    test_section("the oracle against the closed form");
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s], rows[] = { 0, size / 3, size - 1 };
        for (int r = 0; r < 3; r++) {
            const int y = rows[r];
            long double sum = 0.0L;
            for (int x = 0; x < size; x++)
                sum += square_weight(&cube, size, x, y);
            NEAR(sum, strip(square_edge(size, y + 1)) - strip(square_edge(size, y)), 1e-14);
        }
    }
}

/* Where the upper left corner of each face is, as text books draw the cross: the signs of its direction. */
static const signed char corners[6][3] = { { 1, 1, 1 }, { -1, 1, -1 }, { -1, 1, -1 }, { -1, -1, 1 }, { -1, 1, 1 }, { 1, 1, -1 } };

static void orientation(void) {
    enum { SIZE = 5 };
    static const int places[][2] = { { 0, 0 }, { 4, 0 }, { 0, 4 }, { 4, 4 }, { 2, 2 }, { 3, 1 } };
    square_images all = square_create(&cube, SIZE, 1, SH_F32, test_tight);
    square_set_all(&all, 0, 0.0f);
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < 6; i++) {
            const int x = places[i][0], y = places[i][1];
            long double dir[3];
            float c[9];
            test_section("light in face %d at %d %d", face, x, y);
            square_direction(&cube, SIZE, face, x, y, dir);
            test_image_set(&all.of[face], x, y, 0, 1.0f);
            EQUAL(sh_project_cubemap(SH_L2, all.image, 0, c, NULL), SH_OK);
            test_image_set(&all.of[face], x, y, 0, 0.0f);
            for (int axis = 0; axis < 3; axis++) {
                NEAR(c[SH_X + axis] / c[SH_R0], dir[axis], 1e-6);
                if (i == 0)
                    CHECK(c[SH_X + axis] * (float)corners[face][axis] > 0.0f);
            }
        }
    test_section("faces of one colour each");
    for (int face = 0; face < 6; face++) {
        float c[9];
        for (int n = 0; n < SIZE * SIZE; n++)
            for (int other = 0; other < 6; other++)
                test_image_set(&all.of[other], n % SIZE, n / SIZE, 0, other == face ? 1.0f : 0.0f);
        EQUAL(sh_project_cubemap(SH_L1, all.image, 0, c, NULL), SH_OK);
        NEAR(c[SH_R0], 1.0 / 6.0, 1e-7);
        for (int axis = 0; axis < 3; axis++)
            if (axis == face / 2)
                CHECK(c[SH_X + axis] * (face % 2 ? -1.0f : 1.0f) > 0.1f);
            else
                NEAR(c[SH_X + axis], 0.0, 1e-7);
    }
    square_free(&all);
}

/* Texels that a symmetry of the cube maps to each other have one weight, up to rounding. */
static void symmetry(void) {
    static const int sizes[] = { 4, 7, 16, 33 };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const int size = sizes[s];
        square_images all = square_create(&cube, size, 1, SH_F32, test_tight);
        square_set_all(&all, 0, 0.0f);
        test_section("symmetric weights, size %d", size);
        for (int y = 0; y < (size + 1) / 2; y++)
            for (int x = 0; x <= y; x++) {
                double first = 0.0;
                for (int i = 0; i < 48; i++) {
                    const int a = i & 1 ? size - 1 - x : x, b = i & 2 ? size - 1 - y : y;
                    const int column = i & 4 ? b : a, row = i & 4 ? a : b;
                    sh_accum accum;
                    sh_accum_clear(1, &accum);
                    test_image_set(&all.of[i / 8], column, row, 0, 1.0f);
                    EQUAL(sh_project_cubemap_rows(SH_L0, all.image, 0, row, 1, &accum, NULL), SH_OK);
                    test_image_set(&all.of[i / 8], column, row, 0, 0.0f);
                    if (i == 0)
                        first = accum.sum[0];
                    RELATIVE(accum.sum[0], first, 5e-7); /* a few roundings of each */
                }
            }
        square_free(&all);
    }
}

/* One map that is larger than caches. */
static void large(void) {
    enum { SIZE = 512 };
    square_images all = square_random(&cube, SIZE, 1, -0.5, 1.0);
    long double *weight = square_weights(&cube, SIZE);
    test_section("cube map of %d", SIZE);
    square_check(&cube, weight, all.image, 0);
    free(weight);
    square_free(&all);
}

static void run_tests(void) {
    closed_form();
    orientation();
    symmetry();
    large();
    square_run(&cube);
}
