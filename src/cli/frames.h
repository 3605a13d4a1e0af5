/* Renders frames of one scene one after another and measures them (report/report.h). Ownership: frames_render fills
 * *out also when it was interrupted; frames_release releases what it holds. */
#ifndef CUVETTE_CLI_FRAMES_H
#define CUVETTE_CLI_FRAMES_H

#include "report/report.h"

/* Renders count frames, the pool prepared beforehand. What options wants beside the film disturbs the times: with
 * count > 1 it is taken from one further frame that is not measured. The film of every frame must have the same
 * hash; otherwise the times are those of different work, and it is a failure. STATUS_INTERRUPTED after a signal. */
status frames_render(const scene *s, isa level, size_t count, const render_options *options, frames *out,
                     diagnostic *why);
void frames_release(frames *f);

#endif
