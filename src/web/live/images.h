/* The images of the laboratory: those of the render worker, the reference that they are compared with, maps of what
 * their pixels cost, and thumbnails of other scenes. All are thread-safe. Ownership: *_create creates, *_destroy
 * releases once no thread uses the object; a shared image is immutable and reference-counted. Errors: NULL when out
 * of memory, STATUS_BAD_INPUT for images that cannot be compared, STATUS_FAILURE for memory and for renders that take
 * too long. */
#pragma once

#include "base/isa.h"
#include "image/compare.h"
#include "image/heatmap.h"
#include "image/image.h"
#include "scene/model/open.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* --- an image of the render worker (shared_image.c), shared by threads --- */

typedef struct shared_image {
    uint64_t generation;
    uint64_t serial;   /* increases with each image, whatever its generation */
    int pass, passes;  /* from 1 */
    bool final;        /* the complete film of the scene */
    int width, height; /* of this pass */
    int full_width, full_height;
    const json_t *numbers; /* times and counts, from report_image_numbers */
    uint64_t film_hash;    /* of the final image */
    const image *linear;
    const scene *rendered; /* the scene of a final image; otherwise NULL */
} shared_image;

void shared_image_retain(const shared_image *img);
void shared_image_release(const shared_image *img); /* NULL is allowed */

/* The image as an 8-bit PNG or as a JPEG (image_encode with `fast`), encoded once for all callers; the bytes belong to
 * the image. */
status shared_image_encode(const shared_image *img, image_format format, const unsigned char **bytes, size_t *size,
                           diagnostic *why);

/* The image's JSON as described in web/README.md; NULL when out of memory. */
json_t *shared_image_json(const shared_image *img);

/* --- the reference image A that pages compare with (reference_image.c) --- */

/* A is kept until it is replaced or cleared. The differences between A and another image are measured once, and only
 * callers that need them wait. The thread that gets an image or a pair releases it. */

typedef struct reference_image reference_image;
typedef struct reference_pair reference_pair;

reference_image *reference_image_create(void);            /* NULL when out of memory */
void reference_image_destroy(reference_image *reference); /* NULL is allowed */

/* Makes a final image the reference A, and retains it. NULL: clears A. */
void reference_image_set(reference_image *reference, const shared_image *a);
/* Returns a new reference to A; NULL without A. */
const shared_image *reference_image_get(reference_image *reference);
/* A in the state JSON, null without A; NULL when out of memory. */
json_t *reference_image_json(reference_image *reference);

/* The pair of A and b; NULL without A or when out of memory. The newest pair is cached. */
reference_pair *reference_image_compare(reference_image *reference, const shared_image *b);
void reference_pair_release(reference_pair *pair); /* NULL is allowed */
const shared_image *reference_pair_a(const reference_pair *pair);
bool reference_pair_fits(const reference_pair *pair); /* whether both have the same size */
/* The first call measures. out is a copy; bytes, a PNG of the FLIP error in false colour, belong to the pair. */
status reference_pair_numbers(reference_pair *pair, image_comparison *out, diagnostic *why);
status reference_pair_map(reference_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why);

/* --- maps of what each pixel of a final image costs (pixel_maps.c) --- */

/* Maps of the rays and the time of each pixel, and of the light that it lacks because rays were cut. They are
 * false-colour images with a key. They are rendered by one more frame, whose film must equal the film of the image, and
 * kept until maps of another image are requested. A request waits for a render in progress. */

typedef struct pixel_maps pixel_maps;

enum { PIXEL_RAYS, PIXEL_TIME, PIXEL_CUT, PIXEL_MAPS };

typedef struct pixel_map {
    heatmap_scale scale;
    double total, largest; /* over the pixels, in the map's unit: rays; ns; fractions of a pixel's light */
} pixel_map;

typedef struct pixel_map_set {
    uint64_t serial; /* of the image */
    double wall_s;   /* of the frame with the maps */
    int threads;
    int width, height;                   /* of the film */
    int image_width, image_height, left; /* of the maps, and where their pixels begin */
    pixel_map map[PIXEL_MAPS];
} pixel_map_set;

pixel_maps *pixel_maps_create(isa level); /* NULL when out of memory */
void pixel_maps_destroy(pixel_maps *m);   /* NULL is allowed */

/* The maps of a final image, rendered unless they are kept. *png: a copy of the PNG of the map `which`, which the
 * caller frees; png may be NULL. STATUS_INTERRUPTED when cancelled. STATUS_FAILURE if the frame takes more than
 * PIXEL_MAPS_LIMIT_S. */
#define PIXEL_MAPS_LIMIT_S 50.0
status pixel_maps_of(pixel_maps *m, const shared_image *img, pixel_map_set *out, int which, unsigned char **png,
                     size_t *size, diagnostic *why);

/* --- thumbnails of scenes (thumbnails.c) --- */

/* Small images, rendered when they are first requested and kept in memory. */

typedef struct thumbnails thumbnails;

thumbnails *thumbnails_create(isa level); /* NULL when out of memory */
void thumbnails_destroy(thumbnails *t);   /* NULL is allowed */
/* Ends a render; later requests return STATUS_INTERRUPTED. */
void thumbnails_end(thumbnails *t);

/* The JPEG kept for a key, in memory that the caller frees; *bytes is NULL if there is none. */
status thumbnails_find(thumbnails *t, const char *key, unsigned char **bytes, size_t *size, diagnostic *why);
/* Renders the scene and keeps the thumbnail; changes the scene's image settings and loads its files. STATUS_FAILURE if
 * this takes more than 16 s of CPU time. */
status thumbnails_render(thumbnails *t, const char *key, scene *s, unsigned char **bytes, size_t *size,
                         diagnostic *why);
