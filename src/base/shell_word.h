/* Words of a command line, for a reader who copies it into a shell. Errors of the stream stay in the stream. */
#pragma once

#include <stdio.h>

/* Writes a word, in single quotes where a shell would change it. */
void shell_word_write(FILE *out, const char *word);
