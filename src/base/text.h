/* String helpers. Pure unless stated otherwise. */
#pragma once

#include <stddef.h>

/* Optimal string alignment distance (insert, delete, replace, swap neighbours) between two words, letter case
 * ignored; words over 63 characters compare by their first 63. */
unsigned text_distance(const char *a, const char *b);

/* The word of words[0..count-1] nearest to wrong, or NULL if none is within a third of its length (at least 1). */
const char *text_nearest(const char *wrong, const char *const *words, size_t count);

/* printf into newly allocated memory (free it), or NULL. */
char *text_format(const char *format, ...) __attribute__((format(printf, 1, 2)));
