/* Rows in slices, in any order, merged from several accumulators: the whole image's sums and report, for every map and backend. */
#include "image.h"

static void fuzz_one(fuzz_input *in) {
    const fuzz_backend *backend = fuzz_backend_number(fuzz_byte(in));
    unsigned char *bytes[IMAGE_FACES];
    image_job job;
    sh_accum whole[3], sum[3], part[3];
    sh_report report, total = { 0, 0, 0 };
    image_describe(in, fuzz_below(in, FUZZ_MAPS), &job);
    job.first = 0;
    job.count = job.face->height;
    for (int i = 0; i < IMAGE_FACES; i++)
        job.face[i].pixels = "";
    if (!image_job_valid(&job) || image_rows_size(&job, job.face) > IMAGE_MOST)
        return;
    for (int i = 1; i < image_faces(&job); i++)
        if (image_rows_size(&job, job.face + i) > IMAGE_MOST)
            return;
    image_place(in, &job, bytes);

    memset(whole, 0, sizeof whole);
    memset(sum, 0, sizeof sum);
    memset(&report, 0, sizeof report);
    FUZZ_CHECK(backend->rows[job.map](job.order, job.face, job.flags, 0, job.count, whole, &report) == SH_OK);
    const int channels = sh_image_channels(job.face), cut = 1 + fuzz_below(in, job.count), down = fuzz_below(in, 2);
    for (int done = 0; done < job.count; done += cut) {
        const int rows = job.count - done < cut ? job.count - done : cut;
        memset(part, 0, sizeof part);
        FUZZ_CHECK(backend->rows[job.map](job.order, job.face, job.flags, down ? job.count - done - rows : done, rows, part,
                                          &total) == SH_OK);
        sh_accum_merge(channels, part, sum);
    }
    FUZZ_CHECK(report.texels == total.texels && report.nonfinite == total.nonfinite && report.negative == total.negative);
    /* Magnitudes: the sum over texels of |L| is not known here; the largest of all that the format has, or of the pokes, is. */
    float most = 0.0f;
    for (int i = 0; i < image_faces(&job); i++)
        for (int row = 0; row < job.count; row++)
            for (int x = 0; x < job.face->width; x++) {
                float value[3];
                image_texel(job.face,
                            bytes[i] + (size_t)row * (size_t)image_stride(job.face + i) + (size_t)x * image_pixel_size(job.face),
                            value);
                if (fuzz_all_finite(value, 3))
                    most = fmaxf(most, fuzz_largest(value, 3));
            }
    for (int k = 0; k < channels; k++) {
        FUZZ_CHECK(fabs(sum[k].weight - 1.0) <= 1e-5 && fabs(sum[k].weight - whole[k].weight) <= 1e-6);
        for (int i = 0; i < SH_COUNT(job.order); i++)
            FUZZ_CHECK(fabs(sum[k].sum[i] - whole[k].sum[i]) <= 2e-6 * (double)most + 1e-43 || most > 1e38f);
    }
}
