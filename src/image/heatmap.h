/* A quantity per pixel as a false-colour picture with a key: scale bar, its numbers and a title under it.
 * Ownership: the picture is the caller's. */
#pragma once

#include "image/image.h"

/* values: width*height, rows from the top, finite, >= 0. The scale runs from 0 to the largest value, linear,
 * in a perceptually uniform map (viridis). Where the largest is more than twice the 99.5th percentile, a few outliers
 * would darken all the rest: the scale then ends at that percentile, with '>=' before its last number, and what is
 * above has the last colour. Whole values get whole numbers at the scale. The picture is as wide as the data (at least
 * 240) and taller by the key. */
status heatmap_create(const double *values, int width, int height, const char *title, image **out, diagnostic *why);

/* The map's colour for 0..1, sRGB-encoded 0..255. */
void heatmap_color(double t, unsigned char rgb[3]);
