/* Checksums of rows: the column `checksum`, the last one of a new file. Eight hex digits hash the row's values by
 * column name; eight more hash these digits and the checksum of the previous row of the same run (for the first row,
 * the run's id). The first part detects an edited row, the second a row that was removed, inserted or moved. Both
 * ignore NA and the order of the columns, so that a file may get more columns. They detect accidents and careless
 * edits, not forgery. */
#pragma once

#include "base/csv.h"

enum { CHECKSUM_TEXT = 17 };

/* Hashes of the names of a header's columns, without the column `checksum`; checksum_columns_free releases. */
typedef struct checksum_columns {
    uint64_t *name; /* 0: the column checksum */
    size_t count;
} checksum_columns;

status checksum_columns_create(char *const *names, size_t count, checksum_columns *out, diagnostic *why);
void checksum_columns_free(checksum_columns *c);

/* A hash of the values of a row, which has c->count fields; checksum_content is its upper half, the first part. */
uint64_t checksum_values(const checksum_columns *c, char *const *fields);
uint32_t checksum_content(const checksum_columns *c, char *const *fields);
/* The second part; previous: the text of the previous row's checksum, or the run's id for the first row. */
uint32_t checksum_chain(const char *previous, uint32_t content);
/* Write "1234567890abcdef", and read it; false if the text is not a checksum. */
void checksum_text(uint32_t content, uint32_t chain, char text[CHECKSUM_TEXT]);
bool checksum_parse(const char *text, uint32_t *content, uint32_t *chain);

/* Fills in the checksums of complete lines whose field checksum is NA, and updates previous. */
status checksum_lines(const checksum_columns *c, char previous[CHECKSUM_TEXT], csv_buffer *lines, diagnostic *why);
