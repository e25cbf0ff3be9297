/* Prints, as one JSON object, a light of five directions, and its set by this library in other engines' conventions; or, given a file,
 * writes there a small panorama in Radiance format and prints its projection as Filament has it. */
#include <stdio.h>

#include "sh.h"

static void print_array(const char *name, const float *values, int count, const char *end) {
    printf("\"%s\": [", name);
    for (int i = 0; i < count; i++)
        printf("%s%.9g", i ? ", " : "", (double)values[i]);
    printf("]%s\n", end);
}

static void directions(void) {
    enum { LIGHTS = 5, NORMALS = 20 };
    float dirs[3 * LIGHTS], values[LIGHTS], normals[3 * NORMALS], radiance[NORMALS], irradiance[NORMALS], c[9] = { 0 }, out[9], lambert[3];
    for (uint32_t i = 0; i < LIGHTS; i++) {
        sh_direction_sequence(i, 1, dirs + 3 * i);
        values[i] = 0.5f + (float)i;
        sh_add_sample(SH_L2, dirs + 3 * i, values[i], c);
    }
    for (uint32_t i = 0; i < NORMALS; i++) {
        sh_direction_sequence(i, 2, normals + 3 * i);
        radiance[i] = sh_radiance(SH_L2, c, normals + 3 * i);
        irradiance[i] = sh_irradiance(SH_L2, c, normals + 3 * i);
    }
    printf("{");
    print_array("dirs", dirs, 3 * LIGHTS, ",");
    print_array("values", values, LIGHTS, ",");
    print_array("normals", normals, 3 * NORMALS, ",");
    print_array("radiance", radiance, NORMALS, ",");
    print_array("irradiance", irradiance, NORMALS, ",");
    sh_to_orthonormal(SH_L2, c, 0, out);
    print_array("orthonormal", out, 9, ",");
    sh_to_orthonormal(SH_L2, c, SH_CONDON_SHORTLEY, out);
    print_array("phase", out, 9, ",");
    sh_to_unity(SH_L2, c, out);
    print_array("unity", out, 9, ",");
    sh_to_babylon(c, out);
    print_array("babylon", out, 9, ",");
    sh_zonal_lambert(lambert);
    sh_convolve(SH_L2, c, lambert, c);
    sh_to_babylon(c, out);
    print_array("babylon_environment", out, 9, "}");
}

/* Filament's x, y, z are -y, z, -x of a clockwise panorama: y is up, and -z is where column 0 is, not the middle. Its reader takes a
 * mantissa m for m + 1/2, and a texel's corner for its centre: hence many of them. */
static int panorama(const char *path) {
    enum { WIDTH = 2048, HEIGHT = 1024 };
    static unsigned char pixels[WIDTH * HEIGHT][4];
    static float radiance[WIDTH * HEIGHT][3];
    const int axis[3] = { -2, 3, -1 };
    float c[27], out[27], interleaved[27];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            unsigned char *p = pixels[y * WIDTH + x];
            const int sun = (x - 480) * (x - 480) + (y - 320) * (y - 320) < 6400;
            p[0] = (unsigned char)(130 + x / 32);
            p[1] = (unsigned char)(255 - y / 8);
            p[2] = (unsigned char)(128 + (x / 8) * (y / 8) % 100);
            p[3] = sun ? 132 : 129;
            for (int k = 0; k < 3; k++)
                radiance[y * WIDTH + x][k] = ldexpf((float)p[k] + 0.5f, p[3] - 136);
        }
    FILE *file = fopen(path, "wb");
    if (!file)
        return 1;
    fprintf(file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", HEIGHT, WIDTH);
    fwrite(pixels, 1, sizeof pixels, file);
    if (fclose(file) != 0)
        return 1;
    const sh_image image = { radiance, WIDTH, HEIGHT, 0, 3, SH_F32 };
    if (sh_project_equirect(SH_L2, &image, SH_CLOCKWISE, c, NULL) != SH_OK)
        return 1;
    for (int k = 0; k < 3; k++) {
        sh_swap_axes(SH_L2, c + 9 * k, axis, out + 9 * k);
        sh_to_unity(SH_L2, out + 9 * k, out + 9 * k);
    }
    sh_interleave(SH_L2, 3, out, interleaved);
    for (int i = 0; i < 9; i++)
        printf("%.9g %.9g %.9g\n", (double)interleaved[3 * i], (double)interleaved[3 * i + 1], (double)interleaved[3 * i + 2]);
    return 0;
}

int main(int argc, char **argv) {
    if (argc > 1)
        return panorama(argv[1]);
    directions();
    return 0;
}
