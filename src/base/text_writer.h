/* Text in memory, written through a stream. open_memstream does the same, but glibc's reports no lack of memory:
 * what finds no room is left out, fclose returns 0, and the text can be NULL. Here a failure stays known, whatever
 * was written after it. Ownership: open, write to stream, then close or abandon; both release the writer, which
 * stays where it was opened. The text is the caller's, released with free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdio.h>

typedef struct text_writer {
    FILE *stream;
    char *text;
    size_t size, capacity;
    bool failed; /* something found no room */
} text_writer;

status text_writer_open(text_writer *writer, diagnostic *why);

/* *text gets all that was written and a final 0, which *size (may be NULL) leaves out; NULL unless the status is
 * STATUS_OK. */
status text_writer_close(text_writer *writer, char **text, size_t *size, diagnostic *why);
void text_writer_abandon(text_writer *writer);
/* Closes it where code is STATUS_OK, abandons it where it is not; returns code, or why it could not be closed. */
status text_writer_end(text_writer *writer, status code, char **text, size_t *size, diagnostic *why);
