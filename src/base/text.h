/* Texts. Ownership: new texts are the caller's, freed with free. Pure unless stated otherwise. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Optimal string alignment distance (insert, delete, replace, swap neighbours) between two words, letter case ignored;
 * words over 63 characters compare by their first 63. */
unsigned text_distance(const char *a, const char *b);

/* The word of words[0..count-1] nearest to wrong, or NULL if none is within a third of its length (at least 1). */
const char *text_nearest(const char *wrong, const char *const *words, size_t count);

/* printf into newly allocated memory; NULL when out of memory. */
char *text_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* ---- a stream into memory ---- */

/* Text in memory, written through a stream. open_memstream does the same, but glibc's version hides out of memory: it
 * drops what does not fit, fclose returns 0, and the text can be NULL. Here a failure is remembered, whatever is
 * written after it. Open, write to stream, then close or abandon; both free the writer, which must not move in
 * between. */
typedef struct text_writer {
    FILE *stream;
    char *text;
    size_t size, capacity;
    bool failed; /* some text did not fit */
} text_writer;

status text_writer_open(text_writer *writer, diagnostic *why);

/* *text is the text and a final 0, which *size (may be NULL) does not count; NULL unless the status is STATUS_OK. */
status text_writer_close(text_writer *writer, char **text, size_t *size, diagnostic *why);
void text_writer_abandon(text_writer *writer);
/* Closes the writer if code is STATUS_OK, otherwise abandons it; returns code, or the error of closing. */
status text_writer_end(text_writer *writer, status code, char **text, size_t *size, diagnostic *why);

/* ---- encodings ---- */

/* Decodes one UTF-8 character (RFC 3629); returns its length in bytes, 0 if it is invalid. */
size_t text_utf8(const char *text, uint32_t *out);

/* The greatest length, in bytes, of at most `most`, at which the text can be cut between characters of UTF-8. */
int text_cut(const char *text, size_t most);

/* The text of a file of another program as UTF-8 and a final 0: from UTF-16, with a byte order mark or without one, or
 * from bytes, which are of ISO 8859-1 where they are not UTF-8. CR, 0 and halves of characters become blanks. NULL when
 * out of memory. */
char *text_narrow(const char *text, size_t size);

/* Writes a word of a command line, for a reader who copies it into a shell: in single quotes where a shell would change
 * it. Errors of the stream stay in the stream. */
void shell_word_write(FILE *out, const char *word);

/* Base64 (RFC 4648), of data in documents; for_address: base64url without padding. NULL when out of memory. */
char *base64_encode(const void *bytes, size_t size, bool for_address);

/* Decodes base64, or for_address base64url without padding. NULL for another character or an impossible length; also
 * when out of memory, with errno ENOMEM. */
unsigned char *base64_decode(const char *text, size_t length, bool for_address, size_t *size);
