/* The film sums radiance in 64-bit fixed point, so that the order of the sums cannot matter: one unit is
 * 2^-44 (5.7e-14); a channel holds up to 524288, and one contribution is from 0 to 262144. What is beyond that, or is no number, raises the
 * overflow flag, which makes the render an error. Linear light; row 0 is the top.
 * Ownership: film_create gives, film_destroy releases. Different pixels may be written by different threads. */
#ifndef CUVETTE_RENDER_FILM_H
#define CUVETTE_RENDER_FILM_H

#include "base/status.h"
#include "image/image.h"
#include <stdint.h>

#define FILM_ONE 17592186044416.0 /* 2^44 */

typedef struct film {
    int width, height;
    int64_t *sum;   /* [(y*width + x)*3 + channel], in memory */
    void *memory;
} film;

status film_create(int width, int height, film **out, diagnostic *why);
void film_destroy(film *f);

/* Radiance of one channel. */
double film_value(const film *f, int x, int y, int channel);

/* The fingerprint of the film's size and every sum: equal films, equal hashes. */
uint64_t film_hash(const film *f);

/* The film as a picture (linear, float). */
status film_image(const film *f, image **out, diagnostic *why);

#endif
