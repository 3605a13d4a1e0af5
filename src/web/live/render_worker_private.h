/* What the painter's files share: not for others. render_worker.c answers others and starts and ends the thread,
 * render_worker_thread.c is what it does in turn, render_worker_snapshot.c brings the scene there and moves it,
 * render_worker_pass.c makes a picture of it. See web/live/render_worker.h. */
#pragma once

#include "job/job.h"
#include "web/live/adaptive_resolution.h"
#include "web/live/render_worker.h"
#include "web/live/passes.h"
#include <pthread.h>

struct render_worker {
    struct scene_document *scene_document;
    struct live *toy;
    render_worker_listener listener;
    pthread_t thread;
    job *with;

    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t wake, news;
    bool woken, stop, busy;
    const char *waiting; /* waiting_text, or NULL */
    char waiting_text[256];
    const shared_image *newest;
    uint64_t serial;
    diagnostic trouble;
    status trouble_code;          /* of the stage's generation */
    uint64_t snapshot_generation; /* 0: none yet */
    bool snapshot_ready;          /* loaded */

    pthread_rwlock_t snapshot_lock; /* read to look at the stage or to render it, written to replace or move it */
    scene *snapshot;

    /* the thread's own */
    pass_plan plan;
    int pass; /* next */
    double rate;
    int ended;      /* first passes in a row, and loads before them */
    double begun_s; /* when what is on its way, a load or a pass, began */
    uint64_t taken; /* the generation that the stage is a copy of, loaded or not; 0: to be taken anew */
    bool was_on;
    adaptive_resolution traced, raster; /* of the film of the live slime */
};

/* How long the first pass may take. */
#define RENDER_WORKER_FIRST_S 0.04

/* --- for the thread alone --- */

/* What it does until render_worker_end; of is the painter. */
void *render_worker_thread(void *of);

/* Is there something newer on the desk than the stage is of? */
bool render_worker_is_stale(render_worker *p);
/* Shall what is on its way end? of is the painter. */
bool render_worker_must_end(void *of);
/* The stage becomes what is on the desk. */
void render_worker_renew_snapshot(render_worker *p);
/* The slime's orders and its motion. */
void render_worker_move_snapshot(render_worker *p);
/* The next pass, and its picture. */
void render_worker_render_pass(render_worker *p);

/* Frees what a picture that is not shared holds. */
void shared_image_drop(const shared_image *p);
/* One owner; takes what shown holds. NULL when memory is out: it is then the caller's still. */
const shared_image *shared_image_create(const shared_image *shown);

/* Pages are to be told the state. */
void render_worker_notify(render_worker *p);
/* The stage's trouble is this; with the lock held, true where pages are to be told; the other one locks and tells. */
bool render_worker_take_error(render_worker *p, status code, const diagnostic *why);
void render_worker_set_error(render_worker *p, status code, const diagnostic *why);
