/* Values of rows: a column of rows.csv, or the quotient of two formed row by row, over some of its rows; and what
 * disturbed a row. For study/summary/summary.h. Borrows its arguments. */
#pragma once

#include "measure/levels.h"
#include "study/rows/row_files.h"

typedef struct row_quantity {
    const char *name, *below; /* below: the divisor, or NULL */
} row_quantity;

/* NaN for what is unknown. */
typedef struct row_spread {
    size_t known; /* values that are numbers */
    level_interval median;
    double mean, minimum, maximum;
} row_spread;

/* The value of each row; NaN where it is unknown, where a file lacks the column, and for a divisor of 0. */
void row_quantity_values(const row_ref *const *rows, size_t count, row_quantity column, double *values);

/* The same without the unknown ones; returns their number. */
size_t row_quantity_known(const row_ref *const *rows, size_t count, row_quantity column, double *values);

/* What values the quantity can have (measure/levels.h): a fraction, 0 or more, or more than 0. Of a column that this
 * version does not know the last, which a value of 0 or below corrects. */
level_range row_quantity_range(row_quantity column);

/* The median of the values of these rows and its 95% interval, by process, because repetitions of one run are alike
 * (measure/levels.h); values[i] is of rows[i], NaN ones are left out. All NaN without a value; no interval for fewer
 * than 6. */
status row_quantity_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                           level_interval *out, diagnostic *why);

/* values: room for as many numbers; they are overwritten. */
status row_quantity_spread(const row_ref *const *rows, size_t count, row_quantity column, double *values,
                           row_spread *out, diagnostic *why);

/* The noise that a row recorded, judged by the study's present rule. Rows of other versions may lack some of its
 * values. at: the columns of one table; looked up again when the table changes. Start with zeros. */
typedef struct row_noise_columns {
    const csv *table;
    int others, steal, drop, stalled;
} row_noise_columns;
noise_verdict row_noise_judge(const noise_rule *rule, row_noise_columns *at, const row_ref *ref);
