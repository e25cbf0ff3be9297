/* square_maps.h - the geometry of cube maps and octahedral maps, by definition, in long double: where a point is, and the share of the
 * sphere of a rectangle. */
#ifndef TEST_SQUARE_MAPS_H
#define TEST_SQUARE_MAPS_H

#include "square.h"

/* ---- Cube map ----
 * OpenGL 4.6, table 8.19, of direction (rx, ry, rz): s = (sc / |ma| + 1) / 2 runs along rows, t = (tc / |ma| + 1) / 2 along columns.
 *
 *     face  sc   tc   ma
 *     +x    -rz  -ry  rx
 *     -x    +rz  -ry  rx
 *     +y    +rx  +rz  ry
 *     -y    +rx  -rz  ry
 *     +z    +rx  -ry  rz
 *     -z    -rx  -ry  rz
 */
static const struct {
    int sc_axis, sc_sign, tc_axis, tc_sign, ma_axis, ma_sign;
} cube_faces[6] = {
    { 2, -1, 1, -1, 0, 1 }, { 2, 1, 1, -1, 0, -1 }, { 0, 1, 2, 1, 1, 1 },
    { 0, 1, 2, -1, 1, -1 }, { 0, 1, 1, -1, 2, 1 },  { 0, -1, 1, -1, 2, -1 },
};

static inline void cube_point(int face, long double u, long double v, long double at[3]) {
    at[cube_faces[face].sc_axis] = cube_faces[face].sc_sign * u;
    at[cube_faces[face].tc_axis] = cube_faces[face].tc_sign * v;
    at[cube_faces[face].ma_axis] = cube_faces[face].ma_sign;
}

/* A rectangle of a face is plane: two triangles. */
static inline long double cube_share(long double u0, long double u1, long double v0, long double v1) {
    const long double a[3] = { u0, v0, 1.0L }, b[3] = { u1, v0, 1.0L }, c[3] = { u1, v1, 1.0L }, d[3] = { u0, v1, 1.0L };
    return square_triangle(a, b, c) + square_triangle(a, c, d);
}

/* ---- Octahedral map: cut along the axes and the fold, each piece of a rectangle is plane ---- */

static inline void octahedron_point(int image, long double u, long double v, long double at[3]) {
    const long double a = fabsl(u), b = fabsl(v);
    (void)image;
    at[2] = 1.0L - a - b;
    at[0] = at[2] >= 0.0L ? u : u < 0.0L ? b - 1.0L : 1.0L - b;
    at[1] = at[2] >= 0.0L ? v : v < 0.0L ? a - 1.0L : 1.0L - a;
}

enum { OCTAHEDRON_CORNERS = 8 };

typedef struct octahedron_polygon {
    int count;
    long double corner[OCTAHEDRON_CORNERS][2];
} octahedron_polygon;

/* What lies where a u + b v <= c. Sutherland and Hodgman. */
static inline octahedron_polygon octahedron_clip(const octahedron_polygon *p, long double a, long double b, long double c) {
    octahedron_polygon out;
    out.count = 0;
    for (int i = 0; i < p->count; i++) {
        const long double *from = p->corner[i], *to = p->corner[(i + 1) % p->count];
        const long double d0 = c - a * from[0] - b * from[1], d1 = c - a * to[0] - b * to[1];
        if (d0 >= 0.0L) {
            out.corner[out.count][0] = from[0];
            out.corner[out.count++][1] = from[1];
        }
        if ((d0 > 0.0L && d1 < 0.0L) || (d0 < 0.0L && d1 > 0.0L)) {
            out.corner[out.count][0] = from[0] + (to[0] - from[0]) * d0 / (d0 - d1);
            out.corner[out.count++][1] = from[1] + (to[1] - from[1]) * d0 / (d0 - d1);
        }
    }
    return out;
}

/* A plane piece, by a fan of triangles. */
static inline long double octahedron_piece(const octahedron_polygon *p) {
    long double sum = 0.0L;
    for (int i = 2; i < p->count; i++) {
        long double a[3], b[3], c[3];
        octahedron_point(0, p->corner[0][0], p->corner[0][1], a);
        octahedron_point(0, p->corner[i - 1][0], p->corner[i - 1][1], b);
        octahedron_point(0, p->corner[i][0], p->corner[i][1], c);
        sum += square_triangle(a, b, c);
    }
    return sum;
}

static inline long double octahedron_share(long double u0, long double u1, long double v0, long double v1) {
    const octahedron_polygon whole = { 4, { { u0, v0 }, { u1, v0 }, { u1, v1 }, { u0, v1 } } };
    long double sum = 0.0L;
    for (int quadrant = 0; quadrant < 4; quadrant++) {
        const long double su = quadrant & 1 ? -1.0L : 1.0L, sv = quadrant & 2 ? -1.0L : 1.0L;
        const octahedron_polygon half = octahedron_clip(&whole, -su, 0.0L, 0.0L), part = octahedron_clip(&half, 0.0L, -sv, 0.0L);
        const octahedron_polygon upper = octahedron_clip(&part, su, sv, 1.0L), lower = octahedron_clip(&part, -su, -sv, -1.0L);
        sum += octahedron_piece(&upper) + octahedron_piece(&lower);
    }
    return sum;
}

#endif /* TEST_SQUARE_MAPS_H */
