/* Polygons, rectangles, disks and segments against brute-force integration over their solid angle. */
#include "oracle_area.h"
#include "sh.h"
#include "test.h"

/* A regular polygon of `count` corners, squeezed by `squeeze` along one axis, moved and turned. */
static void make_polygon(size_t count, const float center[3], double radius, double squeeze, float *vertices) {
    float q[4], m[9];
    test_fill(q, 4, -1.0, 1.0);
    sh_rotation_from_quaternion(q, m);
    for (size_t i = 0; i < count; i++) {
        const double angle = 2.0 * 3.14159265358979 * ((double)i + 0.1) / (double)count;
        const double x = radius * cos(angle), y = radius * squeeze * sin(angle);
        for (int k = 0; k < 3; k++)
            vertices[3 * i + (size_t)k] = (float)((double)center[k] + (double)m[3 * k] * x + (double)m[3 * k + 1] * y);
    }
}

static void compare(const float *c, const long double expected[9], long double tolerance) {
    NEAR_ALL(c, expected, 9, tolerance * expected[0] + 1e-30L);
}

static void polygons(void) {
    static const double squeezes[] = { 1.0, 0.3, 0.01, 1e-4 };
    const float one = 1.0f;
    for (int i = 0; i < 60; i++) {
        const size_t count = (size_t)(3 + i % 5);
        const double squeeze = squeezes[i % 4];
        float center[3], vertices[21], reversed[21], c[9] = { 0 }, other[9] = { 0 };
        long double expected[9];
        test_section("polygon %d of %d corners, squeezed by %g", i, (int)count, squeeze);
        test_fill(center, 3, -2.0, 2.0);
        make_polygon(count, center, test_uniform(0.1, 1.5), squeeze, vertices);
        oracle_polygon(vertices, count, 9, expected);
        EQUAL(sh_add_polygon(SH_L2, 1, vertices, count, &one, c), SH_OK);
        compare(c, expected, 1e-5L);
        for (size_t k = 0; k < count; k++)
            memcpy(reversed + 3 * k, vertices + 3 * (count - 1 - k), 3 * sizeof(float));
        EQUAL(sh_add_polygon(SH_L2, 1, reversed, count, &one, other), SH_OK);
        NEAR_ALL(other, c, 9, 1e-6 * (double)c[0]);
    }
}

/* From 1e-14 of the distance to nearly a hemisphere, at any scale. */
static void sizes(void) {
    static const double ratios[] = { 1e-14, 1e-9, 2e-8, 1e-6, 1e-4, 0.01, 1.0, 100.0, 1e4 }, scales[] = { 1e-15, 1.0, 1e13 };
    const float one = 1.0f;
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 3; j++) {
            const double h = scales[j], r = h * ratios[i];
            const float corners[4][3] = { { (float)-r, (float)-r, (float)h }, { (float)r, (float)-r, (float)h },
                                          { (float)r, (float)r, (float)h }, { (float)-r, (float)r, (float)h } };
            const float center[3] = { 0, 0, (float)h }, u[3] = { (float)r, 0, 0 }, v[3] = { 0, (float)r, 0 };
            float c[9] = { 0 }, same[9] = { 0 };
            test_section("square of %g at distance 1, times %g", ratios[i], h);
            EQUAL(sh_add_polygon(SH_L2, 1, corners[0], 4, &one, c), SH_OK);
            sh_add_rectangle(SH_L2, 1, center, u, v, &one, same);
            SAME_BITS(c, same, sizeof c);
            if (ratios[i] >= 1e-6) { /* below, floats cannot hold such corners off the axes; on them they can */
                long double expected[9];
                oracle_polygon(corners[0], 4, 22, expected);
                compare(c, expected, ratios[i] > 1000.0 ? 1e-4L : 1e-5L);
            }
            /* Solid angle of a square on its axis: 4 asin(r^2 / (r^2 + h^2)). */
            const long double rr = (long double)corners[2][0] * (long double)corners[2][0], hh = (long double)corners[0][2] * (long double)corners[0][2];
            NEAR(c[0], asinl(rr / (rr + hh)) / oracle_pi, 1e-6L * (long double)c[0]);
            if (ratios[i] < 1e-3) { /* a point */
                const long double all = (long double)c[0], third = all / 3, point[9] = { all, 0, 0, all, -third, 0, 0, -third, 0 };
                NEAR_ALL(c, point, 9, 1e-5L * all);
            }
        }
    const float corners[4][3] = { { -1e9f, -1e9f, 1 }, { 1e9f, -1e9f, 1 }, { 1e9f, 1e9f, 1 }, { -1e9f, 1e9f, 1 } };
    const float hemisphere[9] = { 0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0 };
    float c[9] = { 0 };
    test_section("nearly a hemisphere");
    EQUAL(sh_add_polygon(SH_L2, 1, corners[0], 4, &one, c), SH_OK);
    NEAR_ALL(c, hemisphere, 9, 1e-6);
}

