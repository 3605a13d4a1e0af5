/* A study's rows as a table: one line a cell, tab separated, medians and intervals (results/tables/<study>.tsv).
 * Warm-ups and marked rows are left out of every value but the number of marked rows. */
#pragma once

#include "study/study.h"

/* Columns: cell, each path of the grid, n; for wall_s and cpu_s median, low and high (the 95% interval of the
 * median, from n = 6 on), mean, min, max; then medians of the columns that the header line names; of a
 * study with a reference, the cell's values of compare.csv. NA for what is not
 * known. Cells without rows are there with n = 0; a study without any is STATUS_FAILURE, and nothing is written.
 * Errors of writing to out are the caller's to find (ferror). */
status study_summary(const study *s, const char *results, FILE *out, diagnostic *why);
