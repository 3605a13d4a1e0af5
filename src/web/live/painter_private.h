/* What the painter's files share: not for others. painter.c answers others and starts and ends the thread,
 * painter_thread.c is what it does in turn, painter_stage.c brings the scene there and moves it, painter_pass.c makes a
 * picture of it. See web/live/painter.h. */
#pragma once

#include "job/job.h"
#include "web/live/pace.h"
#include "web/live/painter.h"
#include "web/live/passes.h"
#include <pthread.h>

struct painter {
    struct desk *desk;
    struct live *toy;
    painter_listener listener;
    pthread_t thread;
    job *tracer;

    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t wake, news;
    bool woken, stop, busy;
    const char *waiting; /* waiting_text, or NULL */
    char waiting_text[256];
    const picture *newest;
    uint64_t serial;
    diagnostic trouble;
    status trouble_code;       /* of the stage's generation */
    uint64_t stage_generation; /* 0: none yet */
    bool stage_ready;          /* loaded */

    pthread_rwlock_t stage_lock; /* read to look at the stage or to render it, written to replace or move it */
    scene *stage;

    /* the thread's own */
    pass_plan plan;
    int pass; /* next */
    double rate;
    int ended;      /* first passes in a row, and loads before them */
    double begun_s; /* when what is on its way, a load or a pass, began */
    uint64_t taken; /* the generation that the stage is a copy of, loaded or not; 0: to be taken anew */
    bool was_on;
    pace traced, raster; /* of the film of the live slime */
};

/* How long the first pass may take. */
#define PAINTER_FIRST_S 0.04

/* --- for the thread alone --- */

/* What it does until painter_end; of is the painter. */
void *painter_thread(void *of);

/* Is there something newer on the desk than the stage is of? */
bool painter_is_stale(painter *p);
/* Shall what is on its way end? of is the painter. */
bool painter_must_end(void *of);
/* The stage becomes what is on the desk. */
void painter_renew_stage(painter *p);
/* The slime's orders and its motion. */
void painter_move_stage(painter *p);
/* The next pass, and its picture. */
void painter_paint_pass(painter *p);

/* Frees what a picture that is not shared holds. */
void picture_drop(const picture *p);
/* One owner; takes what shown holds. NULL when memory is out: it is then the caller's still. */
const picture *picture_create(const picture *shown);

/* Pages are to be told the state. */
void painter_say(painter *p);
/* The stage's trouble is this; with the lock held, true where pages are to be told; the other one locks and tells. */
bool painter_take_trouble(painter *p, status code, const diagnostic *why);
void painter_set_trouble(painter *p, status code, const diagnostic *why);
