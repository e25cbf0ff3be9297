/* bench_square.h - projecting cube maps and octahedral maps, RGB float; an item is a texel. */
#ifndef BENCH_SQUARE_H
#define BENCH_SQUARE_H

#include "bench_project.h"

/* ---- The oracle: light from the direction of each texel's centre, weighted by the texel's exact solid angle ---- */

/* The point of a map at u, v: on its own face (u right, v down, towards the face) of the cube, or on the octahedron. */
static inline void square_point(int kind, long double u, long double v, long double point[3]) {
    const long double z = 1.0L - fabsl(u) - fabsl(v);
    point[0] = kind == PROJECT_CUBEMAP || z >= 0.0L ? u : copysignl(1.0L - fabsl(v), u);
    point[1] = kind == PROJECT_CUBEMAP || z >= 0.0L ? v : copysignl(1.0L - fabsl(u), v);
    point[2] = kind == PROJECT_CUBEMAP ? 1.0L : z;
}

/* Solid angle of a triangle, as a fraction of the sphere. Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle". */
static inline long double square_triangle(const long double a[3], const long double b[3], const long double c[3]) {
    const long double la = sqrtl(oracle_dot(a, a)), lb = sqrtl(oracle_dot(b, b)), lc = sqrtl(oracle_dot(c, c));
    const long double volume =
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    const long double sum = la * lb * lc + oracle_dot(a, b) * lc + oracle_dot(b, c) * la + oracle_dot(c, a) * lb;
    return 2.0L * atan2l(fabsl(volume), sum) / (4.0L * oracle_pi);
}

/* Of texel x, y with u, v >= 0. It is two triangles: the diagonal between them is along the octahedron's fold. */
static inline long double square_solid_angle(int kind, int size, int x, int y) {
    const long double u0 = (2.0L * x - size) / size, u1 = (2.0L * x + 2.0L - size) / size;
    const long double v0 = (2.0L * y - size) / size, v1 = (2.0L * y + 2.0L - size) / size;
    long double near[3], far[3], right[3], down[3];
    square_point(kind, u0, v0, near);
    square_point(kind, u1, v1, far);
    square_point(kind, u1, v0, right);
    square_point(kind, u0, v1, down);
    return square_triangle(near, right, down) + square_triangle(far, right, down);
}

/* Adds the texels (x, y) of all faces, whose basis functions and solid angle are those of the first face. */
static inline void square_oracle_add(const project_data *data, int x, int y, const long double dir[3], long double weight,
                                     long double c[PROJECT_MAX_FACES][3][9]) {
    long double basis[9];
    oracle_basis(dir, basis);
    for (int face = 0; face < data->faces; face++) {
        long double value[3];
        oracle_texel(&data->face[face], x, y, value);
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 9; i++)
                c[face][k][i] += weight * value[k] * basis[i];
    }
}

/* Faces +x, -x, +y, -y, +z, -z of a cube map as OpenGL and Direct3D lay them out: the columns are the directions of u, v and the
 * face's centre. */
static const int square_axes[6][3][3] = {
    { { 0, 0, 1 }, { 0, -1, 0 }, { -1, 0, 0 } }, { { 0, 0, -1 }, { 0, -1, 0 }, { 1, 0, 0 } },
    { { 1, 0, 0 }, { 0, 0, 1 }, { 0, 1, 0 } },   { { 1, 0, 0 }, { 0, 0, -1 }, { 0, -1, 0 } },
    { { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 } },  { { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 } },
};

/* Moments in the faces' own frames: the map is its own image under (u, v) -> (+-u, +-v), so that a quarter of it has all solid
 * angles. The size is even. */
static inline void square_oracle_faces(const project_data *data, int kind, long double c[PROJECT_MAX_FACES][3][9]) {
    const int size = data->face[0].width;
    for (int y = size / 2; y < size; y++)
        for (int x = size / 2; x < size; x++) {
            const long double weight = square_solid_angle(kind, size, x, y);
            long double p[3];
            square_point(kind, (2.0L * x + 1.0L - size) / size, (2.0L * y + 1.0L - size) / size, p);
            const long double length = sqrtl(oracle_dot(p, p));
            for (int mirror = 0; mirror < 4; mirror++) {
                const int left = mirror & 1, up = mirror >> 1;
                const long double dir[3] = { (left ? -p[0] : p[0]) / length, (up ? -p[1] : p[1]) / length, p[2] / length };
                square_oracle_add(data, left ? size - 1 - x : x, up ? size - 1 - y : y, dir, weight, c);
            }
        }
}

static inline void cubemap_oracle(const project_data *data, long double c[3][9]) {
    long double local[PROJECT_MAX_FACES][3][9] = { { { 0 } } };
    square_oracle_faces(data, PROJECT_CUBEMAP, local);
    for (int face = 0; face < 6; face++)
        for (int k = 0; k < 3; k++) {
            long double q[3][3], turned[9];
            for (int i = 0; i < 9; i++)
                q[i / 3][i % 3] = square_axes[face][i / 3][i % 3];
            oracle_rotate(local[face][k], q, turned);
            for (int i = 0; i < 9; i++)
                c[k][i] += turned[i];
        }
}

