/* The thread-safe interface of the live slime. */
#include "measure/clock.h"
#include "report/json.h"
#include "web/live/live_private.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

live *live_create(void (*wake)(void *context), void *context)
{
    live *l = calloc(1, sizeof *l);
    if (!l)
        return NULL;
    l->wake = wake;
    l->context = context;
    l->moved_at_s = NAN;
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->answered, NULL);
    return l;
}

void live_destroy(live *l)
{
    if (!l)
        return;
    scene_motion_destroy(l->motion);
    free(l->motion_hands);
    pthread_cond_destroy(&l->answered);
    pthread_mutex_destroy(&l->lock);
    free(l);
}

/* Unlocks before the call: wake may take a lock whose holder calls live_is_due. */
static void unlock_and_wake(live *l)
{
    l->requested = true;
    pthread_mutex_unlock(&l->lock);
    if (l->wake)
        l->wake(l->context);
}

void live_send(live *l, live_command order)
{
    pthread_mutex_lock(&l->lock);
    switch (order) {
    case LIVE_PLAY:
        l->mode = LIVE_IS_PLAYING;
        l->restart |= l->report.in_trouble;
        break;
    case LIVE_PAUSE: l->mode = LIVE_IS_PAUSED; break;
    case LIVE_RESTART:
        l->mode = LIVE_IS_PLAYING;
        l->restart = true;
        break;
    case LIVE_OFF:
        l->mode = LIVE_IS_OFF;
        l->restart = false;
        break;
    }
    unlock_and_wake(l);
}

void live_set_preview(live *l, live_preview preview)
{
    pthread_mutex_lock(&l->lock);
    l->preview = preview;
    unlock_and_wake(l);
}

void live_stop(live *l)
{
    pthread_mutex_lock(&l->lock);
    l->stopped = true;
    pthread_cond_broadcast(&l->answered);
    pthread_mutex_unlock(&l->lock);
}

static void withdraw(live *l, const grab_request *q)
{
    grab_request **link = &l->first;
    while (*link && *link != q)
        link = &(*link)->next;
    if (*link)
        *link = q->next;
}

/* Waits for the render worker's answer. The caller holds the lock, which is released while waiting. */
static status wait_for(live *l, grab_request *q, diagnostic *why)
{
    const struct timespec until = clock_after(LIVE_WAIT_S);
    int waited = 0;
    while (!q->done && !l->stopped && waited != ETIMEDOUT)
        waited = pthread_cond_clockwait(&l->answered, &l->lock, CLOCK_MONOTONIC, &until);
    if (q->done)
        return q->code;
    withdraw(l, q);
    return diagnose(why, STATUS_INTERRUPTED, l->stopped ? "" : "try again when the slime moves",
                    l->stopped ? "the laboratory is closing" : "the slime is not being simulated");
}

/* Checks that the slime can be grabbed. The caller holds the lock. */
static status check_live(const live *l, diagnostic *why)
{
    if (l->mode == LIVE_IS_OFF || !l->report.has_slime)
        return diagnose(why, STATUS_BAD_INPUT, "play a slime first, in a scene that has one", "no slime is live");
    if (l->report.in_trouble && !l->restart)
        return diagnose(why, STATUS_BAD_INPUT, "restart the slime", "the slime has stopped: %s",
                        l->report.trouble.what);
    return STATUS_OK;
}

status live_grab(live *l, vec3 origin, vec3 direction, double reach, int *hand, vec3 *where, diagnostic *why)
{
    const double length = vec3_length(direction);
    if (!vec3_is_finite(origin) || !(length > 0.0 && isfinite(length)) || !(reach >= 0.0 && isfinite(reach)))
        return diagnose(why, STATUS_BAD_INPUT, "use finite coordinates for the ray and a reach of at least 0",
                        "the grab ray or its reach is invalid");
    grab_request q = {.origin = origin, .direction = vec3_scale(direction, 1.0 / length), .reach = reach, .why = why};
    pthread_mutex_lock(&l->lock);
    status code = check_live(l, why);
    if (code == STATUS_OK) {
        grab_request **end = &l->first;
        while (*end)
            end = &(*end)->next;
        *end = &q;
        unlock_and_wake(l);
        pthread_mutex_lock(&l->lock);
        code = wait_for(l, &q, why);
    }
    pthread_mutex_unlock(&l->lock);
    *hand = code == STATUS_OK ? q.hand : LIVE_MISSED;
    *where = q.where;
    return code;
}

