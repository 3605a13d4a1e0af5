/* One measured column of a CSV file by cell and process: of rows.csv, or of any table with a column `cell`, a column
 * `run` or `process`, and the measured one. So the rows of other programs can be judged too. Warm-ups, marked rows and
 * those without a positive value are left out. The checks of rows are not made: see `cuvette study verify`. Ownership:
 * value_table_read gives, value_table_release releases; samples point into the table. */
#pragma once

#include "base/csv.h"
#include "measure/levels.h"

typedef struct value_cell {
    const char *name;
    double *values; /* logarithms */
    size_t *start;
    size_t *process; /* process[k]: number of its k-th process, in the order of the file */
    level_sample sample;
} value_cell;

typedef struct value_table {
    csv *file;
    value_cell *cells; /* in the order of the file; by number if all names are numbers */
    size_t count;
} value_table;

/* STATUS_BAD_INPUT if there is no such file, column or value. */
status value_table_read(const char *path, const char *column, value_table *out, diagnostic *why);
void value_table_release(value_table *t);
/* The cell of that name, or NULL. */
const value_cell *value_table_find(const value_table *t, const char *name);
/* Whether the k-th process of both cells of one table is the same process. */
bool value_cells_share(const value_cell *a, const value_cell *b);
