/* The worker pool: the threads of all parallel work. A persistent pool starts its threads once and wakes them for each
 * run in a tree (worker i wakes 2i+1 and 2i+2), so that a thousand of them do not queue up behind one waker. Otherwise
 * threads are created and joined for each run, as in the published rod report. Workers follow the caller's cancellation
 * (base/cancel.h). A thread team (below) is a loop on such a pool. Ownership: worker_pool_create allocates,
 * worker_pool_destroy joins and releases. One run at a time. In a child of fork, a pool that was not running starts new
 * threads.
 *
 * All other threads run one function each, for a reason:
 *     image/codec.c                      the call is confined, and a confined thread cannot be used again
 *     base/os_process.c                  the call needs a larger stack
 *     mpi/frame.c                        one thread of a rank renders while another exchanges messages
 *     web/http/http_watch.c              watches connections for as long as the server runs
 *     web/lab.c                          starts the laboratory confined, from a thread that its threads inherit from
 *     web/live/render_worker_thread.c    renders the document for as long as the laboratory runs
 *     web/session/rescue.c               saves the document for as long as the laboratory runs
 *     web/session/tasks.c                a study or a video, while the server answers */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct worker_pool worker_pool;
typedef void worker_pool_task(void *context, int worker);

/* stack_bytes: of each thread; 0: the system's usual size. NULL: out of memory. */
worker_pool *worker_pool_create(size_t stack_bytes);
void worker_pool_destroy(worker_pool *p);

/* Starts threads until count of them wait for work. */
status worker_pool_reserve(worker_pool *p, int count, diagnostic *why);

/* Runs task(context, 0 .. count-1), each on its own thread, and returns when all have ended. Meanwhile watch (may be
 * NULL) is called every every_s seconds (under 1) on the calling thread. keep: use the waiting threads, else new
 * ones. */
status worker_pool_run(worker_pool *p, int count, bool keep, worker_pool_task *task, void (*watch)(void *),
                       double every_s, void *context, diagnostic *why);

/* The same on count > 0 waiting threads, while the calling thread works between begin and end. */
void worker_pool_begin(worker_pool *p, int count, worker_pool_task *task, void *context);
void worker_pool_end(worker_pool *p);

/* For tasks, between parts of their work: a pool without threads (src/wasm) runs its workers on the calling thread, one
 * after another, and calls watch here when it is due. */
void worker_pool_pause(worker_pool *p);

/* A parallel loop on the threads of a worker pool, and on the calling thread. A team of one starts
 * no thread. If the system provides fewer threads than requested, the team is smaller; results must not depend on its
 * size. thread_team_create allocates, thread_team_destroy frees; for one caller at a time. Members work under the
 * cancellation of their caller (base/cancel.h). */

typedef struct thread_team thread_team;
typedef void thread_team_task(void *context, size_t index, int member); /* member: 0 .. thread_team_size - 1 */

/* NULL: out of memory. threads: at least 1. */
thread_team *thread_team_create(int threads);
void thread_team_destroy(thread_team *t); /* NULL is allowed */
int thread_team_size(const thread_team *t);

/* The number of processing units that the process may use now (its CPU affinity), at least 1. */
int thread_team_units(void);

/* Calls task for each index 0 .. count - 1, in any order and by any member, and returns when all calls have
 * returned. */
void thread_team_run(thread_team *t, thread_team_task *task, void *context, size_t count);
