/* The interface by which a job shares its frames with other processes (src/mpi): each traces a part of the pieces of
 * every frame. The job calls begin before and end after it traces its own part; all else is as without sharing, since
 * the result that end completes is that of the whole frame. Ownership: the job borrows the interface for its life.
 * Errors: STATUS_BAD_INPUT for outputs that cannot be shared, STATUS_INTERRUPTED when cancelled, and what the other
 * processes report. */
#pragma once

#include "render/core/renderer.h"

typedef struct job_sharing {
    /* Gives the loaded scene to the others, and begins to hand out its pieces; *own: those of this process. progress of
     * the options is called about every 0.1 s until end returns, by one thread at a time, with the share of the frame
     * that all have done. Between begin and end the thread may have a further token, which gives up the frame. */
    status (*begin)(void *of, const scene *s, const render_options *requested, const piece_source **own,
                    diagnostic *why);
    /* traced, result: what the renderer returned for this process's part; result may be NULL after an error. Waits for
     * the others, and adds the film, the variance, counts, times and workers of all. Returns the status of the whole
     * frame. */
    status (*end)(void *of, status traced, render_result *result, diagnostic *why);
    void *of;
} job_sharing;
