/* The picture that pages compare with: A, pinned until another one is or it is let go of; and how far pictures lie
 * apart from it, measured once for each pair however many ask. For any number of threads; nobody waits for a
 * measurement but those who ask for it. Ownership: reference_image_create gives, reference_image_destroy releases;
 * pictures and pairs are shared, and theirs who took them until they release them. Errors: STATUS_BAD_INPUT for
 * pictures that cannot be compared, STATUS_FAILURE for memory. */
#pragma once

#include "image/compare.h"
#include "web/live/render_worker.h"

typedef struct reference_image reference_image;
typedef struct reference_pair reference_pair;

reference_image *reference_image_create(void);    /* NULL when memory is out */
void reference_image_destroy(reference_image *p); /* NULL is allowed */

/* The picture, a final one, becomes A: p keeps it too. NULL: there is no A from now on. */
void reference_image_set(reference_image *p, const shared_image *a);
/* A, kept for the caller; NULL for none. */
const shared_image *reference_image_take(reference_image *p);
/* The state's part: A as it is described, null without one; NULL when memory is out. */
json_t *reference_image_json(reference_image *p);

/* A beside b; NULL without A, or when memory is out. The newest pair is kept. */
reference_pair *reference_image_compare(reference_image *p, const shared_image *b);
void reference_pair_release(reference_pair *pair); /* NULL is allowed */
const shared_image *reference_pair_a(const reference_pair *pair);
bool reference_pair_fits(const reference_pair *pair); /* are they of one size? */
/* Both measure when they are asked first. out is a copy; bytes, a PNG of the FLIP error in false colour, are the
 * pair's. */
status reference_pair_numbers(reference_pair *pair, image_comparison *out, diagnostic *why);
status reference_pair_map(reference_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why);
