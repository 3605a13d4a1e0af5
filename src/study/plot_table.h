/* A study's summary (study/summary.h) as a table in memory, for figures. Ownership: plot_table_of_study gives,
 * plot_table_free releases; texts are borrowed from the table. Errors are those of the summary. */
#pragma once

#include "study/study.h"

typedef struct plot_table {
    char *text;           /* the summary, split in place */
    const char **names;   /* of the columns */
    const char **fields;  /* rows * columns */
    size_t rows, columns; /* rows: without the header */
} plot_table;

status plot_table_of_study(const study *s, const char *results, plot_table *out, diagnostic *why);
/* Splits a text as study_summary writes it; takes the text, also after an error. */
status plot_table_split(char *text, plot_table *out, diagnostic *why);
void plot_table_free(plot_table *t);

/* The index of a column, or -1; the field of a row, "NA" for column -1; its number, NaN for everything else. */
long plot_table_column(const plot_table *t, const char *name);
const char *plot_table_text(const plot_table *t, size_t row, long column);
double plot_table_real(const plot_table *t, size_t row, long column);
