/* Files without what rows need, and rows that do not count, found across files. For study/row_files.c. */
#pragma once

#include "study/row_files.h"

/* Has a file the columns without which its rows cannot be told apart? Others may be missing, and there may be more, in
 * any order. */
status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why);

/* Drops rows that stand in two files alike; two that differ, or stand in one file, are an error. */
status row_check_drop_twins(row_files *files, diagnostic *why);

/* Drops worker rows whose repetition has no row in the file beside theirs: a process was killed between the two
 * writes. */
void row_check_drop_orphans(row_files *workers, const row_files *rows);
