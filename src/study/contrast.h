/* A comparison of two sides of a study (study/side.h), cell by cell: the ratio of a quantity, its 95% interval, and a
 * verdict. Rows of one run are one process; processes, then repetitions within each, are resampled (measure/levels.h),
 * because repetitions of one process are more alike than those of several. Only sides that alternate have a verdict: in
 * each process both were measured, in rounds of random order, or the processes of the sides follow one another in
 * pairs. Otherwise a drift of the machine would look like a difference. Warm-ups, marked and excluded rows are left
 * out; rows of one side are of one environment. Ownership: contrast_make gives, contrast_destroy releases. */
#pragma once

#include "measure/levels.h"
#include "study/row_files.h"
#include "study/side.h"

typedef enum contrast_verdict { CONTRAST_CANNOT_TELL, CONTRAST_FASTER, CONTRAST_SLOWER } contrast_verdict;

/* Why there is no verdict. */
typedef enum contrast_reason {
    CONTRAST_INTERVAL, /* the interval includes 1 */
    CONTRAST_NO_ROWS,  /* a side has none */
    CONTRAST_FEW,      /* fewer than 6 repetitions, or 3 processes, on a side */
    CONTRAST_NO_TURNS, /* the sides did not alternate */
    CONTRAST_CLEAR     /* there is a verdict */
} contrast_reason;

typedef struct contrast_half {
    size_t cell, count, processes;
    double median;           /* of all repetitions; NaN without one */
    const char *film, *rays; /* the expected film hash and the number of rays of the first row, or NULL */
} contrast_half;

typedef struct contrast_line {
    contrast_half a, b;
    level_interval ratio; /* b over a: of the typical value of a process; NaN if unknown */
    bool alternate;
    contrast_verdict verdict;
    contrast_reason reason;
    /* Pairs of processes, each with as many repetitions as now, that find a difference of contrast_options.detect with
     * 95% probability; 0: unknown or more than 10000. Its standard deviation is the upper limit, at 90%, of the one
     * that was observed. */
    size_t pairs_needed;
} contrast_line;

typedef struct contrast_options {
    const char *column; /* a column of rows.csv with positive values; NULL: wall_s */
    double detect;      /* relative difference, such as 0.03; 0: 0.03 */
} contrast_options;

typedef struct contrast {
    contrast_line *lines;
    size_t count;
    contrast_line
        all; /* the geometric mean over the lines with rows on both sides; each counts once, by its processes */
    char environment[2][ENVIRONMENT_KEY]; /* of both sides; "" without rows */
    size_t left_out[2];                   /* rows of other environments */
    size_t compared, same;                /* lines with rows on both sides; those of one film and number of rays */
    row_files *rows[2];                   /* of the sides; contrast_half.film points into them */
} contrast;

/* verdict, which may be NULL, becomes the first fault of the rows, as in study/summary.h. STATUS_FAILURE if a side has
 * no rows at all. */
status contrast_make(const study *s, const study_side *a, const study_side *b, const contrast_options *options,
                     contrast **out, diagnostic *verdict, diagnostic *why);
void contrast_destroy(contrast *c);

/* "faster", "slower", "cannot tell". */
const char *contrast_verdict_text(contrast_verdict verdict);
/* "the interval includes 1", ...; "" for CONTRAST_CLEAR. */
const char *contrast_reason_text(contrast_reason reason);
