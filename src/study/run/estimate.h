/* What a run of a study would measure, and how long it would take, without measuring or writing anything. The time of a
 * cell comes from its rows, or else is extrapolated from trial frames of the cell with fewer pixels, which take at most
 * a few seconds in all. Ownership: values; everything else is borrowed. */
#pragma once

#include "base/budget.h"
#include "study/study.h"

typedef struct study_estimate {
    size_t cells, cells_lacking;  /* of the shard; lacking: with missing repetitions */
    size_t rows_least, rows_most; /* bounds on missing repetitions; equal without relative_width and undisturbed */
    size_t warmups;
    size_t cells_to_keep; /* cells with one more frame, for kept files or the comparison with their reference */
    size_t files, comparisons;
    /* Cells whose time is known from their rows, from trial frames, and from the mean of the trials of other cells
     * because there was no time to try them all; 0, 0, 0 if nothing is missing. */
    size_t from_rows, from_trials, from_others;
    bool cut;               /* a trial took too long: cells without a trial are probably slower than the others */
    disk_room needed;       /* what will be written, without files that exist */
    double free_bytes;      /* on the file system of the results; NaN: unknown */
    double least_s, most_s; /* time of loading and of all frames without those of references; NaN: unknown */
} study_estimate;

/* The time after which no trial frame begins and a running one is cancelled. */
#define STUDY_ESTIMATE_TRIALS_S 5.0

/* options: as for study_run; progress and progressed are not used. STATUS_INTERRUPTED when cancelled; otherwise the
 * errors of reading the rows and of loading the files of a cell. */
status study_estimate_run(const study *s, const study_options *options, study_estimate *out, diagnostic *why);

/* Estimates each of the options->shards parts of a study, from the same trial frames; shard is not used. tries: render
 * trial frames; without them, only the times of cells with rows are known. */
status study_estimate_parts(const study *s, const study_options *options, bool tries, study_estimate *parts,
                            diagnostic *why);

/* The lines of `cuvette study run --dry-run`. results: the results folder. */
void study_estimate_write(FILE *out, const study *s, const char *results, const study_estimate *e);
