/* The measures of compare.h that use neighbourhoods, and the convolution that they use. Their images
 * have the same size and no channel is NaN. Ownership: everything is the caller's. Errors: STATUS_FAILURE without
 * memory. */
#pragma once

#include "image/image.h"

/* Mean structural similarity, -1..1, of two planes of encoded luma, whose values are 0..1. */
status compare_ssim(const double *a, const double *b, int width, int height, double *mean, diagnostic *why);

/* Writes the FLIP error of each pixel, 0..1, to errors, width * height values. */
status compare_flip(const image *a, const image *b, double *errors, diagnostic *why);

/* Convolution of a plane of doubles with separable filters: along the rows, then along the columns. Border values are
 * repeated outside the plane. Pure; cannot fail. Planes are the caller's, width * height values, rows from the top. */

enum { CONVOLVE_TAPS_MAX = 32 };

/* weight[i] applies to the value i - before positions to the right (or below): a correlation, as usual for image
 * filters. */
typedef struct convolve_taps {
    int count, before;
    double weight[CONVOLVE_TAPS_MAX];
} convolve_taps;

/* A Gaussian at count positions, centred, with sum 1. 1 <= count <= CONVOLVE_TAPS_MAX. */
convolve_taps convolve_gaussian(int count, double sigma);

/* Adds scale times the filtered plane to out. The three planes do not overlap; scratch is overwritten. */
void convolve_add(const double *plane, int width, int height, const convolve_taps *across, const convolve_taps *down,
                  double scale, double *scratch, double *out);
