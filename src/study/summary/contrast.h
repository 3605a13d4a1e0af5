/* A comparison of two sides of a study, cell by cell: the ratio of a quantity, its 95% interval, and a verdict. Rows of
 * one run are one process; processes, then repetitions within each, are resampled (measure/levels.h), because
 * repetitions of one process are more alike than those of several. Only sides that alternate have a verdict: in each
 * process both were measured, in rounds of random order, or the processes of the sides follow one another in pairs.
 * Otherwise a drift of the machine would look like a difference. Warm-ups, marked and excluded rows are left out; rows
 * of one side are of one environment. Ownership: contrast_destroy and side_release release what contrast_make and
 * side_read allocate. */
#pragma once

#include "measure/levels.h"
#include "study/rows/row_files.h"
#include "study/study.h"
#include <jansson.h>

/* Which rows of a study a side has. Written as items separated by commas: a results folder; PATH=VALUE for cells with
 * that value; cell=N; environment=KEY; run=ID. "results-old" is all rows of a folder, "render.threads=2" a value of an
 * axis, "other,environment=3d2be922" a part of another folder. */
typedef struct study_side {
    char *text;                              /* a copy, cut into items; results, environment and run point into it */
    const char *given;                       /* the text as given, borrowed */
    const char *results, *environment, *run; /* environment, run: NULL without one */
    long cell;                               /* below 0: not given */
    size_t point[STUDY_AXES_MAX];            /* of each axis, or STUDY_SIDE_ANY */
} study_side;

#define STUDY_SIDE_ANY ((size_t)-1)

/* results: the folder unless the text names one. STATUS_BAD_INPUT for an unknown parameter or value, or a cell that the
 * study does not have; the remedy lists those that exist, or says where to find them. */
status side_read(const study *s, const char *text, const char *results, study_side *out, diagnostic *why);
/* The side of all rows of a results folder, whatever its name is. Owns nothing. */
study_side side_of_folder(const char *results);
void side_release(study_side *side);

/* The cells of a and b that are compared with each other: those that agree in every axis that neither names. Pairs
 * (first of a, then of b) in the order of the grid. STATUS_BAD_INPUT if a side names a parameter and the other does
 * not. */
status side_cells(const study *s, const study_side *a, const study_side *b, size_t (**pairs)[2], size_t *count,
                  diagnostic *why);

typedef enum contrast_verdict { CONTRAST_CANNOT_TELL, CONTRAST_FASTER, CONTRAST_SLOWER } contrast_verdict;

/* Why there is no verdict. */
typedef enum contrast_reason {
    CONTRAST_INTERVAL, /* the interval includes 1 */
    CONTRAST_NO_ROWS,  /* a side has no rows */
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
     * 95% probability; 0: unknown or more than 10000. It is computed with the upper 90% limit of the observed standard
     * deviation. */
    size_t pairs_needed;
} contrast_line;

typedef struct contrast_options {
    const char *column; /* a column of rows.csv with positive values; NULL: wall_s */
    double detect;      /* relative difference to detect; 0: 0.03 */
} contrast_options;

typedef struct contrast {
    contrast_line *lines;
    size_t count;
    /* the geometric mean over the lines with rows on both sides; each counts once, by its processes */
    contrast_line all;
    char environment[2][ENVIRONMENT_KEY]; /* of both sides; "" without rows */
    size_t left_out[2];                   /* rows of other environments */
    size_t compared, same; /* lines with rows on both sides; of these, lines with equal films and numbers of rays */
    row_files *rows[2];    /* of the sides; contrast_half.film points into them */
} contrast;

/* verdict, which may be NULL, becomes the first fault of the rows, as in study/summary/summary.h. STATUS_FAILURE if a
 * side has no rows at all; STATUS_BAD_INPUT for a column without positive numbers, and for an unknown environment or
 * run. */
status contrast_make(const study *s, const study_side *a, const study_side *b, const contrast_options *options,
                     contrast **out, diagnostic *verdict, diagnostic *why);
void contrast_destroy(contrast *c);

/* "faster", "slower", "cannot tell". */
const char *contrast_verdict_text(contrast_verdict verdict);
/* "the interval includes 1", ...; "" for CONTRAST_CLEAR. */
const char *contrast_reason_text(contrast_reason reason);

/* A comparison as JSON, for `cuvette study compare --json` and for the laboratory; a new reference, NULL if memory runs
 * out: {"columns": paths of the grid, "count", "environments": [A, B], "films": {"compared", "same"}, "cells": [line
 * with the values of A's cell, ..], "all": line}; at most `most` cells. A line: {"a": {"cell", "n", "processes",
 * "median"}, "b", "ratio", "low", "high", "verdict", "reason", "alternate", "pairs_needed", "same_film": BOOL or null};
 * null for unknown numbers. */
json_t *contrast_json(const study *s, const contrast *c, size_t most);
