/* Filling the caller's buffers, and passing finished tiles to the caller. */
#include "base/array.h"
#include "engine/engine_private.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 /* pixels converted at a time */ };

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

status canvas_stride(size_t *stride, size_t element_bytes, int width, int height, diagnostic *why)
{
    const size_t row = 3 * (size_t)width, most = (size_t)PTRDIFF_MAX / element_bytes / (size_t)height;
    if (*stride == 0)
        *stride = row;
    if (*stride >= row && *stride <= most)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "set it to 0, or to the number of elements from one row to the next",
                    "a stride of %zu is %s", *stride,
                    *stride < row ? "shorter than a row" : "too large: the last row is beyond all memory");
}

status canvas_open(const cuvette_request *request, float_environment *host, canvas *c, diagnostic *why)
{
    *c = (canvas){.request = request, .host = host};
    if (request->srgb)
        c->bytes = malloc(sizeof *c->bytes);
    if ((request->srgb && !c->bytes) || pthread_mutex_init(&c->lock, NULL) != 0) {
        free(c->bytes);
        return out_of_memory(why);
    }
    if (c->bytes)
        codec_bytes_prepare(c->bytes);
    return STATUS_OK;
}

void canvas_close(canvas *c)
{
    pthread_mutex_destroy(&c->lock);
    free(c->bytes);
    free(c->noted);
}

/* Fills width x height pixels of the buffers with one value. */
static void fill_square(const canvas *c, const float *rgb, int x, int y, int width, int height)
{
    const cuvette_request *r = c->request;
    for (int j = y; j < y + height; j++)
        for (int i = x; i < x + width; i++)
            for (int k = 0; k < 3; k++) {
                if (r->rgb)
                    r->rgb[(size_t)j * r->rgb_stride + 3 * (size_t)i + (size_t)k] = rgb[k];
                if (r->srgb)
                    r->srgb[(size_t)j * r->srgb_stride + 3 * (size_t)i + (size_t)k] = codec_byte(c->bytes, rgb[k]);
            }
}

static void fill_coarse(const canvas *c, const film *f, int x0, int y0, int x1, int y1, int coarse)
{
    const cuvette_request *r = c->request;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            float rgb[3];
            film_read(f, x, y, x + 1, y + 1, rgb, 3);
            const int left = x * coarse, top = y * coarse;
            fill_square(c, rgb, left, top, smaller(coarse, r->width - left), smaller(coarse, r->height - top));
        }
}

void canvas_bytes(const film *f, const codec_bytes *bytes, int x0, int y0, int x1, int y1, unsigned char *srgb,
                  size_t stride)
{
    float rgb[3 * CHUNK];
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x += CHUNK) {
            const int end = smaller(x + CHUNK, x1);
            unsigned char *row = srgb + (size_t)(y - y0) * stride + 3 * (size_t)(x - x0);
            film_read(f, x, y, end, y + 1, rgb, sizeof rgb / sizeof *rgb);
            codec_bytes_encode(bytes, rgb, 3 * (size_t)(end - x), row);
        }
}

void canvas_fill(const canvas *c, const film *f, int x0, int y0, int x1, int y1, int coarse)
{
    const cuvette_request *r = c->request;
    if (coarse > 1) {
        fill_coarse(c, f, x0, y0, x1, y1, coarse);
        return;
    }
    if (r->rgb)
        film_read(f, x0, y0, x1, y1, r->rgb + (size_t)y0 * r->rgb_stride + 3 * (size_t)x0, r->rgb_stride);
    if (r->srgb)
        canvas_bytes(f, c->bytes, x0, y0, x1, y1, r->srgb + (size_t)y0 * r->srgb_stride + 3 * (size_t)x0,
                     r->srgb_stride);
}

void canvas_note(canvas *c, cuvette_tile tile)
{
    pthread_mutex_lock(&c->lock);
    if (GROW(c->noted, c->capacity, c->count + 1))
        c->noted[c->count++] = tile;
    else
        c->out_of_memory = true;
    pthread_mutex_unlock(&c->lock);
}

void canvas_hand_tile(canvas *c, const cuvette_tile *tile)
{
    float_environment_leave(c->host);
    c->request->tile(c->request->context, tile);
    float_environment_enter(c->host);
}

status canvas_hand_out(canvas *c, diagnostic *why)
{
    pthread_mutex_lock(&c->lock);
    cuvette_tile *tiles = c->noted;
    const size_t count = c->count;
    const bool out_of_memory = c->out_of_memory;
    c->noted = NULL; /* the callback may be slow; workers continue to add tiles */
    c->count = c->capacity = 0;
    pthread_mutex_unlock(&c->lock);
    for (size_t i = 0; i < count; i++)
        canvas_hand_tile(c, &tiles[i]);
    free(tiles);
    return out_of_memory ? diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the list of finished tiles")
                         : STATUS_OK;
}
