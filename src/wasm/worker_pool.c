/* The worker pool of a WebAssembly module, which has no threads: the workers run on the calling thread, one after
 * another. See base/worker_pool.h. */
#include "base/worker_pool.h"

#include "measure/clock.h"
#include <stdlib.h>

struct worker_pool {
    void (*watch)(void *context);
    void *context;
    double every_s, watched_s;
};

worker_pool *worker_pool_create(size_t stack_bytes)
{
    (void)stack_bytes;
    return calloc(1, sizeof(worker_pool));
}

void worker_pool_destroy(worker_pool *p)
{
    free(p);
}

status worker_pool_reserve(worker_pool *p, int count, diagnostic *why)
{
    (void)p, (void)count, (void)why;
    return STATUS_OK;
}

status worker_pool_run(worker_pool *p, int count, bool keep, worker_pool_task *task, void (*watch)(void *),
                       double every_s, void *context, diagnostic *why)
{
    (void)keep, (void)why;
    *p = (worker_pool){watch, context, every_s, clock_wall_s()};
    for (int worker = 0; worker < count; worker++)
        task(context, worker);
    return STATUS_OK;
}

void worker_pool_begin(worker_pool *p, int count, worker_pool_task *task, void *context)
{
    p->watch = NULL;
    for (int worker = 0; worker < count; worker++)
        task(context, worker);
}

void worker_pool_end(worker_pool *p)
{
    (void)p;
}

void worker_pool_pause(worker_pool *p)
{
    if (!p->watch || clock_wall_s() - p->watched_s < p->every_s)
        return;
    p->watch(p->context);
    p->watched_s = clock_wall_s();
}
