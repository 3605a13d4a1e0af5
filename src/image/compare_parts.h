/* Internals of compare.h: the measures that use neighbouring pixels, each in a file of its own. Their images and planes
 * have passed compare_check. Ownership: everything belongs to the caller. Errors: STATUS_FAILURE when out of memory. */
#pragma once

#include "image/image.h"

/* STATUS_BAD_INPUT unless the sizes are equal and every channel is a number. */
status compare_check(const image *a, const image *b, diagnostic *why);

/* Mean structural similarity of two planes of encoded luma, 0..1. */
status compare_ssim(const double *a, const double *b, int width, int height, double *mean, diagnostic *why);

/* Writes the FLIP error of each pixel, 0..1, to errors, width * height values. */
status compare_flip(const image *a, const image *b, double *errors, diagnostic *why);

/* ---- colours and colour differences of FLIP, relative to white ---- */

/* Luminance and two opponent colours, red-green and yellow-blue: YCxCz without its scales and its offset, which commute
 * with filters of sum 1. Linear in rgb, which is clamped to 0..1 first. */
void flip_opponent(const float rgb[3], double opponent[3]);
/* Converts back to linear light, clamps it to 0..1, and converts it to CIELAB with Hunt's adjustment. */
void flip_hunt_lab(const double opponent[3], double lab[3]);
/* The HyAB distance, to the power 0.7, of green and blue, the two most distant colours of the RGB cube. */
double flip_farthest(void);
/* The same distance of two colours from flip_hunt_lab, remapped to 0..1. */
double flip_color_error(const double a[3], const double b[3], double farthest);
