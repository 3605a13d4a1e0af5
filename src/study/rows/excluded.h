/* Which rows summaries use: no warm-ups, no marked rows, and none that a person excluded. results/<study>/excluded.csv
 * has a line with the reason for each excluded row, and is only ever appended to. Excluded rows stay in rows.csv and
 * count as measured, so that an unwelcome value cannot be measured again. Ownership: excluded_destroy releases what
 * excluded_read allocates. */
#pragma once

#include "study/rows/row_files.h"

typedef struct excluded excluded;

/* A study without the file has an empty list. STATUS_BAD_INPUT, located in the file, if it is damaged. */
status excluded_read(const study *s, const char *results, excluded **out, diagnostic *why);
void excluded_destroy(excluded *list);

/* Whether the row is excluded. A line names its row by its checksum, or by its cell's identity, run, process
 * and repetition. A list that a person wrote may have only cell and repetition: then a line is for every row that has
 * these numbers in rows.csv, whatever the grid is now. */
bool excluded_has(const excluded *list, const row_ref *row);

/* Whether a row counts in summaries, and why not: a warm-up; its film is not the expected one; a person excluded it. */
typedef enum row_use { ROW_COUNTS, ROW_IS_WARMUP, ROW_IS_MARKED, ROW_IS_EXCLUDED } row_use;
row_use row_use_of(const excluded *without, const row_ref *row);

/* The number of lines of the list. */
size_t excluded_count(const excluded *list);

/* Appends the row, "CELL:REPETITION" or its checksum, and flushes the file to disk. CELL is the row's column in
 * rows.csv. STATUS_BAD_INPUT if no row or more than one matches, if CELL is another row's number in the present grid,
 * if the row is a warm-up or is excluded already, or if the reason is not one line of at most 500 characters. */
status excluded_add(const study *s, const char *results, const char *row, const char *reason, diagnostic *why);
