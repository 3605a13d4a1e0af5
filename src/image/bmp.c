/* Uncompressed 24-bit BMP: a file header of 14 bytes, a header of 40 (BITMAPINFOHEADER, Windows 3) to 124 bytes
 * (BITMAPV5HEADER), and from the file header's offset rows of blue, green, red, each padded to a multiple of 4 bytes;
 * from the bottom, or from the top if the height is negative. Microsoft, Windows GDI, "Bitmap Storage". Numbers are
 * little-endian. */
#include "base/cancel.h"
#include "image/codec.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    FILE_HEADER = 14,
    INFO_HEADER = 40,
    V5_HEADER = 124,
    OS2_HEADER = 12,
    OS2_HEADER_2 = 64,
    OS2_HEADER_2_SHORT = 16
};
enum { UNCOMPRESSED, RLE8, RLE4 }; /* the header's compression */

#define REMEDY "save the file as an uncompressed 24-bit BMP, or as PNG"
#define DAMAGED "copy the file again, or save it as PNG"

static uint32_t number_at(const unsigned char *b, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint32_t)b[i] << 8 * i;
    return value;
}

static int64_t signed_at(const unsigned char *b)
{
    const int64_t value = number_at(b, 4);
    return value >= INT64_C(0x80000000) ? value - INT64_C(0x100000000) : value;
}

/* width and height in pixels; from_top for a negative height. */
typedef struct bmp_header {
    int64_t width, height;
    size_t offset, row_bytes;
    bool from_top;
} bmp_header;

/* Only the fields used below are trusted; the file size in the header is often wrong and is ignored. */
static status check_kind(const unsigned char *bytes, size_t size, diagnostic *why)
{
    const uint32_t header = size >= FILE_HEADER + 4 ? number_at(bytes + FILE_HEADER, 4) : 0;
    if (header == OS2_HEADER || header == OS2_HEADER_2 || header == OS2_HEADER_2_SHORT)
        return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the BMP file has the unsupported OS/2 header");
    if (size < FILE_HEADER + INFO_HEADER || (header <= V5_HEADER && header > size - FILE_HEADER))
        return diagnose(why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is truncated: %zu bytes are less than a header",
                        size);
    if (header < INFO_HEADER || header > V5_HEADER)
        return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the header of the BMP file is damaged: its size is %lu bytes",
                        (unsigned long)header);
    const uint32_t bits = number_at(bytes + 28, 2), compression = number_at(bytes + 30, 4);
    if (compression == RLE8 || compression == RLE4)
        return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the BMP file has the unsupported run-length compression");
    if (bits != 24)
        return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the BMP file has %lu bits per pixel; only 24 are supported",
                        (unsigned long)bits);
    if (compression != UNCOMPRESSED)
        return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the BMP file has the unsupported compression %lu",
                        (unsigned long)compression);
    return STATUS_OK;
}

static status read_header(const unsigned char *bytes, size_t size, bmp_header *out, diagnostic *why)
{
    TRY(check_kind(bytes, size, why));
    const int64_t height = signed_at(bytes + 22);
    *out = (bmp_header){.width = signed_at(bytes + 18),
                        .height = height < 0 ? -height : height,
                        .from_top = height < 0,
                        .offset = number_at(bytes + 10, 4)};
    TRY(codec_check_size(out->width, out->height, size, why));
    out->row_bytes = ((size_t)out->width * 3 + 3) / 4 * 4;
    if (out->offset < FILE_HEADER + number_at(bytes + FILE_HEADER, 4) || out->offset > size)
        return diagnose(why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is damaged: its pixels begin at byte %zu of %zu",
                        out->offset, size);
    /* sides are at most 65536: no overflow; the last row may lack its padding */
    const size_t needed = out->row_bytes * (size_t)(out->height - 1) + (size_t)out->width * 3;
    if (size - out->offset < needed)
        return diagnose(why, STATUS_BAD_INPUT, DAMAGED, "the BMP file is truncated: %zu bytes of pixels instead of %zu",
                        size - out->offset, needed);
    return STATUS_OK;
}

status codec_bmp_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why)
{
    bmp_header header;
    *out = NULL;
    TRY(read_header(bytes, size, &header, why));
    image *img = NULL;
    float *linear = NULL;
    status code = codec_begin(header.width, header.height, size, 255, &img, &linear, why);
    if (code != STATUS_OK) {
        image_destroy(img);
        return code;
    }
    const size_t width = (size_t)header.width, height = (size_t)header.height;
    for (size_t row = 0; row < height && !cancel_asked(); row++) {
        const unsigned char *from = bytes + header.offset + row * header.row_bytes;
        float *pixel = img->pixel + (header.from_top ? row : height - 1 - row) * width * 3;
        for (size_t x = 0; x < width; x++, from += 3, pixel += 3)
            pixel[0] = linear[from[2]], pixel[1] = linear[from[1]], pixel[2] = linear[from[0]];
    }
    free(linear);
    *out = img;
    return STATUS_OK;
}
