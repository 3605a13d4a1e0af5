/* Reading OpenEXR (openexr.com, "Technical Introduction to OpenEXR") through OpenEXRCore, the C library of OpenEXR: it
 * starts no threads, and reads the bytes through read_at. The image is the display window; where the data window does
 * not cover it, it is black and transparent. Colours are those of the first part, deep ones apart, that has: R, G and B
 * without a layer; else the first layer by name with R, G and B; else Y, perhaps with the chroma RY and BY; else one
 * channel alone. Values are linear and multiplied by A ("associated alpha"), by which they are divided here. */
#include "image/codec.h"

#include "base/budget.h"
#include "base/cancel.h"
#include <OpenEXR/openexr.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEMORY_MAX ((size_t)1 << 31) /* of a block of the library's */
#define DAMAGED "copy the file again, or save it anew"

enum { RED, GREEN, BLUE, ALPHA, CHANNELS };
enum { NONE = -1 };

/* ---- the library ---- */

typedef struct exr_source {
    const unsigned char *bytes;
    size_t size;
    exr_context_t file;
    char said[256]; /* the first message of the library since the last success */
} exr_source;

static int64_t read_at(exr_const_context_t file, void *of, void *to, uint64_t count, uint64_t from,
                       exr_stream_error_func_ptr_t fail)
{
    const exr_source *s = of;
    (void)file, (void)fail;
    const size_t left = from < s->size ? s->size - (size_t)from : 0, got = count < left ? (size_t)count : left;
    if (got > 0)
        memcpy(to, s->bytes + from, got);
    return (int64_t)got;
}

static int64_t size_of(exr_const_context_t file, void *of)
{
    (void)file;
    return (int64_t)((const exr_source *)of)->size;
}

static void keep_message(exr_const_context_t file, exr_result_t code, const char *text)
{
    void *of = NULL;
    (void)code;
    if (!file || exr_get_user_data(file, &of) != EXR_ERR_SUCCESS || !of)
        return;
    exr_source *s = of;
    if (!s->said[0])
        snprintf(s->said, sizeof s->said, "%s", text);
}

/* The library reports some damage as a lack of memory: whether this was one, in the last call on this thread. */
static _Thread_local bool lacks_memory;

static void *take_memory(size_t bytes)
{
    void *memory = bytes <= MEMORY_MAX ? malloc(bytes) : NULL;
    lacks_memory |= bytes <= MEMORY_MAX && !memory;
    return memory;
}

/* The status of a call of the library. */
static status check(exr_source *s, exr_result_t code, diagnostic *why)
{
    if (code == EXR_ERR_SUCCESS) {
        s->said[0] = 0; /* a remark */
        return STATUS_OK;
    }
    if (lacks_memory) {
        lacks_memory = false;
        return out_of_memory(why);
    }
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
        return diagnose(why, STATUS_BAD_INPUT, "save it with the compression ZIP or PIZ",
                        "the OpenEXR file is compressed by DWAA or DWAB, which the OpenEXR library in C does not read");
    return diagnose(why, STATUS_BAD_INPUT, DAMAGED, "the OpenEXR file is damaged: %s",
                    s->said[0] ? s->said : exr_get_default_error_message(code));
}

static status open_source(exr_source *s, diagnostic *why)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = keep_message;
    settings.user_data = s;
    settings.alloc_fn = take_memory;
    settings.free_fn = free;
    settings.read_fn = read_at;
    settings.size_fn = size_of;
    settings.max_image_width = settings.max_image_height = IMAGE_SIDE_MAX;
    settings.max_tile_width = settings.max_tile_height = IMAGE_SIDE_MAX;
    const exr_result_t code = exr_start_read(&s->file, "image", &settings);
    if (code != EXR_ERR_SUCCESS)
        s->file = NULL;
    return check(s, code, why);
}

/* ---- the choice of channels ---- */

