/* Image files: the list of codecs, writing and reading in the format of each, and the disk space of files. */
#include "image/image.h"

#include "base/cancel.h"
#include "base/file.h"
#include "base/text.h"
#include "image/codec.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The largest file of an image with CODEC_PIXELS_MAX pixels: a PFM with 12 bytes per pixel and its header. */
#define FILE_BYTES_MAX ((size_t)CODEC_PIXELS_MAX * 12 + 4096)

/* ---- formats ---- */

image_format image_format_of(const char *path)
{
    static const struct {
        const char *ending;
        image_format format;
    } endings[] = {
        {".png", IMAGE_PNG}, {".jpg", IMAGE_JPEG}, {".jpeg", IMAGE_JPEG}, {".pfm", IMAGE_PFM}, {".exr", IMAGE_EXR},
    };
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        size_t ending = strlen(endings[i].ending);
        if (length > ending && strcasecmp(path + length - ending, endings[i].ending) == 0)
            return endings[i].format;
    }
    bool nameless = strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0;
    return nameless ? IMAGE_PNG : IMAGE_UNKNOWN;
}

/* ---- writing ---- */

static void read_toned(const void *of, int y, float *rgb)
{
    const image_rows *rows = of;
    rows->read(rows->of, y, rgb);
    image_tone_apply(&rows->tone, rgb, (size_t)rows->width);
}

static status write_as(const image_rows *rows, image_format format, FILE *stream, int bits, bool fast, diagnostic *why)
{
    image_rows shown = *rows;
    if (!image_tone_is_plain(&rows->tone) && (bits == 8 || format == IMAGE_JPEG))
        shown.read = read_toned, shown.of = rows;
    switch (format) {
    case IMAGE_PNG: return codec_png_write(&shown, stream, bits, fast || cancel_hurries(), why);
    case IMAGE_JPEG: return codec_jpeg_write(&shown, stream, fast, why);
    case IMAGE_PFM: return codec_pfm_write(rows, stream, why);
    case IMAGE_EXR: return codec_exr_write(rows, stream, fast || cancel_hurries(), why);
    case IMAGE_BMP:
    case IMAGE_HDR:
    case IMAGE_UNKNOWN: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "use PNG, JPEG, PFM or OpenEXR", "unknown image format");
}

status image_encode(const image *img, image_format format, int bits, bool fast, unsigned char **bytes, size_t *size,
                    diagnostic *why)
{
    const image_rows rows = image_rows_of(img);
    return image_encode_rows(&rows, format, bits, fast, bytes, size, why);
}

status image_encode_rows(const image_rows *rows, image_format format, int bits, bool fast, unsigned char **bytes,
                         size_t *size, diagnostic *why)
{
    char *text = NULL;
    text_writer writer;
    *bytes = NULL;
    TRY(text_writer_open(&writer, why));
    const status code =
        text_writer_end(&writer, write_as(rows, format, writer.stream, bits, fast, why), &text, size, why);
    *bytes = (unsigned char *)text;
    return code;
}

status image_write(const image *img, const char *path, int bits, diagnostic *why)
{
    const image_rows rows = image_rows_of(img);
    return image_write_rows(&rows, path, bits, why);
}

status image_write_rows(const image_rows *rows, const char *path, int bits, diagnostic *why)
{
    image_format format = image_format_of(path);
    if (format == IMAGE_UNKNOWN)
        return diagnose_at(why, path, STATUS_BAD_INPUT, "end the name in " IMAGE_ENDINGS, "unknown image format");
    if (format == IMAGE_PNG && bits != 8 && bits != 16)
        return diagnose_at(why, path, STATUS_BAD_INPUT, "use 8 or 16", "a PNG image cannot have %d bits per channel",
                           bits);
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    status code = write_as(rows, format, writer.stream, bits, false, why);
    if (code == STATUS_OK || ferror(writer.stream))
        return file_writer_commit(&writer, why); /* the commit finds why the stream failed */
    file_writer_abandon(&writer);
    diagnostic_locate(why, path, 0, 0);
    return code;
}

/* ---- disk space ---- */

/* Deflate shrinks to 1/1032 at most (zlib, algorithm.txt); JPEG to 6 bits for 64 pixels. */
void image_room(image_format format, double width, double height, double count, disk_room *to)
{
    enum { HEADERS_MOST = 20000, DEFLATE_MOST = 1032 };
    const double pixels = width * height;
    if (format == IMAGE_PFM)
        disk_room_add(to, count, 12 * pixels, 12 * pixels + HEADERS_MOST);
    else if (format == IMAGE_EXR)
        disk_room_add(to, count, 12 * pixels / DEFLATE_MOST, 24.2 * pixels + HEADERS_MOST);
    else if (format == IMAGE_PNG)
        disk_room_add(to, count, 3 * pixels / DEFLATE_MOST, 3.01 * pixels + HEADERS_MOST);
    else
        disk_room_add(to, count, pixels / 86, 4 * pixels + HEADERS_MOST);
}

