/* Missing columns, and rows that do not count, across files. For study/row_files.c. */
#pragma once

#include "study/row_files.h"

/* Fails if a file lacks a column that identifies its rows. Other columns may be missing or added, in any order. */
status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why);

/* Drops equal rows of two files; rows of one file, or with different values, are an error. */
status row_check_drop_twins(row_files *files, diagnostic *why);

/* Drops worker rows whose repetition has no row in the corresponding file: the process was killed between the two
 * writes. */
void row_check_drop_orphans(row_files *workers, const row_files *rows);
