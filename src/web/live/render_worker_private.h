/* The private struct of the render worker. render_worker.c is the thread-safe interface, and starts and ends the
 * thread; render_worker_thread.c is the thread's main loop; render_worker_snapshot.c updates, moves and renders the
 * snapshot. See web/live/render_worker.h. */
#pragma once

#include "job/job.h"
#include "scene/model/scene.h"
#include "web/live/passes.h"
#include "web/live/render_worker.h"

#include <pthread.h>

struct render_worker {
    struct scene_document *scene_document;
    struct live *live_slime;
    render_worker_listener listener;
    pthread_t thread;
    job *renderer;

    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t wake, changed;
    bool wake_requested, stop, busy;
    const char *waiting; /* waiting_text, or NULL */
    char waiting_text[256];
    const shared_image *newest;
    uint64_t serial;
    diagnostic trouble;
    status trouble_code;          /* of the snapshot's generation */
    uint64_t snapshot_generation; /* 0: none yet */
    bool snapshot_ready;          /* loaded */
    bool again;                   /* load and render the scene again, after a failure of the machine */
    double again_from_s;          /* the earliest wall time for `again` */

    pthread_rwlock_t snapshot_lock; /* read-locked to read or render the snapshot, write-locked to replace or move it */
    scene *snapshot;

    /* only the thread uses these */
    pass_plan plan;
    int pass; /* the next pass */
    double rate;
    int interrupted;  /* interrupted first passes in a row, including the loads before them */
    double started_s; /* start time of the current copy, load, move or pass */
    uint64_t
        copied_generation;    /* generation of the document that the snapshot copies, loaded or not; 0: copy it again */
    uint64_t seen_generation; /* the newest generation that was ever copied */
    double changed_s, finer_after_s; /* when that generation was copied; when its passes after the first may begin */
    bool was_on;
    adaptive_resolution traced, raster; /* of the frames of the live slime */
};

/* Time limit of the first pass, so that the image follows a drag at 20 images per second on two processors: the browser
 * needs about half of the time to show them. */
#define RENDER_WORKER_FIRST_S 0.025

/* --- only for the thread --- */

/* Starts and joins the thread, which runs until render_worker_end. In a browser there is no such thread; turns of the
 * laboratory's worker replace it (src/wasm/render_turns.c). */
status render_worker_start(render_worker *worker, diagnostic *why);
void render_worker_join(render_worker *worker);

/* Seconds until there is work, unless somebody wakes the thread; INFINITY: nothing is left to do. */
double render_worker_due_s(render_worker *worker);

/* Whether the document has a newer generation than the snapshot. */
bool render_worker_is_stale(render_worker *worker);
/* Copies the scene document to the snapshot. */
void render_worker_renew_snapshot(render_worker *worker);
/* Runs the slime's commands and its motion. */
void render_worker_move_snapshot(render_worker *worker);
/* Renders the next pass and publishes its image. */
void render_worker_render_pass(render_worker *worker);
/* The two parts of render_worker_render_pass, for a pass that a browser's tile workers render. begin fills *out, whose
 * view borrows from the snapshot; the snapshot is read-locked until end. end releases the account, and publishes the
 * image after STATUS_OK. */
typedef struct started_pass {
    int pass;
    bool moving, raster;
    adaptive_resolution *resolution; /* of a moving scene; otherwise NULL */
    scene view;                      /* the snapshot with the settings of the pass */
} started_pass;
void render_worker_begin_pass(render_worker *worker, started_pass *out);
void render_worker_end_pass(render_worker *worker, const started_pass *started, status code, job_account *account,
                            diagnostic *why);

/* Frees the contents of an image that is not shared. */
void shared_image_drop(const shared_image *img);
/* Moves the contents of `shown` into a new shared image with one reference. Returns NULL when out of memory; the
 * contents then still belong to the caller. */
const shared_image *shared_image_create(const shared_image *shown);
