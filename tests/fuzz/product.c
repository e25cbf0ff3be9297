/* The product of two sets against quadrature of the product of their radiances, in double. */
#include "fuzz.h"
#define SH_NO_BATCH
#include "sh.h"

enum { RINGS = 4, COLUMNS = 7, NODES = RINGS * COLUMNS }; /* exact for polynomials up to degree 6 */

typedef struct node {
    double weight, basis[9];
} node;

static const node *nodes(void) {
    /* Gauss-Legendre, 4 points: sqrt(3/7 -+ 2/7 sqrt(6/5)), (18 +- sqrt 30) / 36. */
    static node table[NODES];
    if (table[0].weight > 0.0)
        return table;
    for (int i = 0; i < NODES; i++) {
        const int inner = i % RINGS < 2;
        const double root = sqrt(6.0 / 5.0) * 2.0 / 7.0, size = sqrt(3.0 / 7.0 + (inner ? -root : root));
        const double z = i % 2 ? size : -size, s = sqrt(1.0 - z * z), p = 2.0 * 3.14159265358979323846 * (i / RINGS) / COLUMNS;
        const double x = s * cos(p), y = s * sin(p), third = 1.0 / 3.0;
        const double basis[9] = { 1.0, x, y, z, x * x - third, x * y, x * z, y * y - third, y * z };
        table[i].weight = (18.0 + (inner ? sqrt(30.0) : -sqrt(30.0))) / 72.0 / COLUMNS;
        memcpy(table[i].basis, basis, sizeof basis);
    }
    return table;
}

static double radiance(int order, const float *c, const double basis[9]) {
    double sum = 0.0;
    for (int i = 0; i < SH_COUNT(order); i++)
        sum += (double)c[i] * basis[i] * (i < 1 ? 1.0 : i < 4 ? 3.0 : i == SH_XX || i == SH_YY ? 7.5 : 15.0);
    if (order >= SH_L2) /* zz (z^2 - 1/3) */
        sum += 7.5 * ((double)c[SH_XX] + (double)c[SH_YY]) * (basis[SH_XX] + basis[SH_YY]);
    return sum;
}

static void fuzz_one(fuzz_input *in) {
    const int order = fuzz_below(in, 3), set = SH_COUNT(order);
    float a[9], b[9], out[9], in_place[9];
    fuzz_coefficients(in, a);
    fuzz_coefficients(in, b);
    sh_product(order, a, b, out);
    memcpy(in_place, a, sizeof in_place);
    sh_product(order, in_place, b, in_place);
    FUZZ_CHECK(memcmp(in_place, out, (size_t)set * sizeof *out) == 0);
    const float most_a = fuzz_largest(a, set), most_b = fuzz_largest(b, set);
    if (!(most_a <= 1e17f && most_b <= 1e17f))
        return;
    FUZZ_CHECK(fuzz_all_finite(out, (size_t)set));
    double sum[9] = { 0 }, aa = 0.0, bb = 0.0, ab = 0.0;
    const node *table = nodes();
    for (int i = 0; i < NODES; i++) {
        const double fa = radiance(order, a, table[i].basis), fb = radiance(order, b, table[i].basis);
        aa += table[i].weight * fa * fa;
        bb += table[i].weight * fb * fb;
        ab += table[i].weight * fa * fb;
        for (int j = 0; j < set; j++)
            sum[j] += table[i].weight * fa * fb * table[i].basis[j];
    }
    const double underflow = 1e-37 * (double)(most_a + most_b) + 1e-42, tolerance = 1e-6 * sqrt(aa * bb) + underflow;
    for (int j = 0; j < set; j++)
        FUZZ_CHECK(fabs((double)out[j] - sum[j]) <= tolerance);
    FUZZ_CHECK(fabs((double)sh_dot(order, a, b) - ab) <= tolerance);
}
