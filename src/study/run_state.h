/* A study while it runs: what study/run.c works with, opened and closed by study/run_open.c. */
#ifndef CUVETTE_STUDY_RUN_STATE_H
#define CUVETTE_STUDY_RUN_STATE_H

#include "measure/usage.h"
#include "render/renderer.h"
#include "study/ledger.h"
#include "study/progress.h"
#include "study/table.h"

typedef struct run {
    const study *s;
    const study_options *options;
    char *folder;
    size_t *cells, cell_count;   /* this shard's */
    bool *warm;                  /* by number in the whole grid */
    size_t *order;               /* scratch: the round's order of cells[] */
    ledger *done;
    table *rows, *workers;       /* workers: NULL unless kept */
    size_t row_number, ran;
    isa level;
    topology *machine;
    hardware_counter *hardware;
    renderer *tracer;
    progress_line *line;
} run;

/* Folder, locks, the rows so far (read again under the lock), manifest, machine, renderer. What was opened when it
 * fails is released by run_release too. */
status run_prepare(run *r, diagnostic *why);
void run_release(run *r);

#endif
