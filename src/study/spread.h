/* Any column of rows.csv by cell, with the 95% interval of its median: for quantities of which study/summary.h has only
 * the median or nothing, and for quotients of two columns, formed row by row. Warm-ups, marked and excluded rows are
 * left out, and rows of unlike environments are never in one line. Borrows its arguments; errors as study_summary. */
#pragma once

#include "study/study.h"
#include "study/summary.h"

/* columns: names separated by commas; A/B is the quotient of two columns of one row. Writes lines for each cell with
 * rows: cell, each path of the grid, environment, column, n, median, low and high (the interval; NA for n below 6),
 * min, max; tab separated, NA for unknown values. STATUS_BAD_INPUT if rows.csv has no such column or none is given;
 * STATUS_FAILURE without any row. options and verdict as
 * of study_summary_of. The caller checks out for write errors (ferror). */
status study_spread(const study *s, const char *results, const char *columns, const summary_options *options, FILE *out,
                    diagnostic *verdict, diagnostic *why);
