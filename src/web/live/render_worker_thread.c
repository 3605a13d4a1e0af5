/* The main loop of the render worker's thread. See web/live/render_worker_private.h. */
#include "base/float_environment.h"
#include "measure/clock.h"
#include "web/live/render_worker_private.h"

#include <errno.h>
#include <math.h>
#include <string.h>

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
        const double due_s = render_worker_due_s(p);
        pthread_mutex_lock(&p->lock);
        if (p->stop || (due_s <= 0.0 && !p->waiting))
            break;
        p->busy = false;
        pthread_cond_broadcast(&p->changed);
        sleep_for(p, due_s);
    }
    p->busy = !p->stop;
    const bool runs = !p->stop;
    pthread_mutex_unlock(&p->lock);
    return runs;
}

static void *render_worker_thread(void *of)
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

status render_worker_start(render_worker *p, diagnostic *why)
{
    return pthread_create(&p->thread, NULL, render_worker_thread, p) == 0
               ? STATUS_OK
               : diagnose(why, STATUS_FAILURE, "close other programs", "a thread cannot be started");
}

void render_worker_join(render_worker *p)
{
    pthread_join(p->thread, NULL);
}
