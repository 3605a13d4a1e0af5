/* The thread of a task: starting, stopping, joining. And a counting semaphore that can be closed, on a mutex and a
 * condition variable. */
#include "measure/clock.h"
#include "web/session/tasks.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

void task_thread_create(task_thread *t)
{
    *t = (task_thread){.started = false};
    pthread_mutex_init(&t->life, NULL);
}

void task_thread_destroy(task_thread *t)
{
    pthread_mutex_destroy(&t->life);
}

status task_thread_may_start(const task_thread *t, diagnostic *why)
{
    return cancel_is_set(&t->ending)
               ? diagnose(why, STATUS_INTERRUPTED, "start the laboratory again", "the laboratory is shutting down")
               : STATUS_OK;
}

status task_thread_start(task_thread *t, void *(*run)(void *), void *context, diagnostic *why)
{
    cancel_clear(&t->token);
    t->started = pthread_create(&t->thread, NULL, run, context) == 0;
    return t->started ? STATUS_OK : diagnose(why, STATUS_FAILURE, "close other programs", "a thread cannot be started");
}

bool task_thread_join(task_thread *t)
{
    const bool was = t->started;
    if (was)
        pthread_join(t->thread, NULL);
    t->started = false;
    return was;
}

void task_thread_end(task_thread *t)
{
    cancel_set(&t->ending);
    cancel_set(&t->token);
}

bool task_publish_is_due(double *published_s)
{
    const double now_s = clock_wall_s();
    if (now_s - *published_s < TASK_PUBLISH_PERIOD_S)
        return false;
    *published_s = now_s;
    return true;
}

struct semaphore {
    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t changed;
    int free_places;
    bool closed;
};

semaphore *semaphore_create(int places)
{
    semaphore *g = calloc(1, sizeof *g);
    if (!g)
        return NULL;
    pthread_mutex_init(&g->lock, NULL);
    pthread_cond_init(&g->changed, NULL);
    g->free_places = places;
    return g;
}

void semaphore_destroy(semaphore *g)
{
    if (!g)
        return;
    pthread_cond_destroy(&g->changed);
    pthread_mutex_destroy(&g->lock);
    free(g);
}

status semaphore_acquire(semaphore *g, diagnostic *why)
{
    pthread_mutex_lock(&g->lock);
    while (!g->closed && g->free_places == 0)
        pthread_cond_wait(&g->changed, &g->lock);
    const bool in = !g->closed;
    g->free_places -= in;
    pthread_mutex_unlock(&g->lock);
    return in ? STATUS_OK
              : diagnose(why, STATUS_INTERRUPTED, "start the laboratory again", "the laboratory is shutting down");
}

void semaphore_release(semaphore *g)
{
    pthread_mutex_lock(&g->lock);
    g->free_places++;
    pthread_cond_signal(&g->changed);
    pthread_mutex_unlock(&g->lock);
}

void semaphore_close(semaphore *g)
{
    pthread_mutex_lock(&g->lock);
    g->closed = true;
    pthread_cond_broadcast(&g->changed);
    pthread_mutex_unlock(&g->lock);
}
