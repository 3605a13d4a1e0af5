/* Rows that do not count, found across files. For study/row_files.c. */
#ifndef CUVETTE_STUDY_ROW_CHECK_H
#define CUVETTE_STUDY_ROW_CHECK_H

#include "study/row_files.h"

/* Drops rows that stand in two files alike; two that differ, or stand in one file, are an error. */
status row_check_drop_twins(row_files *files, diagnostic *why);

/* Drops worker rows whose repetition has no row in the file beside theirs: a process was killed between the two
 * writes. */
void row_check_drop_orphans(row_files *workers, const row_files *rows);

#endif
