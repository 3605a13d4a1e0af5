/* Maps of what each pixel of a final image costs, its rays and its time, and of the light that it lacks because rays
 * were cut. They are false-colour images with a key, from
 * one frame of the frame job, which must give the film of the image; kept until maps of another image are requested.
 * Thread-safe; a request waits for a render in progress. Ownership: pixel_maps_create creates, pixel_maps_destroy
 * releases when no thread calls it any more. */
#pragma once

#include "base/isa.h"
#include "image/heatmap.h"
#include "web/live/render_worker.h"

typedef struct pixel_maps pixel_maps;

enum { PIXEL_RAYS, PIXEL_TIME, PIXEL_CUT, PIXEL_MAPS };

typedef struct pixel_map {
    heatmap_scale scale;
    double total, largest; /* rays; ns; shares of a pixel's light */
} pixel_map;

typedef struct pixel_map_set {
    uint64_t serial; /* of the image */
    double wall_s;   /* of the frame that made the maps */
    int threads;
    int width, height;                       /* of the film */
    int picture_width, picture_height, left; /* of the maps, and where their pixels begin */
    pixel_map map[PIXEL_MAPS];
} pixel_map_set;

pixel_maps *pixel_maps_create(isa level); /* NULL when out of memory */
void pixel_maps_destroy(pixel_maps *m);   /* NULL is allowed */

/* The maps of a final image; rendered if they are not kept. png: a copy of the PNG of one map, which the caller frees;
 * NULL: not wanted. STATUS_INTERRUPTED when cancelled. STATUS_FAILURE if the frame takes more than
 * PIXEL_MAPS_LIMIT_S. */
#define PIXEL_MAPS_LIMIT_S 50.0
status pixel_maps_of(pixel_maps *m, const shared_image *of, pixel_map_set *out, int which, unsigned char **png,
                     size_t *size, diagnostic *why);
