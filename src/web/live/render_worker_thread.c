/* The main loop of the render worker's thread. See web/live/render_worker_private.h. */
#include "web/live/render_worker_private.h"

#include "base/float_environment.h"
#include "measure/clock.h"
#include <errno.h>
#include <math.h>
#include <string.h>

void render_worker_notify(render_worker *p)
{
    p->listener.state_changed(p->listener.context);
}

/* A failed attempt that took longer is not repeated before the same time has passed. */
static const double soon_s = 0.25;

/* The caller holds the lock; true if the listener must be called. */
bool render_worker_take_error(render_worker *p, status code, const diagnostic *why)
{
    const bool differs = code != p->trouble_code || (code != STATUS_OK && strcmp(why->what, p->trouble.what) != 0);
    p->trouble_code = code;
    p->trouble = *why;
    const double now_s = clock_wall_s(); /* a scene that never fits must not keep the machine busy */
    p->again_from_s = now_s + fmax(0.0, now_s - p->started_s - soon_s);
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

/* Seconds until there is work, unless somebody wakes the thread; INFINITY: nothing is left to do. */
static double work_due_s(render_worker *p)
{
    if (render_worker_is_stale(p) || live_is_due(p->live_slime))
        return 0.0;
    if (!p->snapshot_ready || p->pass >= p->plan.count)
        return INFINITY;
    return p->pass > 0 ? fmax(0.0, p->finer_after_s - clock_wall_s()) : 0.0;
}

/* Sleeps until somebody wakes the thread or that time is over. The caller holds the lock. */
static void sleep_for(render_worker *p, double seconds)
{
    const bool ends = isfinite(seconds) && !p->waiting;
    const struct timespec until = clock_after(ends ? seconds : 0.0);
    int ended = 0;
    while (!p->wake_requested && !p->stop && ended != ETIMEDOUT)
        ended = ends ? pthread_cond_clockwait(&p->wake, &p->lock, CLOCK_MONOTONIC, &until)
                     : pthread_cond_wait(&p->wake, &p->lock);
    p->wake_requested = false;
}

/* Sleeps until there is work; false at the end. */
static bool wait_for_work(render_worker *p)
{
    pthread_mutex_lock(&p->lock);
    for (;;) {
        if (p->again)
            p->taken_generation = 0;
        p->again = false;
        pthread_mutex_unlock(&p->lock);
        const double due_s = work_due_s(p);
        pthread_mutex_lock(&p->lock);
        if (p->stop || (due_s <= 0.0 && !p->waiting))
            break;
        p->busy = false;
        pthread_cond_broadcast(&p->changed);
        sleep_for(p, due_s);
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
