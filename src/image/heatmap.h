/* False colours, and a quantity per pixel as a false-colour image with a key: scale bar, numbers and a title below.
 * Ownership: the image is the caller's. */
#pragma once

#include "image/image.h"
#include <stdbool.h>

/* The scale of the colours. */
typedef struct heatmap_scale {
    double end;    /* value of the last colour; the first is 0 */
    bool cut;      /* values above end have the last colour */
    bool integers; /* all values are integers */
} heatmap_scale;

/* The scale for count values, which must be as for heatmap_create. */
status heatmap_scale_of(const double *values, size_t count, heatmap_scale *out, diagnostic *why);

/* values: width*height, rows from the top, finite, >= 0. The scale runs linearly from 0 to the maximum, in a
 * perceptually uniform map (viridis). If the maximum is more than twice the 99.5th percentile, a few outliers would
 * darken everything else: the scale then ends at that percentile, with '>=' before its last number, and larger values
 * have the last colour. Integer values have integer labels. The image is as wide as the data (at least 240), and higher
 * by the height of the key. */
status heatmap_create(const double *values, int width, int height, const char *title, image **out, diagnostic *why);

/* The colour of t in 0..1 on the colour scale, as sRGB values 0..255. */
void heatmap_color(double t, unsigned char rgb[3]);

/* Colour maps for numbers from 0 to 1, from dark to light: two maps by S. van der Walt and N. Smith for matplotlib 2015
 * (CC0). Pure. */
typedef enum color_map { VIRIDIS, MAGMA } color_map;

/* sRGB, 0 to 255, not rounded. t is clamped to 0..1, NaN is 0. */
void color_map_at(color_map which, double t, double rgb[3]);

/* A 5 by 7 dot-matrix font for the keys of images: printable ASCII. Pure; cannot fail. */
enum { FONT_WIDTH = 5, FONT_HEIGHT = 8, FONT_ADVANCE = 6 }; /* the eighth row is for descenders */

/* Whether the dot in this column and row of a character is set; characters other than printable ASCII look like '?',
 * dots outside the cell are unset. */
bool font_dot(char character, int column, int row);
