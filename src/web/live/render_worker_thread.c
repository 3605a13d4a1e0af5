/* The main loop of the render worker's thread. See web/live/render_worker_private.h. */
#include "web/live/render_worker_private.h"

#include "base/float_environment.h"
#include <string.h>

void render_worker_notify(render_worker *p)
{
    p->listener.state_changed(p->listener.context);
}

/* The caller holds the lock; true if the listener must be called. */
bool render_worker_take_error(render_worker *p, status code, const diagnostic *why)
{
    const bool differs = code != p->trouble_code || (code != STATUS_OK && strcmp(why->what, p->trouble.what) != 0);
    p->trouble_code = code;
    p->trouble = *why;
    pthread_cond_broadcast(&p->changed);
    return differs;
}

void render_worker_set_error(render_worker *p, status code, const diagnostic *why)
{
    pthread_mutex_lock(&p->lock);
    const bool differs = render_worker_take_error(p, code, why);
    pthread_mutex_unlock(&p->lock);
    if (differs)
        render_worker_notify(p);
}

/* Sleeps until there is work; false at the end. */
static bool wait_for_work(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    for (;;) {
        pthread_mutex_unlock(&p->lock);
        const bool due =
            render_worker_is_stale(p) || (p->snapshot_ready && p->pass < p->plan.count) || live_is_due(p->live_slime);
        pthread_mutex_lock(&p->lock);
        if (p->stop || (due && !p->waiting))
            break;
        p->busy = false;
        pthread_cond_broadcast(&p->changed);
        while (!p->wake_requested && !p->stop && (p->waiting || !due))
            pthread_cond_wait(&p->wake, &p->lock);
        p->wake_requested = false;
    }
    p->busy = !p->stop;
    const bool go_on = !p->stop;
    pthread_mutex_unlock(&p->lock);
    return go_on;
}

void *render_worker_thread(void *of)
{
    render_worker *p = of;
    float_environment_set();
    while (wait_for_work(p)) {
        if (render_worker_is_stale(p))
            render_worker_renew_snapshot(p);
        if (p->snapshot && (live_is_due(p->live_slime) || p->was_on))
            render_worker_move_snapshot(p);
        if (p->snapshot_ready && p->pass < p->plan.count)
            render_worker_render_pass(p);
    }
    pthread_mutex_lock(&p->lock);
    p->busy = false;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->lock);
    return NULL;
}
