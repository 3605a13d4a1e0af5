/* Notes on parameters that are set but have no effect (lint/lint.h), one line each on standard error.
 * A place that already has a note of the linter gets no second one. Ownership: everything is borrowed. */
#pragma once

#include "cli/scene_input.h"
#include "lint/lint.h"

/* Notes on the changes of the command line. s: the changed scene. */
void inert_note_changes(const scene *s, const scene_input *input);

/* Further notes on the command line that need the rendered frame. Where a note needs a second frame for comparison, the
 * job renders it, if the first one took less than a second. */
void inert_note_frame(const scene_input *input, job *with, const job_account *frame);

/* A note on one PATH=VALUE. */
void inert_note_assignment(const scene *s, const char *assignment);
