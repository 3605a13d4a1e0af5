/* How often smaller studies, drawn from measured rows, would have concluded something else: a rate for each pair of
 * cells, order, design and rule. Cells with the same name do the same work, so every claim of a difference is wrong;
 * for other pairs a claim is wrong if its sign contradicts the truth. Ownership: value_table_release and
 * power_rates_free release what value_table_read and power_rates_make allocate; samples and names are borrowed from the
 * tables. */
#pragma once

#include "base/csv.h"
#include "measure/design.h"
#include "measure/levels.h"
#include "measure/statistics.h"

/* One measured column of a CSV file by cell and process: of rows.csv, or of any table with a column `cell`, a column
 * `run` or `process`, and the measured one. So the rows of other programs can be judged, too. Warm-ups, marked rows and
 * rows without a positive value are left out. Rows are not verified: see `cuvette study verify`. */
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

/* What b is known to be, compared with a. */
typedef enum power_truth { POWER_SAME, POWER_LARGER, POWER_SMALLER, POWER_OF_ALL_ROWS } power_truth;

typedef struct power_options {
    const char *a, *b; /* a cell of the first and of the other table; NULL: all pairs of cells with the same name */
    power_truth truth; /* of a and b; POWER_OF_ALL_ROWS: the sign of the ratio of all rows */
    const design *designs;
    size_t design_count, draws;
    double effect;
    uint64_t seed;
} power_options;

typedef struct power_rate {
    const char *a, *b; /* NULL: the sum over all pairs */
    design of;         /* the design of the smaller studies */
    design_tally tally;
    level_interval ratio; /* b over a, of all rows */
    int truth;            /* 1: b is larger; -1: smaller; 0: the same */
} power_rate;

typedef struct power_rates {
    power_rate *rates; /* by pair, order and design, for which there are enough rows */
    size_t count;
} power_rates;

/* other: the table of b, or the same as first. STATUS_BAD_INPUT for an unknown cell, if the tables have
 * no common one, or if no design can be drawn. */
status power_rates_make(const value_table *first, const value_table *other, const power_options *options,
                        power_rates *out, diagnostic *why);
void power_rates_free(power_rates *r);

/* The fraction of studies with a wrong claim; and with no claim. Its interval has as many trials as there are
 * independent studies. */
fraction_interval power_wrong_claims(const power_rate *r, design_rule rule);
fraction_interval power_no_claims(const power_rate *r, design_rule rule);
