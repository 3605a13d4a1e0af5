/* BMP: a file header of 14 bytes, a header of 12 bytes (OS/2 1) to 124 bytes (BITMAPV5HEADER), masks or a palette,
 * and from the file header's offset rows of pixels, each padded to a multiple of 4 bytes; from the bottom, or from
 * the top if the height is negative. Microsoft, Windows GDI, "Bitmap Storage"; IBM, OS/2 2.0 Presentation Manager.
 * Numbers are little-endian.
 *
 * Bit fields have any contiguous bits. The fourth byte of 32 bits is alpha only if a mask says so. Pixels that
 * run-length compression skips have the first colour of the palette, and alpha 0. Of colour spaces, an embedded
 * profile is applied. */
#include "base/cancel.h"
#include "image/codec.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    FILE_HEADER = 14,
    OS2_HEADER = 12,
    OS2_HEADER_2_SHORT = 16,
    OS2_HEADER_2 = 64,
    INFO_HEADER = 40,
    ALPHA_HEADER = 56, /* the least header with a mask of alpha */
    V4_HEADER = 108,
    V5_HEADER = 124
};
/* The header's compression; OS/2 has two of its own in place of FIELDS and JPEG. */
enum { PLAIN, RLE8, RLE4, FIELDS, JPEG, PNG, ALPHA_FIELDS, OS2_HUFFMAN = FIELDS, OS2_RLE24 = JPEG };
enum { EMBEDDED = 0x4d424544, LINKED = 0x4c494e4b }; /* the colour space: MBED, LINK */
enum { CHANNELS = 4, FIELD_BITS_MAX = 16, PALETTE_MAX = 256 };

#define REMEDY "save the file as a BMP of 24 bits, or as PNG"
#define DAMAGED "copy the file again, or save it as PNG"

/* A channel of a pixel: (pixel >> shift) & maximum. No bits: 0, and alpha 1. */
typedef struct bit_field {
    unsigned shift, maximum;
} bit_field;

typedef struct bmp_reading {
    const unsigned char *bytes;
    size_t size;
    uint32_t header, bits, compression;
    bool os2; /* a header of OS/2 2 */
    bool from_top;
    int64_t width, height;
    size_t offset, row_bytes;
    bit_field field[CHANNELS];
    float palette[PALETTE_MAX][3];
    size_t colors; /* of the palette; 0: none */
    codec_color color;
    codec_tables tables;
    image *img;
    diagnostic *why;
} bmp_reading;

static uint32_t number_at(const bmp_reading *job, size_t at, int bytes)
{
    return codec_little_endian(job->bytes + at, bytes);
}

static int64_t signed_at(const bmp_reading *job, size_t at)
{
    const int64_t value = number_at(job, at, 4);
    return value >= INT64_C(0x80000000) ? value - INT64_C(0x100000000) : value;
}

/* ---- headers ---- */

static status read_header_size(bmp_reading *job)
{
    job->header = job->size >= FILE_HEADER + 4 ? number_at(job, FILE_HEADER, 4) : 0;
    const bool old = job->header == OS2_HEADER || job->header == OS2_HEADER_2_SHORT;
    if (job->size < FILE_HEADER + OS2_HEADER || (!old && job->size < FILE_HEADER + INFO_HEADER) ||
        (job->header <= V5_HEADER && job->header > job->size - FILE_HEADER))
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED,
                        "the BMP file is truncated: %zu bytes are less than a header", job->size);
    if (!old && (job->header < INFO_HEADER || job->header > V5_HEADER))
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY,
                        "the header of the BMP file is damaged: its size is %lu bytes", (unsigned long)job->header);
    job->os2 = job->header == OS2_HEADER_2_SHORT || job->header == OS2_HEADER_2;
    return STATUS_OK;
}

/* Only the fields used below are trusted; the file size in the header is often wrong and is ignored. */
static void read_numbers(bmp_reading *job)
{
    const bool oldest = job->header == OS2_HEADER;
    job->offset = number_at(job, 10, 4);
    job->width = oldest ? number_at(job, 18, 2) : signed_at(job, 18);
    job->height = oldest ? number_at(job, 20, 2) : signed_at(job, 22);
    job->bits = number_at(job, oldest ? 24 : 28, 2);
    job->compression = job->header > OS2_HEADER_2_SHORT ? number_at(job, 30, 4) : PLAIN;
    job->from_top = job->height < 0;
    job->height = job->from_top ? -job->height : job->height;
}

static bool is_run_length(const bmp_reading *job)
{
    return job->compression == RLE8 || job->compression == RLE4 || (job->os2 && job->compression == OS2_RLE24);
}

