/* Comparison of two images of one size as a display shows them: values are clamped to 0..1 (infinities too) and
 * sRGB-encoded, but not quantised. Numbers are the same on every machine, psnr_db up to the last place of libm's log10.
 * Ownership: images are borrowed, a map belongs to the caller. Errors: STATUS_BAD_INPUT for sizes that differ and for a
 * pixel that is not a number, with the pixel's position. */
#pragma once

#include "image/image.h"

typedef struct image_comparison {
    double mse;               /* mean squared difference of the encoded channels, 0..1 */
    double psnr_db;           /* 10 log10(1 / mse), INFINITY where mse is 0 */
    double ssim;              /* mean structural similarity of the luma, -1..1, 1 for equal images: compare_ssim.c */
    double flip;              /* mean FLIP error at 67.02 pixels a degree, 0..1, 0 for equal images: compare_flip.c */
    double largest;           /* largest absolute difference of an encoded channel, 0..1 */
    double differing_share;   /* share of the pixels whose 8-bit encodings differ in a channel, 0..1 */
    int largest_x, largest_y; /* the first pixel with the largest difference, rows from the top; 0, 0 if none differs */
} image_comparison;

/* Computes all measures. Each is symmetric in a and b. */
status image_compare(const image *a, const image *b, image_comparison *out, diagnostic *why);

/* Creates an image of the FLIP error of each pixel in false colour (magma, black 0, pale yellow 1), in linear light, so
 * that a PNG of it has the map's own colours. */
status image_compare_map(const image *a, const image *b, image **map, diagnostic *why);