typedef struct exr_reading {
    exr_source source;
    int part, channel[CHANNELS]; /* numbers in the part's list, or NONE; grey is RED alone */
    bool chroma;                 /* GREEN and BLUE are RY and BY */
    bool tiled;
    exr_attr_box2i_t data, display;
    int32_t tile_width, tile_height;
    image *img;
    exr_decode_pipeline_t decoder;
    bool decodes;
    float *chunk; /* planes of the channels */
    size_t chunk_room;
    exr_chroma planes;
} exr_reading;

static int find(const exr_attr_chlist_t *list, const char *layer, size_t length, const char *word)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        if (strncmp(name, layer, length) == 0 && strcmp(name + length, word) == 0)
            return i;
    }
    return NONE;
}

/* Channels with these names behind the layer's name and its point; whether the first three of them are there. */
static bool take(exr_reading *r, const exr_attr_chlist_t *list, const char *layer, size_t length)
{
    static const char *const words[CHANNELS] = {"R", "G", "B", "A"};
    for (int i = 0; i < CHANNELS; i++)
        r->channel[i] = find(list, layer, length, words[i]);
    return r->channel[RED] != NONE && r->channel[GREEN] != NONE && r->channel[BLUE] != NONE;
}

static bool take_colours(exr_reading *r, const exr_attr_chlist_t *list)
{
    return take(r, list, "", 0);
}

/* The list is sorted by name. */
static bool take_layer(exr_reading *r, const exr_attr_chlist_t *list)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str, *point = strrchr(name, '.');
        if (point && strcmp(point, ".R") == 0 && take(r, list, name, (size_t)(point - name) + 1))
            return true;
    }
    return false;
}

static bool take_grey(exr_reading *r, const exr_attr_chlist_t *list)
{
    const int red = find(list, "", 0, "RY"), blue = find(list, "", 0, "BY");
    r->channel[RED] = find(list, "", 0, "Y");
    r->channel[ALPHA] = find(list, "", 0, "A");
    r->chroma = red != NONE && blue != NONE;
    r->channel[GREEN] = r->chroma ? red : NONE;
    r->channel[BLUE] = r->chroma ? blue : NONE;
    return r->channel[RED] != NONE;
}

static bool take_single(exr_reading *r, const exr_attr_chlist_t *list)
{
    r->chroma = false;
    r->channel[RED] = 0;
    r->channel[GREEN] = r->channel[BLUE] = r->channel[ALPHA] = NONE;
    return list->num_channels == 1;
}

static bool is_flat(const exr_reading *r, int part)
{
    exr_storage_t storage;
    return exr_get_storage(r->source.file, part, &storage) == EXR_ERR_SUCCESS &&
           (storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED);
}

static status choose_channels(exr_reading *r, diagnostic *why)
{
    static bool (*const rules[])(exr_reading * r, const exr_attr_chlist_t *list) = {take_colours, take_layer, take_grey,
                                                                                    take_single};
    int parts = 0, deep = 0;
    TRY(check(&r->source, exr_get_count(r->source.file, &parts), why));
    for (size_t rule = 0; rule < sizeof rules / sizeof *rules; rule++)
        for (r->part = 0; r->part < parts; r->part++) {
            const exr_attr_chlist_t *list;
            if (!is_flat(r, r->part))
                deep++;
            else if (exr_get_channels(r->source.file, r->part, &list) == EXR_ERR_SUCCESS && rules[rule](r, list))
                return STATUS_OK;
        }
    return deep > 0 ? diagnose(why, STATUS_BAD_INPUT, "flatten it in the program that made it",
                               "the OpenEXR file has deep pixels, lists of samples, and no image")
                    : diagnose(why, STATUS_BAD_INPUT, "save it with channels R, G and B, or Y",
                               "the OpenEXR file has no colours: no layer of it has channels R, G and B");
}

/* ---- the header ---- */

static long long length(int32_t from, int32_t to)
{
    return (long long)to - from + 1;
}

