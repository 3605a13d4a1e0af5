/* A study's rows as a table: one line per cell and environment, tab separated, medians and intervals
 * (results/tables/<study>.tsv). Warm-ups, marked rows and those that a person excluded (study/excluded.h) are left out
 * of every value except their numbers; rows that cannot be trusted (study/row_files.h) from all. */
#pragma once

#include "study/study.h"

typedef struct summary_options {
    const char *environment; /* only the rows of that key; "main": of the environment with most rows; NULL: of all */
} summary_options;

/* Columns: cell, each path of the grid, n; for wall_s and cpu_s median, low and high (the 95% interval of the median,
 * from n = 6), mean, min, max; then medians of the columns in the header line; the same six of further columns and
 * quotients, all that figures, claims and paper read; with a reference, the cell's values of compare.csv; the number
 * of disturbed rows, number, median, low and high of the others' wall_s; environment. NA for unknown values. A cell
 * without rows has one line with n = 0; a study without any row is STATUS_FAILURE, and nothing is written. verdict,
 * which may be NULL, becomes the first of the rows' faults, or stays as it is. The caller checks out for write errors
 * (ferror). */
status study_summary_of(const study *s, const char *results, const summary_options *options, FILE *out,
                        diagnostic *verdict, diagnostic *why);
/* The same of all environments. */
status study_summary(const study *s, const char *results, FILE *out, diagnostic *why);
