/* The one way to render: program, studies, laboratory and engine all hold a job. A job chooses the instruction set,
 * keeps the renderer with its threads from frame to frame, knows the machine where a scene pins threads, loads scenes,
 * renders frames, watches them (progress, a wish to stop, a limit of time, a quota of memory) and says what they came
 * to (job/account.h).
 *
 * Ownership: job_create gives, job_destroy releases; scenes are borrowed for a call; accounts are the caller's. One
 * thread at a time works with a job, but job_cancel may be called from any, and from signal handlers. No global state:
 * several jobs may live in one process.
 *
 * Errors: STATUS_INTERRUPTED after a wish to stop, with what was finished in the account; STATUS_BAD_INPUT for a wrong
 * scene and for a frame over the quota; STATUS_FAILURE for a frame over its time, and where memory, threads or places
 * for them are out. What is to be said of it stands in the diagnostic. */
#pragma once

#include "job/account.h"

typedef struct job job;

/* All zeros are good settings. */
typedef struct job_settings {
    const isa *level; /* NULL: isa_choose */
    bool measured; /* take usage and hardware counters of frames, and their hashes: some 0.1 ms and a film's reading */
    bool fresh_peak;   /* the peak of memory counts from each frame's beginning, where the system lets it be reset */
    bool keeps_meshes; /* of scenes that were loaded, for those that are loaded later (job/shelf.h) */
    /* Asked before a frame, while it is rendered and while a scene is loaded; true ends that. May be NULL. */
    bool (*stop)(void *context);
    void *context;
    double time_s;         /* no frame takes longer; 0: any time */
    uint64_t memory_bytes; /* no frame's film and maps take more; 0: any amount */
} job_settings;

status job_create(const job_settings *settings, job **out, diagnostic *why);
void job_destroy(job *j); /* NULL is allowed */

isa job_isa(const job *j);
/* The machine, read at the first call; the job's. */
status job_machine(job *j, const topology **out, diagnostic *why);

/* Ends what is under way, and all that follows until job_renew. */
void job_cancel(job *j);
void job_renew(job *j);
/* Is there a wish to stop? */
bool job_must_stop(const job *j);

/* Checks the scene and loads what it names. watch: as for scene_load_until, or NULL. */
status job_load(job *j, scene *s, const load_watch *watch, diagnostic *why);

/* One frame of a loaded scene. options: as for renderer_render, or NULL; its progress need not ask whether to stop.
 * *out is to be released whatever is returned. */
status job_render(job *j, const scene *s, const render_options *options, job_account *out, diagnostic *why);

/* `frames` frames of it, whose films must have one hash: otherwise their times are those of different work, and that is
 * a failure. What options wants beside the film disturbs the times: with more than one frame it is taken from one
 * further frame, which is not measured. progress hears the share of all frames. */
status job_repeat(job *j, const scene *s, size_t frames, const render_options *options, job_account *out,
                  diagnostic *why);
