/* Threads that share the work of one caller: a build, a step. A team of one starts none. Where the system gives fewer
 * threads than were asked for, the team is smaller: what it works out must not depend on its size. thread_team_start
 * gives, thread_team_stop releases; for one caller at a time. */
#pragma once

#include <stddef.h>

typedef struct thread_team thread_team;
typedef void thread_team_task(void *context, size_t index, int member); /* member: 0 .. thread_team_size - 1 */

/* NULL when memory is out. threads: at least 1. */
thread_team *thread_team_start(int threads);
void thread_team_stop(thread_team *t); /* NULL is allowed */
int thread_team_size(const thread_team *t);

/* Calls task for each index 0 .. count - 1, in any order and by any member, and returns when all have returned. */
void thread_team_run(thread_team *t, thread_team_task *task, void *context, size_t count);
