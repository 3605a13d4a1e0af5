/* A study while it runs: rounds of frames in study/run.c, then what is kept and compared of each cell in
 * study/run_keep.c; opened and closed by study/run_open.c. */
#pragma once

#include "job/job.h"
#include "study/csv.h"
#include "study/progress_index.h"
#include "study/progress.h"
#include "study/reference.h"
#include "study/table.h"

typedef struct run {
    const study *s;
    const study_options *options;
    char *folder;
    size_t *cells, cell_count; /* this shard's */
    bool *warm;                /* by number in the whole grid */
    size_t *order;             /* scratch: the round's order of cells[] */
    progress_index *done;
    bool *compared;        /* by number in the whole grid: compare.csv has its row */
    table *rows, *workers; /* workers: NULL unless kept */
    table *compares;       /* NULL without a reference */
    reference held;        /* the last one used */
    size_t row_number, ran;
    job *with;
    progress_line *line;
} run;

/* Folder, locks, the rows so far (read again under the lock), manifest, job. What was opened when it
 * fails is released by run_release too. */
status run_prepare(run *r, diagnostic *why);
void run_release(run *r);

/* Which cells have been compared, from the files that are there. */
status run_find_compared(run *r, diagnostic *why);

/* Is there a row, a picture or a comparison to make? */
bool run_complete(const run *r);

/* Adds the lines to the table, and frees them. */
status run_append(table *to, csv_line *lines, diagnostic *why);

/* Loads what the scene names. */
status run_load(run *r, scene *setting, diagnostic *why);

/* One frame, with a line of progress; *out is to be released whatever is returned. options may be NULL. */
status run_render(run *r, const scene *setting, const render_options *options, job_account *out, diagnostic *why);

/* Makes what is kept of each cell and compares it with its reference, outside of all that is measured. */
status run_keep_all(run *r, diagnostic *why);
