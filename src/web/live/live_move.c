/* The motion of the live slime: simulates the elapsed wall time, as far as the computation keeps up, until the slime
 * is at rest. */
#include "web/live/live_private.h"

#include "measure/clock.h"
#include "scene/model/scene.h"
#include <math.h>

/* The most that one call simulates, so that a pause without rendering is not made up for; and the first call, one frame
 * at 60 Hz. */
static const double max_gap_s = 0.25, first_s = 1.0 / 60.0;

void live_reset_clock(live *l)
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

/* The simulated time before the clock is read again. */
static double slice_s(const live *l, double most_s, double left_s)
{
    const double slices = 8.0 /* of the time budget, which is exceeded by about one of them at most */,
                 step_s = longest_step_s(l);
    const double affordable_s = l->cost > 0.0 ? most_s / slices / l->cost : step_s;
    return fmin(left_s, fmax(step_s, affordable_s));
}

/* Moves the hands by a share of the remaining offset. */
static void move_hands(live *l, double share)
{
    pthread_mutex_lock(&l->lock);
    for (int i = 0; i < LIVE_HANDS_MAX; i++) {
        const live_hand *known = &l->held[i];
        if (known->id == 0)
            continue;
        motion_hand *h = &l->hands[known->slime * SOFTBODY_HANDS_MAX + (size_t)known->number];
        const vec3 offset = vec3_sub(motion_hand_offset(h, known->by), h->from);
        h->to = share >= 1.0 ? motion_hand_offset(h, known->by) : vec3_add(h->from, vec3_scale(offset, share));
    }
    pthread_mutex_unlock(&l->lock);
}

static status step_to(live *l, double time_s, diagnostic *why)
{
    for (size_t i = 0; i < scene_motion_count(l->motion); i++)
        TRY(scene_motion_step_held(l->motion, i, &l->hands[i * SOFTBODY_HANDS_MAX], time_s, NULL, why));
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

/* Ignores the speed that a vertex on the floor gains and loses in each step. */
static bool is_quiet(const live *l)
{
    const double rest_speed = 0.1; /* radii per second: a wobble of less than a pixel */
    bool quiet = l->time_s >= scene_motion_script_end_s(l->motion);
    for (size_t i = 0; i < scene_motion_count(l->motion) && quiet; i++) {
        const softbody_settings *set = &entry_of(l, i)->slime;
        const softbody_quantities a = entry_of(l, i)->account;
        quiet = a.held == 0 && a.speed_max < rest_speed * set->radius + 4.0 * vec3_length(set->gravity) * set->dt_s;
    }
    return quiet;
}

/* A swinging body may be at its turning point at the end of a long step, so one sample counts for at most poll_s. */
static void watch_rest(live *l, double simulated_s)
{
    const double rest_s = 0.25, poll_s = rest_s / 8.0;
    l->quiet_s = is_quiet(l) ? l->quiet_s + fmin(simulated_s, poll_s) : 0.0;
    if (l->quiet_s < rest_s)
        return;
    pthread_mutex_lock(&l->lock);
    l->account.resting = true;
    pthread_mutex_unlock(&l->lock);
    l->changed = true;
}

status live_move_on(live *l, double most_s, diagnostic *why)
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
