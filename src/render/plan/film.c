/* The film's fixed-point sums: allocation, merging of replicates, conversion to linear sRGB, hash; and its named
 * layers. */
#include "render/plan/film.h"

#include "base/array.h"
#include "base/hash.h"
#include "optics/spectrum.h"
#include <stdlib.h>
#include <string.h>

/* Two cache lines, which processors fetch together: if the widths of the image and of the tiles are multiples of 16, no
 * two tiles share a line, so workers do not contend for it. A film of several large pages is rounded up to large pages:
 * a remainder in small pages would take longer to create than all the rest. */
enum { ALIGNMENT = 128, PAGE = 4096 };

static size_t values_of(const film *f)
{
    return (size_t)f->width * (size_t)f->height * 3;
}

/* Allocates zeroed sums and touches every page, so that no worker waits for a page fault while the clock runs. Large
 * pages, if the system has them, are created in a third of the time. calloc does not write memory that is zero
 * already. */
static bool allocate_sums(film *f, size_t bytes)
{
    const size_t alignment = bytes >= LARGE_PAGES_MIN ? LARGE_PAGE : ALIGNMENT,
                 rounded = (bytes + alignment - 1) / alignment * alignment;
    f->memory =
        calloc(1, rounded + alignment); /* aligned_alloc would leave gaps that are too small for the next film */
    if (!f->memory)
        return false;
    f->sum = (film_sum *)(((uintptr_t)f->memory + alignment - 1) / alignment * alignment);
    large_pages(f->sum, rounded);
    for (size_t i = 0; i < bytes; i += PAGE)
        ((volatile film_sum *)f->sum)[i / sizeof *f->sum] = 0;
    return true;
}

status film_create(int width, int height, int replicates, film_space space, film **out, diagnostic *why)
{
    const uint64_t bytes = (uint64_t)width * (uint64_t)height * 3 * sizeof(int64_t) * (uint64_t)replicates;
    film *f = calloc(1, sizeof *f);
    if (!f || bytes > SIZE_MAX / 2 || !allocate_sums(f, (size_t)bytes)) {
        free(f);
        return diagnose(why, STATUS_FAILURE, "render a smaller image", "out of memory for a film of %d x %d", width,
                        height);
    }
    f->width = width;
    f->height = height;
    f->replicates = replicates;
    f->space = space;
    *out = f;
    return STATUS_OK;
}

void film_destroy(film *f)
{
    if (!f)
        return;
    free(f->memory);
    free(f);
}

void film_begin_tile(film *f, int image_width, int x0, int y0, int x1, int y1, int replicates)
{
    f->width = x1 - x0;
    f->height = y1 - y0;
    f->replicates = replicates;
    f->first_pixel = (int64_t)y0 * image_width + x0;
    f->image_width = image_width;
    f->row_per_pixel = 1.0 / (double)image_width;
    memset(f->sum, 0, values_of(f) * (size_t)replicates * sizeof *f->sum);
}

void film_store_tile(film *f, int x0, int y0, int x1, int y1, const void *sums)
{
    const film_sum *sum = sums;
    const size_t length = 3 * (size_t)(x1 - x0);
    for (int y = y0; y < y1; y++, sum += length)
        memcpy(&f->sum[3 * ((size_t)y * (size_t)f->width + (size_t)x0)], sum, length * sizeof *sum);
}

bool film_merge_replicates(film *f, double *variance)
{
    const size_t count = values_of(f), replicates = (size_t)f->replicates;
    int64_t overflow = 0;
    if (replicates == 1)
        return true;
    for (size_t i = 0; i < count; i++) {
        double total = 0.0, squares = 0.0;
        film_sum sum = 0;
        for (size_t k = 0; k < replicates; k++) {
            sum = film_add(sum, f->sum[k * count + i]);
            overflow |= film_overflow(sum);
            total += film_radiance(f->sum[k * count + i]);
        }
        for (size_t k = 0; k < replicates; k++) {
            const double from_mean = film_radiance(f->sum[k * count + i]) - total / (double)replicates;
            squares += from_mean * from_mean;
        }
        if (variance) /* the variance of a sum of n values, each with variance squares / (n - 1) */
            variance[i] = squares * (double)replicates / (double)(replicates - 1);
        f->sum[i] = sum;
    }
    f->replicates = 1;
    return overflow >= 0;
}

/* The pixel's colour, linear sRGB. */
static void pixel_rgb(const film *f, size_t pixel, double rgb[3])
{
    const size_t replicates = (size_t)f->replicates, stride = values_of(f);
    double value[3];
    for (size_t c = 0; c < 3; c++) {
        film_sum sum = 0;
        for (size_t k = 0; k < replicates; k++)
            sum = film_add(sum, f->sum[k * stride + pixel * 3 + c]);
        value[c] = film_radiance(sum);
    }
    if (f->space == FILM_XYZ)
        xyz_to_linear_srgb(value, rgb);
    else
        memcpy(rgb, value, sizeof value);
}

double film_value(const film *f, int x, int y, int channel)
{
    double rgb[3];
    pixel_rgb(f, (size_t)y * (size_t)f->width + (size_t)x, rgb);
    return rgb[channel];
}

void film_read(const film *f, int x0, int y0, int x1, int y1, float *rgb, size_t stride)
{
    for (int y = y0; y < y1; y++) {
        float *row = rgb + (size_t)(y - y0) * stride;
        if (f->space == FILM_RGB && f->replicates == 1) { /* a faster path with equal results */
            const film_sum *sum = f->sum + 3 * ((size_t)y * (size_t)f->width + (size_t)x0);
            for (size_t i = 0; i < 3 * (size_t)(x1 - x0); i++)
                row[i] = (float)film_radiance(sum[i]);
            continue;
        }
        for (int x = x0; x < x1; x++, row += 3) {
            double value[3];
            pixel_rgb(f, (size_t)y * (size_t)f->width + (size_t)x, value);
            for (size_t c = 0; c < 3; c++)
                row[c] = (float)value[c];
        }
    }
}

uint64_t film_hash(const film *f)
{
    const int64_t size[2] = {f->width, f->height};
    return hash_finish(hash_words(hash_words(HASH_START, size, 2), f->sum, values_of(f)));
}

status film_image(const film *f, image **out, diagnostic *why)
{
    TRY(image_create(f->width, f->height, out, why));
    film_read(f, 0, 0, f->width, f->height, (*out)->pixel, 3 * (size_t)f->width);
    return STATUS_OK;
}

/* --- named layers --- */

layer_set *layers_create(int width, int height)
{
    layer_set *l = calloc(1, sizeof *l);
    bool missing = !l;
    for (int i = 0; l && i < LAYER_COUNT; i++)
        missing |= !(l->values[i] = calloc((size_t)width * (size_t)height * (size_t)layer_channels[i], sizeof(float)));
    if (!missing)
        return l;
    layers_destroy(l);
    return NULL;
}

uint64_t layers_bytes(void)
{
    uint64_t sum = 0;
    for (int i = 0; i < LAYER_COUNT; i++)
        sum += (uint64_t)layer_channels[i] * sizeof(float);
    return sum;
}

void layers_destroy(layer_set *l)
{
    for (int i = 0; l && i < LAYER_COUNT; i++)
        free(l->values[i]);
    free(l);
}
