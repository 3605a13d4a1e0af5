/* Trials of the toy, and of one mass: falls and bounces, a free toy, a toy at rest. */
#include "measure/clock.h"
#include "measure/statistics.h"
#include "softbody/trials.h"

/* --- falls and bounces: of one mass, compared with Galilei and Newton, and of the toy --- */

static status measure_fall(const trials *t)
{
    softbody_settings s = trial_free_settings(t);
    s.gravity.y = t->set->gravity.y;
    const uint64_t steps = trial_steps(&s, 1.0);
    const double g = -s.gravity.y, time_s = (double)steps * s.dt_s;
    softbody *b;
    bool completed;
    status code = trial_one_mass(t, &s, &b);
    THEN(code, trial_run(b, steps, NULL, NULL, &completed, t));
    if (code == STATUS_OK) {
        vec3 at;
        softbody_positions(b, &at);
        const double depth = completed ? -at.y : NAN, exact = 0.5 * g * time_s * time_s;
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

/* Follows a bounce: down, up, and down again. */
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
    const softbody_quantities a = softbody_measure(b);
    follow(context, a.center.y, a.momentum.y);
    return !((bounce *)context)->done;
}

/* Runs for at most four times the duration of the fall from the height. If the bounce has not ended by then, the body
 * oscillates on the floor, and its greatest height counts. */
static status run_bounce(softbody *b, const softbody_settings *s, double height, trial_watch *watch, double *high,
                         const trials *t)
{
    const double wanted = ceil(4.0 * sqrt(2.0 * height / -s->gravity.y) / s->dt_s);
    bounce k = {0};
    bool completed;
    const status code = trial_run(b, (uint64_t)fmin(wanted, TRIAL_STEPS_MAX), watch, &k, &completed, t);
    if (code == STATUS_OK && completed && (k.done || (k.up && wanted <= TRIAL_STEPS_MAX)))
        *high = k.high;
    return code;
}

static softbody_settings over_floor(const trials *t, double height)
{
    softbody_settings s = trial_free_settings(t);
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

/* --- the toy in free space: its conserved quantities --- */

/* Estimated frequency of the whole body from the settings: all its stiffness over its mass. */
static double body_omega(const softbody_settings *s)
{
    return sqrt((s->stiffness + s->bending + s->through + s->pressure * s->radius) / s->mass_kg);
}

static status free_toy(const trials *t, double damping, const trial_field *field, softbody **out)
{
    softbody_settings s = trial_free_settings(t);
    s.adaptive = t->set->adaptive;
    s.damping = damping;
    TRY(softbody_create(&s, t->level, out, t->why));
    return trial_stir(*out, field, t->why);
}

typedef struct energies {
    double first, before, now, off, rise;
} energies;

static bool watch_energy(const softbody *b, void *context)
{
    energies *e = context;
    e->now = trial_energy(b);
    e->off = fmax(e->off, fabs(e->now - e->first));
    e->rise = fmax(e->rise, e->now - e->before);
    e->before = e->now;
    return true;
}

/* Follows the energy for 1 s; NaN if the motion diverges. */
static status follow_energy(const trials *t, double damping, energies *e)
{
    const trial_field field = {.wobble = 0.02 * body_omega(t->set)};
    softbody *b;
    bool completed = false;
    status code = free_toy(t, damping, &field, &b);
    if (code == STATUS_OK) {
        e->first = e->before = e->now = trial_energy(b);
        code = trial_run(b, trial_steps(t->set, 1.0), watch_energy, e, &completed, t);
    }
    if (!completed)
        *e = (energies){NAN, NAN, NAN, NAN, NAN};
    softbody_destroy(b);
    return code;
}

typedef struct momenta {
    softbody_quantities first;
    double off, angular_off;
} momenta;

static bool watch_momenta(const softbody *b, void *context)
{
    momenta *m = context;
    const softbody_quantities a = softbody_measure(b);
    m->off = fmax(m->off, vec3_length(vec3_sub(a.momentum, m->first.momentum)));
    m->angular_off = fmax(m->angular_off, vec3_length(vec3_sub(a.angular_momentum, m->first.angular_momentum)));
    return true;
}

/* Sums over the masses of |v| and |x cross v|. */
typedef struct sizes {
    double *speeds, *moments;
} sizes;

static void add_sizes(const void *context, size_t i, vec3 *at, vec3 *velocity)
{
    (void)i;
    const sizes *sum = context;
    *sum->speeds += vec3_length(*velocity);
    *sum->moments += vec3_length(vec3_cross(*at, *velocity));
}

static status follow_momenta(const trials *t)
{
    const double rate = 0.02 * body_omega(t->set), speed = rate * t->set->radius, mass_kg = trial_mass_kg(t->set);
    const trial_field field = {rate, vec3_make(2.0 * rate, rate, 3.0 * rate),
                               vec3_make(speed, -0.5 * speed, 0.25 * speed)};
    double speeds = 0.0, moments = 0.0;
    softbody *b;
    bool completed = false;
    momenta m = {0};
    status code = free_toy(t, t->set->damping, &field, &b);
    if (code == STATUS_OK)
        code = trial_each_mass(b, add_sizes, &(sizes){&speeds, &moments}, false, t->why);
    if (code == STATUS_OK) {
        m.first = softbody_measure(b);
        code = trial_run(b, trial_steps(t->set, 1.0), watch_momenta, &m, &completed, t);
    }
    trial_put(t, MOMENTUM_DRIFT, completed ? m.off / (mass_kg * speeds) : NAN, 0.0);
    trial_put(t, ANGULAR_MOMENTUM_DRIFT, completed ? m.angular_off / (mass_kg * moments) : NAN, 0.0);
    softbody_destroy(b);
    return code;
}

status trials_free(const trials *t)
{
    if (!(body_omega(t->set) > 0.0))
        return STATUS_OK;
    energies undamped = {0}, damped = {0};
    status code = follow_energy(t, 0.0, &undamped);
    THEN(code, follow_energy(t, t->set->damping, &damped));
    trial_put(t, ENERGY_DRIFT, undamped.off / undamped.first, 0.0);
    trial_put(t, ENERGY_END, undamped.now / undamped.first - 1.0, 0.0);
    trial_put(t, ENERGY_RISE, damped.rise / damped.first, 0.0);
    return code == STATUS_OK ? follow_momenta(t) : code;
}

/* --- the toy at rest on its floor: its volume, and the time of a step --- */

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
    bool completed;
    const status code = trial_run(b, TIMED, watch_clock, &w, &completed, t);
    if (code != STATUS_OK || !completed)
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
    bool completed = false;
    status code = softbody_create(&s, t->level, &b, t->why);
    THEN(code, trial_run(b, trial_steps(&s, 3.0), NULL, NULL, &completed, t));
    if (code == STATUS_OK && completed) {
        const softbody_quantities a = softbody_measure(b);
        trial_put(t, VOLUME_DRIFT, a.volume / a.volume_at_rest - 1.0, 0.0);
        code = time_steps(t, b);
    } else {
        trial_put(t, VOLUME_DRIFT, NAN, 0.0);
    }
    softbody_destroy(b);
    return code;
}
