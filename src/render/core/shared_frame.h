/* A frame whose tiles are traced in several places, such as the ranks of an MPI job or the workers of a browser,
 * each by a piece_source (render/core/renderer.h): the tiles, and their sum, which is the film of the whole frame
 * bit for bit. Ownership: shared_frame_begin allocates film and variance; shared_frame_release frees them, unless
 * the owner took them and set them to NULL. One thread at a time. */
#pragma once

#include "render/core/renderer.h"

/* The settings with which all places have the same tiles: of that side, whatever their threads. */
render_settings tiles_settings(const render_settings *r, int side);

typedef struct shared_frame {
    schedule places; /* of the tiles */
    film *img;
    double *variance; /* NULL: unknown */
} shared_frame;

status shared_frame_begin(const scene *s, int side, shared_frame *out, diagnostic *why);
void shared_frame_release(shared_frame *f);

/* The number of values of a traced tile: its sums, 3 for each pixel, then as many variances (doubles) if there are
 * any. */
size_t shared_frame_values(const shared_frame *f, int64_t tile);
/* Adds a traced tile. */
void shared_frame_put(shared_frame *f, int64_t tile, const int64_t *values);
