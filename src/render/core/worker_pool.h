/* The worker pool: threads that run a task once per frame. A persistent pool starts its threads once and wakes them
 * for each frame in a tree (worker i wakes 2i+1 and 2i+2), so that a thousand of them do not queue up behind one
 * waker. Otherwise threads are created and joined for each run, as in the report. Workers follow the caller's
 * cancellation (base/cancel.h). Ownership: worker_pool_create allocates, worker_pool_destroy joins and releases. One
 * run at a time. In a child of fork, a pool that was not running starts threads of its own. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

typedef struct worker_pool worker_pool;
typedef void worker_pool_task(void *context, int worker);

worker_pool *worker_pool_create(void);
void worker_pool_destroy(worker_pool *p);

/* Makes sure that count threads are waiting for work. */
status worker_pool_reserve(worker_pool *p, int count, diagnostic *why);

/* Runs task(context, 0 .. count-1), each on its own thread, and returns when all have ended. Meanwhile watch (may be
 * NULL) is called every every_s seconds (under 1) on the calling thread. keep: use the waiting threads, else new
 * ones. */
status worker_pool_run(worker_pool *p, int count, bool keep, worker_pool_task *task, void (*watch)(void *),
                       double every_s, void *context, diagnostic *why);

/* For tasks, between parts of their work: a pool without threads (src/wasm) runs its workers on the calling thread, one
 * after another, and calls watch here when it is due. */
void worker_pool_pause(worker_pool *p);
