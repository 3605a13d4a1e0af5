/* Lines of words, for readers of text. All functions stop at the end of the text or of the line. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct lines {
    const char *at, *end; /* the rest of the text; a 0 follows */
    const char *word, *line_end;
    long line;
} lines;

/* Begins the next line; false at the end of the text. A \ at its end joins it with the one after. */
bool lines_next(lines *l);
/* The next word of the line and its length; false: none. */
bool lines_word(lines *l, const char **word, size_t *length);
/* Is the word that text? */
bool lines_is(const char *word, size_t length, const char *text);
/* The rest of the line, without blanks at both ends. */
size_t lines_rest(const lines *l, const char **text);
/* Reads the line's further words as numbers, at most `most`, rounded as the importer rounds them (import/obj.h);
 * returns how many, -1: a word is none. */
int lines_numbers(lines *l, int most, float *numbers);
