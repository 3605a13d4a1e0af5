/* The reference image A that pages compare with, kept until it is replaced or cleared, and the differences between A
 * and other images, measured once per pair. Thread-safe; only a caller that needs a measurement waits for it.
 * Ownership: reference_image_create creates, reference_image_destroy releases; images and pairs are reference-counted
 * and released by the thread that took them. Errors: STATUS_BAD_INPUT for images that cannot be compared,
 * STATUS_FAILURE for memory. */
#pragma once

#include "image/compare.h"
#include "web/live/render_worker.h"

typedef struct reference_image reference_image;
typedef struct reference_pair reference_pair;

reference_image *reference_image_create(void);    /* NULL when out of memory */
void reference_image_destroy(reference_image *p); /* NULL is allowed */

/* Makes a final image the reference A; p takes a reference of its own. NULL: clears A. */
void reference_image_set(reference_image *p, const shared_image *a);
/* Returns a new reference to A; NULL without A. */
const shared_image *reference_image_take(reference_image *p);
/* A in the state JSON, null without A; NULL when out of memory. */
json_t *reference_image_json(reference_image *p);

/* The pair of A and b; NULL without A or when out of memory. The newest pair is cached. */
reference_pair *reference_image_compare(reference_image *p, const shared_image *b);
void reference_pair_release(reference_pair *pair); /* NULL is allowed */
const shared_image *reference_pair_a(const reference_pair *pair);
bool reference_pair_fits(const reference_pair *pair); /* whether both have the same size */
/* Both measure on the first call. out is a copy; bytes, a PNG of the FLIP error in false colour, belong to the pair. */
status reference_pair_numbers(reference_pair *pair, image_comparison *out, diagnostic *why);
status reference_pair_map(reference_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why);
