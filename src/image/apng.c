/* Takes the chunks of each frame's PNG file: those of the first frame stay, with acTL and fcTL before its IDAT; IDAT of
 * later frames become fdAT, which begin with a sequence number. */
#include "image/apng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { SIGNATURE_SIZE = 8, CHUNK_EXTRA = 12, TYPE_SIZE = 4, DELAY_MAX = 65535 };

static void put_32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> (24 - 8 * i));
}

static void put_16(unsigned char *at, uint32_t value)
{
    at[0] = (unsigned char)(value >> 8);
    at[1] = (unsigned char)value;
}

static uint32_t get_32(const unsigned char *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* A chunk whose data is head, then data. */
static void write_chunk(FILE *stream, const char type[TYPE_SIZE + 1], const unsigned char *head, size_t head_size,
                        const unsigned char *data, size_t size)
{
    unsigned char word[4];
    uLong crc = crc32(0, (const unsigned char *)type, TYPE_SIZE);
    crc = head_size ? crc32(crc, head, (uInt)head_size) : crc;
    crc = size ? crc32(crc, data, (uInt)size) : crc;
    put_32(word, (uint32_t)(head_size + size));
    fwrite(word, 1, sizeof word, stream);
    fwrite(type, 1, TYPE_SIZE, stream);
    if (head_size)
        fwrite(head, 1, head_size, stream);
    if (size)
        fwrite(data, 1, size, stream);
    put_32(word, (uint32_t)crc);
    fwrite(word, 1, sizeof word, stream);
}

/* The time of a frame in seconds as a fraction of 16-bit numbers; in ms if the rate's parts are larger. */
static void put_delay(unsigned char at[4], const apng *a)
{
    const bool fits = a->fps_num <= DELAY_MAX && a->fps_den <= DELAY_MAX;
    const double ms = round(1000.0 * (double)a->fps_den / (double)a->fps_num);
    put_16(at, fits ? (uint32_t)a->fps_den : (uint32_t)fmin(ms, DELAY_MAX));
    put_16(at + 2, fits ? (uint32_t)a->fps_num : 1000);
}

static void write_control(apng *a, const image *img)
{
    unsigned char control[26] = {0};
    put_32(control, a->sequence++);
    put_32(control + 4, (uint32_t)img->width);
    put_32(control + 8, (uint32_t)img->height);
    put_delay(control + 20, a);
    write_chunk(a->stream, "fcTL", control, sizeof control, NULL, 0);
}

static void begin_frame(apng *a, const image *img)
{
    unsigned char film[8] = {0}; /* plays without end */
    put_32(film, a->frames);
    if (a->written == 0)
        write_chunk(a->stream, "acTL", film, sizeof film, NULL, 0);
    write_control(a, img);
}

static void write_pixels(apng *a, const unsigned char *data, size_t size)
{
    unsigned char number[4];
    if (a->written == 0) {
        write_chunk(a->stream, "IDAT", NULL, 0, data, size);
        return;
    }
    put_32(number, a->sequence++);
    write_chunk(a->stream, "fdAT", number, sizeof number, data, size);
}

static void write_chunks(apng *a, const image *img, const unsigned char *png, size_t size)
{
    bool in_pixels = false;
    if (a->written == 0)
        fwrite(png, 1, SIGNATURE_SIZE, a->stream);
    for (size_t at = SIGNATURE_SIZE; at + CHUNK_EXTRA <= size;) {
        const size_t length = get_32(png + at);
        const unsigned char *type = png + at + 4, *data = type + TYPE_SIZE;
        const bool has_pixels = memcmp(type, "IDAT", TYPE_SIZE) == 0, ends = memcmp(type, "IEND", TYPE_SIZE) == 0;
        if (has_pixels && !in_pixels)
            begin_frame(a, img);
        in_pixels |= has_pixels;
        if (has_pixels)
            write_pixels(a, data, length);
        else if (ends ? a->written + 1 == a->frames : a->written == 0)
            fwrite(png + at, 1, length + CHUNK_EXTRA, a->stream);
        at += length + CHUNK_EXTRA;
    }
}

status apng_frame(apng *a, const image *img, diagnostic *why)
{
    unsigned char *png = NULL;
    size_t size;
    TRY(image_encode(img, IMAGE_PNG, 8, false, &png, &size, why));
    write_chunks(a, img, png, size);
    a->written++;
    free(png);
    return STATUS_OK;
}
