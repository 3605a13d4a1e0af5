/* A column of rows.csv, or the quotient of two formed row by row, over some of its rows: what study/summary.h and
 * study/spread.h print. Borrows its arguments. */
#pragma once

#include "measure/levels.h"
#include "study/row_files.h"

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

/* What values the quantity can have (measure/levels.h): a share, 0 or more, or more than 0. Of a column that this
 * version does not know the last, which a value of 0 or below corrects. */
level_range row_quantity_range(row_quantity column);

/* values: room for as many numbers; they are overwritten. */
status row_quantity_spread(const row_ref *const *rows, size_t count, row_quantity column, double *values,
                           row_spread *out, diagnostic *why);
