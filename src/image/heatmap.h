/* Heat maps: a quantity per pixel as a false-colour image, with a key below it: scale bar, numbers and title.
 * Ownership: the image belongs to the caller. */
#pragma once

#include "image/image.h"

/* values: width * height, rows from the top, finite, >= 0. The scale is linear from 0 to the largest value, in a
 * perceptually uniform map (viridis). If the largest value is more than twice the 99.5th percentile, a few outliers
 * would darken all the others: the scale then ends at that percentile, its last number is preceded by '>=', and larger
 * values have the last colour. If all values are integers, so are the numbers of the scale. The image is as wide as the
 * data (at least 240 pixels) and taller by the key. */
status heatmap_create(const double *values, int width, int height, const char *title, image **out, diagnostic *why);

/* The colour of t, 0..1, sRGB-encoded to 0..255. */
void heatmap_color(double t, unsigned char rgb[3]);
