/* What a run will write: rows, the list of runs, kept files, references. */
#pragma once

#include "base/budget.h"
#include "study/run_state.h"

/* Of the cells of r; r->done and r->compared are read. */
status run_room(const run *r, disk_room *out, diagnostic *why);

/* STATUS_FAILURE where it cannot fit; a warning goes to the news of the options. */
status run_check_room(const run *r, diagnostic *why);
