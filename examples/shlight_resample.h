/* shlight_resample.h - averages texels over blocks that need not be whole numbers of them: thumbnails, and the blocks of
 * shlight_reference.h. */
#ifndef SHLIGHT_RESAMPLE_H
#define SHLIGHT_RESAMPLE_H

#include "shlight_image.h"

/* A stretch of an axis of length 1 that lies within one source texel and one target block. */
typedef struct shlight_piece {
    int source, target;
    double begin, end;
} shlight_piece;

/* Cuts [0, 1] at all i / source and j / target; writes at most source + target pieces, returns how many. */
static int shlight_cut(int source, int target, shlight_piece *pieces) {
    int count = 0;
    double begin = 0.0;
    for (int i = 0, j = 0; i < source;) {
        const int64_t texel_end = (int64_t)(i + 1) * target, block_end = (int64_t)(j + 1) * source;
        const double end = texel_end <= block_end ? (double)(i + 1) / source : (double)(j + 1) / target;
        pieces[count++] = (shlight_piece){ i, j, begin, end };
        begin = end;
        i += texel_end <= block_end;
        j += block_end <= texel_end;
    }
    return count;
}

/* Fills out[width * height * channels] with means over the picture's area, as it is seen: not over solid angle.
 * -1: not enough memory. */
static int shlight_resample(const shlight_image *image, int width, int height, float *out) {
    const size_t row_size = (size_t)image->width * (size_t)image->channels, channels = (size_t)image->channels;
    const size_t pieces = (size_t)image->width + (size_t)image->height + (size_t)width + (size_t)height;
    shlight_piece *column = (shlight_piece *)malloc(pieces * sizeof *column), *row = column;
    if (!column)
        return -1;
    const int columns = shlight_cut(image->width, width, column);
    row += columns;
    const int rows = shlight_cut(image->height, height, row);
    memset(out, 0, (size_t)width * (size_t)height * channels * sizeof *out);
    for (int r = 0; r < rows; r++) {
        const float *from = image->pixels + (size_t)row[r].source * row_size;
        float *to = out + (size_t)row[r].target * (size_t)width * channels;
        const double share = (row[r].end - row[r].begin) * width * height;
        for (int i = 0; i < columns; i++)
            for (size_t k = 0; k < channels; k++)
                to[(size_t)column[i].target * channels + k] +=
                    (float)(share * (column[i].end - column[i].begin) * (double)from[(size_t)column[i].source * channels + k]);
    }
    free(column);
    return 0;
}

#endif /* SHLIGHT_RESAMPLE_H */
