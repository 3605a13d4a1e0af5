/* Row filters of PNG (PNG specification, 9): before compression a byte is replaced by its difference to a neighbour,
 * modulo 256. Only Sub (the pixel to the left) and Up (the row above) are used. On the shipped scenes the others, added
 * to these, made the files larger or saved nothing, and took more time. Pure; cannot fail. */
#pragma once

#include <stddef.h>

/* How the filter of a row is chosen. */
typedef enum png_filter_choice {
    PNG_FILTER_ALWAYS_SUB,     /* fastest */
    PNG_FILTER_FEWEST_CHANGES, /* the fewest unequal neighbouring bytes: deflate finds long matches, best for 8 bits */
    PNG_FILTER_LEAST_SUM       /* the least sum of absolute differences (PNG specification, 12.7), best for 16 bits */
} png_filter_choice;

/* Writes the filter's type and the filtered row, bytes + 1 values, to out. above: the row above, all 0 for the first
 * row. pixel: bytes per pixel. spare: bytes + 1 values that may be overwritten. */
void png_filter_row(png_filter_choice choice, const unsigned char *row, const unsigned char *above, size_t bytes,
                    size_t pixel, unsigned char *out, unsigned char *spare);
