/* Videos in one file: YUV4MPEG2. */
#include "image/video.h"

#include "image/codec.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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

bool y4m_is_named(const char *path)
{
    const char *ending = strrchr(path, '.');
    return ending && strcasecmp(ending, ".y4m") == 0;
}
