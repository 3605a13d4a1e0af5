/* The parts of a comparison, private to study/summary/contrast*.c: the rows of each side by cell and process, and the
 * line over all cells. Ownership: contrast_rows_release releases rows; contrast_sample_free releases samples, which
 * refer to processes of the rows. */
#pragma once

#include "study/summary/contrast.h"

/* A process of the program: a run. first, last: the times of its first and last row, as text that sorts by time. */
typedef struct contrast_process {
    const char *id, *first, *last;
} contrast_process;

typedef struct contrast_row {
    size_t cell, process; /* process: index in contrast_rows.processes */
    long repetition;
    double value;
    const row_ref *ref;
} contrast_row;

typedef struct contrast_rows {
    row_files *files;
    const char *results; /* borrowed from the side */
    char environment[ENVIRONMENT_KEY];
    size_t left_out;             /* rows of other environments */
    contrast_row *rows;          /* by cell, process, repetition */
    size_t *first_of;            /* index of each cell's first row; cells + 1 elements */
    contrast_process *processes; /* in the order of their starts */
    size_t process_count;
} contrast_rows;

/* Reads the side's rows with a positive value of the column, without warm-ups, marked and excluded rows. */
status contrast_rows_read(const study *s, const study_side *side, const char *column, contrast_rows *out,
                          diagnostic *why);
void contrast_rows_release(contrast_rows *r);

/* The logarithms of values by process. process[k]: the index of its k-th process. */
typedef struct contrast_sample {
    double *values;
    size_t *start, *process;
    level_sample levels;
} contrast_sample;

status contrast_sample_of_cell(const contrast_rows *r, size_t cell, contrast_sample *out, diagnostic *why);
void contrast_sample_free(contrast_sample *s);

/* Whether the processes of both samples are the same ones, or follow one another in pairs, one of each side, without
 * overlap. */
bool contrast_alternate(const contrast_rows *ra, const contrast_sample *a, const contrast_rows *rb,
                        const contrast_sample *b);

/* The line of a comparison over all its cells: each cell counts once, by the processes that measured it. A process need
 * not have all cells: a grid may have grown between two runs, and each shard has other cells. Processes with the same
 * cells are a stratum, and resamples draw within each, so that every resample has every cell (Davison and Hinkley,
 * Bootstrap Methods and their Application, 1997, 3.2). */
typedef struct contrast_all {
    level_interval ratio; /* logarithm of b over a, mean over the cells; no interval if a stratum has fewer than 3 */
    size_t values[2], processes[2]; /* numbers of values and of processes on each side, over all cells */
    size_t fewest;                  /* processes in the smallest stratum of a side */
    size_t fewest_values;           /* values of the cell that has fewest, on the side with fewer */
    bool alternate;                 /* in each stratum; then the sides have the same strata, and are drawn together */
    double deviation; /* standard deviation of the processes' or pairs' means over the cells; NaN with several strata */
} contrast_all;

/* pairs: count cells of a and of b, all with rows on both sides. */
status contrast_all_make(const contrast_rows *a, const contrast_rows *b, const size_t (*pairs)[2], size_t count,
                         contrast_all *out, diagnostic *why);
