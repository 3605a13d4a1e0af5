/* The thread team: a parallel loop over tasks on a worker pool. */
#include "base/worker_pool.h"

#include "base/os_process.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

struct thread_team {
    int size;
    pid_t process; /* after fork, the child has only one thread */
    worker_pool *pool;
    thread_team_task *task;
    void *context;
    size_t count;
    atomic_size_t next;
};

static void work(thread_team *t, int member)
{
    for (;;) {
        size_t index = atomic_fetch_add_explicit(&t->next, 1, memory_order_relaxed);
        if (index >= t->count)
            return;
        t->task(t->context, index, member);
    }
}

static void work_as_worker(void *team, int worker)
{
    work(team, worker + 1);
}

thread_team *thread_team_create(int threads)
{
    thread_team *t = malloc(sizeof *t);
    if (!t)
        return NULL;
    *t = (thread_team){.size = 1, .process = getpid(), .pool = threads > 1 ? worker_pool_create(0) : NULL};
    while (t->pool && t->size < threads && worker_pool_reserve(t->pool, t->size, NULL) == STATUS_OK)
        t->size++;
    return t;
}

void thread_team_destroy(thread_team *t)
{
    if (!t)
        return;
    worker_pool_destroy(t->pool);
    free(t);
}

int thread_team_size(const thread_team *t)
{
    return t->size;
}

void thread_team_run(thread_team *t, thread_team_task *task, void *context, size_t count)
{
    if (t->process != getpid())
        t->size = 1;
    t->task = task;
    t->context = context;
    t->count = count;
    atomic_store_explicit(&t->next, 0, memory_order_relaxed);
    if (t->size > 1)
        worker_pool_begin(t->pool, t->size - 1, work_as_worker, t);
    work(t, 0);
    if (t->size > 1)
        worker_pool_end(t->pool);
}

int thread_team_units(void)
{
    int count = os_usable_units();
    if (count < 1)
        count = (int)sysconf(_SC_NPROCESSORS_ONLN);
    return count > 1 ? count : 1;
}
