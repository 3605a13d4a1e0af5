/* A parallel loop on the threads of a worker pool (base/worker_pool.h) and on the calling thread. A team of one starts
 * no thread. If the system provides fewer threads than requested, the team is smaller; results must not depend on its
 * size. thread_team_create allocates, thread_team_destroy frees; for one caller at a time. Members work under the
 * cancellation of their caller (base/cancel.h). */
#pragma once

#include <stddef.h>

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
