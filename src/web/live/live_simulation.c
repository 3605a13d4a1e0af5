/* The render worker's side of the live slime: its motion, its scene, the commands and the hands. */
#include "measure/clock.h"
#include "scene/model/scene.h"
#include "web/live/live_private.h"

#include <math.h>
#include <stdlib.h>

/* --- motion: simulates the elapsed wall time, as far as the computation keeps up, until the slime is at rest --- */

/* The longest time that one call simulates, so that the slime does not catch up after a pause without rendering; and
 * the time that the first call simulates, one frame at 60 Hz. */
static const double max_gap_s = 0.25, first_s = 1.0 / 60.0;

/* Resets the motion's clock and rates. */
static void reset_clock(live *l)
{
    l->moved_at_s = NAN;
    l->realtime = 0.0;
    l->quiet_s = 0.0;
}

static const mesh_entry *entry_of(const live *l, size_t i)
{
    return &l->snapshot->meshes[scene_motion_mesh(l->motion, i)];
}

static double longest_step_s(const live *l)
{
    double step_s = 0.0;
    for (size_t i = 0; i < scene_motion_count(l->motion); i++)
        step_s = fmax(step_s, entry_of(l, i)->slime.dt_s);
    return step_s;
}

/* The time to simulate before the clock is read again. */
static double slice_s(const live *l, double most_s, double left_s)
{
    const double slices = 8.0 /* per time budget, which is exceeded by about one slice at most */,
                 step_s = longest_step_s(l);
    const double affordable_s = l->cost > 0.0 ? most_s / slices / l->cost : step_s;
    return fmin(left_s, fmax(step_s, affordable_s));
}

/* Moves the hands by a fraction of the remaining offset. */
static void move_hands(live *l, double fraction)
{
    pthread_mutex_lock(&l->lock);
    for (int i = 0; i < LIVE_HANDS_MAX; i++) {
        const live_hand *known = &l->live_hands[i];
        if (known->id == 0)
            continue;
        motion_hand *h = &l->motion_hands[known->slime * SOFTBODY_HANDS_MAX + (size_t)known->number];
        const vec3 offset = vec3_sub(motion_hand_offset(h, known->by), h->from);
        h->to = fraction >= 1.0 ? motion_hand_offset(h, known->by) : vec3_add(h->from, vec3_scale(offset, fraction));
    }
    pthread_mutex_unlock(&l->lock);
}

static status step_to(live *l, double time_s, diagnostic *why)
{
    for (size_t i = 0; i < scene_motion_count(l->motion); i++)
        TRY(scene_motion_step_held(l->motion, i, &l->motion_hands[i * SOFTBODY_HANDS_MAX], time_s, NULL, why));
    return scene_motion_advance(l->motion, time_s, false, why);
}

/* If a script's hand misses a solid that the user dragged away, the scripts are dropped without an error. */
static status step_script_tolerant(live *l, double time_s, diagnostic *why)
{
    const status code = step_to(l, time_s, why);
    if (code != STATUS_BAD_INPUT || !scene_motion_drop_scripts(l->motion))
        return code;
    *why = (diagnostic){.what = ""};
    return step_to(l, time_s, why);
}

/* Simulates in slices until that time, or until the time budget is used up. */
static status advance_until(live *l, double until_s, double most_s, diagnostic *why)
{
    const double start_s = clock_wall_s();
    double slice_start_s = start_s;
    for (status code; l->time_s < until_s && slice_start_s - start_s < most_s;) {
        const double left_s = until_s - l->time_s, now_s = slice_s(l, most_s, left_s);
        const double to_s = now_s < left_s ? l->time_s + now_s : until_s;
        move_hands(l, now_s / left_s);
        code = step_script_tolerant(l, to_s, why);
        if (code != STATUS_OK)
            return code;
        l->time_s = to_s;
        const double slice_end_s = clock_wall_s(), cost = (slice_end_s - slice_start_s) / now_s, recent = 0.3;
        l->cost = l->cost > 0.0 ? l->cost + recent * (cost - l->cost) : cost;
        slice_start_s = slice_end_s;
    }
    return STATUS_OK;
}

/* Whether the slimes hardly move, apart from the speed that a vertex on the floor gains and loses in each step. */
static bool is_quiet(const live *l)
{
    const double rest_speed = 0.1; /* radii per second; a slower wobble moves the surface by less than a pixel */
    bool quiet = l->time_s >= scene_motion_script_end_s(l->motion);
    for (size_t i = 0; i < scene_motion_count(l->motion) && quiet; i++) {
        const softbody_settings *settings = &entry_of(l, i)->slime;
        const softbody_quantities measured = entry_of(l, i)->account;
        quiet = measured.held == 0 && measured.speed_max < rest_speed * settings->radius +
                                                               4.0 * vec3_length(settings->gravity) * settings->dt_s;
    }
    return quiet;
}

/* Reports a slime at rest after rest_s of quiet. A swinging body may be at its turning point at the end of a long step,
 * so one sample counts for at most poll_s. */
static void watch_rest(live *l, double simulated_s)
{
    const double rest_s = 0.25, poll_s = rest_s / 8.0;
    l->quiet_s = is_quiet(l) ? l->quiet_s + fmin(simulated_s, poll_s) : 0.0;
    if (l->quiet_s < rest_s)
        return;
    pthread_mutex_lock(&l->lock);
    l->report.resting = true;
    pthread_mutex_unlock(&l->lock);
    l->changed = true;
}

/* Simulates the wall time since the last call, with at most about most_s of computation. The caller does not hold the
 * lock. STATUS_BAD_INPUT: the body diverged. */
