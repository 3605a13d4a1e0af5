/* Values of a column of rows.csv, or of the quotient of two columns, row by row; their medians; and the noise of rows.
 * For study/summary/summary.h. Borrows its arguments. */
#pragma once

#include "measure/levels.h"
#include "study/rows/row_files.h"

/* A column, or a quotient of two columns; not a `quantity` of job/quantities.h, which describes a measured value. */
typedef struct row_quantity {
    const char *name, *divisor; /* columns; divisor: NULL if it is not a quotient */
} row_quantity;

/* Unknown values are NaN. */
typedef struct row_spread {
    size_t known; /* values that are numbers */
    level_interval median;
    double mean, minimum, maximum;
} row_spread;

/* The value of each row; NaN if it is unknown, if a file lacks the column, for a divisor of 0, and for a negative
 * time. */
void row_quantity_values(const row_ref *const *rows, size_t count, row_quantity quantity, double *values);

/* Writes only the known values, without gaps, and returns their number. */
size_t row_quantity_known(const row_ref *const *rows, size_t count, row_quantity quantity, double *values);

/* The values that the quantity can have (measure/levels.h): a fraction, 0 or more, or more than 0. A column that this
 * version does not know counts as more than 0; level_median uses a wider range if a value is outside it. */
level_range row_quantity_range(row_quantity quantity);

/* The median of the values of these rows and its 95% interval, by process, because repetitions of one run are alike
 * (measure/levels.h); values[i] is of rows[i]; NaN is left out. Without values, the median is NaN; with fewer than 6,
 * there is no interval. */
status row_quantity_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                           level_interval *out, diagnostic *why);

/* Fills *out; values: scratch memory for count numbers. */
status row_quantity_spread(const row_ref *const *rows, size_t count, row_quantity quantity, double *values,
                           row_spread *out, diagnostic *why);

/* The noise that a row recorded, judged by the study's present rule. Rows of other versions may lack some of its
 * values. at: the columns of one table, looked up again when the table changes; zero-initialise it. */
typedef struct row_noise_columns {
    const csv *table;
    int others, steal, drop, stalled;
} row_noise_columns;
noise_verdict row_noise_judge(const noise_rule *rule, row_noise_columns *at, const row_ref *ref);
