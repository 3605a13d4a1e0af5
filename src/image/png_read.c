/* Reading PNG through libpng. Everything that must survive a longjmp is in a job, which belongs to a function that does
 * not call setjmp; the function that does has no modified local variables. */
#include "image/codec.h"

#include <png.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct png_job {
    png_structp png;
    png_infop info;
    char message[256];          /* libpng's error message */
    unsigned char *raw;         /* one row, or the whole image if it is interlaced */
    const unsigned char *bytes; /* the file, and the number of bytes consumed */
    size_t size, used;
    image *img;
    float *linear; /* sRGB decoding table */
    int bits;
    status code; /* for errors not from libpng */
    diagnostic *why;
} png_job;

static _Noreturn void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    snprintf(job->message, sizeof job->message, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void take_bytes(png_structp png, png_bytep to, size_t count)
{
    png_job *job = png_get_io_ptr(png);
    if (count > job->size - job->used)
        png_error(png, "the file is truncated");
    memcpy(to, job->bytes + job->used, count);
    job->used += count;
}

/* Requests RGB or RGBA with 8 or 16 bits from libpng, for any kind of file. */
static void normalize(png_job *job)
{
    job->bits = png_get_bit_depth(job->png, job->info) == 16 ? 16 : 8;
    png_set_expand(job->png); /* palettes, depths below 8 and transparent colours */
    png_set_gray_to_rgb(job->png);
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
    job->code = codec_begin(width, height, job->size, job->bits == 8 ? 255 : 65535, &job->img, &job->linear, job->why);
    if (job->code != STATUS_OK)
        return false;
    /* Zeroed, because an interlaced image is read by combining with the previous contents. */
    job->raw = calloc(interlaced ? (size_t)height : 1, png_get_rowbytes(job->png, job->info));
    if (!job->raw)
        job->code = out_of_memory(job->why);
    return job->raw;
}

static bool read_rows(png_job *job)
{
    png_set_read_fn(job->png, job, take_bytes);
    png_set_user_limits(job->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(job->png, 8000000);
    png_set_chunk_cache_max(job->png, 128);
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_crc_action(job->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(job->png, job->info);
    normalize(job);
    int passes = png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    png_uint_32 width = png_get_image_width(job->png, job->info), height = png_get_image_height(job->png, job->info);
    if (!allocate(job, width, height, passes > 1))
        return false;
    size_t channels = png_get_channels(job->png, job->info), row_bytes = png_get_rowbytes(job->png, job->info);
    for (int pass = 0; pass < passes; pass++) {
        for (int y = 0; y < job->img->height; y++) {
            unsigned char *row = job->raw + (passes > 1 ? (size_t)y * row_bytes : 0);
            png_read_row(job->png, row, NULL);
            if (pass == passes - 1)
                store_row(job, row, y, channels);
        }
    }
    png_read_end(job->png, NULL); /* the remaining chunks must be valid as well */
    return true;
}

static void read_guarded(png_job *job)
{
    if (setjmp(png_jmpbuf(job->png))) {
        job->code = diagnose(job->why, STATUS_BAD_INPUT, NULL, "the PNG file is damaged: %s", job->message);
        return;
    }
    if (read_rows(job))
        job->code = STATUS_OK;
}

status codec_png_read(const unsigned char *bytes, size_t size, image **out, int *bits, diagnostic *why)
{
    png_job job = {.bytes = bytes, .size = size, .why = why, .code = STATUS_FAILURE};
    *out = NULL;
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    if (!job.info)
        out_of_memory(why);
    else
        read_guarded(&job);
    png_destroy_read_struct(&job.png, &job.info, NULL);
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