/* Six faces of a cube around the receiver, wherever it stands, are ambient light; so are two halves of each. */
static void cubes(void) {
    static const int order[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    const float one[3] = { 1, 2, 4 };
    for (int i = 0; i < 100; i++) {
        float at[3], c[27] = { 0 };
        test_section("inside a cube");
        test_fill(at, 3, -0.999, 0.999);
        for (int face = 0; face < 6; face++) {
            float corner[4][3], half[3][3];
            for (int k = 0; k < 4; k++)
                for (int j = 0; j < 3; j++) {
                    const int axis = (j - face / 2 + 3) % 3;
                    corner[k][j] = (float)(axis == 0 ? (face % 2 ? 1 : -1) : order[k][axis - 1]) - at[j];
                }
            if (i % 2) {
                EQUAL(sh_add_polygon(SH_L2, 3, corner[0], 4, one, c), SH_OK);
                continue;
            }
            EQUAL(sh_add_polygon(SH_L2, 3, corner[0], 3, one, c), SH_OK);
            memcpy(half[0], corner[2], sizeof half[0]);
            memcpy(half[1], corner[3], sizeof half[1]);
            memcpy(half[2], corner[0], sizeof half[2]);
            EQUAL(sh_add_polygon(SH_L2, 3, half[0], 3, one, c), SH_OK);
        }
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < 9; j++)
                NEAR(c[9 * k + j], j ? 0 : one[k], 3e-6);
    }
}

/* An L is the sum of two rectangles. */
static void not_convex(void) {
    const float l[6][3] = { { 0, 0, 1 }, { 2, 0, 1 }, { 2, 1, 1 }, { 1, 1, 1 }, { 1, 2, 1 }, { 0, 2, 1 } }, one = 1.0f;
    const float center[2][3] = { { 1, 0.5f, 1 }, { 0.5f, 1.5f, 1 } };
    const float u[2][3] = { { 1, 0, 0 }, { 0.5f, 0, 0 } }, v[3] = { 0, 0.5f, 0 };
    float c[9] = { 0 }, sum[9] = { 0 }, turned[6][3];
    test_section("not convex");
    for (int k = 0; k < 2; k++)
        sh_add_rectangle(SH_L2, 1, center[k], u[k], v, &one, sum);
    for (int start = 0; start < 6; start++) {
        memset(c, 0, sizeof c);
        for (int k = 0; k < 6; k++)
            memcpy(turned[k], l[(k + start) % 6], sizeof turned[k]);
        EQUAL(sh_add_polygon(SH_L2, 1, turned[0], 6, &one, c), SH_OK);
        NEAR_ALL(c, sum, 9, 1e-7);
    }
}

/* A receiver on a diagonal, where the triangles of a fan meet, and a vertex so far away that the others are lost beside it. */
static void in_the_plane(void) {
    const float center[3] = { 0, 0, 0 }, u[3] = { 1, 0, 0 }, v[3] = { 0, 1, 0 }, one = 1.0f, hemisphere[9] = { 0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0 };
    const float far_first[3][3] = { { 1e18f, 1e18f, -0.75f }, { 0, -2, -0.75f }, { -2, -2, -0.75f } };
    const float far_last[3][3] = { { -2, -2, -0.75f }, { 0, -2, -0.75f }, { 1e18f, 1e18f, -0.75f } };
    const float far[3][3] = { { 1e5f, 1e5f, -0.75f }, { 0, -2, -0.75f }, { -2, -2, -0.75f } };
    float c[9] = { 0 }, first[9] = { 0 }, last[9] = { 0 };
    sh_add_rectangle(SH_L2, 1, center, u, v, &one, c);
    c[SH_Z] = fabsf(c[SH_Z]);
    NEAR_ALL(c, hemisphere, 9, 1e-6);
    memset(c, 0, sizeof c);
    EQUAL(sh_add_polygon(SH_L2, 1, far_first[0], 3, &one, first), SH_OK);
    EQUAL(sh_add_polygon(SH_L2, 1, far_last[0], 3, &one, last), SH_OK);
    EQUAL(sh_add_polygon(SH_L2, 1, far[0], 3, &one, c), SH_OK);
    NEAR_ALL(first, last, 9, 1e-7);
    NEAR_ALL(first, c, 9, 1e-5); /* what is beyond 1e5 is 1e-5 of the sphere */
}

