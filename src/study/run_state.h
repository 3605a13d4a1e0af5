/* A running study: rounds of frames in study/run.c, then kept files and comparisons of each cell in study/run_keep.c;
 * opened and closed by study/run_open.c. */
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
    size_t *cells, cell_count; /* the cells of this shard */
    bool *warm;                /* indexed by cell number in the whole grid */
    size_t *order;             /* scratch: the order of cells[] in a round */
    progress_index *done;
    bool *compared;        /* indexed by cell number in the whole grid: compare.csv has its row */
    table *rows, *workers; /* workers: NULL unless kept */
    table *compares;       /* NULL without a reference */
    reference held;        /* the last reference used */
    size_t row_number, ran;
    job *with;
    progress_line *line;
} run;

/* Opens folder, locks, existing rows (read again under the lock), manifest, job. After a failure run_release releases
 * what was opened. */
status run_prepare(run *r, diagnostic *why);
void run_release(run *r);

/* Fills cells and cell_count with the cells of the shard; order is overwritten. */
void run_choose_cells(run *r);

/* Reads which cells have been compared from the existing files. */
status run_find_compared(run *r, diagnostic *why);

/* Whether a row, a kept file or a comparison is missing. */
bool run_complete(const run *r);

/* Appends the lines to the table, and frees them. */
status run_append(table *to, csv_line *lines, diagnostic *why);

/* Loads the files of the scene. */
status run_load(run *r, scene *setting, diagnostic *why);

/* One frame, with a progress line; *out must be released in any case. options may be NULL. */
status run_render(run *r, const scene *setting, const render_options *options, job_account *out, diagnostic *why);

/* Makes the kept files of each cell and compares it with its reference, separately from all measurements. */
status run_keep_all(run *r, diagnostic *why);
