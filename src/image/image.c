/* Images in memory: creation, ownership, notes, checks, rows, packing. */
#include "image/image.h"

#include "base/budget.h"
#include "base/cancel.h"
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status image_create(int width, int height, image **out, diagnostic *why)
{
    *out = NULL;
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use a width and height of 1 to 65536",
                        "an image cannot have %d x %d pixels", width, height);
    TRY(memory_budget_check((uint64_t)width * (uint64_t)height * 3 * sizeof(float), "use a smaller one", why,
                            "an image of %d x %d pixels", width, height));
    image *img = malloc(sizeof *img);
    float *pixel = calloc((size_t)width * (size_t)height * 3, sizeof *pixel);
    if (!img || !pixel) {
        free(img);
        free(pixel);
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for an image of %d x %d pixels", width,
                        height);
    }
    *img = (image){.width = width, .height = height, .pixel = pixel, .owners = 1};
    *out = img;
    return STATUS_OK;
}

void image_destroy(image *img)
{
    if (img && __atomic_sub_fetch(&img->owners, 1, __ATOMIC_ACQ_REL) <= 0) {
        free(img->pixel);
        free(img->alpha);
        free(img);
    }
}

status image_add_alpha(image *img, diagnostic *why)
{
    const size_t count = (size_t)img->width * (size_t)img->height;
    TRY(memory_budget_check(count * sizeof *img->alpha, "use a smaller one", why, "the alpha of %d x %d pixels",
                            img->width, img->height));
    if (!(img->alpha = malloc(count * sizeof *img->alpha)))
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        img->alpha[i] = 1.0F;
    return STATUS_OK;
}

image *image_retain(const image *img)
{
    image *retained = (image *)(uintptr_t)img; /* only the reference count changes */
    __atomic_add_fetch(&retained->owners, 1, __ATOMIC_RELAXED);
    return retained;
}

/* ---- notes and checks ---- */

void image_note(char note[IMAGE_NOTE_MAX], const char *text, ...)
{
    size_t used = strlen(note);
    va_list arguments;
    va_start(arguments, text);
    if (used > 0 && used + 3 < IMAGE_NOTE_MAX) {
        memcpy(note + used, "; ", 3);
        used += 2;
    }
    vsnprintf(note + used, IMAGE_NOTE_MAX - used, text, arguments);
    va_end(arguments);
}

enum { LANES = 8 };

/* Whether all values are finite and at least 0, as those of nearly all images; *most: the largest. In lanes, which the
 * compiler makes vectors of. */
static bool is_plain(const float *value, size_t count, float *most)
{
    float low[LANES] = {0.0F}, high[LANES] = {0.0F}, whole[LANES] = {0.0F};
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (int k = 0; k < LANES; k++) {
            const float x = value[i + (size_t)k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
            whole[k] += x - x; /* 0, or NaN from infinity and NaN */
        }
    for (; i < count; i++) {
        low[0] = value[i] < low[0] ? value[i] : low[0];
        high[0] = value[i] > high[0] ? value[i] : high[0];
        whole[0] += value[i] - value[i];
    }
    bool plain = true;
    for (int k = 0; k < LANES; k++) {
        plain &= low[k] == 0.0F && whole[k] == 0.0F;
        *most = high[k] > *most ? high[k] : *most;
    }
    return plain;
}

status image_check_light(const image *img, char note[IMAGE_NOTE_MAX], float *largest, diagnostic *why)
{
    const size_t width = (size_t)img->width, count = 3 * width * (size_t)img->height;
    size_t negative = 0, lowest = 0;
    float most = 0.0F;
    if (is_plain(img->pixel, count, &most)) {
        if (largest)
            *largest = most;
        return cancel_check(why);
    }
    most = 0.0F;
    for (size_t i = 0; i < count; i++) {
        const float value = img->pixel[i];
        if (cancel_asked_at(i))
            return cancel_check(why);
        if (!isfinite(value))
            return diagnose(why, STATUS_BAD_INPUT, "use an image with finite values",
                            "the pixel in column %zu, row %zu from the top is not a finite number", i / 3 % width,
                            i / 3 / width);
        most = value > most ? value : most;
        negative += value < 0.0F;
        lowest = value < img->pixel[lowest] ? i : lowest;
    }
    if (negative > 0 && -img->pixel[lowest] > most / 10.0F)
        return diagnose(why, STATUS_BAD_INPUT,
                        "use an image of values from 0; only small negative ones, down to a tenth of the largest, are "
                        "read as 0",
                        "the pixel in column %zu, row %zu from the top is negative: %g", lowest / 3 % width,
                        lowest / 3 / width, (double)img->pixel[lowest]);
    if (negative > 0)
        image_note(note, "%zu small negative values, down to %.3g, are read as 0", negative,
                   (double)img->pixel[lowest]);
    if (largest)
        *largest = most;
    return STATUS_OK;
}

/* ---- rows ---- */

static void copy_row(const void *of, int y, float *rgb)
{
    const image *img = of;
    const size_t count = (size_t)img->width * 3;
    memcpy(rgb, img->pixel + (size_t)y * count, count * sizeof *rgb);
}

image_rows image_rows_of(const image *img)
{
    return (image_rows){.width = img->width, .height = img->height, .read = copy_row, .of = img, .tone = img->tone};
}

/* ---- packing ---- */

typedef struct image_head {
    int64_t width, height;
} image_head;

static bool is_side(int64_t length)
{
    return length >= 1 && length <= IMAGE_SIDE_MAX;
}

bool image_pack_holds(const pack_reader *from, int64_t width, int64_t height, size_t pixel)
{
    return is_side(width) && is_side(height) && pack_holds(from, (uint64_t)width * (uint64_t)height, pixel);
}

static size_t image_bytes(const image *img)
{
    return (size_t)img->width * (size_t)img->height * 3 * sizeof *img->pixel;
}

status image_pack(const image *img, pack_writer *to, diagnostic *why)
{
    const image_head head = {img->width, img->height};
    TRY(pack_put(to, &head, sizeof head, why));
    return pack_put(to, img->pixel, image_bytes(img), why);
}

status image_unpack(pack_reader *from, image **out, diagnostic *why)
{
    image_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    if (!image_pack_holds(from, head.width, head.height, 3 * sizeof(float)))
        return pack_damaged(why, "the size of an image");
    TRY(image_create((int)head.width, (int)head.height, out, why));
    const status code = pack_get(from, (*out)->pixel, image_bytes(*out), why);
    if (code != STATUS_OK) {
        image_destroy(*out);
        *out = NULL;
    }
    return code;
}
