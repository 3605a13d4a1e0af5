/* A study's rows as tables. Warm-ups, marked rows and those that a person excluded (study/rows/row_files.h) are left
 * out of every value except their counts; rows that cannot be trusted (study/rows/row_files.h) are left out everywhere.
 * Rows of unlike environments are never in one line. verdict, which may be NULL, becomes the first of the rows' faults,
 * or stays as it is; the caller checks the stream `out` for write errors (ferror). A study without any row is
 * STATUS_FAILURE, and nothing is written. */
#pragma once

#include "study/study.h"

typedef struct summary_options {
    const char *environment; /* key of the environment whose rows are used; "main": the one with most rows; NULL: all */
} summary_options;

/* The summary: one line per cell and environment, tab separated, medians and intervals (results/tables/<study>.tsv).
 * Columns, by the lists in summary.c: cell, each path of the grid, n; for wall_s and cpu_s (time_spreads) median, low
 * and high (the 95% interval of the median, from n = 6), mean, min, max; medians of ray counts (ray_medians);
 * film_hash, marked, excluded; medians of workers, memory and meshes (machine_medians); medians of first_hits; the six
 * values of further columns and quotients (quotient_spreads); with a reference, the cell's values of compare.csv; the
 * number of disturbed rows, and n, median, low and high of the others' wall_s; quick, for a quick study; environment.
 * Figures, claims and paper read nothing else. NA for unknown values. A cell without rows has one line with n = 0. */
status study_summary_of(const study *s, const char *results, const summary_options *options, FILE *out,
                        diagnostic *verdict, diagnostic *why);
/* The summary of all environments. */
status study_summary(const study *s, const char *results, FILE *out, diagnostic *why);

/* A summary as a table in memory, for figures; texts are borrowed from it. summary_table_free releases it. */
typedef struct summary_table {
    char *text;           /* the summary, split in place */
    const char **names;   /* of the columns */
    const char **fields;  /* rows * columns */
    size_t rows, columns; /* rows: without the header */
} summary_table;

status summary_table_read(const study *s, const char *results, summary_table *out, diagnostic *why);
/* Splits a text as study_summary writes it, and owns it from then on, also after an error. */
status summary_table_split(char *text, summary_table *out, diagnostic *why);
void summary_table_free(summary_table *t);

/* The index of a column, or -1; the field of a row, "NA" for column -1; its number, NaN for everything else. */
long summary_table_column(const summary_table *t, const char *name);
const char *summary_table_text(const summary_table *t, size_t row, long column);
double summary_table_real(const summary_table *t, size_t row, long column);

/* Any column of rows.csv by cell, with the 95% interval of its median: for quantities without an interval in the
 * summary, and for quotients of two columns, formed row by row. columns: names separated by commas; A/B is the quotient
 * of two columns of one row. Writes a line for each column, cell and environment with rows: cell, each path of the
 * grid, environment, column, n, median, low and high (the interval; NA for n below 6), min, max; tab separated, NA for
 * unknown values. STATUS_BAD_INPUT if rows.csv has no such column or none is given. */
status study_spread(const study *s, const char *results, const char *columns, const summary_options *options, FILE *out,
                    diagnostic *verdict, diagnostic *why);

/* All rows as one table in CSV, for other programs: the columns of the files, then `environment`, the key of the row's
 * environment, and `left_out`: "" for a row that counts, else warm-up, marked or excluded. environment: a key; "main":
 * the environment with most rows; "all"; NULL: the rows must be of only one. s NULL: results is the folder of the rows
 * itself; the grid is then unknown, and rows of all cells are written. STATUS_BAD_INPUT if there are no such rows. */
status row_list_write(const study *s, const char *results, const char *environment, FILE *out, diagnostic *verdict,
                      diagnostic *why);
