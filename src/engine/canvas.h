/* The caller's buffers, and the pieces of them that are finished: workers fill in pieces and note them, the calling
 * thread hands the notes to the caller. Ownership: canvas_open gives memory, canvas_close takes it; film and request
 * are borrowed. */
#pragma once

#include "base/float_environment.h"
#include "cuvette.h"
#include "image/codec.h"
#include "render/core/film.h"
#include <pthread.h>

typedef struct canvas {
    const cuvette_request *request; /* checked; strides are not 0 */
    float_environment *host;        /* the caller's, for the caller's functions */
    codec_bytes *bytes;             /* NULL unless bytes are wanted */
    pthread_mutex_t lock;           /* of what follows */
    cuvette_piece *noted;
    size_t count, capacity;
    bool out_of_memory;
} canvas;

status canvas_open(const cuvette_request *request, float_environment *host, canvas *c, diagnostic *why);
void canvas_close(canvas *c);

/* Copies a rectangle of the film, whose pixels each become a square of `coarse`, cut off at the picture's edge. */
void canvas_fill(const canvas *c, const film *f, int x0, int y0, int x1, int y1, int coarse);

/* Notes a piece, from any thread; hands out the noted ones, on the caller's. */
void canvas_note(canvas *c, cuvette_piece piece);
status canvas_hand_out(canvas *c, diagnostic *why);
/* Hands out one alone. */
void canvas_hand_piece(canvas *c, const cuvette_piece *piece);

/* A rectangle of the film as sRGB bytes; stride: bytes from one row to the next. */
void canvas_bytes(const film *f, const codec_bytes *bytes, int x0, int y0, int x1, int y1, unsigned char *srgb,
                  size_t stride);