/* Chroma has half the lines and columns of luminance; everything else has a value in each pixel. */
static status check_sampling(const exr_reading *r, diagnostic *why)
{
    const exr_attr_chlist_t *list;
    if (exr_get_channels(r->source.file, r->part, &list) != EXR_ERR_SUCCESS)
        return STATUS_OK;
    for (int i = 0; i < CHANNELS; i++) {
        const int32_t step = r->chroma && (i == GREEN || i == BLUE) ? 2 : 1;
        const exr_attr_chlist_entry_t *c = r->channel[i] != NONE ? &list->entries[r->channel[i]] : NULL;
        if (c && (c->x_sampling != step || c->y_sampling != step))
            return diagnose(why, STATUS_BAD_INPUT, "save it with all channels in full resolution",
                            "the channel '%s' of the OpenEXR file has a value in every %d columns and %d lines only",
                            c->name.str, (int)c->x_sampling, (int)c->y_sampling);
    }
    return STATUS_OK;
}

static status read_windows(exr_reading *r, diagnostic *why)
{
    const exr_const_context_t file = r->source.file;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    TRY(check(&r->source, exr_get_data_window(file, r->part, &r->data), why));
    TRY(check(&r->source, exr_get_display_window(file, r->part, &r->display), why));
    TRY(check(&r->source, exr_get_storage(file, r->part, &storage), why));
    r->tiled = storage == EXR_STORAGE_TILED;
    if (r->tiled)
        TRY(check(&r->source, exr_get_tile_sizes(file, r->part, 0, 0, &r->tile_width, &r->tile_height), why));
    const exr_attr_box2i_t windows[] = {r->data, r->display};
    for (int i = 0; i < 2; i++)
        TRY(codec_check_size(length(windows[i].min.x, windows[i].max.x), length(windows[i].min.y, windows[i].max.y),
                             r->source.size, why));
    return check_sampling(r, why);
}

static status prepare(exr_reading *r, diagnostic *why)
{
    const size_t width = (size_t)length(r->display.min.x, r->display.max.x),
                 height = (size_t)length(r->display.min.y, r->display.max.y);
    TRY(image_create((int)width, (int)height, &r->img, why));
    if (r->channel[ALPHA] != NONE) {
        TRY(image_add_alpha(r->img, why));
        memset(r->img->alpha, 0, width * height * sizeof *r->img->alpha);
    }
    return r->chroma ? exr_chroma_create(&r->planes, (int)length(r->data.min.x, r->data.max.x),
                                         (int)length(r->data.min.y, r->data.max.y), why)
                     : STATUS_OK;
}

/* ---- pixels ---- */

/* Copies the chunk, whose first pixel has these coordinates. */
static void store(exr_reading *r, int64_t x0, int64_t y0, size_t width, size_t height)
{
    const size_t plane = width * height;
    for (size_t i = 0; i < plane; i++) {
        const int64_t x = x0 + (int64_t)(i % width) - r->display.min.x,
                      y = y0 + (int64_t)(i / width) - r->display.min.y;
        if (x < 0 || y < 0 || x >= r->img->width || y >= r->img->height)
            continue;
        const size_t at = (size_t)y * (size_t)r->img->width + (size_t)x;
        for (size_t channel = 0; channel < 3; channel++)
            r->img->pixel[3 * at + channel] =
                r->chunk[i + (r->chroma || r->channel[channel] == NONE ? 0 : channel * plane)];
        if (r->img->alpha)
            r->img->alpha[at] = r->chunk[i + ALPHA * plane];
    }
}

/* Copies the chunk's lines of chroma: those of even number, counted from the first of the data window. */
static void store_chroma(exr_reading *r, int64_t y0, size_t width, size_t height)
{
    const size_t from = (size_t)(y0 - r->data.min.y + 1) / 2, to = ((size_t)(y0 - r->data.min.y) + height + 1) / 2,
                 columns = (size_t)r->planes.columns, count = columns * (to - from) * sizeof(float);
    if (to > (size_t)r->planes.lines)
        return;
    memcpy(r->planes.red + from * columns, r->chunk + GREEN * width * height, count);
    memcpy(r->planes.blue + from * columns, r->chunk + BLUE * width * height, count);
}

