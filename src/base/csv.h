/* Comma-separated values (RFC 4180), restricted to fields without line breaks. In a file of this program a line is
 * complete if and only if its newline is present; other programs and people leave out the last newline, end lines with
 * CR LF, and begin with a byte order mark, which csv_read_any accepts. Ownership: csv_read allocates, csv_destroy
 * releases; a csv_buffer is released with csv_buffer_free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdint.h>

/* The text of one or more lines under construction. Running out of memory sets failed, and later calls do nothing. */
typedef struct csv_buffer {
    char *text;
    size_t size, capacity;
    bool started, failed;
} csv_buffer;

/* Each function appends one field. Missing values are written as NA: a NULL text, a NaN, a negative integer in
 * csv_count. */
void csv_text(csv_buffer *line, const char *text);
void csv_real(csv_buffer *line, double value);
void csv_count(csv_buffer *line, int64_t value);
void csv_hash(csv_buffer *line, uint64_t value); /* 16 hex digits */
/* Ends the line; later fields start the next line in the same text. */
void csv_end(csv_buffer *line);
void csv_buffer_free(csv_buffer *line);

/* The offset after the last complete line of a text. A line is complete if its newline is there and no byte is 0: after
 * a power cut, a part of the last line may never have been written, and reads as zeros. */
size_t csv_complete_size(const char *text, size_t size);

/* The complete lines of a file. */
typedef struct csv {
    char *raw;
    size_t size;          /* bytes of the file */
    size_t complete_size; /* csv_complete_size of raw */
    char *split;          /* the same bytes split into fields; owned */
    size_t column_count;
    char **header; /* column_count names */
    size_t row_count;
    char **fields; /* row_count * column_count fields, after the header */
    size_t *start; /* offset of row i in raw; start[row_count] = complete_size */
    bool mended;   /* csv_read_any: raw differs from the file, because it was converted to the form of this program */
    bool torn;     /* the last line is left out: no newline (csv_read_any: and too few fields), or a zero byte */
    bool *broken;  /* csv_read_rows: row i has another number of fields or invalid quotes; its fields are NA */
} csv;

/* STATUS_OK and *out = NULL if the file does not exist. STATUS_BAD_INPUT if a row does not have as many fields as the
 * header. */
status csv_read(const char *path, csv **out, diagnostic *why);
/* The same for a file below root (base/file.h) that people and other programs write. */
status csv_read_any(const char *path, const char *root, csv **out, diagnostic *why);
/* As csv_read, for a file below root, but rows with another number of fields are no error. A byte order mark or CR LF
 * is an error: another program has rewritten the file. */
status csv_read_rows(const char *path, const char *root, csv **out, diagnostic *why);
void csv_destroy(csv *table);

/* Splits one line without its newline into fields, in place; returns their number, or 0 for invalid quotes. fields may
 * be NULL. */
size_t csv_split(char *line, char **fields);

/* Index of the column of that name, or -1. */
int csv_column(const csv *table, const char *name);
/* "NA" for a missing column. */
const char *csv_field(const csv *table, size_t row, int column);
/* The field as a number; NaN for NA and for anything that is not a number. */
double csv_field_real(const csv *table, size_t row, int column);
