/* Worker threads. A kept pool starts its threads once and wakes them for each frame, in a tree (worker i wakes 2i+1 and
 * 2i+2), so that a thousand of them do not queue up behind one waker. Without keeping, threads are made and joined for
 * each run, as the report does. Ownership: pool_create gives, pool_destroy joins and releases. One run at a time. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

typedef struct pool pool;
typedef void pool_task(void *context, int worker);

pool *pool_create(void);
void pool_destroy(pool *p);

/* Makes sure that count threads are waiting. */
status pool_reserve(pool *p, int count, diagnostic *why);

/* Runs task(context, 0 .. count-1), each on a thread of its own, and returns when all have ended. Meanwhile watch (may
 * be NULL) is called every so many seconds (under 1) on the calling thread. keep: use waiting threads; else fresh ones.
 */
status pool_run(pool *p, int count, bool keep, pool_task *task, void (*watch)(void *), double every_s, void *context,
                diagnostic *why);
