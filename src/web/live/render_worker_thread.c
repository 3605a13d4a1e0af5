/* The main loop of the render worker's thread. See web/live/render_worker_private.h. */
#include "base/float_environment.h"
#include "measure/clock.h"
#include "web/live/render_worker_private.h"

#include <errno.h>
#include <math.h>
#include <string.h>

/* Sleeps until another thread wakes this one or `seconds` have passed. The caller holds the lock. */
static void sleep_for(render_worker *worker, double seconds)
{
    const bool ends = isfinite(seconds) && !worker->waiting;
    const struct timespec until = clock_after(ends ? seconds : 0.0);
    int ended = 0;
    while (!worker->wake_requested && !worker->stop && ended != ETIMEDOUT)
        ended = ends ? pthread_cond_clockwait(&worker->wake, &worker->lock, CLOCK_MONOTONIC, &until)
                     : pthread_cond_wait(&worker->wake, &worker->lock);
    worker->wake_requested = false;
}

/* Sleeps until there is work; false at the end. */
static bool wait_for_work(render_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    for (;;) {
        if (worker->again)
            worker->copied_generation = 0;
        worker->again = false;
        pthread_mutex_unlock(&worker->lock);
        const double due_s = render_worker_due_s(worker);
        pthread_mutex_lock(&worker->lock);
        if (worker->stop || (due_s <= 0.0 && !worker->waiting))
            break;
        worker->busy = false;
        pthread_cond_broadcast(&worker->changed);
        sleep_for(worker, due_s);
    }
    worker->busy = !worker->stop;
    const bool runs = !worker->stop;
    pthread_mutex_unlock(&worker->lock);
    return runs;
}

static void *render_worker_thread(void *of)
{
    render_worker *worker = of;
    float_environment_set();
    while (wait_for_work(worker)) {
        if (render_worker_is_stale(worker))
            render_worker_renew_snapshot(worker);
        if (worker->snapshot && (live_is_due(worker->live_slime) || worker->was_on))
            render_worker_move_snapshot(worker);
        if (worker->snapshot_ready && worker->pass < worker->plan.count)
            render_worker_render_pass(worker);
    }
    pthread_mutex_lock(&worker->lock);
    worker->busy = false;
    pthread_cond_broadcast(&worker->changed);
    pthread_mutex_unlock(&worker->lock);
    return NULL;
}

status render_worker_start(render_worker *worker, diagnostic *why)
{
    return pthread_create(&worker->thread, NULL, render_worker_thread, worker) == 0
               ? STATUS_OK
               : diagnose(why, STATUS_FAILURE, "close other programs", "cannot start a thread");
}

void render_worker_join(render_worker *worker)
{
    pthread_join(worker->thread, NULL);
}
