/* Reading PNG through libpng. Everything that must survive a longjmp is in a job, which belongs to a function that does
 * not call setjmp; the function that does has no modified local variables. */
#include "base/memory_budget.h"
#include "base/cancel.h"
#include "image/codec.h"
#include "image/png_library.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct png_job {
    png_library of;     /* first: libpng hands it back */
    unsigned char *raw; /* one row, or the whole image if it is interlaced */
    image *img;
    float *linear; /* sRGB decoding table */
    int bits;
    status code; /* for errors not from libpng */
    diagnostic *why;
} png_job;

/* Requests RGB or RGBA with 8 or 16 bits from libpng, for any kind of file. */
static void normalize(png_job *job)
{
    job->bits = png_get_bit_depth(job->of.png, job->of.info) == 16 ? 16 : 8;
    png_set_expand(job->of.png); /* palettes, depths below 8 and transparent colours */
    png_set_gray_to_rgb(job->of.png);
}

static unsigned sample(const png_job *job, const unsigned char *row, size_t index)
{
    return job->bits == 8 ? row[index] : (unsigned)row[2 * index] << 8 | row[2 * index + 1];
}

/* Linear values, blended over black with alpha, which is linear itself (PNG specification 13.16). */
static void store_row(png_job *job, const unsigned char *row, int y, size_t channels)
{
    float *pixel = job->img->pixel + (size_t)y * (size_t)job->img->width * 3;
    for (size_t x = 0; x < (size_t)job->img->width; x++) {
        for (size_t channel = 0; channel < 3; channel++)
            pixel[3 * x + channel] = job->linear[sample(job, row, channels * x + channel)];
        if (channels == 4) {
            double alpha = (double)sample(job, row, 4 * x + 3) / (job->bits == 8 ? 255.0 : 65535.0);
            for (size_t channel = 0; channel < 3; channel++)
                pixel[3 * x + channel] = (float)(alpha * (double)pixel[3 * x + channel]);
        }
    }
}

static bool allocate(png_job *job, long long width, long long height, bool interlaced)
{
    job->code =
        codec_begin(width, height, job->of.size, job->bits == 8 ? 255 : 65535, &job->img, &job->linear, job->why);
    if (job->code != STATUS_OK)
        return false;
    if (interlaced)
        job->code = memory_budget_check((uint64_t)height * png_get_rowbytes(job->of.png, job->of.info),
                                        "save it without interlacing", job->why, "the interlaced image");
    if (job->code != STATUS_OK)
        return false;
    /* Zeroed, because an interlaced image is read by combining with the previous contents. */
    job->raw = calloc(interlaced ? (size_t)height : 1, png_get_rowbytes(job->of.png, job->of.info));
    if (!job->raw)
        job->code = out_of_memory(job->why);
    return job->raw;
}

static bool read_rows(png_job *job)
{
    png_library_guard(&job->of, 8000000);
    png_set_keep_unknown_chunks(job->of.png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_read_info(job->of.png, job->of.info);
    normalize(job);
    int passes = png_set_interlace_handling(job->of.png);
    png_read_update_info(job->of.png, job->of.info);
    png_uint_32 width = png_get_image_width(job->of.png, job->of.info),
                height = png_get_image_height(job->of.png, job->of.info);
    if (!allocate(job, width, height, passes > 1))
        return false;
    size_t channels = png_get_channels(job->of.png, job->of.info),
           row_bytes = png_get_rowbytes(job->of.png, job->of.info);
    for (int pass = 0; pass < passes; pass++) {
        for (int y = 0; y < job->img->height; y++) {
            unsigned char *row = job->raw + (passes > 1 ? (size_t)y * row_bytes : 0);
            if (cancel_asked()) {
                job->code = cancel_check(job->why);
                return false;
            }
            png_read_row(job->of.png, row, NULL);
            if (pass == passes - 1)
                store_row(job, row, y, channels);
        }
    }
    png_read_end(job->of.png, NULL); /* the remaining chunks must be valid as well */
    return true;
}

static void read_guarded(png_job *job)
{
    if (setjmp(png_jmpbuf(job->of.png))) {
        job->code = png_library_failed(&job->of, job->why);
        return;
    }
    if (read_rows(job))
        job->code = STATUS_OK;
}

status codec_png_read(const unsigned char *bytes, size_t size, image **out, int *bits, diagnostic *why)
{
    png_job job = {.of = {.bytes = bytes, .size = size}, .why = why, .code = STATUS_FAILURE};
    *out = NULL;
    if (!png_library_read(&job.of))
        out_of_memory(why);
    else
        read_guarded(&job);
    png_destroy_read_struct(&job.of.png, &job.of.info, NULL);
    free(job.raw);
    free(job.linear);
    if (job.code != STATUS_OK) {
        image_destroy(job.img);
        return job.code;
    }
    *bits = job.bits;
    *out = job.img;
    return STATUS_OK;
}
