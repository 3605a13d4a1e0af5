/* Reading a text of a PNG file through libpng. Everything that must survive a longjmp is in a job, which belongs to a
 * function that does not call setjmp; the function that does has no modified local variables. */
#include "image/codec.h"

#include <png.h>
#include <stdlib.h>

typedef struct png_job {
    png_structp png;
    png_infop info;
    char message[256]; /* libpng's error message */
    const unsigned char *bytes;
    size_t size, used; /* of the file; consumed */
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

/* The limit on a chunk's memory also bounds what a compressed text expands to. */
static bool read_guarded(png_job *job, size_t limit)
{
    if (setjmp(png_jmpbuf(job->png)))
        return false;
    png_set_read_fn(job->png, job, take_bytes);
    png_set_user_limits(job->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(job->png, limit + 4096);
    png_set_chunk_cache_max(job->png, 128);
    png_set_crc_action(job->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(job->png, job->info);
    return true;
}

static char *find(const png_job *job, const char *keyword, size_t limit)
{
    png_textp texts = NULL;
    const int count = png_get_text(job->png, job->info, &texts, NULL);
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, keyword) == 0 && texts[i].text && strlen(texts[i].text) <= limit)
            return texts[i].text;
    return NULL;
}

status image_png_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    png_job job = {.bytes = bytes, .size = size};
    status code = STATUS_OK;
    *text = NULL;
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    if (!job.info) {
        code = out_of_memory(why);
    } else if (!read_guarded(&job, limit)) {
        code = diagnose(why, STATUS_BAD_INPUT, NULL, "the PNG file is damaged: %s", job.message);
    } else {
        const char *found = find(&job, keyword, limit);
        if (found && !(*text = strdup(found)))
            code = out_of_memory(why);
    }
    png_destroy_read_struct(&job.png, &job.info, NULL);
    return code;
}
