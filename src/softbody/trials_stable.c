/* The longest stable step, by bisection. */
#include "softbody/trials_private.h"

#include "base/random.h"

enum { STEPS = 1000, LOOK = 50, WIDENINGS = 12 };

typedef status holds_at(const trials *t, double dt_s, bool *holds);

/* Expands from a guess until one end is stable and the other is not; NaN if there is no limit within a factor of 4096.
 * */
static status find_limit(const trials *t, holds_at *try_it, double guess_s, int halvings, double *out)
{
    double low = guess_s, high = guess_s;
    bool holds;
    status code = try_it(t, guess_s, &holds);
    const bool upwards = holds;
    for (int i = 0; code == STATUS_OK && holds == upwards && i < WIDENINGS; i++) {
        *(upwards ? &low : &high) = upwards ? high : low;
        *(upwards ? &high : &low) *= upwards ? 2.0 : 0.5;
        code = try_it(t, upwards ? high : low, &holds);
    }
    if (code != STATUS_OK || holds == upwards)
        return code;
    for (int i = 0; code == STATUS_OK && i < halvings; i++) {
        const double middle = 0.5 * (low + high);
        code = try_it(t, middle, &holds);
        *(holds ? &low : &high) = middle;
    }
    *out = low;
    return code;
}

#define FIRST_SWING 1e-6
#define GROWN 1e3

typedef struct swing_watch {
    double omega;
    bool grown;
} swing_watch;

static bool watch_swing(const softbody *b, void *context)
{
    swing_watch *w = context;
    const swing_state now = trial_swing_state(b, w->omega);
    w->grown = hypot(now.q, now.p) > GROWN * FIRST_SWING;
    return !w->grown;
}

/* Below the limit q^2 + p^2 - omega dt q p is conserved (verlet: p^2 + (1 - (omega dt / 2)^2) q^2), so the amplitude
 * grows by at most sqrt(2 / (1 - omega dt / 2)): a thousandfold only at 2e-6 from the limit; above it by exp(2
 * acosh(omega dt / 2)) per step: a thousandfold in 1000 steps from 6e-6. */
static status spring_holds(const trials *t, double dt_s, bool *holds)
{
    softbody_settings s = trial_alone(t);
    s.dt_s = dt_s;
    swing_watch w = {.omega = trial_omega(t->set)};
    bool held = false;
    softbody *b;
    status code = trial_swing(t, &s, FIRST_SWING, &b);
    THEN(code, trial_run(b, STEPS, watch_swing, &w, &held, t));
    *holds = held && !w.grown;
    softbody_destroy(b);
    return code;
}

typedef struct growth {
    double first;
    int step;
    bool grown;
} growth;

static bool watch_energy(const softbody *b, void *context)
{
    growth *g = context;
    if (++g->step % LOOK == 0)
        g->grown = trial_energy(b) > 4.0 * g->first;
    return !g->grown;
}

/* Displaces a mass by up to 1e-4 of the radius, so that all modes are excited; at rest. */
static void shake(const void *context, size_t i, vec3 *at, vec3 *velocity)
{
    const double *reach = context;
    const random_words r = random_at(1, (uint32_t)i, 0, 0, 0);
    const vec3 off =
        vec3_make(random_unit(r.word[0]) - 0.5, random_unit(r.word[1]) - 0.5, random_unit(r.word[2]) - 0.5);
    *at = vec3_add(*at, vec3_scale(off, *reach));
    *velocity = vec3_make(0.0, 0.0, 0.0);
}

static status toy_holds(const trials *t, double dt_s, bool *holds)
{
    softbody_settings s = trial_alone(t);
    s.dt_s = dt_s;
    growth g = {0};
    bool held = false;
    softbody *b;
    status code = softbody_create(&s, t->level, &b, t->why);
    if (code == STATUS_OK)
        code = trial_each_mass(b, shake, &(double){2e-4 * t->set->radius}, true, t->why);
    if (code == STATUS_OK) {
        g.first = trial_energy(b);
        code = trial_run(b, STEPS, watch_energy, &g, &held, t);
    }
    *holds = held && !g.grown;
    softbody_destroy(b);
    return code;
}

static status measure_toy(const trials *t)
{
    const softbody_settings s = trial_alone(t);
    softbody *b;
    status code = softbody_create(&s, t->level, &b, t->why);
    const double bound_s = code == STATUS_OK ? softbody_stable_dt_s(b) : NAN;
    softbody_destroy(b);
    double limit_s = NAN;
    if (code != STATUS_OK || !(bound_s < INFINITY))
        return code;
    code = find_limit(t, toy_holds, bound_s, 9, &limit_s);
    trial_put(t, STABLE_TOY, limit_s, bound_s);
    return code;
}

status trials_stable(const trials *t)
{
    const double omega = trial_omega(t->set);
    status code = STATUS_OK;
    if (t->set->integrator == SOFTBODY_IMPLICIT)
        return code;
    if (omega > 0.0) {
        double limit_s = NAN;
        code = find_limit(t, spring_holds, 1.0 / omega, 30, &limit_s);
        trial_put(t, STABLE_SPRING, limit_s, 2.0 / omega);
    }
    return code == STATUS_OK ? measure_toy(t) : code;
}
