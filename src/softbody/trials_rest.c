/* The toy at rest on its floor: its volume, and the time of a step. */
#include "softbody/trials_private.h"

#include "measure/clock.h"
#include "measure/statistics.h"

enum { TIMED = 64 };

typedef struct timing {
    double last_s, wall_s[TIMED];
    int count;
} timing;

static bool watch_clock(const softbody *b, void *context)
{
    (void)b;
    timing *w = context;
    const double now_s = clock_wall_s();
    w->wall_s[w->count++] = now_s - w->last_s;
    w->last_s = now_s;
    return w->count < TIMED;
}

static status time_steps(const trials *t, softbody *b)
{
    const uint64_t before = softbody_measure(b).substeps;
    timing w = {.last_s = clock_wall_s()};
    bool held;
    const status code = trial_run(b, TIMED, watch_clock, &w, &held, t);
    if (code != STATUS_OK || !held)
        return code;
    const double step_s = summarize(w.wall_s, TIMED).median;
    trial_put(t, RATE_SUBSTEPS, (double)(softbody_measure(b).substeps - before) / TIMED, NAN);
    trial_put(t, RATE_STEP, step_s, NAN);
    trial_put(t, RATE_SIMULATED, t->set->dt_s / step_s, NAN);
    return code;
}

status trials_rest(const trials *t)
{
    softbody_settings s = *t->set;
    s.velocity = vec3_make(0.0, 0.0, 0.0);
    s.position = vec3_make(0.0, s.radius, 0.0);
    s.ground = 1;
    s.ground_y = 0.0;
    softbody *b;
    bool held = false;
    status code = softbody_create(&s, t->level, &b, t->why);
    THEN(code, trial_run(b, trial_steps(&s, 3.0), NULL, NULL, &held, t));
    if (code == STATUS_OK && held) {
        const softbody_account a = softbody_measure(b);
        trial_put(t, VOLUME_DRIFT, a.volume / a.volume_at_rest - 1.0, 0.0);
        code = time_steps(t, b);
    } else {
        trial_put(t, VOLUME_DRIFT, NAN, 0.0);
    }
    softbody_destroy(b);
    return code;
}
