/* A study while it runs: rounds of frames in study/run.c, then what is kept and compared of each cell in
 * study/run_keep.c; opened and closed by study/run_open.c. */
#ifndef CUVETTE_STUDY_RUN_STATE_H
#define CUVETTE_STUDY_RUN_STATE_H

#include "measure/usage.h"
#include "render/core/renderer.h"
#include "study/ledger.h"
#include "study/progress.h"
#include "study/reference.h"
#include "study/shelf.h"
#include "study/table.h"

typedef struct run {
    const study *s;
    const study_options *options;
    char *folder;
    size_t *cells, cell_count; /* this shard's */
    bool *warm;                /* by number in the whole grid */
    size_t *order;             /* scratch: the round's order of cells[] */
    ledger *done;
    bool *compared;        /* by number in the whole grid: compare.csv has its row */
    table *rows, *workers; /* workers: NULL unless kept */
    table *compares;       /* NULL without a reference */
    reference held;        /* the last one used */
    size_t row_number, ran;
    isa level;
    topology *machine;
    hardware_counter *hardware;
    renderer *tracer;
    progress_line *line;
    shelf meshes;
} run;

/* Folder, locks, the rows so far (read again under the lock), manifest, machine, renderer. What was opened when it
 * fails is released by run_release too. */
status run_prepare(run *r, diagnostic *why);
void run_release(run *r);

/* Which cells have been compared, from the files that are there. */
status run_find_compared(run *r, diagnostic *why);

/* Is there a row, a picture or a comparison to make? */
bool run_complete(const run *r);

/* Asks the caller; what the frame calls meanwhile, with the run as context; and the error that follows. */
bool run_should_stop(const run *r);
bool run_frame_progress(void *of, double share_done);
status run_interrupted(diagnostic *why);

/* Loads what the scene names and makes the renderer ready for it. */
status run_prepare_scene(run *r, scene *setting, diagnostic *why);

/* Makes what is kept of each cell and compares it with its reference, outside of all that is measured. */
status run_keep_all(run *r, diagnostic *why);

#endif
