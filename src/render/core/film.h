/* The film sums radiance in 64-bit fixed point, so that the order of the sums cannot matter: one unit is
 * 2^-44 (5.7e-14); a channel holds up to 524288, and one contribution is from 0 to 262144. What is beyond that, or is
 * no number, raises the overflow flag, which makes the render an error. Linear light; row 0 is the top. The channels
 * are linear sRGB, or of a spectral film CIE XYZ, whose sums are never negative. A film of random paths is exposed in
 * equal shares of the paths, one film behind another: their differences give the standard error. Written by expose_at
 * (render/shade/shading.c). Ownership: film_create gives, film_destroy releases. Different pixels may be written by
 * different threads. */
#pragma once

#include "base/status.h"
#include "image/image.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FILM_ONE 17592186044416.0 /* 2^44 */

typedef enum film_space { FILM_RGB, FILM_XYZ } film_space;
enum { FILM_SHARES_MAX = 8 };

typedef struct film {
    int width, height;
    film_space space;
    int shares;   /* 1, or the number of films of this size one behind another in memory: see film_merge_shares */
    int64_t *sum; /* [(y*width + x)*3 + channel], in memory */
    void *memory;
} film;

status film_create(int width, int height, int shares, film_space space, film **out, diagnostic *why);

/* Puts the sum of all shares into the first, after which the film can be read; the square of the standard error of each
 * value goes to variance unless that is NULL. Nothing to do for one share. variance: [(y*width + x)*3 + channel], in
 * the film's own space. False when a sum leaves the film's range. */
bool film_merge_shares(film *f, double *variance);
void film_destroy(film *f);

/* Radiance of one channel, linear sRGB: of a spectral film that can be negative, where a colour lies outside its gamut.
 */
double film_value(const film *f, int x, int y, int channel);

/* Linear RGB of the rectangle x0 <= x < x1, y0 <= y < y1 as floats, all shares together; stride: floats from one row to
 * the next. Others may write the film elsewhere meanwhile. */
void film_read(const film *f, int x0, int y0, int x1, int y1, float *rgb, size_t stride);

/* The fingerprint of the film's size and every sum: equal films, equal hashes. */
uint64_t film_hash(const film *f);

/* The film as a picture (linear, float). */
status film_image(const film *f, image **out, diagnostic *why);
