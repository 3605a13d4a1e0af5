/* A running study: rounds of frames in study/run.c, then kept files and comparisons of each cell in study/run_keep.c;
 * opened and closed by study/run_open.c. */
#pragma once

#include "job/job.h"
#include "study/check.h"
#include "study/progress_index.h"
#include "study/progress.h"
#include "study/reference.h"
#include "study/row_files.h"
#include "study/runs.h"
#include "study/table.h"

/* A file of rows that this run appends to, and the chain of their checks (study/check.h). */
typedef struct row_table {
    table *file; /* NULL: closed */
    check_columns columns;
    char last[CHECK_TEXT]; /* the check of the last row of this run, its id at first */
    size_t count;          /* rows of this run */
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

/* Opens folder, locks, existing rows (read again under the lock), list of runs, job. After a failure run_release
 * releases what was opened. */
status run_prepare(run *r, diagnostic *why);
void run_release(run *r);

/* Reads the existing rows into r->done. */
status run_read_rows(run *r, diagnostic *why);
/* Fills cells and cell_count with the cells of the shard; order is overwritten. */
void run_choose_cells(run *r);

/* Reads which cells have been compared from the existing files. */
status run_find_compared(run *r, diagnostic *why);

/* Whether a row, a kept file or a comparison is missing. */
bool run_complete(const run *r);

/* Completes the checks of the lines, appends them to the table, and frees them. */
status run_append(row_table *to, csv_line *lines, diagnostic *why);
/* Records the end of the run: number and last check of its rows. */
status run_seal_rows(const run *r, diagnostic *why);

/* Loads the files of the scene. */
status run_load(run *r, scene *setting, diagnostic *why);

/* One frame, with a progress line; *out must be released in any case. options may be NULL. */
status run_render(run *r, const scene *setting, const render_options *options, job_account *out, diagnostic *why);

/* Makes the kept files of each cell and compares it with its reference, separately from all measurements. */
status run_keep_all(run *r, diagnostic *why);
