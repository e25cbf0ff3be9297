/* Octahedral maps: descriptors, rows and pixels of any kind. */
#include "image.h"

static void fuzz_one(fuzz_input *in) {
    image_run(in, FUZZ_OCTAHEDRAL);
}
