#include "render/film.h"

#include "base/hash.h"
#include <stdlib.h>
#include <string.h>

status film_create(int width, int height, film **out, diagnostic *why)
{
    film *f = calloc(1, sizeof *f);
    if (f)
        f->sum = malloc((size_t)width * (size_t)height * 3 * sizeof *f->sum);
    if (!f || !f->sum) {
        free(f);
        return diagnose(why, STATUS_FAILURE, "render a smaller picture", "out of memory for a film of %d x %d", width, height);
    }
    memset(f->sum, 0, (size_t)width * (size_t)height * 3 * sizeof *f->sum); /* the pages are there before the clock starts */
    f->width = width;
    f->height = height;
    *out = f;
    return STATUS_OK;
}

void film_destroy(film *f)
{
    if (!f)
        return;
    free(f->sum);
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
