/* A 5 by 7 dot-matrix font for the keys of images: printable ASCII. Pure functions; cannot fail. */
#pragma once

#include <stdbool.h>

enum { FONT_WIDTH = 5, FONT_HEIGHT = 8, FONT_ADVANCE = 6 }; /* the eighth row is for descenders */

/* True if the dot in this column and row of a character is set. Characters that are not printable ASCII look like '?';
 * dots outside the cell are unset. */
bool font_dot(char character, int column, int row);
