/* Values of rows by process: repetitions of one run are alike (measure/levels.h). */
#pragma once

#include "measure/levels.h"
#include "study/row_files.h"

/* The median of the values of these rows and its 95% interval; values[i] is of rows[i], NaN ones are left out. All NaN
 * without a value; no interval for fewer than 6. */
status level_rows_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                         level_interval *out, diagnostic *why);
