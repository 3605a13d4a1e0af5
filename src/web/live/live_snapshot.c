/* The render worker's side of the live slime: its scene, the commands and the hands. */
#include "web/live/live_private.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>

/* Releases all hands. The caller holds the lock. */
static void forget_hands(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        l->held[i] = (live_hand){.id = 0};
}

static void measure(live *l)
{
    live_account *a = &l->account;
    a->time_s = l->time_s;
    a->realtime = l->realtime;
    a->speed = a->volume = a->volume_at_rest = 0.0;
    a->held = 0;
    for (size_t i = 0; l->motion && i < scene_motion_count(l->motion); i++) {
        const softbody_quantities of = softbody_measure(scene_motion_body(l->motion, i));
        a->speed = fmax(a->speed, of.speed_max);
        a->volume += of.volume;
        a->volume_at_rest += of.volume_at_rest;
        a->held += of.held;
    }
}

static void forget_motion(live *l)
{
    l->motion = NULL;
    free(l->hands);
    l->hands = NULL;
    l->time_s = 0.0;
    l->cost = 0.0;
    live_reset_clock(l);
    l->moved = l->changed = true;
    pthread_mutex_lock(&l->lock);
    forget_hands(l);
    l->account = (live_account){.has_slime = l->account.has_slime};
    pthread_mutex_unlock(&l->lock);
}

/* Ends the simulation; the scene gets its original surface back. */
static void end(live *l)
{
    scene_motion_end(l->motion);
    forget_motion(l);
}

/* Records an error that stops the simulation. */
static void fail(live *l, const diagnostic *why)
{
    pthread_mutex_lock(&l->lock);
    l->account.in_trouble = true;
    l->account.trouble = *why;
    l->account.resting = false;
    pthread_mutex_unlock(&l->lock);
    l->changed = true;
}

static status begin(live *l, diagnostic *why)
{
    diagnostic bad = {.what = ""};
    status code = scene_motion_create(l->snapshot, &l->motion, &bad);
    if (code == STATUS_OK) {
        l->hands = calloc(scene_motion_count(l->motion) * SOFTBODY_HANDS_MAX, sizeof *l->hands);
        code = l->hands ? STATUS_OK : out_of_memory(&bad);
    }
    if (code != STATUS_OK) {
        end(l);
        fail(l, &bad);
        if (why)
            *why = bad;
        return code;
    }
    l->moved = l->changed = true;
    pthread_mutex_lock(&l->lock);
    measure(l);
    pthread_mutex_unlock(&l->lock);
    return STATUS_OK;
}

/* Moves the simulation to a new snapshot, or starts a new one where the scene has another slime of the same name. */
static status transfer_motion(live *l, diagnostic *why)
{
    bool joined = false;
    const status code = scene_motion_join(l->motion, l->snapshot, &joined, why);
    if (code != STATUS_OK || joined)
        return code;
    end(l);
    return begin(l, why);
}

status live_attach(live *l, scene *snapshot, diagnostic *why)
{
    l->snapshot = snapshot;
    pthread_mutex_lock(&l->lock);
    l->account.has_slime = scene_moves(snapshot);
    if (!l->account.has_slime && !l->requested) /* a pending command may be for a scene to come */
        l->mode = LIVE_IS_OFF;
    const bool still = l->mode == LIVE_IS_OFF || !l->account.has_slime;
    pthread_mutex_unlock(&l->lock);
    if (still) {
        end(l);
        return STATUS_OK;
    }
    if (l->motion)
        return transfer_motion(l, why);
    end(l); /* clears an earlier error */
    return begin(l, why);
}

void live_detach(live *l)
{
    if (l->motion)
        scene_motion_leave(l->motion);
    l->snapshot = NULL;
}

/* --- hands; the caller holds the lock --- */

static status pick(const live *l, const grab_request *q, size_t *index, motion_place *best, diagnostic *why)
{
    *best = (motion_place){.distance = INFINITY};
    for (size_t i = 0; i < scene_motion_count(l->motion); i++) {
        motion_place hit;
        TRY(scene_motion_pick(l->motion, i, MOTION_ANY_SOLID, q->origin, q->direction, &hit, why));
        if (hit.distance < best->distance) {
            *best = hit;
            *index = i;
        }
    }
    return STATUS_OK;
}

static double reach_of(const live *l, const grab_request *q, size_t index, const motion_place *place)
{
    const double share = 0.3;
    const vec3 scale = l->snapshot->solids[place->solid].shape.scale;
    const double radius = l->snapshot->meshes[scene_motion_mesh(l->motion, index)].slime.radius;
    return q->reach > 0.0 ? q->reach : share * radius * fmax(scale.x, fmax(scale.y, scale.z));
}

