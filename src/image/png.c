/* PNG through libpng. Everything that must survive a longjmp is in a job, which belongs to a function that does not
 * call setjmp; the function that does has no modified local variables. */
#include "base/budget.h"
#include "base/cancel.h"
#include "base/status.h"
#include "image/codec.h"
#include "image/image.h"
#include <errno.h>
#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- for reading and writing ---- */

/* The state of libpng's callbacks: an error is stored and jumps back, warnings are ignored, and bytes are read from
 * memory. It is the first member of each job, because libpng passes its address to the callbacks. */
typedef struct png_library {
    png_structp png;
    png_infop info;
    char message[256];          /* libpng's error */
    const unsigned char *bytes; /* the file to read */
    size_t size, used;
    int error;      /* errno when libpng ended */
    bool no_memory; /* an allocation of libpng or zlib failed, which libpng reports like damage */
} png_library;

static __attribute__((noreturn)) void png_library_error(png_structp png, png_const_charp message)
{
    png_library *library = png_get_error_ptr(png);
    library->error = errno;
    snprintf(library->message, sizeof library->message, "%s", message);
    png_longjmp(png, 1);
}

static void png_library_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp allocate_memory(png_structp png, png_alloc_size_t size)
{
    png_library *library = png_get_mem_ptr(png);
    void *memory = malloc(size);
    library->no_memory |= !memory;
    return memory;
}

static void free_memory(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

/* Creates png and info of a job for reading, or for writing; false: out of memory. */
static bool png_library_begin_read(png_library *library)
{
    library->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, library, png_library_error, png_library_warning,
                                            library, allocate_memory, free_memory);
    library->info = library->png ? png_create_info_struct(library->png) : NULL;
    return library->info;
}

static bool png_library_begin_write(png_library *library)
{
    library->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, library, png_library_error, png_library_warning,
                                             library, allocate_memory, free_memory);
    library->info = library->png ? png_create_info_struct(library->png) : NULL;
    return library->info;
}

/* The status of a write, and of a read, that ended with an error of libpng. */
static status png_library_write_error(const png_library *library, diagnostic *why)
{
    return library->no_memory ? out_of_memory(why)
                              : system_error(why, STATUS_FAILURE, NULL, "cannot write the PNG file", library->error,
                                             "write a PFM file instead");
}

static status png_library_read_error(const png_library *library, diagnostic *why)
{
    return library->no_memory ? out_of_memory(why)
                              : diagnose(why, STATUS_BAD_INPUT, "copy the file again, or save it again as PNG",
                                         "the PNG file is damaged: %s", library->message);
}

/* ---- writing: libpng writes the chunks, png_bands.c compresses the pixels ---- */

typedef struct png_writing {
    png_library library; /* first: libpng hands it back */
    const image_rows *rows;
    png_bands *bands;
    int bits;
    png_text texts[IMAGE_TEXTS_MAX];
} png_writing;

static void set_texts(png_writing *job)
{
    for (int i = 0; i < job->rows->text_count && i < IMAGE_TEXTS_MAX; i++) {
        const image_text *from = &job->rows->texts[i];
        job->texts[i] = (png_text){.compression = PNG_ITXT_COMPRESSION_zTXt,
                                   .key = (png_charp)(uintptr_t)from->keyword,
                                   .text = (png_charp)(uintptr_t)from->text,
                                   .itxt_length = strlen(from->text)};
        png_set_text(job->library.png, job->library.info, &job->texts[i], 1);
    }
}