/* ---- reading ---- */

bool image_is_png(const void *bytes, size_t size)
{
    return size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0;
}

bool image_holds_text(const void *bytes, size_t size)
{
    return image_is_png(bytes, size) || (size >= 4 && memcmp(bytes, "\x76\x2f\x31\x01", 4) == 0);
}

/* The formats' signatures: PNG specification 5.2; OpenEXR's magic number, 20000630; JPEG's SOI and the next marker;
 * PFM's PF or Pf; BMP's BM; Radiance's #?. */
static image_format format_of_bytes(const unsigned char *bytes, size_t size)
{
    if (image_is_png(bytes, size))
        return IMAGE_PNG;
    if (image_holds_text(bytes, size))
        return IMAGE_EXR;
    if (size >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0)
        return IMAGE_JPEG;
    if (size >= 2 && memcmp(bytes, "BM", 2) == 0)
        return IMAGE_BMP;
    if (size >= 2 && memcmp(bytes, "#?", 2) == 0)
        return IMAGE_HDR;
    bool pfm = size >= 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
               (bytes[2] == '\n' || bytes[2] == '\r' || bytes[2] == ' ');
    return pfm ? IMAGE_PFM : IMAGE_UNKNOWN;
}

static status decode(const unsigned char *bytes, size_t size, image_values values, image **out, int *bits,
                     diagnostic *why)
{
    switch (format_of_bytes(bytes, size)) {
    case IMAGE_PNG: return codec_png_read(bytes, size, values, out, bits, why);
    case IMAGE_JPEG: *bits = 8; return codec_jpeg_read(bytes, size, values, out, why);
    case IMAGE_PFM: *bits = 32; return codec_pfm_read(bytes, size, out, why);
    case IMAGE_BMP: return codec_bmp_read(bytes, size, values, out, bits, why);
    case IMAGE_HDR: *bits = 32; return codec_hdr_read(bytes, size, out, why);
    case IMAGE_EXR: *bits = 32; return codec_exr_read(bytes, size, out, why);
    case IMAGE_UNKNOWN: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "use a " IMAGE_FORMATS " file", "%s",
                    size == 0 ? "the file is empty" : "unknown image format");
}

status image_read(const char *path, image **out, int *file_bits, diagnostic *why)
{
    return image_read_below(path, NULL, IMAGE_LIGHT, out, file_bits, why);
}

typedef struct decoding {
    const char *bytes;
    size_t size;
    image_values values;
    image **out;
    int bits;
    diagnostic *why;
    status code;
} decoding;

static void decode_confined(void *of)
{
    decoding *d = of;
    d->code = decode((const unsigned char *)d->bytes, d->size, d->values, d->out, &d->bits, d->why);
}

status image_decode(const void *bytes, size_t size, image_values values, image **out, int *file_bits, diagnostic *why)
{
    decoding d = {.bytes = bytes, .size = size, .values = values, .out = out, .why = why};
    *out = NULL;
    codec_run_confined(decode_confined, &d);
    TRY(d.code);
    if (file_bits)
        *file_bits = d.bits;
    return STATUS_OK;
}

status image_read_below(const char *path, const char *root, image_values values, image **out, int *file_bits,
                        diagnostic *why)
{
    char *bytes;
    size_t size;
    *out = NULL;
    TRY(file_read_below(path, root, FILE_BYTES_MAX, &bytes, &size, why));
    const status code = image_decode(bytes, size, values, out, file_bits, why);
    free(bytes);
    return locate_failure(why, path, code);
}

/* ---- reading a text ---- */

typedef struct text_job {
    const void *bytes;
    size_t size;
    const char *keyword;
    size_t limit;
    char **text;
    diagnostic *why;
    status code;
} text_job;

static void read_text_confined(void *of)
{
    text_job *w = of;
    w->code = (image_is_png(w->bytes, w->size) ? codec_png_text : codec_exr_text)(w->bytes, w->size, w->keyword,
                                                                                  w->limit, w->text, w->why);
}

status image_text_read(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    text_job w = {bytes, size, keyword, limit, text, why, STATUS_OK};
    codec_run_confined(read_text_confined, &w);
    return w.code;
}