static live_hand *free_hand(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        if (l->held[i].id == 0)
            return &l->held[i];
    return NULL;
}

static status grab(live *l, grab_request *q)
{
    q->hand = LIVE_MISSED;
    if (!l->motion || l->account.in_trouble)
        return diagnose(q->why, STATUS_BAD_INPUT, "restart it", "the slime is not live");
    size_t index = 0;
    motion_place place;
    status code = pick(l, q, &index, &place, q->why);
    if (code != STATUS_OK || isinf(place.distance))
        return code;
    live_hand *h = free_hand(l);
    int number = 0;
    TRY(h ? scene_motion_grab(l->motion, index, &place, reach_of(l, q, index, &place),
                              &l->hands[index * SOFTBODY_HANDS_MAX], &number, q->why)
          : diagnose(q->why, STATUS_BAD_INPUT, "release a hand first", "no hand is free"));
    *h = (live_hand){.id = ++l->last_id, .slime = index, .number = number, .where = place.where};
    q->hand = h->id;
    q->where = place.where;
    l->account.resting = false;
    l->quiet_s = 0.0;
    l->changed = true;
    return STATUS_OK;
}

static void release_hands(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++) {
        live_hand *h = &l->held[i];
        if (!h->released)
            continue;
        scene_motion_release(l->motion, h->slime, &l->hands[h->slime * SOFTBODY_HANDS_MAX], h->number);
        *h = (live_hand){.id = 0};
        l->account.resting = false;
        l->changed = true;
    }
}

static void answer_grabs(live *l)
{
    for (grab_request *q = l->first; q; q = q->next) {
        q->code = grab(l, q);
        q->done = true;
    }
    if (l->first)
        pthread_cond_broadcast(&l->answered);
    l->first = NULL;
}

/* --- commands --- */

/* Runs the commands since the last call; does nothing where they cannot run yet. */
static status apply_commands(live *l, live_mode *mode, diagnostic *why)
{
    pthread_mutex_lock(&l->lock);
    *mode = l->mode;
    const bool restart = l->restart, trouble = l->account.in_trouble;
    l->changed |= l->requested;
    l->restart = l->requested = false;
    pthread_mutex_unlock(&l->lock);
    if (*mode == LIVE_IS_OFF && (l->motion || trouble))
        end(l);
    if (*mode != LIVE_IS_OFF && restart)
        end(l);
    const bool must_begin = *mode != LIVE_IS_OFF && !l->motion && (restart || !trouble);
    return must_begin && scene_moves(l->snapshot) ? begin(l, why) : STATUS_OK;
}

/* Serves grabs and releases; measures afterwards, so that the account already includes the grab when the caller
 * returns. */
static void serve_hands(live *l)
{
    pthread_mutex_lock(&l->lock);
    answer_grabs(l);
    release_hands(l);
    if (l->changed)
        measure(l);
    pthread_mutex_unlock(&l->lock);
}

static bool has_surfaces(const live *l)
{
    bool all = true;
    for (size_t i = 0; l->motion && i < scene_motion_count(l->motion); i++)
        all &= l->snapshot->meshes[scene_motion_mesh(l->motion, i)].data != NULL;
    return all;
}

/* A body without a surface, because vertices became NaN or infinite, is useless: the scene gets its original surface
 * back. */
static void stop(live *l, const diagnostic *why)
{
    if (!has_surfaces(l))
        end(l);
    fail(l, why);
}

status live_advance(live *l, double most_s, bool *state_changed, diagnostic *why)
{
    *state_changed = false;
    if (!l->snapshot)
        return STATUS_OK;
    live_mode mode;
    diagnostic bad = {.what = ""};
    status code = apply_commands(l, &mode, &bad);
    serve_hands(l);
    if (code == STATUS_OK && live_is_moving(l) && l->motion)
        code = live_move_on(l, most_s, &bad);
    else
        live_reset_clock(l);
    if (code != STATUS_OK)
        stop(l, &bad);
    pthread_mutex_lock(&l->lock);
    measure(l);
    pthread_mutex_unlock(&l->lock);
    *state_changed = l->changed;
    l->changed = false;
    if (code == STATUS_OK || code == STATUS_BAD_INPUT)
        return STATUS_OK; /* reported by live_json */
    if (why)
        *why = bad;
    return code;
}

bool live_take_moved(live *l)
{
    const bool moved = l->moved;
    l->moved = false;
    return moved;
}