static bool has_fields(const bmp_reading *job)
{
    return !job->os2 && (job->compression == FIELDS || job->compression == ALPHA_FIELDS);
}

static status check_kind(const bmp_reading *job)
{
    const uint32_t bits = job->bits, kind = job->compression;
    const unsigned long depth = bits, number = kind;
    if (job->os2 && kind == OS2_HUFFMAN)
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY, "the BMP file has the unsupported Huffman compression");
    if (kind > ALPHA_FIELDS || (job->os2 && kind > OS2_RLE24))
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY, "the BMP file has the unsupported compression %lu", number);
    const bool right = is_run_length(job) ? bits == (kind == RLE8   ? 8
                                                     : kind == RLE4 ? 4
                                                                    : 24)
                       : has_fields(job)
                           ? bits == 16 || bits == 32
                           : bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16 || bits == 24 || bits == 32;
    if (!right)
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY,
                        "the BMP file has %lu bits per pixel, which is not supported with compression %lu", depth,
                        number);
    if (is_run_length(job) && job->from_top)
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY,
                        "the BMP file is damaged: rows with run-length compression begin at the bottom");
    return STATUS_OK;
}

/* The offset of the palette. */
static size_t headers_end(const bmp_reading *job)
{
    const size_t masks = job->header != INFO_HEADER || !has_fields(job) ? 0 : job->compression == FIELDS ? 12 : 16;
    return FILE_HEADER + job->header + masks;
}

static status check_sizes(bmp_reading *job)
{
    TRY(codec_check_size(job->width, job->height, job->size, job->why));
    job->row_bytes = ((size_t)job->width * job->bits + 31) / 32 * 4;
    if (job->offset < headers_end(job) || job->offset > job->size)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED,
                        "the BMP file is damaged: its pixels begin at byte %zu of %zu", job->offset, job->size);
    /* sides are at most 65536: no overflow; the last row may lack its padding */
    const size_t needed = job->row_bytes * (size_t)(job->height - 1) + ((size_t)job->width * job->bits + 7) / 8;
    if (!is_run_length(job) && job->size - job->offset < needed)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED,
                        "the BMP file is truncated: %zu bytes of pixels instead of %zu", job->size - job->offset,
                        needed);
    return STATUS_OK;
}

/* ---- colours ---- */

/* A field of more than 16 bits is read to 16 bits. */
static status read_mask(bmp_reading *job, uint32_t mask, bit_field *out)
{
    unsigned shift = 0, count = 0;
    while (mask && !(mask >> shift & 1))
        shift++;
    while (shift + count < 32 && mask >> (shift + count) & 1)
        count++;
    if (mask && mask != (count < 32 ? (1U << count) - 1 : ~0U) << shift)
        return diagnose(job->why, STATUS_BAD_INPUT, REMEDY,
                        "the BMP file is damaged: the bits of a channel, %08lx, are not adjacent", (unsigned long)mask);
    const unsigned extra = count > FIELD_BITS_MAX ? count - FIELD_BITS_MAX : 0;
    *out = (bit_field){.shift = shift + extra, .maximum = (1U << (count - extra)) - 1};
    return STATUS_OK;
}

static status read_fields(bmp_reading *job)
{
    static const uint32_t of_16[CHANNELS] = {0x7c00, 0x03e0, 0x001f, 0}, of_32[CHANNELS] = {0xff0000, 0xff00, 0xff, 0};
    const bool has_alpha = job->header >= ALPHA_HEADER || job->compression == ALPHA_FIELDS;
    if (has_fields(job) && FILE_HEADER + INFO_HEADER + (has_alpha ? 16U : 12U) > job->size)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is truncated: it has no bit fields");
    for (size_t c = 0; c < CHANNELS; c++) {
        uint32_t mask = job->bits == 16 ? of_16[c] : of_32[c];
        if (has_fields(job))
            mask = c < 3 || has_alpha ? number_at(job, FILE_HEADER + INFO_HEADER + 4 * c, 4) : 0;
        TRY(read_mask(job, mask, &job->field[c]));
    }
    return STATUS_OK;
}

static void read_space(bmp_reading *job)
{
    const uint32_t space = job->header >= V4_HEADER ? number_at(job, FILE_HEADER + ALPHA_HEADER, 4) : 0;
    if (space == LINKED)
        image_note(job->img->note, "its colour profile is in another file, and ignored");
    if (space != EMBEDDED || job->header < V5_HEADER)
        return;
    const size_t at = FILE_HEADER + (size_t)number_at(job, FILE_HEADER + 112, 4),
                 length = number_at(job, FILE_HEADER + 116, 4);
    const char *reason = at <= job->size && length <= job->size - at
                             ? codec_color_of_icc(job->bytes + at, length, &job->color)
                             : "is damaged";
    if (reason)
        image_note(job->img->note, CODEC_PROFILE_NOTE, reason);
}

