/* Writing PNG: libpng writes the chunks, png_bands.c compresses the pixels. Everything that must survive a longjmp is
 * in a job, which belongs to a function that does not call setjmp; the function that does has no modified local
 * variables. */
#include "base/cancel.h"
#include "image/png_bands.h"
#include "image/png_library.h"

#include <stdlib.h>
#include <string.h>

typedef struct png_job {
    png_library of; /* first: libpng hands it back */
    const image_rows *rows;
    png_bands *bands;
    int bits;
    png_text texts[IMAGE_TEXTS_MAX];
} png_job;

static void set_texts(png_job *job)
{
    for (int i = 0; i < job->rows->text_count && i < IMAGE_TEXTS_MAX; i++) {
        const image_text *from = &job->rows->texts[i];
        job->texts[i] = (png_text){.compression = PNG_ITXT_COMPRESSION_zTXt,
                                   .key = (png_charp)(uintptr_t)from->keyword,
                                   .text = (png_charp)(uintptr_t)from->text,
                                   .itxt_length = strlen(from->text)};
        png_set_text(job->of.png, job->of.info, &job->texts[i], 1);
    }
}

static void write_chunks(png_job *job, FILE *stream)
{
    png_init_io(job->of.png, stream);
    png_set_IHDR(job->of.png, job->of.info, (png_uint_32)job->rows->width, (png_uint_32)job->rows->height, job->bits,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(job->of.png, job->of.info, PNG_sRGB_INTENT_PERCEPTUAL);
    set_texts(job);
    png_write_info(job->of.png, job->of.info);
    for (size_t count; (count = png_bands_compress(job->bands)) > 0;)
        for (size_t i = 0; i < count; i++) {
            const unsigned char *bytes;
            size_t size;
            if (!png_bands_get(job->bands, i, &bytes, &size))
                png_error(job->of.png, "zlib failed");
            png_write_chunk(job->of.png, (png_const_bytep) "IDAT", bytes, size);
        }
    png_write_chunk(job->of.png, (png_const_bytep) "IEND", NULL, 0); /* png_write_end wants IDAT written by libpng */
}

static bool write_guarded(png_job *job, FILE *stream)
{
    if (setjmp(png_jmpbuf(job->of.png)))
        return false;
    write_chunks(job, stream);
    return true;
}

status codec_png_write(const image_rows *rows, FILE *stream, int bits, bool fast, diagnostic *why)
{
    png_job job = {.rows = rows, .bits = bits};
    status code = png_bands_create(rows, bits, fast, &job.bands, why);
    if (code != STATUS_OK)
        return code;
    if (!png_library_write(&job.of))
        code = out_of_memory(why);
    else if (!write_guarded(&job, stream))
        code = cancel_asked() ? cancel_check(why) : png_library_unwritten(&job.of, why);
    png_destroy_write_struct(&job.of.png, &job.of.info);
    png_bands_destroy(job.bands);
    return code;
}
