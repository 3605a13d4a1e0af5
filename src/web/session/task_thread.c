/* Starting, stopping and joining the thread of a task. */
#include "web/session/task_thread.h"

#include "measure/clock.h"

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