static void store(const codec_tables *tables, unsigned r, unsigned g, unsigned b, float *pixel)
{
    pixel[0] = tables->of[0][r], pixel[1] = tables->of[1][g], pixel[2] = tables->of[2][b];
}

/* A palette that is shorter than the pixels' values allow is normal; values beyond it are damage. */
static status read_palette(bmp_reading *job)
{
    const size_t entry = job->header == OS2_HEADER ? 3 : 4, from = headers_end(job), most = (size_t)1 << job->bits,
                 room = (job->offset - from) / entry, used = job->header >= 36 ? number_at(job, 46, 4) : 0;
    job->colors = used > 0 && used < most ? used : most;
    job->colors = room < job->colors ? room : job->colors;
    for (size_t i = 0; i < job->colors; i++) {
        const unsigned char *bgr = job->bytes + from + entry * i;
        store(&job->tables, bgr[2], bgr[1], bgr[0], job->palette[i]);
    }
    return job->colors > 0
               ? STATUS_OK
               : diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is damaged: it has no palette");
}

static status read_colors(bmp_reading *job, image_values values)
{
    const bool fields = job->bits == 16 || job->bits == 32;
    if (fields)
        TRY(read_fields(job));
    const unsigned maximum[3] = {fields ? job->field[0].maximum : 255, fields ? job->field[1].maximum : 255,
                                 fields ? job->field[2].maximum : 255};
    TRY(codec_tables_make(values == IMAGE_CODED ? NULL : &job->color, maximum, &job->tables, job->why));
    return job->bits <= 8 ? read_palette(job) : STATUS_OK;
}

/* ---- pixels ---- */

static float *pixel_at(const bmp_reading *job, size_t row, size_t x)
{
    const size_t y = job->from_top ? row : (size_t)job->height - 1 - row;
    return job->img->pixel + (y * (size_t)job->width + x) * 3;
}

static float *alpha_at(const bmp_reading *job, size_t row, size_t x)
{
    return job->img->alpha + (pixel_at(job, row, x) - job->img->pixel) / 3;
}

static status store_index(const bmp_reading *job, unsigned index, float *pixel)
{
    if (index >= job->colors)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED,
                        "the BMP file is damaged: a pixel has color %u of a palette of %zu", index, job->colors);
    memcpy(pixel, job->palette[index], sizeof job->palette[index]);
    return STATUS_OK;
}

static status read_row(const bmp_reading *job, const unsigned char *from, size_t row)
{
    float *pixel = pixel_at(job, row, 0);
    for (size_t x = 0; x < (size_t)job->width; x++, pixel += 3) {
        if (job->bits <= 8) {
            const size_t bit = x * job->bits;
            const unsigned index = from[bit / 8] >> (8 - job->bits - bit % 8) & ((1U << job->bits) - 1);
            TRY(store_index(job, index, pixel));
        } else if (job->bits == 24) {
            store(&job->tables, from[3 * x + 2], from[3 * x + 1], from[3 * x], pixel);
        } else {
            const bit_field *f = job->field;
            const uint32_t word = codec_little_endian(from + x * job->bits / 8, (int)job->bits / 8);
            store(&job->tables, word >> f[0].shift & f[0].maximum, word >> f[1].shift & f[1].maximum,
                  word >> f[2].shift & f[2].maximum, pixel);
            if (job->img->alpha)
                *alpha_at(job, row, x) = (float)((word >> f[3].shift & f[3].maximum) / (double)f[3].maximum);
        }
    }
    return STATUS_OK;
}

static status read_rows(bmp_reading *job)
{
    if ((job->bits == 16 || job->bits == 32) && job->field[3].maximum > 0)
        TRY(image_add_alpha(job->img, job->why));
    for (size_t row = 0; row < (size_t)job->height; row++) {
        TRY(cancel_check(job->why));
        TRY(read_row(job, job->bytes + job->offset + row * job->row_bytes, row));
    }
    return STATUS_OK;
}

/* ---- run lengths ---- */

typedef struct run_reading {
    bmp_reading *job;
    const unsigned char *at, *end;
    size_t row, x, written;
} run_reading;

