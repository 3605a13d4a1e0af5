/* Text in memory, written through a stream. open_memstream does the same, but glibc's version hides out of memory: it
 * drops what does not fit, fclose returns 0, and the text can be NULL. Here a failure is remembered, whatever is
 * written after it. Ownership: open, write to stream, then close or abandon; both free the writer, which must not move
 * in between. The caller owns the text and frees it with free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdio.h>

typedef struct text_writer {
    FILE *stream;
    char *text;
    size_t size, capacity;
    bool failed; /* some text did not fit */
} text_writer;

status text_writer_open(text_writer *writer, diagnostic *why);

/* *text is the whole text and a final 0, which *size (may be NULL) does not count; NULL unless the status is
 * STATUS_OK. */
status text_writer_close(text_writer *writer, char **text, size_t *size, diagnostic *why);
void text_writer_abandon(text_writer *writer);
/* Closes the writer if code is STATUS_OK, otherwise abandons it; returns code, or the error of closing. */
status text_writer_end(text_writer *writer, status code, char **text, size_t *size, diagnostic *why);
