/* seeds.c - writes inputs to start from: seeds TARGET FOLDER. For read_image, small files of every kind that shlight reads; for the
 * others, whose bytes are choices, bytes of all kinds. */
#include <stdio.h>
#include <string.h>

static int write_seed(const char *folder, int number, const unsigned char *bytes, size_t size) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/seed%02d", folder, number) >= (int)sizeof path)
        return 0;
    FILE *file = fopen(path, "wb");
    if (!file)
        return 0;
    const size_t written = fwrite(bytes, 1, size, file);
    return fclose(file) == 0 && written == size;
}

/* A header and pixels, the bytes of `rest` after the text. */
static int write_picture(const char *folder, int number, const char *text, const char *rest, size_t rest_size) {
    unsigned char bytes[512];
    const size_t length = strlen(text);
    memcpy(bytes, text, length);
    memcpy(bytes + length, rest, rest_size);
    return write_seed(folder, number, bytes, length + rest_size);
}

static int write_pictures(const char *folder) {
    /* Flat: two pixels. Old runs: a pixel, repeated once, and 256 times less one. New runs: 8 pixels, each component a run and a dump. */
    static const char flat[] = "\x80\x40\x20\x81\x10\xff\x00\x7f", old_runs[] = "\x80\x40\x20\x81\x01\x01\x01\x02\x01\x01\x01\x01";
    static const char new_runs[] = "\x02\x02\x00\x08"
                                   "\x88\x40"
                                   "\x83\x10\x05\x01\x02\x03\x04\x05"
                                   "\x88\x00"
                                   "\x88\x81";
    static const char little[] = "\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\xc0\x7f",
                      big[] = "\x3f\x80\x00\x00\x40\x00\x00\x00\x7f\x80\x00\x00";
    int ok = 1, number = 0;
    ok &= write_picture(folder, number++, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n", flat, 8);
    ok &= write_picture(folder, number++, "#?RGBE\nEXPOSURE=2\nCOLORCORR=1 .5 2\n\n+X 2 -Y 1\n", flat, 8);
    ok &= write_picture(folder, number++, "#?RADIANCE\n\n+Y 1 -X 259\n", old_runs, 12);
    ok &= write_picture(folder, number++, "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 8\r\n", new_runs, 18);
    ok &= write_picture(folder, number++, "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n", flat, 8);
    ok &= write_picture(folder, number++, "Pf\n3 1\n-1.0\n", little, 12);
    ok &= write_picture(folder, number++, "PF 1 1 2.5\n", big, 12);
    ok &= write_picture(folder, number++, "PF\n40000 40000\n-1\n", little, 12);
    return ok;
}

/* Bytes of a linear congruential generator, in lengths from 8 to 128. */
static int write_choices(const char *folder) {
    unsigned char bytes[128];
    unsigned long state = 1;
    int ok = 1;
    for (int number = 0; number < 64; number++) {
        for (size_t i = 0; i < sizeof bytes; i++) {
            state = (state * 1103515245ul + 12345ul) & 0x7ffffffful;
            bytes[i] = (unsigned char)(state >> 16);
        }
        ok &= write_seed(folder, number, bytes, (size_t)(number % 16 + 1) * 8);
    }
    return ok;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: seeds TARGET FOLDER\n");
        return 2;
    }
    return (strcmp(argv[1], "read_image") == 0 ? write_pictures(argv[2]) : write_choices(argv[2])) ? 0 : 1;
}
