/* The film: sums of radiance in 64-bit fixed point, so that the order of summation does not matter. One unit is 2^-44
 * (5.7e-14); a channel holds up to 524288, and one contribution is from 0 to 262144. A value out of range, or not a
 * number, raises the overflow flag, which makes the render an error. Linear light; row 0 is the top. The channels are
 * linear sRGB, or CIE XYZ in a spectral film, whose sums are never negative. A film of random paths consists of
 * replicates, films of equal numbers of paths stored one after another, whose differences give the standard error.
 * add_units (render/shade/exposure.h) writes the film. A film may also hold one tile of an image at a time, for frames
 * that several processes render. Ownership: film_create allocates, film_destroy releases. Different threads may write
 * different pixels, of the film and of its layers. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "image/image.h"
#include "scene/model/integrators.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FILM_ONE 17592186044416.0 /* 2^44 */

/* Set in the float builds of `make variants`: sums are doubles, which depend on the order of summation and have no
 * limited range. Only for measuring the cost of fixed point (experiments/determinism.sh). */
#ifndef CUVETTE_FILM_FLOAT
#define CUVETTE_FILM_FLOAT 0
#endif

#if CUVETTE_FILM_FLOAT
typedef double film_sum;
static inline bool film_accepts(double radiance)
{
    (void)radiance;
    return true;
}
static inline film_sum film_units(double radiance)
{
    return radiance;
}
static inline film_sum film_add(film_sum a, film_sum b)
{
    return a + b;
}
static inline double film_radiance(film_sum sum)
{
    return sum;
}
/* Negative if a sum left the film's range. */
static inline int64_t film_overflow(film_sum sum)
{
    (void)sum;
    return 0;
}
#else
typedef int64_t film_sum;
/* Whether a contribution is in range; false for NaN. */
static inline bool film_accepts(double radiance)
{
    const double limit = 262144.0; /* half of a channel's range */
    return (int)(radiance >= 0.0) & (int)(radiance < limit);
}
static inline film_sum film_units(double radiance)
{
    return (int64_t)(radiance * FILM_ONE + 0.5);
}
static inline film_sum film_add(film_sum a, film_sum b)
{
    return (int64_t)((uint64_t)a + (uint64_t)b);
}
static inline double film_radiance(film_sum sum)
{
    return (double)sum / FILM_ONE;
}
/* Negative if a sum left the film's range: no replicate's sum is negative. */
static inline int64_t film_overflow(film_sum sum)
{
    return sum;
}
#endif

typedef enum film_space { FILM_RGB, FILM_XYZ } film_space;
enum { FILM_REPLICATES_MAX = 8 };

typedef struct film {
    int width, height;
    film_space space;
    int replicates; /* 1, or the number of films of this size stored one after another: see film_merge_replicates */
    film_sum *sum;  /* [(y*width + x)*3 + channel], a pointer into memory */
    void *memory;
    /* for a film of one tile: the number of its first pixel in the image, and the image's width; otherwise 0 */
    int64_t first_pixel;
    int image_width;
    double row_per_pixel; /* 1 / image_width */
} film;

status film_create(int width, int height, int replicates, film_space space, film **out, diagnostic *why);

/* Adds all replicates into the first, after which the film can be read; writes the square of the standard error of each
 * value to variance unless that is NULL. Has no effect with one replicate. variance: [(y*width + x)*3 + channel], in
 * the film's colour space. Returns false when a sum leaves the film's range. */
bool film_merge_replicates(film *f, double *variance);
void film_destroy(film *f);

/* Clears f and makes it the film of the tile x0 <= x < x1, y0 <= y < y1 of an image, of at most the size that f was
 * created with. replicates: the number that f was created with, since film_merge_replicates sets it to 1. */
void film_begin_tile(film *f, int image_width, int x0, int y0, int x1, int y1, int replicates);

/* Copies the sums (film_sum) of the tile x0 <= x < x1, y0 <= y < y1, row by row, into the film of the image, which has
 * one replicate. */
void film_store_tile(film *f, int x0, int y0, int x1, int y1, const void *sums);

/* The pixel's place in sum, in pixels; pixel: its number in the image, y*image_width + x. Truncation finds the row
 * exactly: the boundary of a row is half a pixel away, and rounding moves the quotient by less than 2^-52 of itself,
 * which is below 2^-24 pixels. */
static inline int64_t film_pixel_index(const film *f, int64_t pixel)
{
    if (f->image_width == 0)
        return pixel;
    const int64_t from = pixel - f->first_pixel, row = (int64_t)(((double)from + 0.5) * f->row_per_pixel);
    return from - row * (f->image_width - f->width);
}

/* Radiance of one channel, linear sRGB; in a spectral film, negative if the colour is outside the sRGB gamut. */
double film_value(const film *f, int x, int y, int channel);

/* Reads linear RGB of the rectangle x0 <= x < x1, y0 <= y < y1 as floats, the sum of all replicates; stride: floats
 * from one row to the next. Other threads may write the film elsewhere at the same time. */
void film_read(const film *f, int x0, int y0, int x1, int y1, float *rgb, size_t stride);

/* A hash of the film's size and every sum: equal films have equal hashes. */
uint64_t film_hash(const film *f);

/* The film as an image (linear, float). */
status film_image(const film *f, image **out, diagnostic *why);

/* --- named layers --- */

/* Arrays of per-pixel values that an integrator writes in addition to the film, row by row as in the film. */
typedef struct layer_set {
    float *values[LAYER_COUNT]; /* [pixel * layer_channels + channel]; 0 where rays hit nothing */
} layer_set;

/* All values are 0. Returns NULL when out of memory; layers_destroy releases. */
layer_set *layers_create(int width, int height);
uint64_t layers_bytes(void);       /* per pixel */
void layers_destroy(layer_set *l); /* NULL is allowed */

/* Stores a pixel's value; a layer of one channel stores value.x. */
static inline void layers_put(layer_set *l, layer_rule which, int64_t pixel, vec3 value)
{
    float *at = l->values[which] + pixel * layer_channels[which];
    at[0] = (float)value.x;
    if (layer_channels[which] == 3)
        at[1] = (float)value.y, at[2] = (float)value.z;
}
