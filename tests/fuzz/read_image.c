/* The readers of shlight: hostile .hdr and .pfm files. Small limits, so that a run is short. */
#define SHLIGHT_MAX_SIDE 512
#define SHLIGHT_MAX_BYTES 65536
#include "../../examples/shlight_image.h"

#include "fuzz.h"

static void fuzz_one(fuzz_input *in) {
    const size_t size = (size_t)(in->end - in->at);
    unsigned char *bytes = fuzz_place(0, size, 0);
    shlight_image image;
    const char *error = NULL;
    if (size)
        memcpy(bytes, in->at, size);
    if (shlight_read(bytes, size, &image, &error) != 0) {
        FUZZ_CHECK(error && *error && !image.pixels);
        return;
    }
    FUZZ_CHECK(!error && image.pixels && image.format);
    FUZZ_CHECK(image.width >= 1 && image.width <= SHLIGHT_MAX_SIDE && image.height >= 1 && image.height <= SHLIGHT_MAX_SIDE);
    FUZZ_CHECK(image.channels == 1 || image.channels == 3);
    const size_t count = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
    FUZZ_CHECK(count * sizeof(float) <= SHLIGHT_MAX_BYTES);
    for (size_t i = 0; i < count; i++)
        FUZZ_CHECK(bytes[0] != '#' || image.pixels[i] >= 0.0f); /* every pixel was written; RGBE has no sign */
    free(image.pixels);
}