/* The caller holds the lock. */
static status find_hand(live *l, int id, live_hand **out, diagnostic *why)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        if (id > 0 && l->live_hands[i].id == id && !l->live_hands[i].released) {
            *out = &l->live_hands[i];
            return STATUS_OK;
        }
    return diagnose(why, STATUS_BAD_INPUT, "grab again: the slime may have restarted", "no hand has the number %d", id);
}

status live_where(live *l, int hand, vec3 *where, diagnostic *why)
{
    live_hand *h = NULL;
    pthread_mutex_lock(&l->lock);
    const status code = find_hand(l, hand, &h, why);
    if (code == STATUS_OK)
        *where = h->where;
    pthread_mutex_unlock(&l->lock);
    return code;
}

status live_move(live *l, int hand, vec3 by, diagnostic *why)
{
    const double limit = 1e6;
    if (!(vec3_length(by) <= limit))
        return diagnose(why, STATUS_BAD_INPUT, "stay within 1e6 scene units", "the hand moves too far");
    live_hand *h = NULL;
    pthread_mutex_lock(&l->lock);
    const status code = find_hand(l, hand, &h, why);
    if (code == STATUS_OK)
        h->by = by;
    pthread_mutex_unlock(&l->lock);
    return code;
}

status live_release(live *l, int hand, diagnostic *why)
{
    live_hand *h = NULL;
    pthread_mutex_lock(&l->lock);
    const status code = hand == LIVE_ALL ? STATUS_OK : find_hand(l, hand, &h, why);
    if (code != STATUS_OK) {
        pthread_mutex_unlock(&l->lock);
        return code;
    }
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        l->live_hands[i].released |= l->live_hands[i].id > 0 && (!h || h == &l->live_hands[i]);
    unlock_and_wake(l);
    return STATUS_OK;
}

bool live_is_on(live *l)
{
    pthread_mutex_lock(&l->lock);
    const bool on = l->mode != LIVE_IS_OFF;
    pthread_mutex_unlock(&l->lock);
    return on;
}

/* The caller holds the lock. */
static bool is_moving(const live *l)
{
    const live_report *a = &l->report;
    return l->mode == LIVE_IS_PLAYING && a->has_slime && !a->resting && !a->in_trouble;
}

bool live_is_moving(live *l)
{
    pthread_mutex_lock(&l->lock);
    const bool moving = is_moving(l);
    pthread_mutex_unlock(&l->lock);
    return moving;
}

bool live_has_request(live *l)
{
    pthread_mutex_lock(&l->lock);
    const bool pending = l->requested || l->first;
    pthread_mutex_unlock(&l->lock);
    return pending;
}

bool live_is_due(live *l)
{
    pthread_mutex_lock(&l->lock);
    const bool due = is_moving(l) || l->requested || l->first;
    pthread_mutex_unlock(&l->lock);
    return due;
}

live_preview live_preview_of(live *l)
{
    pthread_mutex_lock(&l->lock);
    const live_preview preview = l->preview;
    pthread_mutex_unlock(&l->lock);
    return preview;
}

static json_t *json_of_trouble(const live_report *a)
{
    return a->in_trouble ? json_of_diagnostic(&a->trouble) : json_null();
}

json_t *live_json(live *l)
{
    pthread_mutex_lock(&l->lock);
    const live_report a = l->report;
    const live_mode mode = l->mode;
    const live_preview preview = l->preview;
    pthread_mutex_unlock(&l->lock);
    if (!a.has_slime)
        return json_null();
    return json_pack("{s:b, s:b, s:o, s:o, s:o, s:o, s:I, s:b, s:o, s:s, s:o}", "on", mode != LIVE_IS_OFF, "playing",
                     mode == LIVE_IS_PLAYING && !a.in_trouble, "time_s", json_of_real(a.time_s), "speed",
                     json_of_real(a.speed), "volume", json_of_real(a.volume), "volume_at_rest",
                     json_of_real(a.volume_at_rest), "held", (json_int_t)a.held_vertices, "resting", a.resting,
                     "realtime", json_of_real(a.realtime), "preview", preview == LIVE_ZBUFFER ? "zbuffer" : "traced",
                     "trouble", json_of_trouble(&a));
}
