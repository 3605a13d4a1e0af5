/* Writing OpenEXR (openexr.com, "OpenEXR File Layout") through OpenEXRCore: one part of scan lines with R, G, B and
 * named channels, 32-bit floats, compressed by ZIP in blocks of 16 lines. The library writes the places of the blocks,
 * which stand before them, at the end: so the file grows in memory. */
#include "image/codec.h"

#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include <OpenEXR/openexr.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_LINES = 16, LEVEL = 4, LEVEL_FAST = 1, COLOURS = 3 };

typedef struct exr_writing {
    const image_rows *rows;
    unsigned char *bytes; /* the file */
    size_t size, room;
    bool failed; /* out of memory */
    exr_context_t file;
    int part;
    float *block; /* 3 values a pixel, if there are colours, then a plane for each channel */
    exr_encode_pipeline_t encoder;
    bool encodes;
} exr_writing;

static int64_t write_at(exr_const_context_t file, void *of, const void *from, uint64_t count, uint64_t to,
                        exr_stream_error_func_ptr_t fail)
{
    exr_writing *w = of;
    (void)file, (void)fail;
    const size_t start = (size_t)to, end = start + (size_t)count;
    if (count > SIZE_MAX / 4 || to > SIZE_MAX / 4 || !GROW(w->bytes, w->room, end)) {
        w->failed = true;
        return -1;
    }
    if (start > w->size) /* the table's place */
        memset(w->bytes + w->size, 0, start - w->size);
    memcpy(w->bytes + start, from, (size_t)count);
    w->size = end > w->size ? end : w->size;
    return (int64_t)count;
}

static void ignore_message(exr_const_context_t file, exr_result_t code, const char *text)
{
    (void)file, (void)code, (void)text;
}

static status check(const exr_writing *w, exr_result_t code, diagnostic *why)
{
    if (code == EXR_ERR_SUCCESS)
        return STATUS_OK;
    return w->failed || code == EXR_ERR_OUT_OF_MEMORY
               ? out_of_memory(why)
               : diagnose(why, STATUS_FAILURE, "write another format", "the OpenEXR library failed: %s",
                          exr_get_default_error_message(code));
}

