/* Videos in one file: YUV4MPEG2 and animated PNG. */
#include "image/video.h"

#include "image/codec.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <zlib.h>

/* ---- YUV4MPEG2 ---- */

/* The header follows y4m(5); luma and chroma follow ITU-R BT.601-7, 2.5, and BT.709-6, 3 and 4, quantised to 8 bits in
 * limited range: Y' = 16 + 219 E_Y, C_B = 128 + 224 (E_B - E_Y) / (2 (1 - K_B)), C_R likewise. */

enum { HIGH_DEFINITION_LINES = 720, TEN_THOUSAND = 10000 };

/* Weights of red, green and blue in the luma, in ten thousandths: K_R, K_G, K_B. */
typedef struct luma_weights {
    int64_t red, green, blue;
} luma_weights;

static luma_weights weights_for(int height)
{
    return height < HIGH_DEFINITION_LINES ? (luma_weights){2990, 5870, 1140} /* BT.601 */
                                          : (luma_weights){2126, 7152, 722}; /* BT.709 */
}

/* The integer nearest to a / b, b > 0; halves round up. */
static int64_t nearest(int64_t a, int64_t b)
{
    int64_t doubled = 2 * a + b, quotient = doubled / (2 * b);
    return quotient - (doubled % (2 * b) < 0);
}

/* The bytes of a frame, 4:2:0: the luma plane, then chroma planes a quarter as large. */
typedef struct planes {
    unsigned char *rgb; /* three bytes per pixel */
    unsigned char *y, *cb, *cr;
    float *row; /* of the image, with its tone */
    size_t wide, high, chroma_wide, chroma_high;
} planes;

static size_t plane_bytes(const planes *p)
{
    return p->wide * p->high + 2 * p->chroma_wide * p->chroma_high;
}

/* E_Y of a pixel, times 255 * 10000. */
static int64_t luma(const luma_weights *k, const unsigned char rgb[3])
{
    return k->red * rgb[0] + k->green * rgb[1] + k->blue * rgb[2];
}

static void put_luma(const planes *p, const luma_weights *k)
{
    for (size_t i = 0; i < p->wide * p->high; i++)
        p->y[i] = (unsigned char)(16 + nearest(219 * luma(k, p->rgb + 3 * i), 255 * TEN_THOUSAND));
}

/* Sets the chroma of the pixel 2 x, 2 y and of its right and lower neighbours, as far as they exist. */
static void put_chroma_at(const planes *p, const luma_weights *k, size_t x, size_t y)
{
    int64_t blue = 0, red = 0, count = 0; /* sums of 10000 (B - Y), 10000 (R - Y) */
    for (size_t j = 2 * y; j < 2 * y + 2 && j < p->high; j++)
        for (size_t i = 2 * x; i < 2 * x + 2 && i < p->wide; i++) {
            const unsigned char *rgb = p->rgb + 3 * (j * p->wide + i);
            blue += TEN_THOUSAND * rgb[2] - luma(k, rgb);
            red += TEN_THOUSAND * rgb[0] - luma(k, rgb);
            count++;
        }
    size_t at = y * p->chroma_wide + x;
    p->cb[at] = (unsigned char)(128 + nearest(224 * blue, 255 * 2 * (TEN_THOUSAND - k->blue) * count));
    p->cr[at] = (unsigned char)(128 + nearest(224 * red, 255 * 2 * (TEN_THOUSAND - k->red) * count));
}

static void convert(const planes *p, const image *img)
{
    codec_bytes bytes;
    codec_bytes_prepare(&bytes);
    for (size_t y = 0; y < p->high; y++) {
        memcpy(p->row, img->pixel + 3 * p->wide * y, 3 * p->wide * sizeof *p->row);
        if (!image_tone_is_plain(&img->tone))
            image_tone_apply(&img->tone, p->row, p->wide);
        codec_bytes_encode(&bytes, p->row, 3 * p->wide, p->rgb + 3 * p->wide * y);
    }
    const luma_weights k = weights_for(img->height);
    put_luma(p, &k);
    for (size_t y = 0; y < p->chroma_high; y++)
        for (size_t x = 0; x < p->chroma_wide; x++)
            put_chroma_at(p, &k, x, y);
}

status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why)
{
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use a width and height of 1 to 65536",
                        "a video cannot have %d x %d pixels", width, height);
    if (fps_num < 1 || fps_den < 1)
        return diagnose(why, STATUS_BAD_INPUT, "use a fraction of two numbers of at least 1",
                        "%" PRId64 "/%" PRId64 " frames per second are not possible", fps_num, fps_den);
    fprintf(stream, "YUV4MPEG2 W%d H%d F%" PRId64 ":%" PRId64 " Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n", width, height,
            fps_num, fps_den);
    return STATUS_OK;
}

status y4m_frame(FILE *stream, const image *img, diagnostic *why)
{
    const size_t wide = (size_t)img->width, high = (size_t)img->height;
    planes p = {.wide = wide, .high = high, .chroma_wide = (wide + 1) / 2, .chroma_high = (high + 1) / 2};
    p.rgb = malloc(3 * wide * high + plane_bytes(&p));
    p.row = malloc(3 * wide * sizeof *p.row);
    if (!p.rgb || !p.row) {
        free(p.rgb);
        free(p.row);
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for a frame of %d x %d pixels", img->width,
                        img->height);
    }
    p.y = p.rgb + 3 * wide * high;
    p.cb = p.y + wide * high;
    p.cr = p.cb + p.chroma_wide * p.chroma_high;
    convert(&p, img);
    fputs("FRAME\n", stream);
    fwrite(p.y, 1, plane_bytes(&p), stream);
    free(p.rgb);
    free(p.row);
    return STATUS_OK;
}

/* ---- animated PNG ---- */

/* The chunks come from each frame's PNG file: those of the first frame stay, with acTL and fcTL before its IDAT. Of
 * later frames only IDAT is kept, as fdAT, which begins with a sequence number. IEND comes from the last frame. */

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
    unsigned char animation[8] = {0}; /* 0: plays without end */
    put_32(animation, a->frames);
    if (a->written == 0)
        write_chunk(a->stream, "acTL", animation, sizeof animation, NULL, 0);
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

/* ---- the format by name ---- */

video_format video_format_of(const char *path)
{
    const char *ending = strrchr(path, '.');
    return ending && strcasecmp(ending, ".y4m") == 0    ? VIDEO_Y4M
           : ending && strcasecmp(ending, ".apng") == 0 ? VIDEO_APNG
                                                        : VIDEO_NONE;
}

status video_begin(video *v, video_format format, FILE *stream, int width, int height, int64_t frames, int64_t fps_num,
                   int64_t fps_den, diagnostic *why)
{
    *v = (video){.format = format,
                 .stream = stream,
                 .png = {.stream = stream, .frames = (uint32_t)frames, .fps_num = fps_num, .fps_den = fps_den}};
    return format == VIDEO_Y4M ? y4m_begin(stream, width, height, fps_num, fps_den, why) : STATUS_OK;
}

status video_frame(video *v, const image *img, diagnostic *why)
{
    return v->format == VIDEO_Y4M ? y4m_frame(v->stream, img, why) : apng_frame(&v->png, img, why);
}
