/* What the painter's thread does in turn. See web/live/painter_private.h. */
#include "web/live/painter_private.h"

#include "base/float_environment.h"
#include <string.h>

void painter_say(painter *p)
{
    p->listener.told(p->listener.context);
}

/* With the lock held; true where pages are to be told. */
bool painter_take_trouble(painter *p, status code, const diagnostic *why)
{
    const bool differs = code != p->trouble_code || (code != STATUS_OK && strcmp(why->what, p->trouble.what) != 0);
    p->trouble_code = code;
    p->trouble = *why;
    pthread_cond_broadcast(&p->news);
    return differs;
}

void painter_set_trouble(painter *p, status code, const diagnostic *why)
{
    pthread_mutex_lock(&p->lock);
    const bool differs = painter_take_trouble(p, code, why);
    pthread_mutex_unlock(&p->lock);
    if (differs)
        painter_say(p);
}

/* Sleeps until there is something to do; false when it is to end. */
static bool wait_for_work(painter *p)
{
    pthread_mutex_lock(&p->lock);
    for (;;) {
        pthread_mutex_unlock(&p->lock);
        const bool due = painter_is_stale(p) || (p->stage_ready && p->pass < p->plan.count) || live_is_due(p->toy);
        pthread_mutex_lock(&p->lock);
        if (p->stop || (due && !p->waiting))
            break;
        p->busy = false;
        pthread_cond_broadcast(&p->news);
        while (!p->woken && !p->stop && (p->waiting || !due))
            pthread_cond_wait(&p->wake, &p->lock);
        p->woken = false;
    }
    p->busy = !p->stop;
    const bool go_on = !p->stop;
    pthread_mutex_unlock(&p->lock);
    return go_on;
}

void *painter_thread(void *of)
{
    painter *p = of;
    float_environment_set();
    while (wait_for_work(p)) {
        if (painter_is_stale(p))
            painter_renew_stage(p);
        if (p->stage && (live_is_due(p->toy) || p->was_on))
            painter_move_stage(p);
        if (p->stage_ready && p->pass < p->plan.count)
            painter_paint_pass(p);
    }
    pthread_mutex_lock(&p->lock);
    p->busy = false;
    pthread_cond_broadcast(&p->news);
    pthread_mutex_unlock(&p->lock);
    return NULL;
}
