/* Falls and bounces: of one mass, compared with Galilei and Newton, and of the toy. */
#include "softbody/trials_private.h"

static status measure_fall(const trials *t)
{
    softbody_settings s = trial_alone(t);
    s.gravity.y = t->set->gravity.y;
    const uint64_t steps = trial_steps(&s, 1.0);
    const double g = -s.gravity.y, time_s = (double)steps * s.dt_s;
    softbody *b;
    bool held;
    status code = trial_one_mass(t, &s, &b);
    THEN(code, trial_run(b, steps, NULL, NULL, &held, t));
    if (code == STATUS_OK) {
        vec3 at;
        softbody_positions(b, &at);
        const double depth = held ? -at.y : NAN, exact = 0.5 * g * time_s * time_s;
        trial_put(t, FALL_DEPTH, depth, exact);
        trial_put(t, FALL_DEPTH_DISCRETE, depth,
                  s.integrator == SOFTBODY_VERLET ? exact : exact + 0.5 * g * time_s * s.dt_s);
    }
    softbody_destroy(b);
    return code;
}

typedef struct bounce {
    double speed, high;
    bool up, done;
} bounce;

/* Down, up, and down again. */
static void follow(bounce *k, double y, double speed)
{
    if (!k->up && k->speed < 0.0 && speed >= 0.0)
        *k = (bounce){.up = true, .high = y};
    if (k->up) {
        k->high = fmax(k->high, y);
        k->done = speed < 0.0;
    }
    k->speed = speed;
}

static bool follow_mass(const softbody *b, void *context)
{
    vec3 at, velocity;
    softbody_positions(b, &at);
    softbody_velocities(b, &velocity);
    follow(context, at.y, velocity.y);
    return !((bounce *)context)->done;
}

static bool follow_body(const softbody *b, void *context)
{
    const softbody_account a = softbody_measure(b);
    follow(context, a.center.y, a.momentum.y);
    return !((bounce *)context)->done;
}

/* Time for a fall from a height, and three times as much again: the bounce is complete by then, and the body has
 * oscillated. It mostly ends earlier. */
static status run_bounce(softbody *b, const softbody_settings *s, double height, trial_watch *watch, double *high,
                         const trials *t)
{
    const double wanted = ceil(4.0 * sqrt(2.0 * height / -s->gravity.y) / s->dt_s);
    bounce k = {0};
    bool held;
    const status code = trial_run(b, (uint64_t)fmin(wanted, TRIAL_STEPS_MAX), watch, &k, &held, t);
    if (code == STATUS_OK && held && (k.done || (k.up && wanted <= TRIAL_STEPS_MAX)))
        *high = k.high;
    return code;
}

static softbody_settings over_floor(const trials *t, double height)
{
    softbody_settings s = trial_alone(t);
    s.gravity.y = t->set->gravity.y;
    s.ground = 1;
    s.ground_y = 0.0;
    s.position.y = height;
    return s;
}

static status bounce_of_mass(const trials *t, double *high)
{
    const softbody_settings s = over_floor(t, 1.0);
    softbody *b;
    status code = trial_one_mass(t, &s, &b);
    THEN(code, run_bounce(b, &s, 1.0, follow_mass, high, t));
    softbody_destroy(b);
    return code;
}

static status bounce_of_body(const trials *t, double *high)
{
    softbody_settings s = over_floor(t, 2.0 * t->set->radius);
    s.adaptive = t->set->adaptive;
    softbody *b;
    status code = softbody_create(&s, t->level, &b, t->why);
    THEN(code, run_bounce(b, &s, s.radius, follow_body, high, t));
    *high = (*high - s.radius) / s.radius;
    softbody_destroy(b);
    return code;
}

status trials_fall(const trials *t)
{
    return measure_fall(t);
}

status trials_bounce(const trials *t)
{
    if (!(t->set->gravity.y < 0.0))
        return STATUS_OK;
    double mass = NAN, body = NAN;
    status code = bounce_of_mass(t, &mass);
    THEN(code, bounce_of_body(t, &body));
    trial_put(t, BOUNCE_HEIGHT, mass, t->set->restitution * t->set->restitution);
    trial_put(t, BOUNCE_BODY, body, NAN);
    return code;
}
