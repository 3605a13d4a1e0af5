/* A running study, private to study/run. run_state.c opens, reads and closes it; run.c measures rounds of frames,
 * run_noise.c judges their noise, run_keep.c then makes the kept files and comparisons of each cell. */
#pragma once

#include "base/budget.h"
#include "job/job.h"
#include "study/rows/compare_rows.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/rows/runs.h"
#include "study/rows/table.h"
#include "study/run/progress.h"

/* A file of rows that this run appends to, and the chain of their checksums (study/rows/rows.h). */
typedef struct row_table {
    table *file; /* NULL: closed */
    checksum_columns columns;
    char last[CHECKSUM_TEXT]; /* the checksum of this run's last row; before the first row, the run's id */
    size_t count;             /* rows of this run */
} row_table;

typedef struct run {
    const study *s;
    const study_options *options;
    char *folder;
    size_t *cells, cell_count; /* the cells of this shard */
    bool *warm;                /* for each cell of the grid: this process has warmed it up */
    size_t *order;             /* scratch: the order of cells[] in a round */
    progress_index *done;      /* the measured rows */
    bool *compared;            /* for each cell of the grid: compare.csv has its row */
    row_table rows, workers;   /* workers: closed unless kept */
    row_table compares;        /* closed without a reference */
    reference last_reference;
    size_t row_number, ran;
    char id[RUN_ID]; /* of this run; "" before run_prepare */
    int process;
    run_environment environment;
    char units[ENVIRONMENT_FACT_MAX]; /* environment_read_units at the beginning */
    uint64_t build;                   /* progress_index_build */
    double next_news_s[NOISE_KINDS];  /* when news of this kind may be reported again, monotonic */
    bool reported_waiting;            /* the news that the machine did not become quiet */
    job *frame_job;
    progress_display *line;
} run;

/* Fills cells and cell_count with the cells of the shard; order is overwritten. */
void run_choose_cells(run *r);
/* Reads the existing rows into r->done. */
status run_read_rows(run *r, diagnostic *why);
/* Finds the cells that compare.csv has already. */
status run_find_compared(run *r, diagnostic *why);

/* Opens the folder and locks its row files, reads the existing rows again under the lock, and adds the run to the list.
 * After a failure run_release releases what was opened. */
status run_prepare(run *r, diagnostic *why);
/* Fills in the checksums of the lines, appends them to the table, and frees them. */
status run_append(row_table *to, csv_buffer *lines, diagnostic *why);
/* Records the end of the run: number and last checksum of its rows. */
status run_seal_rows(const run *r, diagnostic *why);
void run_release(run *r);

/* Loads the files of the scene. */
status run_load(run *r, scene *setting, diagnostic *why);
/* Renders a frame, and shows its progress; *out must be released in any case. options may be NULL. */
status run_render(run *r, const scene *setting, const render_options *options, job_account *out, diagnostic *why);

/* The disk space for what r still lacks, by r->done and r->compared: rows, the list of runs, kept files, references. */
status run_room(const run *r, disk_room *out, diagnostic *why);
/* STATUS_FAILURE if the disk has too little space; if it may have too little, news say so. */
status run_check_room(const run *r, diagnostic *why);

/* The verdict of the study's rule on a row; reports disturbances as news. Measured times play no role. */
noise_verdict run_noise_judge(run *r, const machine_noise *noise);
/* With options->wait_quiet_s: waits until nothing disturbs, at most that long. STATUS_INTERRUPTED when cancelled. */
status run_noise_wait(run *r, diagnostic *why);

/* Whether no row, kept file or comparison is missing. */
bool run_complete(const run *r);
/* Makes the kept files of each cell and compares it with its reference, separately from all measurements. */
status run_keep_all(run *r, diagnostic *why);
