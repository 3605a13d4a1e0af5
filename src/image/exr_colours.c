/* Colours of OpenEXR files: luminance and chroma, primaries, associated alpha. Colours are converted by CIE XYZ without
 * adaptation to another white: the spectrum that they stand for stays the same. */
#include "base/budget.h"
#include "base/cancel.h"
#include "image/codec.h"
#include <math.h>
#include <stdlib.h>

/* ---- chroma ---- */

status exr_chroma_create(exr_chroma *c, int width, int height, diagnostic *why)
{
    const size_t columns = (size_t)width / 2, lines = (size_t)height / 2;
    *c = (exr_chroma){.columns = (int)columns, .lines = (int)lines};
    TRY(memory_budget_check(2 * columns * lines * sizeof *c->red, "use a smaller one", why,
                            "the chroma of %d x %d pixels", width, height));
    c->red = calloc(columns * lines + 1, sizeof *c->red);
    c->blue = calloc(columns * lines + 1, sizeof *c->blue);
    return c->red && c->blue ? STATUS_OK : out_of_memory(why);
}

void exr_chroma_release(exr_chroma *c)
{
    free(c->red);
    free(c->blue);
    *c = (exr_chroma){.red = NULL};
}

static int64_t within(int64_t i, int64_t count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* The value between from[i] and from[i + 1], of count values a stride apart: the filter of OpenEXR's reader
 * (ImfRgbaYca.cpp, reconstructChromaHoriz), which is symmetric; the values at the edges are repeated. */
static double between(const float *from, size_t stride, int count, int64_t i)
{
    static const double weights[] = {0.627123, -0.186077, 0.087929, -0.043159, 0.019597, -0.007540, 0.002128};
    double sum = 0;
    for (int64_t k = 0; k < 7; k++)
        sum += weights[k] * ((double)from[(size_t)within(i - k, count) * stride] +
                             (double)from[(size_t)within(i + 1 + k, count) * stride]);
    return sum;
}

/* Gives the even lines a value in each column. */
static status widen(float **plane, const exr_chroma *c, diagnostic *why)
{
    const size_t columns = (size_t)c->columns, lines = (size_t)c->lines;
    TRY(memory_budget_check(2 * columns * lines * sizeof(float), "use a smaller one", why,
                            "the chroma of %d x %d pixels", 2 * c->columns, 2 * c->lines));
    float *wide = malloc((2 * columns * lines + 1) * sizeof *wide);
    if (!wide)
        return out_of_memory(why);
    for (size_t y = 0; y < lines && !cancel_asked(); y++)
        for (size_t x = 0; x < columns; x++) {
            const float *line = *plane + y * columns;
            wide[2 * (y * columns + x)] = line[x];
            wide[2 * (y * columns + x) + 1] = (float)between(line, 1, c->columns, (int64_t)x);
        }
    free(*plane);
    *plane = wide;
    return cancel_check(why);
}

/* Chroma at a pixel, of a plane that was widened. */
static double chroma_at(const float *plane, const exr_chroma *c, size_t x, size_t y)
{
    const size_t width = 2 * (size_t)c->columns;
    return y % 2 == 0 ? (double)plane[y / 2 * width + x] : between(plane + x, width, c->lines, (int64_t)(y / 2));
}

/* luminance: of R, G and B, of sum 1. */
static void colour_of(const double luminance[3], double red, double blue, float rgb[3])
{
    const double Y = (double)rgb[0], R = (red + 1.0) * Y, B = (blue + 1.0) * Y;
    if (red == 0.0 && blue == 0.0)
        return; /* grey stays exact */
    rgb[0] = (float)R;
    rgb[1] = (float)((Y - R * luminance[0] - B * luminance[2]) / luminance[1]);
    rgb[2] = (float)B;
}

/* ---- primaries ---- */

/* ITU-R BT.709, which a file without primaries has. */
static const double bt709[8] = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};

static void convert(const codec_color *color, float rgb[3])
{
    const double r = (double)rgb[0], g = (double)rgb[1], b = (double)rgb[2];
    for (int i = 0; i < 3; i++)
        rgb[i] = (float)(color->to_srgb[i][0] * r + color->to_srgb[i][1] * g + color->to_srgb[i][2] * b);
}

/* ---- alpha ---- */

/* Porter and Duff 1984: the file holds colour times alpha. */
static void divide(float rgb[3], float *alpha)
{
    *alpha = *alpha > 0.0F ? fminf(*alpha, 1.0F) : 0.0F;
    if (*alpha > 0.0F && *alpha < 1.0F)
        for (int i = 0; i < 3; i++)
            rgb[i] = (float)((double)rgb[i] / (double)*alpha);
}

static void drop_full_alpha(image *img)
{
    const size_t count = (size_t)img->width * (size_t)img->height;
    for (size_t i = 0; i < count; i++)
        if (img->alpha[i] < 1.0F)
            return;
    free(img->alpha);
    img->alpha = NULL;
}

status exr_colours_convert(image *img, const double primaries[8], exr_chroma *chroma, int64_t x, int64_t y,
                           diagnostic *why)
{
    codec_color color = {.mixes = false};
    double luminance[3];
    if (!codec_color_set_unadapted(&color, primaries ? primaries : bt709, luminance))
        return diagnose(why, STATUS_BAD_INPUT, "save it with the chromaticities of its red, green, blue and white",
                        "the chromaticities in the OpenEXR file are no primaries: they are on one line");
    if (chroma) {
        TRY(widen(&chroma->red, chroma, why));
        TRY(widen(&chroma->blue, chroma, why));
    }
    for (size_t row = 0; row < (size_t)img->height; row++) {
        TRY(cancel_check(why));
        for (size_t column = 0; column < (size_t)img->width; column++) {
            const size_t at = row * (size_t)img->width + column;
            const int64_t cx = x + (int64_t)column, cy = y + (int64_t)row;
            float *rgb = img->pixel + 3 * at;
            if (chroma && cx >= 0 && cy >= 0 && cx < 2 * (int64_t)chroma->columns && cy < 2 * (int64_t)chroma->lines)
                colour_of(luminance, chroma_at(chroma->red, chroma, (size_t)cx, (size_t)cy),
                          chroma_at(chroma->blue, chroma, (size_t)cx, (size_t)cy), rgb);
            if (color.mixes)
                convert(&color, rgb);
            if (img->alpha)
                divide(rgb, &img->alpha[at]);
            if (!isfinite(rgb[0]) || !isfinite(rgb[1]) || !isfinite(rgb[2]))
                return diagnose(why, STATUS_BAD_INPUT, "use an image with finite values",
                                "the pixel in column %zu, row %zu from the top is not a finite number", column, row);
        }
    }
    if (img->alpha)
        drop_full_alpha(img);
    return STATUS_OK;
}
