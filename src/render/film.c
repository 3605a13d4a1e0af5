#include "render/film.h"

#include "base/hash.h"
#include <stdlib.h>
#include <string.h>

/* Two cache lines, which processors fetch together: where the picture's and the tiles' widths are multiples
 * of 16, tiles then share none, and workers do not take lines from one another. */
enum { ALIGNMENT = 128 };

status film_create(int width, int height, film **out, diagnostic *why)
{
    const size_t bytes = (size_t)width * (size_t)height * 3 * sizeof(int64_t);
    film *f = calloc(1, sizeof *f);
    if (f)
        f->memory = malloc(bytes + ALIGNMENT); /* aligned_alloc would leave gaps that the next film does not fit into */
    if (!f || !f->memory) {
        free(f);
        return diagnose(why, STATUS_FAILURE, "render a smaller picture", "out of memory for a film of %d x %d", width, height);
    }
    f->sum = (int64_t *)(((uintptr_t)f->memory + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
    memset(f->sum, 0, bytes); /* the pages are there before the clock starts */
    f->width = width;
    f->height = height;
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

double film_value(const film *f, int x, int y, int channel)
{
    size_t at = ((size_t)y * (size_t)f->width + (size_t)x) * 3 + (size_t)channel;
    return (double)f->sum[at] / FILM_ONE;
}

uint64_t film_hash(const film *f)
{
    const int64_t size[2] = {f->width, f->height};
    uint64_t hash = hash_words(HASH_START, size, 2);
    return hash_finish(hash_words(hash, f->sum, (size_t)f->width * (size_t)f->height * 3));
}

status film_image(const film *f, image **out, diagnostic *why)
{
    status code = image_create(f->width, f->height, out, why);
    if (code != STATUS_OK)
        return code;
    size_t count = (size_t)f->width * (size_t)f->height * 3;
    for (size_t i = 0; i < count; i++)
        (*out)->pixel[i] = (float)((double)f->sum[i] / FILM_ONE);
    return STATUS_OK;
}
