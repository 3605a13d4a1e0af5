/* How far two pictures of one size lie apart, as a viewer of a display would meet them: values are clamped to 0..1
 * (infinities too) and sRGB-encoded, never quantised; what comes from 8 bits is what it is. Numbers are the same on
 * every machine, psnr_db up to libm's last place. Ownership: pictures are borrowed, a map is the caller's. Errors:
 * sizes that differ and a pixel that is not a number are STATUS_BAD_INPUT, with the pixel's place. */
#pragma once

#include "image/image.h"

typedef struct image_comparison {
    double mse;               /* mean squared difference of the encoded channels, 0..1 */
    double psnr_db;           /* 10 log10(1 / mse), INFINITY where mse is 0 */
    double ssim;              /* mean structural similarity of the luma, -1..1, 1 for equal ones: compare_ssim.c */
    double flip;              /* mean FLIP error at 67.02 pixels a degree, 0..1, 0 for equal ones: compare_flip.c */
    double largest;           /* largest absolute difference of an encoded channel, 0..1 */
    double differing_share;   /* of the pixels, those whose 8-bit encodings differ in a channel, 0..1 */
    int largest_x, largest_y; /* where the largest stands first, rows from the top; 0, 0 where nothing differs */
} image_comparison;

/* All measures at once. Every one is symmetric in a and b. */
status image_compare(const image *a, const image *b, image_comparison *out, diagnostic *why);

/* The FLIP error of each pixel in false colour (magma, black 0, pale yellow 1), of the pictures' size: linear light, so
 * that a PNG of it has the map's own colours. */
status image_compare_map(const image *a, const image *b, image **map, diagnostic *why);
