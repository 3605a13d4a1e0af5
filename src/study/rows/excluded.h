/* Which rows summaries use: no warm-ups, no marked rows, and none that a person excluded, with the reason:
 * results/<study>/excluded.csv, one line per row, only ever appended to. The rows themselves stay as they are, and
 * count as measured, so that a value that displeases cannot be measured again. Ownership: excluded_read gives,
 * excluded_destroy releases. */
#pragma once

#include "study/rows/row_files.h"

typedef struct excluded excluded;

/* A study without the file has an empty list. STATUS_BAD_INPUT, located in the file, if it is damaged. */
status excluded_read(const study *s, const char *results, excluded **out, diagnostic *why);
void excluded_destroy(excluded *list);

/* Whether the row is excluded. A line names its row by its checksum, or by cell (its identity where rows have one),
 * run, process and repetition; a list that a person wrote may have only cell and repetition. */
bool excluded_has(const excluded *list, const row_ref *row);

/* Whether a row counts in summaries, and why not: a warm-up; its film is not the expected one; a person excluded it. */
typedef enum row_use { ROW_COUNTS, ROW_IS_WARMUP, ROW_IS_MARKED, ROW_IS_EXCLUDED } row_use;
row_use row_use_of(const excluded *without, const row_ref *row);

/* The number of lines of the list. */
size_t excluded_count(const excluded *list);

/* Appends the row, "CELL:REPETITION" or its checksum, and flushes the file to disk. STATUS_BAD_INPUT if there
 * is no such row, more than one, or a warm-up, if it is excluded already, and for a reason that is not one line. */
status excluded_add(const study *s, const char *results, const char *row, const char *reason, diagnostic *why);