static void degenerate(void) {
    const float flat[4][3] = { { 1, 1, 0 }, { 2, 1, 0 }, { 2, 2, 0 }, { 1, 2, 0 } }, around[3][3] = { { 1, 0, 0 }, { -1, 1, 0 }, { -1, -1, 0 } };
    const float line[4][3] = { { 1, 0, 1 }, { 2, 0, 1 }, { 3, 0, 1 }, { 1.5f, 0, 1 } }, corner[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    const float one = 1.0f, hemisphere[9] = { 0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0 };
    float c[9] = { 0 }, before[9];
    test_section("degenerate polygons");
    EQUAL(sh_add_polygon(SH_L2, 1, flat[0], 4, &one, c), SH_OK);
    EQUAL(sh_add_polygon(SH_L2, 1, line[0], 4, &one, c), SH_OK);
    for (int i = 0; i < 9; i++)
        NEAR(c[i], 0, 1e-8);
    EQUAL(sh_add_polygon(SH_L2, 1, around[0], 3, &one, c), SH_OK);
    c[SH_Z] = fabsf(c[SH_Z]);
    NEAR_ALL(c, hemisphere, 9, 1e-6);
    in_the_plane();
    EQUAL(sh_add_polygon(SH_L2, 1, corner[0], 3, &one, c), SH_OK);
    for (int i = 0; i < 9; i++)
        CHECK(fabsf(c[i]) < 2.0f);
    memcpy(before, c, sizeof c);
    EQUAL(sh_add_polygon(SH_L2, 1, flat[0], 2, &one, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_add_polygon(SH_L2, 1, NULL, 4, &one, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_add_polygon(SH_L2, 1, flat[0], 4, NULL, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_add_polygon(SH_L2, 0, flat[0], 4, &one, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_add_polygon(3, 1, flat[0], 4, &one, c), SH_ERROR_ARGUMENT);
    EQUAL(sh_add_polygon(SH_L2, 1, flat[0], 4, &one, NULL), SH_ERROR_ARGUMENT);
    SAME_BITS(c, before, sizeof c);
}

static void disks(void) {
    const float one = 1.0f, up[3] = { 0, 0, 1 };
    for (int i = 0; i < 12; i++) {
        float center[3], normal[3], c[9] = { 0 };
        long double expected[9];
        const float radius = (float)test_uniform(0.05, 2.0);
        test_section("disk %d", i);
        test_direction(normal);
        do
            test_fill(center, 3, -2.0, 2.0);
        while (fabsf(center[0] * normal[0] + center[1] * normal[1] + center[2] * normal[2]) < 0.05f);
        oracle_disk(center, normal, radius, 128, 512, expected);
        sh_add_disk(SH_L2, 1, center, normal, radius, &one, c);
        compare(c, expected, 3e-6L);
    }
    /* Seen nearly edge-on, R0 vanishes with the height. */
    static const double offs[] = { 1.04, 1.1, 1.5, 3.0 }, heights[] = { 1e-6, 1e-5, 1e-4, 0.01 };
    for (int i = 0; i < 16; i++) {
        const float center[3] = { (float)-offs[i / 4], 0.0f, (float)heights[i % 4] }, normal[3] = { 0, 0, 1 };
        float c[9] = { 0 };
        long double expected[9];
        test_section("disk at %g radii, from a height of %g", offs[i / 4], heights[i % 4]);
        oracle_disk(center, normal, 1.0f, 128, 512, expected);
        sh_add_disk(SH_L2, 1, center, normal, 1.0f, &one, c);
        compare(c, expected, 1e-6L);
    }
    /* Facing, it is the cap of tan = radius / distance, at any size. */
    static const double ratios[] = { 1e-9, 2e-8, 1e-5, 0.01, 1.0, 50.0, 1e5 };
    for (int i = 0; i < 7; i++) {
        const float center[3] = { 0.48f, -0.6f, 0.64f }, away[3] = { -0.48f, 0.6f, -0.64f };
        float c[9] = { 0 }, cap[9] = { 0 };
        test_section("disk of radius %g at distance 1", ratios[i]);
        sh_add_disk(SH_L2, 1, center, away, (float)ratios[i], &one, c);
        sh_add_cap(SH_L2, 1, center, (float)atan(ratios[i]), SH_RADIANCE, &one, cap);
        NEAR_ALL(c, cap, 9, 2e-6 * (double)cap[0]);
    }
    /* Near the rim the error stays within what is stated; on the disk it is a hemisphere. */
    for (int i = 0; i < 40; i++) {
        const double gap = 1.0 / 30.0, angle = 2.0 * 3.14159265358979 * i / 40.0;
        const float z[3] = { 0, 0, 1 }, center[3] = { (float)(-1.0 - gap * cos(angle)), 0, (float)(gap * sin(angle)) };
        float vertices[3 * 512], c[9] = { 0 }, polygon[9] = { 0 };
        const double grow = 1.0 + 0.5 * 6.5797362674 / (512.0 * 512.0); /* equal areas: 2 pi^2 / 3 n^2 more, halved in length */
        test_section("%g radii from the rim, at %g", gap, angle);
        for (int k = 0; k < 512; k++) {
            vertices[3 * k] = (float)((double)center[0] + grow * cos(2.0 * 3.14159265358979 * k / 512.0));
            vertices[3 * k + 1] = (float)(grow * sin(2.0 * 3.14159265358979 * k / 512.0));
            vertices[3 * k + 2] = center[2];
        }
        sh_add_disk(SH_L2, 1, center, z, 1.0f, &one, c);
        EQUAL(sh_add_polygon(SH_L2, 1, vertices, 512, &one, polygon), SH_OK);
        if (fabsf(center[2]) > 1e-3f)
            NEAR_ALL(c, polygon, 9, 3e-5);
    }
    /* On the rim, or nearer to it than the sum can see, it is still some light. */
    for (int i = 0; i < 60; i++) {
        const double distance = pow(10.0, -45.0 + 0.75 * i), radius = i % 2 ? 1.0 : 16777216.0;
        const float center[3] = { (float)(i % 3 ? -radius : -radius - distance), 0.0f, i % 3 == 2 ? 0.0f : (float)distance };
        float c[9] = { 0 };
        test_section("disk of radius %g, %g from its rim", radius, distance);
        sh_add_disk(SH_L2, 1, center, up, (float)radius, &one, c);
        CHECK(c[0] >= -1e-6f && c[0] <= 0.51f);
        for (int k = 1; k < 9; k++)
            CHECK(fabsf(c[k]) <= 0.51f);
    }
    const float nowhere[3] = { 0, 0, 0 }, z[3] = { 0, 0, 1 }, hemisphere[9] = { 0.5f, 0, 0, 0.25f, 0, 0, 0, 0, 0 };
    float c[9] = { 0 };
    test_section("on the disk");
    sh_add_disk(SH_L2, 1, nowhere, z, 0.0f, &one, c);
    sh_add_disk(SH_L2, 1, nowhere, z, 2.0f, &one, c);
    NEAR_ALL(c, hemisphere, 9, 1e-6);
}

/* A segment is the limit of a thin rectangle that faces the receiver, per width. */
static void segments(void) {
    const float one = 1.0f;
    for (int i = 0; i < 60; i++) {
        float a[3], b[3], c[9] = { 0 }, ribbon[9] = { 0 };
        double t[3], side[3], length = 0, across = 0, width = 1e-3;
        test_section("segment %d", i);
        test_fill(a, 3, -2.0, 2.0);
        test_fill(b, 3, -2.0, 2.0);
        for (int k = 0; k < 3; k++)
            t[k] = (double)b[k] - (double)a[k];
        for (int k = 0; k < 3; k++)
            side[k] = (double)a[(k + 1) % 3] * t[(k + 2) % 3] - (double)a[(k + 2) % 3] * t[(k + 1) % 3];
        for (int k = 0; k < 3; k++) {
            length += t[k] * t[k];
            across += side[k] * side[k];
        }
        if (across < 0.05 * length)
            continue; /* too near for this width */
        float center[3], half_u[3], half_v[3];
        for (int k = 0; k < 3; k++) {
            center[k] = 0.5f * (a[k] + b[k]);
            half_u[k] = (float)(0.5 * t[k]);
            half_v[k] = (float)(0.5 * width * side[k] / sqrt(across));
        }
        sh_add_segment(SH_L2, 1, a, b, (float)width, &one, c);
        sh_add_rectangle(SH_L2, 1, center, half_u, half_v, &one, ribbon);
        NEAR_ALL(c, ribbon, 9, 1e-3 * (double)c[0]); /* the corners are floats: half_v has 3 digits beside center */
    }
    const float a[3] = { 0, 0, 1 }, b[3] = { 0, 0, 3 }, left[3] = { -1e9f, 0, 2 }, right[3] = { 1e9f, 0, 2 };
    float c[9] = { 0 };
    test_section("segments on the axis, endless, without length");
    sh_add_segment(SH_L2, 1, a, b, 0.1f, &one, c);
    sh_add_segment(SH_L2, 1, a, a, 0.1f, &one, c);
    NEAR(c[0], 0, 0);
    sh_add_segment(SH_L2, 1, left, right, 0.1f, &one, c);
    NEAR(c[0], 0.1 / 2.0 * 2.0 / (4.0 * 3.14159265358979), 1e-8);
    NEAR(c[SH_Z], 0.1 / 2.0 * 3.14159265358979 / 2.0 / (4.0 * 3.14159265358979), 1e-8);
    NEAR(c[SH_XX] + c[0] / 3.0f, 0.1 / 2.0 * (2.0 / 3.0) / (4.0 * 3.14159265358979), 1e-8);
}

static void run_tests(void) {
    polygons();
    sizes();
    cubes();
    not_convex();
    degenerate();
    disks();
    segments();
}
