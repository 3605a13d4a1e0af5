/* Missing columns, and checks of rows against each other, across files. For study/rows/row_read.c. */
#pragma once

#include "study/rows/row_files.h"

/* Fails if a file lacks a required column (`needed` in row_check.c). Other columns may be missing or added, in any
 * order. */
status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why);

/* Drops the later of two rows of one repetition (and worker). Unless it is the same row in another file, that is an
 * issue. */
status row_check_drop_twins(row_files *files, diagnostic *why);

/* Drops worker rows whose repetition has no row: the process was killed between the two writes. */
status row_check_drop_orphans(row_files *workers, const row_files *rows, diagnostic *why);

/* Quantities that depend only on the scene (QUANTITY_SAME) must be equal in all unmarked rows of a cell in one
 * environment: drops the rows that differ from most others, as issues. Marked rows become issues and stay. */
status row_check_quantities(row_files *files, diagnostic *why);
