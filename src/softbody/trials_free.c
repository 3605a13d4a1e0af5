/* The toy alone in space: its conserved quantities. */
#include "softbody/trials_private.h"

/* Estimated frequency of the whole body from the settings: all its stiffness over its mass. */
static double body_omega(const softbody_settings *s)
{
    return sqrt((s->stiffness + s->bending + s->through + s->pressure * s->radius) / s->mass_kg);
}

static status free_toy(const trials *t, double damping, const trial_field *field, softbody **out)
{
    softbody_settings s = trial_alone(t);
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

/* NaN if it diverges. */
static status follow_energy(const trials *t, double damping, energies *e)
{
    const trial_field field = {.wobble = 0.02 * body_omega(t->set)};
    softbody *b;
    bool held = false;
    status code = free_toy(t, damping, &field, &b);
    if (code == STATUS_OK) {
        e->first = e->before = e->now = trial_energy(b);
        code = trial_run(b, trial_steps(t->set, 1.0), watch_energy, e, &held, t);
    }
    if (!held)
        *e = (energies){NAN, NAN, NAN, NAN, NAN};
    softbody_destroy(b);
    return code;
}

typedef struct momenta {
    softbody_account first;
    double off, angular_off;
} momenta;

static bool watch_momenta(const softbody *b, void *context)
{
    momenta *m = context;
    const softbody_account a = softbody_measure(b);
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
    bool held = false;
    momenta m = {0};
    status code = free_toy(t, t->set->damping, &field, &b);
    if (code == STATUS_OK)
        code = trial_each_mass(b, add_sizes, &(sizes){&speeds, &moments}, false, t->why);
    if (code == STATUS_OK) {
        m.first = softbody_measure(b);
        code = trial_run(b, trial_steps(t->set, 1.0), watch_momenta, &m, &held, t);
    }
    trial_put(t, MOMENTUM_DRIFT, held ? m.off / (mass_kg * speeds) : NAN, 0.0);
    trial_put(t, ANGULAR_MOMENTUM_DRIFT, held ? m.angular_off / (mass_kg * moments) : NAN, 0.0);
    softbody_destroy(b);
    return code;
}

status trials_free(const trials *t)
{
    if (!(body_omega(t->set) > 0.0))
        return STATUS_OK;
    energies kept = {0}, damped = {0};
    status code = follow_energy(t, 0.0, &kept);
    THEN(code, follow_energy(t, t->set->damping, &damped));
    trial_put(t, ENERGY_DRIFT, kept.off / kept.first, 0.0);
    trial_put(t, ENERGY_END, kept.now / kept.first - 1.0, 0.0);
    trial_put(t, ENERGY_RISE, damped.rise / damped.first, 0.0);
    return code == STATUS_OK ? follow_momenta(t) : code;
}