static inline void octahedral_oracle(const project_data *data, long double c[3][9]) {
    long double local[PROJECT_MAX_FACES][3][9] = { { { 0 } } };
    square_oracle_faces(data, PROJECT_OCTAHEDRAL, local);
    memcpy(c, local[0], sizeof local[0]);
}

/* ---- The baselines: a point of the map, the customary weight 1 / |point|^3, a normalised direction ---- */

SHI_INLINE void engine_cube_point(int face, float u, float v, float point[3]) {
    switch (face) {
    case 0: point[0] = 1.0f, point[1] = -v, point[2] = -u; break;
    case 1: point[0] = -1.0f, point[1] = -v, point[2] = u; break;
    case 2: point[0] = u, point[1] = 1.0f, point[2] = v; break;
    case 3: point[0] = u, point[1] = -1.0f, point[2] = -v; break;
    case 4: point[0] = u, point[1] = -v, point[2] = 1.0f; break;
    default: point[0] = -u, point[1] = -v, point[2] = -1.0f; break;
    }
}

SHI_INLINE void engine_octahedron_point(float u, float v, float point[3]) {
    point[2] = 1.0f - fabsf(u) - fabsf(v);
    const float over = point[2] < 0.0f ? -point[2] : 0.0f;
    point[0] = u + (u >= 0.0f ? -over : over);
    point[1] = v + (v >= 0.0f ? -over : over);
}

SHI_INLINE void engine_square(int order, int kind, project_data *d) {
    const int size = d->face[0].width;
    const float step = 2.0f / (float)size;
    engine_rgb sum[9] = { { { 0 } } };
    float total = 0.0f;
    for (int face = 0; face < d->faces; face++) {
        const unsigned char *texel = (const unsigned char *)d->face[face].pixels;
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const float u = ((float)x + 0.5f) * step - 1.0f, v = ((float)y + 0.5f) * step - 1.0f;
                float rgb[3], p[3];
                if (kind == PROJECT_CUBEMAP)
                    engine_cube_point(face, u, v, p);
                else
                    engine_octahedron_point(u, v, p);
                const float square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2], length = sqrtf(square);
                const float weight = step * step / (square * length), scale = 1.0f / length;
                const float dir[3] = { p[0] * scale, p[1] * scale, p[2] * scale };
                engine_texel(SH_F32, texel, rgb);
                engine_add(order, dir, rgb, weight, sum);
                total += weight;
                texel += project_texel_size(SH_F32);
            }
    }
    memcpy(d->engine, sum, sizeof sum);
    d->engine_weight = total;
}

static inline void cubemap_baseline(bench_case *test) {
    if (test->order == SH_L1)
        engine_square(SH_L1, PROJECT_CUBEMAP, (project_data *)test->data);
    else
        engine_square(SH_L2, PROJECT_CUBEMAP, (project_data *)test->data);
}

static inline void octahedral_baseline(bench_case *test) {
    engine_square(SH_L2, PROJECT_OCTAHEDRAL, (project_data *)test->data);
}

/* ---- The cases ---- */

static inline void cubemap_prepare(bench_case *test) {
    project_prepare(test, 6)->oracle = cubemap_oracle;
}

static inline void cubemap_run(bench_case *test) {
    project_data *d = (project_data *)test->data;
    if (test->order == SH_L1)
        sh_project_cubemap(SH_L1, d->face, 0, d->c, NULL);
    else
        sh_project_cubemap(SH_L2, d->face, 0, d->c, NULL);
}

static inline void octahedral_prepare(bench_case *test) {
    project_prepare(test, 1)->oracle = octahedral_oracle;
}

static inline void octahedral_run(bench_case *test) {
    project_data *d = (project_data *)test->data;
    sh_project_octahedral(SH_L2, &d->face[0], 0, d->c, NULL);
}

static inline void cubemap_add(bench_list *list, int order, int size) {
    bench_case *test = project_add(list, order, SH_F32, 6, size, size);
    snprintf(test->name, sizeof test->name, "project/cubemap/L%d/rgb/f32/%d", order, size);
    test->kind = PROJECT_CUBEMAP;
    test->prepare = cubemap_prepare;
    test->run = cubemap_run;
    test->baseline = "sqrt per texel";
    test->run_baseline = cubemap_baseline;
}

static inline void octahedral_add(bench_list *list) {
    bench_case *test = project_add(list, SH_L2, SH_F32, 1, 1024, 1024);
    snprintf(test->name, sizeof test->name, "project/octahedral/L2/rgb/f32/1024");
    test->kind = PROJECT_OCTAHEDRAL;
    test->prepare = octahedral_prepare;
    test->run = octahedral_run;
    test->baseline = "sqrt per texel";
    test->run_baseline = octahedral_baseline;
}

static inline void bench_square_cases(bench_list *list) {
    for (int order = SH_L1; order <= SH_L2; order++) {
        cubemap_add(list, order, 64);
        cubemap_add(list, order, 1024);
    }
    octahedral_add(list);
}

#endif /* BENCH_SQUARE_H */
