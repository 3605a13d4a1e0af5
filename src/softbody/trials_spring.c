/* A single spring. Along its own line it is linear for any amplitude, so its motion follows a recurrence of second
 * order, and the integrators' closed forms hold to rounding. */
#include "softbody/trials_private.h"

enum { SAMPLES = 64 };
#define SWING \
    1e-3 /* of the length at rest: the ends do not meet even where a step near its limit makes the swing hundreds of \
            times longer */

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
    softbody_settings s = trial_alone(t);
    recording r = {.stride = (uint64_t)fmin(fmax(floor(1.0 / (omega * s.dt_s)), 1.0), 20000 / SAMPLES)};
    softbody *b;
    bool held;
    double factor, angle;
    status code = trial_swing(t, &s, SWING, &b);
    THEN(code, trial_run(b, r.stride * SAMPLES, record, &r, &held, t));
    if (code == STATUS_OK && held && fit_swing(&r, &factor, &angle)) {
        *period_s = 2.0 * M_PI * (double)r.stride * s.dt_s / angle;
        *decay = pow(factor, 1.0 / (double)r.stride);
    }
    softbody_destroy(b);
    return code;
}

/* Distance in (q, p) from the exact state after a quarter period, (0, -1) amplitudes, starting at (1, 0). Both matter:
 * in the positions of the semi-implicit method alone the first order cancels when starting at rest. */
static status quarter_error(const trials *t, double omega, uint64_t steps, double *error)
{
    softbody_settings s = trial_alone(t);
    softbody *b;
    bool held;
    s.dt_s = 0.5 * M_PI / omega / (double)steps;
    status code = trial_swing(t, &s, SWING, &b);
    THEN(code, trial_run(b, steps, NULL, NULL, &held, t));
    if (code == STATUS_OK && held) {
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
    double whole = NAN, half = NAN;
    status code = quarter_error(t, omega, steps, &whole);
    THEN(code, quarter_error(t, omega, 2 * steps, &half));
    trial_put(t, SPRING_ORDER, log2(whole / half), t->set->integrator == SOFTBODY_VERLET ? 2.0 : 1.0);
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