static status write_header(exr_writing *w, bool fast, diagnostic *why)
{
    static const exr_attr_chromaticities_t srgb = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
    static const char *const colours[COLOURS] = {"R", "G", "B"};
    const image_rows *rows = w->rows;
    TRY(check(w, exr_add_part(w->file, "", EXR_STORAGE_SCANLINE, &w->part), why));
    TRY(check(w, exr_initialize_required_attr_simple(w->file, w->part, rows->width, rows->height, EXR_COMPRESSION_ZIP),
              why));
    TRY(check(w, exr_set_zip_compression_level(w->file, w->part, fast ? LEVEL_FAST : LEVEL), why));
    for (int i = 0; i < (rows->read ? COLOURS : 0); i++)
        TRY(check(w, exr_add_channel(w->file, w->part, colours[i], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                  why));
    for (int i = 0; i < rows->channel_count; i++)
        TRY(check(
            w,
            exr_add_channel(w->file, w->part, rows->channels[i].name, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1),
            why));
    if (rows->read)
        TRY(check(w, exr_attr_set_chromaticities(w->file, w->part, "chromaticities", &srgb), why));
    for (int i = 0; i < rows->text_count; i++)
        TRY(check(w, exr_attr_set_string(w->file, w->part, rows->texts[i].keyword, rows->texts[i].text), why));
    return check(w, exr_write_header(w->file), why);
}

/* The lines y0 <= y < y0 + height. */
static void fill_block(const exr_writing *w, int y0, int height)
{
    const image_rows *rows = w->rows;
    const size_t width = (size_t)rows->width, count = width * (size_t)height, first = (size_t)y0 * width;
    float *at = w->block;
    if (rows->read) {
        for (int y = 0; y < height; y++)
            rows->read(rows->of, y0 + y, at + COLOURS * width * (size_t)y);
        at += COLOURS * count;
    }
    for (int i = 0; i < rows->channel_count; i++, at += count)
        for (size_t k = 0; k < count; k++)
            at[k] = rows->channels[i].value(rows->channels[i].of, first + k);
}

/* The library sorts channels by name. */
static void point_at_block(exr_writing *w, int height)
{
    const image_rows *rows = w->rows;
    const size_t count = (size_t)rows->width * (size_t)height;
    for (int i = 0; i < w->encoder.channel_count; i++) {
        exr_coding_channel_info_t *c = &w->encoder.channels[i];
        const char *colour = rows->read && !c->channel_name[1] ? strchr("RGB", c->channel_name[0]) : NULL;
        const float *from = w->block + (rows->read ? COLOURS * count : 0);
        const int values = colour ? COLOURS : 1;
        if (colour)
            from = w->block + (colour[0] == 'R' ? 0 : colour[0] == 'G' ? 1 : 2);
        for (int k = 0; !colour && strcmp(rows->channels[k].name, c->channel_name) != 0; k++)
            from += count;
        c->user_data_type = EXR_PIXEL_FLOAT;
        c->user_bytes_per_element = sizeof(float);
        c->user_pixel_stride = values * (int32_t)sizeof(float);
        c->user_line_stride = c->user_pixel_stride * rows->width;
        c->encode_from_ptr = (const uint8_t *)from;
    }
}

static status write_blocks(exr_writing *w, diagnostic *why)
{
    for (int y = 0; y < w->rows->height; y += BLOCK_LINES) {
        exr_chunk_info_t block;
        TRY(cancel_check(why));
        TRY(check(w, exr_write_scanline_chunk_info(w->file, w->part, y, &block), why));
        fill_block(w, y, block.height);
        TRY(check(w,
                  w->encodes ? exr_encoding_update(w->file, w->part, &block, &w->encoder)
                             : exr_encoding_initialize(w->file, w->part, &block, &w->encoder),
                  why));
        w->encodes = true;
        point_at_block(w, block.height);
        TRY(check(w, exr_encoding_choose_default_routines(w->file, w->part, &w->encoder), why));
        TRY(check(w, exr_encoding_run(w->file, w->part, &w->encoder), why));
    }
    return STATUS_OK;
}

static status make_file(exr_writing *w, bool fast, diagnostic *why)
{
    const image_rows *rows = w->rows;
    const size_t values = (size_t)rows->channel_count + (rows->read ? COLOURS : 0), width = (size_t)rows->width,
                 lines = (size_t)rows->height;
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = ignore_message;
    settings.user_data = w;
    settings.write_fn = write_at;
    TRY(memory_budget_check(values * width * (lines + BLOCK_LINES) * sizeof(float), "write .pfm instead", why,
                            "an OpenEXR file of %d x %d pixels with %zu values each", rows->width, rows->height,
                            values));
    if (!(w->block = malloc(values * width * BLOCK_LINES * sizeof *w->block)))
        return out_of_memory(why);
    const exr_result_t started = exr_start_write(&w->file, "image", EXR_WRITE_FILE_DIRECTLY, &settings);
    if (started != EXR_ERR_SUCCESS)
        w->file = NULL;
    TRY(check(w, started, why));
    TRY(write_header(w, fast, why));
    return write_blocks(w, why);
}

status codec_exr_write(const image_rows *rows, FILE *stream, bool fast, diagnostic *why)
{
    exr_writing w = {.rows = rows};
    status code = make_file(&w, fast, why);
    if (w.encodes)
        exr_encoding_destroy(w.file, &w.encoder);
    const exr_result_t ended = exr_finish(&w.file); /* writes the table */
    THEN(code, check(&w, ended, why));
    if (code == STATUS_OK) /* a write error stays set in the stream */
        fwrite(w.bytes, 1, w.size, stream);
    free(w.block);
    free(w.bytes);
    return code;
}
