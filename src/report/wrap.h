/* Rows of a table wrapped to the width of a terminal. Widths count the characters of UTF-8. Ownership: everything is
 * borrowed. Errors of the stream stay in the stream, where the caller checks them. */
#pragma once

#include <stdio.h>

/* Writes start, the aligned cells of a row with the blanks after them, then the text of its last column, which may have
 * any length, and a newline. columns is the width of the terminal: the text is wrapped under itself, or, if fewer than
 * 24 columns are left for it, below the cells with an indent of 4. columns 0, for a pipe or a file: one line, nothing
 * is wrapped. */
void wrap_row(FILE *stream, int columns, const char *start, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