/* IEEE 754 binary16. */
static float half_value(unsigned half)
{
    const uint32_t sign = (half & 0x8000U) << 16, exponent = half >> 10 & 31U, fraction = half & 1023U;
    const uint32_t word = sign | (exponent == 31U ? 255U : exponent + 112U) << 23 | fraction << 13;
    float value;
    if (exponent == 0)
        return (sign ? -1.0F : 1.0F) * (float)fraction * 0x1p-24F;
    memcpy(&value, &word, sizeof value);
    return value;
}

static float value_at(const uint8_t *at, int type)
{
    const uint32_t low = (uint32_t)at[0] | (uint32_t)at[1] << 8;
    if (type == EXR_PIXEL_HALF)
        return half_value(low);
    const uint32_t word = low | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    float value;
    memcpy(&value, &word, sizeof value);
    return type == EXR_PIXEL_FLOAT ? value : (float)word;
}

/* Copies the chunk's lines, each with all channels one after another, into planes. The library's own functions for this
 * ignore skipped or sampled channels for some layouts (OpenEXR 3.1.5, unpack.c). */
static exr_result_t unpack(exr_decode_pipeline_t *d)
{
    exr_reading *r = d->decoding_user_data;
    const uint8_t *at = d->unpacked_buffer, *end = at + d->chunk.unpacked_size;
    const size_t plane = (size_t)d->chunk.width * (size_t)d->chunk.height;
    for (int y = 0; y < d->chunk.height; y++)
        for (int i = 0; i < d->channel_count; i++) {
            const exr_coding_channel_info_t *c = &d->channels[i];
            const size_t width = (size_t)c->width, bytes = (size_t)c->bytes_per_element;
            if (c->y_samples > 1 && (d->chunk.start_y + y) % c->y_samples != 0)
                continue;
            if (width * bytes > (size_t)(end - at))
                return EXR_ERR_CORRUPT_CHUNK;
            for (size_t k = 0; k < CHANNELS; k++) {
                float *to = r->chunk + k * plane + (size_t)(y / c->y_samples) * width;
                for (size_t x = 0; r->channel[k] == i && x < width; x++)
                    to[x] = value_at(at + x * bytes, c->data_type);
            }
            at += width * bytes;
        }
    return EXR_ERR_SUCCESS;
}

static status decode_chunk(exr_reading *r, const exr_chunk_info_t *c, int64_t x0, int64_t y0, diagnostic *why)
{
    const size_t width = (size_t)c->width, height = (size_t)c->height, values = CHANNELS * width * height;
    const exr_const_context_t file = r->source.file;
    TRY(cancel_check(why));
    if (c->unpacked_size > MEMORY_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "save it with smaller tiles",
                        "a tile of the OpenEXR file has %d x %d pixels of many channels", (int)c->width,
                        (int)c->height);
    /* the library has the packed bytes, the unpacked ones, and two buffers of their size in between */
    TRY(memory_budget_check(4 * c->unpacked_size + values * sizeof *r->chunk, "save it with smaller tiles", why,
                            "a tile of %d x %d pixels", (int)c->width, (int)c->height));
    if (values > r->chunk_room) {
        free(r->chunk);
        r->chunk_room = 0;
        if (!(r->chunk = malloc(values * sizeof *r->chunk)))
            return out_of_memory(why);
        r->chunk_room = values;
    }
    memset(r->chunk, 0, values * sizeof *r->chunk);
    TRY(check(&r->source,
              r->decodes ? exr_decoding_update(file, r->part, c, &r->decoder)
                         : exr_decoding_initialize(file, r->part, c, &r->decoder),
              why));
    r->decodes = true;
    TRY(check(&r->source, exr_decoding_choose_default_routines(file, r->part, &r->decoder), why));
    r->decoder.unpack_and_convert_fn = unpack;
    r->decoder.decoding_user_data = r;
    if (c->packed_size == c->unpacked_size) /* what compression would not shrink is stored as it is, under B44, too */
        r->decoder.decompress_fn = NULL;
    TRY(check(&r->source, exr_decoding_run(file, r->part, &r->decoder), why));
    store(r, x0, y0, width, height);
    if (r->chroma)
        store_chroma(r, y0, width, height);
    return STATUS_OK;
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static status no_height(diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, DAMAGED, "the OpenEXR file is damaged: a piece of it has no pixels");
}

