/* A running study, private to study/run. It is opened, asked and closed by run_state.c; run.c measures rounds of
 * frames, run_noise.c judges what disturbs them, run_keep.c then makes the kept files and comparisons of each cell. */
#pragma once

#include "base/budget.h"
#include "job/job.h"
#include "study/rows/checksum.h"
#include "study/run/progress.h"
#include "study/rows/compare_rows.h"
#include "study/rows/row_files.h"
#include "study/rows/runs.h"
#include "study/rows/table.h"

/* A file of rows that this run appends to, and the chain of their checksums (study/rows/checksum.h). */
typedef struct row_table {
    table *file; /* NULL: closed */
    checksum_columns columns;
    char last[CHECKSUM_TEXT]; /* the checksum of the last row of this run, its id at first */
    size_t count;             /* rows of this run */
} row_table;

typedef struct run {
    const study *s;
    const study_options *options;
    char *folder;
    size_t *cells, cell_count; /* the cells of this shard */
    bool *warm;                /* indexed by cell number in the whole grid */
    size_t *order;             /* scratch: the order of cells[] in a round */
    progress_index *done;
    bool *compared;          /* indexed by cell number in the whole grid: compare.csv has its row */
    row_table rows, workers; /* workers: closed unless kept */
    row_table compares;      /* closed without a reference */
    reference held;          /* the last reference used */
    size_t row_number, ran;
    char id[RUN_ID]; /* of this run; "" before run_prepare */
    int process;
    run_environment here;
    char units[ENVIRONMENT_FACT_MAX]; /* environment_read_units at the beginning */
    uint64_t build;                   /* progress_index_build */
    double next_news_s[NOISE_KINDS];  /* when news of this kind may be reported again, monotonic */
    bool said_waiting;                /* that the machine did not become quiet */
    job *with;
    progress_line *line;
} run;

/* Fills cells and cell_count with the cells of the shard; order is overwritten. */
void run_choose_cells(run *r);
/* Reads the existing rows into r->done. */
status run_read_rows(run *r, diagnostic *why);
/* Reads which cells have been compared from the existing files. */
status run_find_compared(run *r, diagnostic *why);

/* Opens folder, locks, existing rows (read again under the lock), list of runs, job. After a failure run_release
 * releases what was opened. */
status run_prepare(run *r, diagnostic *why);
/* Fills in the checksums of the lines, appends them to the table, and frees them. */
status run_append(row_table *to, csv_line *lines, diagnostic *why);
/* Records the end of the run: number and last checksum of its rows. */
status run_seal_rows(const run *r, diagnostic *why);
void run_release(run *r);

/* Loads the files of the scene. */
status run_load(run *r, scene *setting, diagnostic *why);
/* One frame, with a progress line; *out must be released in any case. options may be NULL. */
status run_render(run *r, const scene *setting, const render_options *options, job_account *out, diagnostic *why);

/* What the cells of r will write, by r->done and r->compared: rows, the list of runs, kept files, references. */
status run_room(const run *r, disk_room *out, diagnostic *why);
/* STATUS_FAILURE where it cannot fit; a warning goes to the news of the options. */
status run_check_room(const run *r, diagnostic *why);

/* The verdict of the study's rule on a row; reports what disturbs. The measured times are never looked at. */
noise_verdict run_noise_judge(run *r, const machine_noise *noise);
/* With options->wait_quiet_s: waits until nothing disturbs, at most that long. STATUS_INTERRUPTED after a stop
 * request. */
status run_noise_wait(run *r, diagnostic *why);

/* Whether no row, kept file or comparison is missing. */
bool run_complete(const run *r);
/* Makes the kept files of each cell and compares it with its reference, separately from all measurements. */
status run_keep_all(run *r, diagnostic *why);