/* Stores pixel i of the bytes of a run, or of pixels without runs. */
static status store_run(run_reading *r, const unsigned char *from, size_t i)
{
    bmp_reading *job = r->job;
    if (r->row >= (size_t)job->height || r->x >= (size_t)job->width)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is damaged: a run leaves row %zu of %lld",
                        r->row, (long long)job->height);
    float *pixel = pixel_at(job, r->row, r->x), *alpha = alpha_at(job, r->row, r->x);
    r->written += *alpha == 0.0F;
    *alpha = 1.0F;
    r->x++;
    if (job->bits == 24) {
        store(&job->tables, from[3 * i + 2], from[3 * i + 1], from[3 * i], pixel);
        return STATUS_OK;
    }
    return store_index(job, job->bits == 8 ? from[i] : i % 2 ? from[i / 2] & 15U : from[i / 2] >> 4U, pixel);
}

/* Reads a run, or a command; *done after the last one. */
static status read_run(run_reading *r, bool *done)
{
    const size_t bits = r->job->bits, count = r->at[0], left = (size_t)(r->end - r->at);
    if (count > 0) {
        const size_t bytes = bits == 24 ? 3 : 1;
        for (size_t i = 0; i < count && 1 + bytes <= left; i++)
            TRY(store_run(r, r->at + 1, bits == 4 ? i % 2 : 0));
        *done = 1 + bytes > left;
        r->at += *done ? left : 1 + bytes;
        return STATUS_OK;
    }
    const size_t command = r->at[1];
    r->at += 2;
    switch (command) {
    case 0: r->row++, r->x = 0; break;
    case 1: *done = true; break;
    case 2:
        if (left >= 4)
            r->x += r->at[0], r->row += r->at[1];
        r->at += left >= 4 ? 2 : left - 2;
        break;
    default: {
        const size_t bytes = (command * bits + 7) / 8;
        for (size_t i = 0; i < command && bytes <= left - 2; i++)
            TRY(store_run(r, r->at, i));
        r->at += bytes < left - 2 ? bytes + bytes % 2 : left - 2;
    }
    }
    return STATUS_OK;
}

static status read_runs(bmp_reading *job)
{
    const size_t pixels = (size_t)job->width * (size_t)job->height;
    run_reading r = {.job = job, .at = job->bytes + job->offset, .end = job->bytes + job->size};
    bool done = false;
    TRY(image_add_alpha(job->img, job->why));
    for (size_t i = 0; i < pixels; i++) {
        job->img->alpha[i] = 0.0F;
        if (job->colors > 0)
            memcpy(job->img->pixel + 3 * i, job->palette[0], sizeof job->palette[0]);
    }
    while (!done && r.end - r.at >= 2) {
        TRY(cancel_check(job->why));
        TRY(read_run(&r, &done));
    }
    if (!done && r.written < pixels)
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is truncated: %zu of %zu pixels", r.written,
                        pixels);
    if (r.written == pixels) {
        free(job->img->alpha);
        job->img->alpha = NULL;
    }
    return STATUS_OK;
}

/* ---- the file ---- */

static int coded_bits(const bmp_reading *job)
{
    int bits = 8;
    for (int c = 0; c < 3; c++)
        bits = job->field[c].maximum > 255 ? 16 : bits;
    return bits;
}

static status read_image(bmp_reading *job, image_values values)
{
    TRY(check_sizes(job));
    TRY(image_create((int)job->width, (int)job->height, &job->img, job->why));
    if (values == IMAGE_LIGHT)
        read_space(job);
    TRY(read_colors(job, values));
    TRY(is_run_length(job) ? read_runs(job) : read_rows(job));
    codec_color_apply(&job->color, 1.0, job->img);
    return cancel_check(job->why);
}

status codec_bmp_read(const unsigned char *bytes, size_t size, image_values values, image **out, int *bits,
                      diagnostic *why)
{
    bmp_reading job = {.bytes = bytes, .size = size, .why = why};
    *out = NULL;
    TRY(read_header_size(&job));
    read_numbers(&job);
    if (!job.os2 && (job.compression == JPEG || job.compression == PNG) && job.offset < size) {
        *bits = 8;
        return job.compression == JPEG ? codec_jpeg_read(bytes + job.offset, size - job.offset, values, out, why)
                                       : codec_png_read(bytes + job.offset, size - job.offset, values, out, bits, why);
    }
    TRY(check_kind(&job));
    const status code = read_image(&job, values);
    codec_tables_free(&job.tables);
    if (code != STATUS_OK) {
        image_destroy(job.img);
        return code;
    }
    *bits = coded_bits(&job);
    *out = job.img;
    return STATUS_OK;
}