static status simulate_elapsed(live *l, double most_s, diagnostic *why)
{
    const double now_s = clock_wall_s(), before_s = l->time_s;
    const bool was_moving = !isnan(l->moved_at_s);
    const double elapsed_s = was_moving ? now_s - l->moved_at_s : first_s;
    l->moved_at_s = now_s;
    status code = advance_until(l, before_s + fmin(elapsed_s, max_gap_s), most_s, why);
    if (code != STATUS_OK)
        return code; /* surfaces keep their last shape */
    TRY(scene_motion_advance(l->motion, l->time_s, true, why));
    const double simulated_s = l->time_s - before_s, memory_s = 0.5;
    if (was_moving && elapsed_s > 0.0)
        l->realtime += (simulated_s / elapsed_s - l->realtime) * fmin(1.0, elapsed_s / memory_s);
    else
        l->realtime = 1.0;
    l->moved = true;
    watch_rest(l, simulated_s);
    return STATUS_OK;
}

/* --- the scene --- */

/* Releases all hands. The caller holds the lock. */
static void forget_hands(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        l->live_hands[i] = (live_hand){.id = 0};
}

static void measure(live *l)
{
    live_report *a = &l->report;
    a->time_s = l->time_s;
    a->realtime = l->realtime;
    a->speed = a->volume = a->volume_at_rest = 0.0;
    a->held_vertices = 0;
    for (size_t i = 0; l->motion && i < scene_motion_count(l->motion); i++) {
        const softbody_quantities measured = softbody_measure(scene_motion_body(l->motion, i));
        a->speed = fmax(a->speed, measured.speed_max);
        a->volume += measured.volume;
        a->volume_at_rest += measured.volume_at_rest;
        a->held_vertices += measured.held;
    }
}

static void forget_motion(live *l)
{
    l->motion = NULL;
    free(l->motion_hands);
    l->motion_hands = NULL;
    l->time_s = 0.0;
    l->cost = 0.0;
    reset_clock(l);
    l->moved = l->changed = true;
    pthread_mutex_lock(&l->lock);
    forget_hands(l);
    l->report = (live_report){.has_slime = l->report.has_slime};
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
    l->report.in_trouble = true;
    l->report.trouble = *why;
    l->report.resting = false;
    pthread_mutex_unlock(&l->lock);
    l->changed = true;
}

static status begin(live *l, diagnostic *why)
{
    diagnostic bad = {.what = ""};
    status code = scene_motion_create(l->snapshot, &l->motion, &bad);
    if (code == STATUS_OK) {
        l->motion_hands = calloc(scene_motion_count(l->motion) * SOFTBODY_HANDS_MAX, sizeof *l->motion_hands);
        code = l->motion_hands ? STATUS_OK : out_of_memory(&bad);
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

/* Moves the simulation to a new snapshot, or starts a new one if the slimes differ in names or parameters. */
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
    l->report.has_slime = scene_moves(snapshot);
    if (!l->report.has_slime && !l->requested) /* a pending command may be for a scene to come */
        l->mode = LIVE_IS_OFF;
    const bool still = l->mode == LIVE_IS_OFF || !l->report.has_slime;
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
    const double fraction = 0.3;
    const vec3 scale = l->snapshot->solids[place->solid].shape.scale;
    const double radius = l->snapshot->meshes[scene_motion_mesh(l->motion, index)].slime.radius;
    return q->reach > 0.0 ? q->reach : fraction * radius * fmax(fabs(scale.x), fmax(fabs(scale.y), fabs(scale.z)));
}

static live_hand *free_hand(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++)
        if (l->live_hands[i].id == 0)
            return &l->live_hands[i];
    return NULL;
}

static status grab(live *l, grab_request *q)
{
    q->hand = LIVE_MISSED;
    if (!l->motion || l->report.in_trouble)
        return diagnose(q->why, STATUS_BAD_INPUT, "restart the slime", "the slime is not live");
    size_t index = 0;
    motion_place place;
    status code = pick(l, q, &index, &place, q->why);
    if (code != STATUS_OK || isinf(place.distance))
        return code;
    live_hand *h = free_hand(l);
    int number = 0;
    TRY(h ? scene_motion_grab(l->motion, index, &place, reach_of(l, q, index, &place),
                              &l->motion_hands[index * SOFTBODY_HANDS_MAX], &number, q->why)
          : diagnose(q->why, STATUS_BAD_INPUT, "release a hand first", "no hand is free"));
    *h = (live_hand){.id = ++l->last_id, .slime = index, .number = number, .where = place.where};
    q->hand = h->id;
    q->where = place.where;
    l->report.resting = false;
    l->quiet_s = 0.0;
    l->changed = true;
    return STATUS_OK;
}

static void release_hands(live *l)
{
    for (int i = 0; i < LIVE_HANDS_MAX; i++) {
        live_hand *h = &l->live_hands[i];
        if (!h->released)
            continue;
        scene_motion_release(l->motion, h->slime, &l->motion_hands[h->slime * SOFTBODY_HANDS_MAX], h->number);
        *h = (live_hand){.id = 0};
        l->report.resting = false;
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

/* Applies the mode, and a restart requested since the last call: ends the simulation, or begins it if the scene
 * moves. */
static status apply_commands(live *l, live_mode *mode, diagnostic *why)
{
    pthread_mutex_lock(&l->lock);
    *mode = l->mode;
    const bool restart = l->restart, trouble = l->report.in_trouble;
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

/* Serves grabs and releases, then measures, so that the report includes the grab when live_grab returns. */
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
        code = simulate_elapsed(l, most_s, &bad);
    else
        reset_clock(l);
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

bool live_fetch_moved(live *l)
{
    const bool moved = l->moved;
    l->moved = false;
    return moved;
}
