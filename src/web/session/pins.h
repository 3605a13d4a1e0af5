/* The picture that pages compare with: A, pinned until another one is or it is let go of; and how far pictures lie
 * apart from it, measured once for each pair however many ask. For any number of threads; nobody waits for a
 * measurement but those who ask for it. Ownership: pins_create gives, pins_destroy releases; pictures and pairs are
 * shared, and theirs who took them until they release them. Errors: STATUS_BAD_INPUT for pictures that cannot be
 * compared, STATUS_FAILURE for memory. */
#pragma once

#include "image/compare.h"
#include "web/live/painter.h"

typedef struct pins pins;
typedef struct pin_pair pin_pair;

pins *pins_create(void);    /* NULL when memory is out */
void pins_destroy(pins *p); /* NULL is allowed */

/* The picture, a final one, becomes A: p keeps it too. NULL: there is no A from now on. */
void pins_set(pins *p, const picture *a);
/* A, kept for the caller; NULL for none. */
const picture *pins_take(pins *p);
/* The state's part: A as it is described, null without one; NULL when memory is out. */
json_t *pins_tell(pins *p);

/* A beside b; NULL without A, or when memory is out. The newest pair is kept. */
pin_pair *pins_pair(pins *p, const picture *b);
void pin_pair_release(pin_pair *pair); /* NULL is allowed */
const picture *pin_pair_a(const pin_pair *pair);
bool pin_pair_fits(const pin_pair *pair); /* are they of one size? */
/* Both measure when they are asked first. out is a copy; bytes, a PNG of the FLIP error in false colour, are the
 * pair's. */
status pin_pair_numbers(pin_pair *pair, image_comparison *out, diagnostic *why);
status pin_pair_map(pin_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why);
