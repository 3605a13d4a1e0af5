/* Comma-separated values after RFC 4180, with the one restriction that no field holds a line break, so that a line
 * is whole exactly when its newline is there. Ownership: csv_read gives, csv_destroy releases; a csv_line is
 * released with csv_line_free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdint.h>

/* A line under construction. Running out of memory is remembered in failed, and every later call does nothing. */
typedef struct csv_line {
    char *text;
    size_t size, capacity;
    bool started, failed;
} csv_line;

/* Each adds one field. Absent values are written NA: text NULL, a real that is NaN, an integer under 0 for
 * csv_count. */
void csv_text(csv_line *line, const char *text);
void csv_real(csv_line *line, double value);
void csv_count(csv_line *line, int64_t value);
void csv_hash(csv_line *line, uint64_t value); /* 16 hex digits */
/* Ends the line; fields that follow begin the next one in the same text. */
void csv_end(csv_line *line);
void csv_line_free(csv_line *line);

/* A file as it was read: its whole lines only. What lies behind the last newline is torn and not in it. */
typedef struct csv {
    char *raw;
    size_t size; /* the file's bytes; whole is where the last newline ends */
    size_t whole;
    char *split; /* the same with fields cut apart; owned */
    size_t column_count;
    char **header; /* column_count names */
    size_t row_count;
    char **fields; /* row_count * column_count, behind the header's */
    size_t *start; /* where row i begins in raw; start[row_count] = whole */
} csv;

/* STATUS_OK and *out = NULL when there is no such file. A row with another number of fields than the header is
 * STATUS_BAD_INPUT. */
status csv_read(const char *path, csv **out, diagnostic *why);
/* The same of a file that lies below root (base/below.h). */
status csv_read_below(const char *path, const char *root, csv **out, diagnostic *why);
void csv_destroy(csv *table);

/* Cuts the fields of one line without its newline apart, in place; returns how many, or 0 when quotes are wrong. fields
 * may be NULL. */
size_t csv_split(char *line, char **fields);

/* Index of the column of that name, or -1. */
int csv_column(const csv *table, const char *name);
/* "NA" for a column that the file does not have. */
const char *csv_field(const csv *table, size_t row, int column);
/* The field as a number; NaN for NA and what is no number. */
double csv_field_real(const csv *table, size_t row, int column);
