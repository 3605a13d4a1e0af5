/* A study's rows as one table in CSV, for other programs: those that summaries take, or all, with the reason why a row
 * is left out. */
#pragma once

#include "study/row_files.h"
#include <stdio.h>

/* Whether a row counts in summaries, and why not: a warm-up; its film is not the expected one; a person excluded it. */
typedef enum row_use { ROW_COUNTS, ROW_IS_WARMUP, ROW_IS_MARKED, ROW_IS_EXCLUDED } row_use;
struct excluded;
row_use row_use_of(const struct excluded *without, const row_ref *row);

/* The columns of the files, then `environment`, the key of the row's, and `left_out`: "" for a row that counts, else
 * warm-up, marked or excluded. environment: a key; "main", that with most rows; "all"; NULL: there must be only one.
 * s NULL: results is the folder of the rows itself, and no row is left out because the grid has no such cell.
 * STATUS_BAD_INPUT without such rows; verdict as in study/summary.h. */
status row_list_write(const study *s, const char *results, const char *environment, FILE *out, diagnostic *verdict,
                      diagnostic *why);