/* Lines of chroma beyond the display window count, too: all are read. */
static status read_lines(exr_reading *r, diagnostic *why)
{
    int64_t y = r->data.min.y, last = r->data.max.y;
    if (!r->chroma)
        y = larger(y, r->display.min.y), last = smaller(last, r->display.max.y);
    while (y <= last) {
        exr_chunk_info_t c;
        TRY(check(&r->source, exr_read_scanline_chunk_info(r->source.file, r->part, (int)y, &c), why));
        if (c.width < 1 || c.height < 1 || c.start_y > y || c.start_y + (int64_t)c.height <= y)
            return no_height(why);
        TRY(decode_chunk(r, &c, r->data.min.x, c.start_y, why));
        y = c.start_y + (int64_t)c.height;
    }
    return STATUS_OK;
}

static status read_tiles(exr_reading *r, diagnostic *why)
{
    const int64_t left = larger(r->data.min.x, r->display.min.x), right = smaller(r->data.max.x, r->display.max.x),
                  top = larger(r->data.min.y, r->display.min.y), bottom = smaller(r->data.max.y, r->display.max.y);
    if (r->tile_width < 1 || r->tile_height < 1)
        return no_height(why);
    for (int64_t row = (top - r->data.min.y) / r->tile_height;
         top <= bottom && row <= (bottom - r->data.min.y) / r->tile_height; row++)
        for (int64_t column = (left - r->data.min.x) / r->tile_width;
             left <= right && column <= (right - r->data.min.x) / r->tile_width; column++) {
            exr_chunk_info_t c;
            TRY(check(&r->source, exr_read_tile_chunk_info(r->source.file, r->part, (int)column, (int)row, 0, 0, &c),
                      why));
            if (c.width < 1 || c.height < 1)
                return no_height(why);
            TRY(decode_chunk(r, &c, r->data.min.x + column * r->tile_width, r->data.min.y + row * r->tile_height, why));
        }
    return STATUS_OK;
}

static status read_image(exr_reading *r, diagnostic *why)
{
    exr_attr_chromaticities_t c;
    TRY(open_source(&r->source, why));
    TRY(choose_channels(r, why));
    TRY(read_windows(r, why));
    TRY(prepare(r, why));
    TRY(r->tiled ? read_tiles(r, why) : read_lines(r, why));
    const bool given = exr_attr_get_chromaticities(r->source.file, r->part, "chromaticities", &c) == EXR_ERR_SUCCESS;
    const double primaries[8] = {c.white_x, c.white_y, c.red_x, c.red_y, c.green_x, c.green_y, c.blue_x, c.blue_y};
    return exr_colours_convert(r->img, given ? primaries : NULL, r->chroma ? &r->planes : NULL,
                               r->display.min.x - (int64_t)r->data.min.x, r->display.min.y - (int64_t)r->data.min.y,
                               why);
}

status codec_exr_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why)
{
    exr_reading r = {.source = {.bytes = bytes, .size = size}};
    *out = NULL;
    const status code = read_image(&r, why);
    if (r.decodes)
        exr_decoding_destroy(r.source.file, &r.decoder);
    exr_finish(&r.source.file);
    free(r.chunk);
    exr_chroma_release(&r.planes);
    if (code == STATUS_OK)
        *out = r.img;
    else
        image_destroy(r.img);
    return code;
}

/* ---- reading a text ---- */

status codec_exr_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    exr_source s = {.bytes = bytes, .size = size};
    const char *found = NULL;
    int32_t count = 0;
    *text = NULL;
    TRY(open_source(&s, why));
    status code = STATUS_OK;
    if (exr_attr_get_string(s.file, 0, keyword, &count, &found) == EXR_ERR_SUCCESS && found && count > 0) {
        if ((size_t)count > limit)
            code = diagnose(why, STATUS_BAD_INPUT, "copy the file again, or use another file",
                            "the text '%s' in this OpenEXR file is longer than %zu bytes", keyword, limit);
        else if (!(*text = strndup(found, (size_t)count)))
            code = out_of_memory(why);
    }
    exr_finish(&s.file);
    return code;
}
