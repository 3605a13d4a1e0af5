/* Images in memory: creation, ownership, rows, packing. */
#include "image/image.h"

#include "base/budget.h"
#include <stdbool.h>
#include <stdint.h>
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
    int64_t width, height, coded_bits;
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
    const image_head head = {img->width, img->height, img->coded_bits};
    TRY(pack_put(to, &head, sizeof head, why));
    return pack_put(to, img->pixel, image_bytes(img), why);
}

status image_unpack(pack_reader *from, image **out, diagnostic *why)
{
    image_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    if (!image_pack_holds(from, head.width, head.height, 3 * sizeof(float)) || head.coded_bits < 0 ||
        head.coded_bits > 16)
        return pack_damaged(why, "the size of an image");
    TRY(image_create((int)head.width, (int)head.height, out, why));
    (*out)->coded_bits = (int)head.coded_bits;
    const status code = pack_get(from, (*out)->pixel, image_bytes(*out), why);
    if (code != STATUS_OK) {
        image_destroy(*out);
        *out = NULL;
    }
    return code;
}
