/* Notes on parameters that a person sets and that cannot act (scene/model/inert/inert.h), one line each on standard
 * error. What the linter notes of the same place is not said twice. Everything is borrowed. */
#pragma once

#include "cli/scene_input.h"
#include "scene/model/inert/inert.h"
#include "study/study.h"

/* Of the command line. s: as it changed it. */
void inert_note_changes(const scene *s, const scene_input *input);

/* Of the command line, too, what shows only in a frame: rendered by this job. Renders another one
 * where a note depends on it, if that takes no more than a moment. */
void inert_note_frame(const scene_input *input, job *with, const job_account *frame);

/* Of one PATH=VALUE. */
void inert_note_assignment(const scene *s, const char *assignment);

/* Of a study's axes and fixed parameters: what is inert in every cell. */
status inert_note_study(const study *s, diagnostic *why);
