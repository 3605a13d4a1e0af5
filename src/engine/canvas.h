/* The canvas: the caller's buffers and the list of their finished tiles. Workers fill tiles and record them; the
 * calling thread passes the records to the caller. Ownership: canvas_open allocates, canvas_close releases; film and
 * request are borrowed. */
#pragma once

#include "base/float_environment.h"
#include "cuvette.h"
#include "image/codec.h"
#include "render/plan/film.h"

#include <pthread.h>

typedef struct canvas {
    const cuvette_request *request; /* validated; strides are not 0 */
    float_environment *host;        /* the caller's, for callbacks */
    codec_bytes *bytes;             /* NULL unless the request has srgb */
    pthread_mutex_t lock;           /* protects the fields below */
    cuvette_tile *noted;
    size_t count, capacity;
    bool out_of_memory;
} canvas;

/* Checks the caller's stride for height rows of width pixels, in elements of element_bytes; 0 becomes the stride of
 * contiguous rows. STATUS_BAD_INPUT if it is shorter than a row, or the last row would end beyond the largest object
 * (PTRDIFF_MAX bytes). */
status canvas_stride(size_t *stride, size_t element_bytes, int width, int height, diagnostic *why);

status canvas_open(const cuvette_request *request, float_environment *host, canvas *c, diagnostic *why);
void canvas_close(canvas *c);

/* Copies a rectangle of the film; each of its pixels becomes a square of `coarse` x `coarse` pixels, clipped at the
 * image's edge. */
void canvas_fill(const canvas *c, const film *f, int x0, int y0, int x1, int y1, int coarse);

/* canvas_note records a tile, from any thread; canvas_hand_out passes the recorded tiles to the callback, on the
 * caller's thread. */
void canvas_note(canvas *c, cuvette_tile tile);
status canvas_hand_out(canvas *c, diagnostic *why);
/* Passes a single tile to the callback. */
void canvas_hand_tile(canvas *c, const cuvette_tile *tile);

/* Writes a rectangle of the film as sRGB bytes; stride: bytes from one row to the next. */
void canvas_bytes(const film *f, const codec_bytes *bytes, int x0, int y0, int x1, int y1, unsigned char *srgb,
                  size_t stride);
