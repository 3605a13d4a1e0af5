/* Differences of two images of equal size, as displayed: values are clamped to 0..1 (infinities as well) and
 * sRGB-encoded, without quantisation. Results are the same on every machine, psnr_db up to libm's last place.
 * Ownership: images are borrowed, a map is the caller's. Errors: different sizes and NaN pixels are STATUS_BAD_INPUT,
 * with the position of the pixel. */
#pragma once

#include "image/image.h"

typedef struct image_comparison {
    double mse;     /* mean squared difference of the encoded channels, 0..1 */
    double psnr_db; /* 10 log10(1 / mse), INFINITY if mse is 0 */
    double ssim;    /* mean structural similarity of the luma, -1..1, 1 for equal images: compare_parts.c */
    double flip;    /* mean FLIP error at 67.02 pixels per degree, 0..1, 0 for equal images: compare_parts.c */
    double largest; /* largest absolute difference of an encoded channel, 0..1 */
    double differing_fraction; /* fraction of pixels whose 8-bit encodings differ in a channel, 0..1 */
    int largest_x, largest_y;  /* position of the first maximum, rows from the top; 0, 0 for equal images */
} image_comparison;

/* All measures at once. Each is symmetric in a and b. */
status image_compare(const image *a, const image *b, image_comparison *out, diagnostic *why);

/* The FLIP error of each pixel in false colour (magma, black 0, pale yellow 1), in the size of the images: linear
 * values, so that its PNG has the colours of the map. */
status image_compare_map(const image *a, const image *b, image **map, diagnostic *why);

/* The measures of compare.h that use neighbourhoods, and the convolution that they use. Their images
 * have the same size and no channel is NaN. Ownership: everything is the caller's. Errors: STATUS_FAILURE without
 * memory. */

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
