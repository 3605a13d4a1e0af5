/* Trials of a single spring, and the longest stable steps of a spring and of the toy. */
#include "base/random.h"
#include "softbody/trials.h"

/* --- the period, decay and order of a spring ---
 *
 * Along its own line a spring is linear for any amplitude, so its motion follows a recurrence of second order, and the
 * integrators' closed forms hold to rounding. */

enum { SAMPLES = 64 };
/* Amplitude over the length at rest: the ends do not meet, even if a step near its limit makes the swing hundreds of
 * times longer. */
#define SWING 1e-3

typedef struct recording {
    uint64_t stride, step;
    int count;
    double q[SAMPLES];
} recording;

static bool record(const softbody *b, void *context)
{
    recording *r = context;
    if (++r->step % r->stride == 0)
        r->q[r->count++] = trial_swing_state(b, 1.0).q;
    return r->count < SAMPLES;
}

/* q[n + 1] = a q[n] + b q[n - 1] by least squares (de Prony, 1795): for a sampled oscillation with factor r and angle
 * phi per sample, a = 2 r cos phi and b = -r^2. */
static bool fit_swing(const recording *s, double *factor, double *angle)
{
    double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
    for (int i = 1; i + 1 < s->count; i++) {
        aa += s->q[i] * s->q[i];
        ab += s->q[i] * s->q[i - 1];
        bb += s->q[i - 1] * s->q[i - 1];
        ay += s->q[i] * s->q[i + 1];
        by += s->q[i - 1] * s->q[i + 1];
    }
    const double det = aa * bb - ab * ab, a = (ay * bb - by * ab) / det, b = (by * aa - ay * ab) / det;
    *factor = sqrt(-b);
    *angle = acos(a / (2.0 * *factor));
    return det > 0.0 && b < 0.0 && fabs(a) < 2.0 * *factor;
}

/* About one sample per radian: closer samples make the fit ill-conditioned, and the phase must not advance by pi
 * between two. */
static status measure_period(const trials *t, double omega, double *period_s, double *decay)
{
    softbody_settings s = trial_free_settings(t);
    recording r = {.stride = (uint64_t)fmin(fmax(floor(1.0 / (omega * s.dt_s)), 1.0), 20000 / SAMPLES)};
    softbody *b;
    bool completed;
    double factor, angle;
    status code = trial_swing(t, &s, SWING, &b);
    THEN(code, trial_run(b, r.stride * SAMPLES, record, &r, &completed, t));
    if (code == STATUS_OK && completed && fit_swing(&r, &factor, &angle)) {
        *period_s = 2.0 * M_PI * (double)r.stride * s.dt_s / angle;
        *decay = pow(factor, 1.0 / (double)r.stride);
    }
    softbody_destroy(b);
    return code;
}

/* Distance in (q, p) from the exact state after a quarter period, (0, -1) amplitudes, starting at (1, 0). Both q and p
 * matter: in a motion that starts at rest, the first order cancels in the positions of the semi-implicit method. */
static status quarter_error(const trials *t, double omega, uint64_t steps, double *error)
{
    softbody_settings s = trial_free_settings(t);
    softbody *b;
    bool completed;
    s.dt_s = 0.5 * M_PI / omega / (double)steps;
    status code = trial_swing(t, &s, SWING, &b);
    THEN(code, trial_run(b, steps, NULL, NULL, &completed, t));
    if (code == STATUS_OK && completed) {
        const swing_state end = trial_swing_state(b, omega);
        *error = hypot(end.q, end.p + SWING) / SWING;
    }
    softbody_destroy(b);
    return code;
}

/* Steps short enough to hide the next order (64 in a quarter, or dt_s if that is shorter), and long enough to hide
 * rounding (1024). */
static status measure_order(const trials *t, double omega)
{
    const double wanted = ceil(0.5 * M_PI / omega / t->set->dt_s);
    const uint64_t steps = (uint64_t)fmin(fmax(wanted, 64.0), 1024.0);
    double full_step = NAN, half_step = NAN;
    status code = quarter_error(t, omega, steps, &full_step);
    THEN(code, quarter_error(t, omega, 2 * steps, &half_step));
    trial_put(t, SPRING_ORDER, log2(full_step / half_step), t->set->integrator == SOFTBODY_VERLET ? 2.0 : 1.0);
    return code;
}

status trials_spring(const trials *t)
{
    const double omega = trial_omega(t->set), dt = t->set->dt_s, angle = omega * dt;
    const bool implicit = t->set->integrator == SOFTBODY_IMPLICIT;
    if (!(omega > 0.0))
        return STATUS_OK;
    double period_s = NAN, decay = NAN;
    status code = STATUS_OK;
    if (implicit || angle < 2.0)
        code = measure_period(t, omega, &period_s, &decay);
    trial_put(t, SPRING_PERIOD, period_s, 2.0 * M_PI / omega);
    trial_put(t, SPRING_PERIOD_DISCRETE, period_s,
              implicit      ? 2.0 * M_PI * dt / atan(angle)
              : angle < 2.0 ? M_PI * dt / asin(0.5 * angle)
                            : NAN);
    trial_put(t, SPRING_DECAY, decay, implicit ? 1.0 / sqrt(1.0 + angle * angle) : angle < 2.0 ? 1.0 : NAN);
    return code == STATUS_OK ? measure_order(t, omega) : code;
}

/* --- the longest stable step, by bisection --- */

enum { STEPS = 1000, LOOK = 50, WIDENINGS = 12 };

typedef status holds_at(const trials *t, double dt_s, bool *holds);

/* Expands from a guess until one end is stable and the other is not, then bisects. *out is the stable end; it is
 * unchanged if there is no limit within a factor of 4096. */
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
 * grows by at most sqrt(2 / (1 - omega dt / 2)): a thousandfold only at 2e-6 from the limit. Above the limit it grows
 * by exp(2 acosh(omega dt / 2)) per step: a thousandfold in 1000 steps from 6e-6. */
static status spring_holds(const trials *t, double dt_s, bool *holds)
{
    softbody_settings s = trial_free_settings(t);
    s.dt_s = dt_s;
    swing_watch w = {.omega = trial_omega(t->set)};
    bool completed = false;
    softbody *b;
    status code = trial_swing(t, &s, FIRST_SWING, &b);
    THEN(code, trial_run(b, STEPS, watch_swing, &w, &completed, t));
    *holds = completed && !w.grown;
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

/* Displaces a mass at rest by up to 1e-4 of the radius, so that all modes are excited. */
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
    softbody_settings s = trial_free_settings(t);
    s.dt_s = dt_s;
    growth g = {0};
    bool completed = false;
    softbody *b;
    status code = softbody_create(&s, t->level, &b, t->why);
    if (code == STATUS_OK)
        code = trial_each_mass(b, shake, &(double){2e-4 * t->set->radius}, true, t->why);
    if (code == STATUS_OK) {
        g.first = trial_energy(b);
        code = trial_run(b, STEPS, watch_energy, &g, &completed, t);
    }
    *holds = completed && !g.grown;
    softbody_destroy(b);
    return code;
}

static status measure_toy(const trials *t)
{
    const softbody_settings s = trial_free_settings(t);
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
