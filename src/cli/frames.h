/* Frames of one scene, rendered one after another and measured. Ownership: frames_render fills *out also when it was
 * interrupted; frames_release releases what it holds. */
#ifndef CUVETTE_CLI_FRAMES_H
#define CUVETTE_CLI_FRAMES_H

#include "measure/usage.h"
#include "render/renderer.h"
#include <stdbool.h>

typedef struct frames {
    render_result *result;    /* of the last whole frame; a partial one if none was finished */
    bool whole;               /* all that were asked for are finished */
    size_t count;             /* finished frames */
    double *wall_s, *cpu_s;   /* of each finished frame, in order */
    usage spent;              /* over all the frames */
    hardware_counts hardware; /* over all the frames, pool threads included; -1 where absent */
} frames;

/* Renders count frames, the pool prepared beforehand. What options wants beside the film disturbs the times: with
 * count > 1 it is taken from one further frame that is not measured. The film of every frame must have the same
 * hash; otherwise the times are those of different work, and it is a failure. STATUS_INTERRUPTED after a signal. */
status frames_render(const scene *s, isa level, size_t count, const render_options *options, frames *out,
                     diagnostic *why);
void frames_release(frames *f);

#endif
