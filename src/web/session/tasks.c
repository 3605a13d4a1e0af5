/* The thread of a task: starting, stopping, joining. And a counting semaphore that can be closed, on a mutex and a
 * condition variable. */
#include "web/session/tasks.h"
#include "measure/clock.h"

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
    return t->started ? STATUS_OK : diagnose(why, STATUS_FAILURE, "close other programs", "cannot start a thread");
}

bool task_thread_join(task_thread *t)
{
    const bool joins = t->started;
    if (joins)
        pthread_join(t->thread, NULL);
    t->started = false;
    return joins;
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
    semaphore *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->changed, NULL);
    s->free_places = places;
    return s;
}

void semaphore_destroy(semaphore *s)
{
    if (!s)
        return;
    pthread_cond_destroy(&s->changed);
    pthread_mutex_destroy(&s->lock);
    free(s);
}

status semaphore_acquire(semaphore *s, diagnostic *why)
{
    pthread_mutex_lock(&s->lock);
    while (!s->closed && s->free_places == 0)
        pthread_cond_wait(&s->changed, &s->lock);
    const bool acquired = !s->closed;
    s->free_places -= acquired;
    pthread_mutex_unlock(&s->lock);
    return acquired
               ? STATUS_OK
               : diagnose(why, STATUS_INTERRUPTED, "start the laboratory again", "the laboratory is shutting down");
}

void semaphore_release(semaphore *s)
{
    pthread_mutex_lock(&s->lock);
    s->free_places++;
    pthread_cond_signal(&s->changed);
    pthread_mutex_unlock(&s->lock);
}

void semaphore_close(semaphore *s)
{
    pthread_mutex_lock(&s->lock);
    s->closed = true;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->lock);
}