static void write_chunks(png_writing *job, FILE *stream)
{
    png_init_io(job->library.png, stream);
    png_set_IHDR(job->library.png, job->library.info, (png_uint_32)job->rows->width, (png_uint_32)job->rows->height,
                 job->bits, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(job->library.png, job->library.info, PNG_sRGB_INTENT_PERCEPTUAL);
    set_texts(job);
    png_write_info(job->library.png, job->library.info);
    for (size_t count; (count = png_bands_compress(job->bands)) > 0;)
        for (size_t i = 0; i < count; i++) {
            const unsigned char *bytes;
            size_t size;
            if (!png_bands_get(job->bands, i, &bytes, &size))
                png_error(job->library.png, "zlib failed");
            png_write_chunk(job->library.png, (png_const_bytep) "IDAT", bytes, size);
        }
    /* not png_write_end, which requires IDAT chunks written by libpng */
    png_write_chunk(job->library.png, (png_const_bytep) "IEND", NULL, 0);
}

static bool write_guarded(png_writing *job, FILE *stream)
{
    if (setjmp(png_jmpbuf(job->library.png)))
        return false;
    write_chunks(job, stream);
    return true;
}

status codec_png_write(const image_rows *rows, FILE *stream, int bits, bool fast, diagnostic *why)
{
    png_writing job = {.rows = rows, .bits = bits};
    status code = png_bands_create(rows, bits, fast, &job.bands, why);
    if (code != STATUS_OK)
        return code;
    if (!png_library_begin_write(&job.library))
        code = out_of_memory(why);
    else if (!write_guarded(&job, stream))
        code = cancel_asked() ? cancel_check(why) : png_library_write_error(&job.library, why);
    png_destroy_write_struct(&job.library.png, &job.library.info);
    png_bands_destroy(job.bands);
    return code;
}

/* ---- reading ---- */

static void read_bytes(png_structp png, png_bytep to, size_t count)
{
    png_library *from = png_get_io_ptr(png);
    if (count > from->size - from->used)
        png_error(png, "the file is truncated");
    memcpy(to, from->bytes + from->used, count);
    from->used += count;
}

/* libpng allocates memory for a chunk of any length, up to 2 GiB, before it reads the chunk; a chunk above its limit
 * causes only a warning. */
static void check_lengths(const png_library *library)
{
    for (size_t at = 8; library->size > at && library->size - at >= 8;) {
        const size_t length = png_get_uint_32(library->bytes + at), left = library->size - at - 8;
        if (length > left)
            png_error(library->png, "the file is truncated");
        if (memcmp(library->bytes + at + 4, "IEND", 4) == 0)
            return;
        at += 12 + length;
    }
}

/* Protects against files of unknown origin; call it after setjmp, before the first byte is read. No chunk may be longer
 * than the file, nor larger than chunk_max when it is expanded, and a wrong checksum is an error. */
static void png_library_guard(png_library *library, size_t chunk_max)
{
    png_set_read_fn(library->png, library, read_bytes);
    png_set_user_limits(library->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(library->png, chunk_max);
    png_set_chunk_cache_max(library->png, 128);
    png_set_crc_action(library->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    check_lengths(library);
}

typedef struct png_reading {
    png_library library; /* first: libpng hands it back */
    unsigned char *raw;  /* one row, or the image if it is interlaced */
    image *img;
    image_values values;
    png_space space;
    codec_tables tables;
    int bits;
    status code; /* for errors not from libpng */
    diagnostic *why;
} png_reading;

/* Requests RGB or RGBA with 8 or 16 bits from libpng, for any kind of file. */
static void normalize(png_reading *job)
{
    job->bits = png_get_bit_depth(job->library.png, job->library.info) == 16 ? 16 : 8;
    png_set_expand(job->library.png); /* palettes, depths below 8 and transparent colours */
    png_set_gray_to_rgb(job->library.png);
}

static unsigned sample(const png_reading *job, const unsigned char *row, size_t index)
{
    return job->bits == 8 ? row[index] : (unsigned)row[2 * index] << 8 | row[2 * index + 1];
}

/* Linear values, and alpha, which is linear in the file, too; PNG does not multiply colours by it (PNG specification,
 * 12.3). */
static void store_row(png_reading *job, const unsigned char *row, int y, size_t channels)
{
    const size_t first = (size_t)y * (size_t)job->img->width;
    float *pixel = job->img->pixel + 3 * first;
    for (size_t x = 0; x < (size_t)job->img->width; x++) {
        for (size_t channel = 0; channel < 3; channel++)
            pixel[3 * x + channel] = job->tables.of[channel][sample(job, row, channels * x + channel)];
        if (channels == 4)
            job->img->alpha[first + x] =
                (float)((double)sample(job, row, 4 * x + 3) / (job->bits == 8 ? 255.0 : 65535.0));
    }
}

/* The space's tables borrow from its profile. Grey values have no primaries. */
static bool read_space(png_reading *job)
{
    job->code = png_read_space(job->library.bytes, job->library.size, job->values, &job->space, job->why);
    job->space.color.mixes &= (png_get_color_type(job->library.png, job->library.info) & PNG_COLOR_MASK_COLOR) != 0;
    return job->code == STATUS_OK;
}

static bool allocate(png_reading *job, long long width, long long height, bool interlaced)
{
    job->code = codec_begin(width, height, job->library.size, job->bits == 8 ? 255 : 65535,
                            job->values == IMAGE_CODED ? NULL : &job->space.color, &job->img, &job->tables, job->why);
    if (job->code == STATUS_OK && png_get_channels(job->library.png, job->library.info) == 4)
        job->code = image_add_alpha(job->img, job->why);
    if (job->code != STATUS_OK)
        return false;
    if (interlaced)
        job->code = memory_budget_check((uint64_t)height * png_get_rowbytes(job->library.png, job->library.info),
                                        "save it without interlacing", job->why, "the interlaced image");
    if (job->code != STATUS_OK)
        return false;
    /* Zeroed, because an interlaced image is read by combining with the previous contents. */
    job->raw = calloc(interlaced ? (size_t)height : 1, png_get_rowbytes(job->library.png, job->library.info));
    if (!job->raw)
        job->code = out_of_memory(job->why);
    return job->raw;
}

static bool read_rows(png_reading *job)
{
    png_library_guard(&job->library, 8000000);
    png_set_keep_unknown_chunks(job->library.png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_read_info(job->library.png, job->library.info);
    if (!read_space(job))
        return false;
    normalize(job);
    int passes = png_set_interlace_handling(job->library.png);
    png_read_update_info(job->library.png, job->library.info);
    png_uint_32 width = png_get_image_width(job->library.png, job->library.info),
                height = png_get_image_height(job->library.png, job->library.info);
    if (!allocate(job, width, height, passes > 1))
        return false;
    size_t channels = png_get_channels(job->library.png, job->library.info),
           row_bytes = png_get_rowbytes(job->library.png, job->library.info);
    for (int pass = 0; pass < passes; pass++) {
        for (int y = 0; y < job->img->height; y++) {
            unsigned char *row = job->raw + (passes > 1 ? (size_t)y * row_bytes : 0);
            if (cancel_asked()) {
                job->code = cancel_check(job->why);
                return false;
            }
            png_read_row(job->library.png, row, NULL);
            if (pass == passes - 1)
                store_row(job, row, y, channels);
        }
    }
    png_read_end(job->library.png, NULL); /* the remaining chunks must be valid as well */
    codec_color_apply(&job->space.color, 1.0, job->img);
    if (job->space.note[0])
        image_note(job->img->note, "%s", job->space.note);
    job->code = codec_orient(&job->img, job->space.orientation, job->why);
    return job->code == STATUS_OK;
}

static void read_guarded(png_reading *job)
{
    if (setjmp(png_jmpbuf(job->library.png))) {
        job->code = png_library_read_error(&job->library, job->why);
        return;
    }
    if (read_rows(job))
        job->code = STATUS_OK;
}

status codec_png_read(const unsigned char *bytes, size_t size, image_values values, image **out, int *bits,
                      diagnostic *why)
{
    png_reading job = {.library = {.bytes = bytes, .size = size}, .values = values, .why = why, .code = STATUS_FAILURE};
    *out = NULL;
    if (!png_library_begin_read(&job.library))
        out_of_memory(why);
    else
        read_guarded(&job);
    png_destroy_read_struct(&job.library.png, &job.library.info, NULL);
    free(job.raw);
    free(job.space.profile);
    codec_tables_free(&job.tables);
    if (job.code != STATUS_OK) {
        image_destroy(job.img);
        return job.code;
    }
    *bits = job.bits;
    *out = job.img;
    return STATUS_OK;
}

/* ---- reading a text ---- */

/* The limit on a chunk's memory also bounds what a compressed text expands to. */
static bool read_text_guarded(png_library *job, size_t limit)
{
    if (setjmp(png_jmpbuf(job->png)))
        return false;
    png_library_guard(job, limit + 4096);
    png_read_info(job->png, job->info);
    return true;
}

static char *find_text(const png_library *job, const char *keyword, size_t limit)
{
    png_textp texts = NULL;
    const int count = png_get_text(job->png, job->info, &texts, NULL);
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, keyword) == 0 && texts[i].text && strlen(texts[i].text) <= limit)
            return texts[i].text;
    return NULL;
}

/* Whether a text chunk (tEXt, zTXt, iTXt) has this keyword: libpng silently drops a text that it cannot expand. */
static bool has_keyword(const unsigned char *bytes, size_t size, const char *keyword)
{
    const size_t name_size = strlen(keyword) + 1;
    for (size_t at = 8; size > at && size - at >= 12;) {
        const size_t length = png_get_uint_32(bytes + at);
        if (length > size - at - 12)
            return false;
        const bool is_text = memcmp(bytes + at + 5, "TXt", 3) == 0 || memcmp(bytes + at + 5, "EXt", 3) == 0;
        if (is_text && length >= name_size && memcmp(bytes + at + 8, keyword, name_size) == 0)
            return true;
        at += 12 + length;
    }
    return false;
}

status codec_png_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    png_library job = {.bytes = bytes, .size = size};
    status code = STATUS_OK;
    *text = NULL;
    if (!png_library_begin_read(&job)) {
        code = out_of_memory(why);
    } else if (!read_text_guarded(&job, limit)) {
        code = png_library_read_error(&job, why);
    } else {
        const char *found = find_text(&job, keyword, limit);
        if (found && !(*text = strdup(found)))
            code = out_of_memory(why);
        else if (!found && has_keyword(bytes, size, keyword))
            code = diagnose(why, STATUS_BAD_INPUT, "copy the file again, or use another file",
                            "the text '%s' in this PNG file is damaged, or longer than %zu bytes", keyword, limit);
    }
    png_destroy_read_struct(&job.png, &job.info, NULL);
    return code;
}
