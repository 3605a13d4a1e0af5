/* A study's rows as a table: one line per cell, tab separated, medians and intervals (results/tables/<study>.tsv).
 * Warm-ups and marked rows are excluded from every value except the number of marked rows. */
#pragma once

#include "study/study.h"

/* Columns: cell, each path of the grid, n; for wall_s and cpu_s median, low and high (the 95% interval of the median,
 * from n = 6), mean, min, max; then medians of the columns in the header line; with a reference, the cell's values of
 * compare.csv. NA for unknown values. Cells without rows have n = 0; a study without any row is STATUS_FAILURE, and
 * nothing is written. The caller checks out for write errors (ferror). */
status study_summary(const study *s, const char *results, FILE *out, diagnostic *why);
