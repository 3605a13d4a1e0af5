/* Threads that share the work of one caller: a build, a step. A team of one starts none. Where the system gives fewer
 * threads than were asked for, the team is smaller: what it works out must not depend on its size. team_start gives,
 * team_stop releases; for one caller at a time. */
#pragma once

#include <stddef.h>

typedef struct team team;
typedef void team_task(void *context, size_t index, int member); /* member: 0 .. team_size - 1 */

/* NULL when memory is out. threads: at least 1. */
team *team_start(int threads);
void team_stop(team *t); /* NULL is allowed */
int team_size(const team *t);

/* Calls task for each index 0 .. count - 1, in any order and by any member, and returns when all have returned. */
void team_run(team *t, team_task *task, void *context, size_t count);
