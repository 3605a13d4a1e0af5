/* The checks of rows: the last column of each file. Eight hex digits of a hash of the row's values by column name, then
 * eight of a hash of these and of the check of the previous row of the same run (for the first row, of the run's id).
 * The first part shows an edited row, the second a row that was removed, inserted or moved. Both ignore NA and the
 * order of the columns, so that a file may get more columns. It detects accidents and careless edits, not forgery. */
#pragma once

#include "base/csv.h"

enum { CHECK_TEXT = 17 };

/* Hashes of the names of a header's columns; check_columns_free releases. The column `check` itself is ignored. */
typedef struct check_columns {
    uint64_t *name; /* 0: the column check */
    size_t count;
} check_columns;

status check_columns_create(char *const *names, size_t count, check_columns *out, diagnostic *why);
void check_columns_free(check_columns *c);

/* A hash of the values of one row with c->count fields; its upper half is the first part. */
uint64_t check_values(const check_columns *c, char *const *fields);
uint32_t check_content(const check_columns *c, char *const *fields);
/* The second part; previous: the text before, the run's id at first. */
uint32_t check_chain(const char *previous, uint32_t content);
/* "1234567890abcdef"; and back, false if the text is no check. */
void check_text(uint32_t content, uint32_t chain, char text[CHECK_TEXT]);
bool check_parse(const char *text, uint32_t *content, uint32_t *chain);

/* Writes checks into complete lines whose last field is check and empty ("...,NA"): replaces it. previous is updated.
 */
status check_lines(const check_columns *c, char previous[CHECK_TEXT], csv_line *lines, diagnostic *why);
