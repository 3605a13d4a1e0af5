/* Colour maps of the numbers from 0 to 1, from dark to light: two maps by S. van der Walt and N. Smith for matplotlib,
 * 2015 (CC0). Pure functions. */
#pragma once

typedef enum color_map { VIRIDIS, MAGMA } color_map;

/* sRGB, 0 to 255, not rounded. t is clamped to 0..1; NaN counts as 0. */
void color_map_at(color_map which, double t, double rgb[3]);
