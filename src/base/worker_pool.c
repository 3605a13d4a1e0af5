/* Starting, waking and joining of worker threads. */
#include "base/worker_pool.h"

#include "base/cancel.h"
#include "base/float_environment.h"
#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct worker {
    worker_pool *owner;
    int index;
    bool quit;
    pthread_t thread;
    _Alignas(64) sem_t wake; /* on its own cache line: workers wake one another */
} worker;

struct worker_pool {
    worker **workers;
    int count;   /* threads in the pool */
    int running; /* number of workers of this run */
    size_t stack_bytes;
    pid_t process; /* the process with the threads: a child of fork has none of them (fork(2)) */
    worker_pool_task *task;
    void *context;
    cancel_token *token; /* of the caller */
    _Alignas(64) atomic_int left;
    sem_t done;
};

worker_pool *worker_pool_create(size_t stack_bytes)
{
    worker_pool *p = aligned_alloc(64, (sizeof(worker_pool) + 63) / 64 * 64);
    if (!p)
        return NULL;
    memset(p, 0, sizeof *p);
    sem_init(&p->done, 0, 0);
    p->process = getpid();
    p->stack_bytes = stack_bytes;
    return p;
}

/* In a child of fork: frees the workers, whose threads exist only in the parent, so that new ones are started. */
static void forget_threads_of_parent(worker_pool *p)
{
    if (p->process == getpid())
        return;
    for (int i = 0; i < p->count; i++)
        free(p->workers[i]);
    p->count = 0;
    sem_init(&p->done, 0, 0);
    p->process = getpid();
}

static void end_of_task(worker_pool *p)
{
    if (atomic_fetch_sub(&p->left, 1) == 1)
        sem_post(&p->done);
}

static void wait_for(sem_t *s)
{
    while (sem_wait(s) != 0 && errno == EINTR)
        ;
}

static void *kept_worker(void *argument)
{
    worker *w = argument;
    worker_pool *p = w->owner;
    float_environment_set();
    for (;;) {
        wait_for(&w->wake);
        if (w->quit)
            return NULL;
        for (int child = 2 * w->index + 1; child <= 2 * w->index + 2 && child < p->running; child++)
            sem_post(&p->workers[child]->wake);
        cancel_follow(p->token);
        p->task(p->context, w->index);
        end_of_task(p);
    }
}

static void *fresh_worker(void *argument)
{
    worker *w = argument;
    float_environment_set();
    cancel_follow(w->owner->token);
    w->owner->task(w->owner->context, w->index);
    end_of_task(w->owner);
    return NULL;
}

static int start_thread(worker *w, void *(*run)(void *))
{
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    if (w->owner->stack_bytes)
        pthread_attr_setstacksize(&attributes, w->owner->stack_bytes);
    int error = pthread_create(&w->thread, &attributes, run, w);
    pthread_attr_destroy(&attributes);
    return error;
}

static status no_thread(int have, int error, diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "use fewer threads, or raise the limit (ulimit -u)",
                    "cannot start thread %d: %s", have + 1, strerror(error));
}

/* Ends all threads but the first count. */
static void end_workers(worker_pool *p, int count)
{
    for (int i = count; i < p->count; i++) {
        p->workers[i]->quit = true;
        sem_post(&p->workers[i]->wake);
    }
    while (p->count > count) {
        worker *w = p->workers[--p->count];
        pthread_join(w->thread, NULL);
        sem_destroy(&w->wake);
        free(w);
    }
}

static status grow_to(worker_pool *p, int count, diagnostic *why)
{
    worker **grown = realloc(p->workers, (size_t)count * sizeof *grown);
    if (!grown)
        return out_of_memory(why);
    p->workers = grown;
    while (p->count < count) {
        worker *w = aligned_alloc(64, (sizeof *w + 63) / 64 * 64);
        if (!w)
            return out_of_memory(why);
        memset(w, 0, sizeof *w);
        w->owner = p;
        w->index = p->count;
        sem_init(&w->wake, 0, 0);
        int error = start_thread(w, kept_worker);
        if (error) {
            sem_destroy(&w->wake);
            free(w);
            return no_thread(p->count, error, why);
        }
        p->workers[p->count++] = w;
    }
    return STATUS_OK;
}

status worker_pool_reserve(worker_pool *p, int count, diagnostic *why)
{
    forget_threads_of_parent(p);
    const int before = p->count;
    const status s = count > before ? grow_to(p, count, why) : STATUS_OK;
    if (s != STATUS_OK)
        end_workers(p, before); /* their stacks may be the memory that a frame with fewer threads needs */
    return s;
}

void worker_pool_destroy(worker_pool *p)
{
    if (!p)
        return;
    forget_threads_of_parent(p);
    end_workers(p, 0);
    sem_destroy(&p->done);
    free(p->workers);
    free(p);
}

/* Waits for the last worker, calling watch every every_s seconds unless it is NULL. */
static void wait_until_done(worker_pool *p, void (*watch)(void *), double every_s)
{
    if (!watch) {
        wait_for(&p->done);
        return;
    }
    for (;;) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += (long)(every_s * 1e9);
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        if (sem_timedwait(&p->done, &until) == 0)
            return;
        if (errno == ETIMEDOUT || errno == EINTR) /* a signal may be the reason to stop */
            watch(p->context);
    }
}

static status run_fresh(worker_pool *p, int count, void (*watch)(void *), double every_s, diagnostic *why)
{
    worker *fresh = aligned_alloc(64, (size_t)count * sizeof *fresh);
    if (!fresh)
        return out_of_memory(why);
    int started = 0, error = 0;
    for (; started < count; started++) {
        fresh[started].owner = p;
        fresh[started].index = started;
        error = start_thread(&fresh[started], fresh_worker);
        if (error)
            break;
    }
    int missing = count - started;
    if (missing > 0 && atomic_fetch_sub(&p->left, missing) == missing)
        sem_post(&p->done);
    wait_until_done(p, watch, every_s);
    for (int i = 0; i < started; i++)
        pthread_join(fresh[i].thread, NULL);
    free(fresh);
    return missing > 0 ? no_thread(started, error, why) : STATUS_OK;
}

static void prepare(worker_pool *p, int count, worker_pool_task *task, void *context)
{
    p->task = task;
    p->context = context;
    p->token = cancel_current();
    p->running = count;
    atomic_store(&p->left, count);
}

void worker_pool_begin(worker_pool *p, int count, worker_pool_task *task, void *context)
{
    prepare(p, count, task, context);
    sem_post(&p->workers[0]->wake);
}

void worker_pool_end(worker_pool *p)
{
    wait_for(&p->done);
}

status worker_pool_run(worker_pool *p, int count, bool keep, worker_pool_task *task, void (*watch)(void *),
                       double every_s, void *context, diagnostic *why)
{
    forget_threads_of_parent(p);
    if (keep)
        TRY(worker_pool_reserve(p, count, why));
    if (!keep) {
        prepare(p, count, task, context);
        return run_fresh(p, count, watch, every_s, why);
    }
    worker_pool_begin(p, count, task, context);
    wait_until_done(p, watch, every_s);
    return STATUS_OK;
}

void worker_pool_pause(worker_pool *p)
{
    (void)p; /* nothing to do: the tasks have their own threads, and the calling thread calls watch */
}
