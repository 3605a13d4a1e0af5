/* The per-pixel measures of compare.h, calls of the measures that use neighbourhoods, and the map of FLIP errors. */
#include "image/compare.h"

#include "base/budget.h"
#include "base/cancel.h"
#include "image/codec.h"
#include "image/heatmap.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static size_t pixels_of(const image *img)
{
    return (size_t)img->width * (size_t)img->height;
}

static status check_numbers(const image *img, const char *which, diagnostic *why)
{
    for (size_t i = 0; i < 3 * pixels_of(img); i++) {
        if (isnan(img->pixel[i])) {
            size_t pixel = i / 3, width = (size_t)img->width;
            return diagnose(why, STATUS_BAD_INPUT, "use images with finite values",
                            "pixel %zu,%zu of the %s image is not a number", pixel % width, pixel / width, which);
        }
    }
    return STATUS_OK;
}

/* STATUS_BAD_INPUT unless the sizes are equal and no channel is NaN. */
static status compare_check(const image *a, const image *b, diagnostic *why)
{
    if (a->width != b->width || a->height != b->height)
        return diagnose(why, STATUS_BAD_INPUT, "use two images of the same size",
                        "an image of %d x %d pixels cannot be compared with one of %d x %d", a->width, a->height,
                        b->width, b->height);
    TRY(check_numbers(a, "first", why));
    return check_numbers(b, "second", why);
}

/* Luma of ITU-R BT.601. */
static double luma(const double encoded[3])
{
    return 0.299 * encoded[0] + 0.587 * encoded[1] + 0.114 * encoded[2];
}

/* Measures of single pixels; the lumas are kept for the structural similarity. */
static void compare_pixels(const image *a, const image *b, double *luma_a, double *luma_b, image_comparison *out)
{
    size_t count = pixels_of(a), differing = 0;
    double sum = 0.0;
    codec_bytes table;
    codec_bytes_prepare(&table);
    for (size_t i = 0; i < count && !cancel_asked_at(i); i++) {
        double encoded_a[3], encoded_b[3];
        bool differs = false;
        for (size_t channel = 0; channel < 3; channel++) {
            float linear_a = a->pixel[3 * i + channel], linear_b = b->pixel[3 * i + channel];
            encoded_a[channel] = srgb_encode(linear_a);
            encoded_b[channel] = srgb_encode(linear_b);
            double difference = fabs(encoded_a[channel] - encoded_b[channel]);
            sum += difference * difference;
            differs = differs || codec_byte(&table, linear_a) != codec_byte(&table, linear_b);
            if (difference > out->largest) {
                out->largest = difference;
                out->largest_x = (int)(i % (size_t)a->width);
                out->largest_y = (int)(i / (size_t)a->width);
            }
        }
        differing += differs;
        luma_a[i] = luma(encoded_a);
        luma_b[i] = luma(encoded_b);
    }
    out->mse = sum / (3.0 * (double)count);
    out->psnr_db = out->mse > 0 ? -10.0 * log10(out->mse) : (double)INFINITY;
    out->differing_fraction = (double)differing / (double)count;
}

static double mean(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum / (double)count;
}

status image_compare(const image *a, const image *b, image_comparison *out, diagnostic *why)
{
    TRY(compare_check(a, b, why));
    status code = STATUS_OK;
    size_t count = pixels_of(a);
    /* planes of doubles: 2 here, and 14 in compare_flip, which needs more than compare_ssim */
    enum { PLANES = 2 + 14 };
    TRY(memory_budget_check(count * PLANES * sizeof(double), "compare smaller images", why,
                            "a comparison of images of %d x %d pixels", a->width, a->height));
    double *first = malloc(count * sizeof *first), *second = malloc(count * sizeof *second);
    if (!first || !second) {
        code = diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the comparison");
    } else {
        *out = (image_comparison){0};
        compare_pixels(a, b, first, second, out);
        code = cancel_check(why);
        THEN(code, compare_ssim(first, second, a->width, a->height, &out->ssim, why));
    }
    THEN(code, compare_flip(a, b, first, why));
    if (code == STATUS_OK)
        out->flip = mean(first, count);
    free(first);
    free(second);
    return code;
}

/* ---- the map of errors ---- */

/* The map's colour for 0..1 in linear values. */
static void magma(double t, float linear[3])
{
    double rgb[3];
    color_map_at(MAGMA, t, rgb);
    for (int channel = 0; channel < 3; channel++)
        linear[channel] = (float)srgb_decode(rgb[channel] / 255.0);
}

status image_compare_map(const image *a, const image *b, image **map, diagnostic *why)
{
    image *img = NULL;
    *map = NULL;
    TRY(compare_check(a, b, why));
    size_t count = (size_t)a->width * (size_t)a->height;
    double *errors = malloc(count * sizeof *errors);
    status code = errors ? image_create(a->width, a->height, &img, why)
                         : diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the map of errors");
    THEN(code, compare_flip(a, b, errors, why));
    for (size_t i = 0; code == STATUS_OK && i < count && !cancel_asked(); i++)
        magma(errors[i], img->pixel + 3 * i);
    THEN(code, cancel_check(why));
    free(errors);
    if (code != STATUS_OK) {
        image_destroy(img);
        return code;
    }
    *map = img;
    return STATUS_OK;
}
