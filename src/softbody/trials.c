/* The table of trials, the selection of those to run, and the code that all use: bodies, steps, observed quantities. */
#include "softbody/trials.h"
#include "base/cancel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* HLW: Hairer, Lubich, Wanner, "Geometric numerical integration", 2nd edition. */
static const struct {
    const char *name, *unit, *what;
} trial_table[SOFTBODY_TRIAL_COUNT] = {
    [SPRING_PERIOD] = {"spring.period_s", "s",
                       "two masses on one spring: period; theory 2 pi sqrt(m / 2k) (Goldstein 3.1)"},
    [SPRING_PERIOD_DISCRETE] =
        {"spring.period_discrete_s", "s",
         "two masses on one spring: period; theory of the integrator: pi dt / asin(omega dt / 2), "
         "implicit 2 pi dt / atan(omega dt) (HLW I.1)"},
    [SPRING_DECAY] = {"spring.decay", "",
                      "growth of the amplitude in one step; theory 1, implicit 1 / sqrt(1 + (omega dt)^2) (HLW "
                      "I.1)"},
    [SPRING_ORDER] = {"spring.order", "",
                      "order of convergence: log2 of the error with dt over that with dt / 2, after a quarter "
                      "period; theory 1, verlet 2 (HLW I.1)"},
    [FALL_DEPTH] = {"fall.depth", "scene units", "fall of one mass in 1 s (whole steps); theory g t^2 / 2 (Galilei)"},
    [FALL_DEPTH_DISCRETE] =
        {"fall.depth_discrete", "scene units",
         "fall of one mass in 1 s (whole steps); theory of the integrator: g t (t + dt) / 2, verlet "
         "g t^2 / 2"},
    [BOUNCE_HEIGHT] = {"bounce.height", "scene units",
                       "rebound height of a mass that falls by 1; theory restitution^2 (Newton)"},
    [BOUNCE_BODY] = {"bounce.body", "",
                     "rebound of the toy's centre above its height at rest, as a fraction of its fall of one radius"},
    [ENERGY_DRIFT] = {"energy.drift", "", "free toy without damping, 1 s: largest |E - E0| / E0; theory 0"},
    [ENERGY_END] = {"energy.end", "", "free toy without damping, after 1 s: E / E0 - 1; theory 0"},
    [ENERGY_RISE] = {"energy.rise", "",
                     "free toy with damping, 1 s: largest rise of E from one step to the next, over E0; theory 0"},
    [MOMENTUM_DRIFT] = {"momentum.drift", "",
                        "rotating free toy, 1 s: largest change of momentum over the sum of |m v|; theory 0"},
    [ANGULAR_MOMENTUM_DRIFT] =
        {"angular_momentum.drift", "",
         "rotating free toy, 1 s: largest change of angular momentum over the sum of |m x cross v|; "
         "theory 0"},
    [VOLUME_DRIFT] = {"volume.drift", "",
                      "toy after 3 s on its floor: relative change of volume; theory 0, for infinite pressure"},
    [STABLE_SPRING] = {"stable_dt.spring_s", "s",
                       "largest stable dt of the spring; theory 2 / omega; none for implicit"},
    [STABLE_TOY] = {"stable_dt.toy_s", "s",
                    "largest stable dt of the free toy, 1000 steps; theory a lower bound (Gershgorin); none "
                    "for implicit"},
    [RATE_SUBSTEPS] = {"rate.substeps", "", "substeps of a step, on the floor"},
    [RATE_STEP] = {"rate.step_s", "s", "wall time of a step: median of 64"},
    [RATE_SIMULATED] = {"rate.simulated_s_per_s", "", "simulated over wall time"},
};

static const struct {
    const char *starts; /* of the names of its values */
    status (*run)(const trials *t);
} groups[] = {{"spring.", trials_spring},     {"fall.", trials_fall},
              {"bounce.", trials_bounce},     {"energy. momentum. angular_momentum.", trials_free},
              {"volume. rate.", trials_rest}, {"stable_dt.", trials_stable}};

/* Whether a group measures the value of a name; NULL: any value. */
static bool measures(size_t group, const char *name)
{
    char start[32] = "";
    if (name)
        snprintf(start, sizeof start, "%.*s.", (int)strcspn(name, "."), name);
    return strstr(groups[group].starts, start);
}

static int find_trial(const char *name)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++)
        if (strcmp(trial_table[i].name, name) == 0)
            return i;
    return -1;
}

static status run_groups(const trials *t, const char *name)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++)
        t->out->value[i] = (softbody_trial){trial_table[i].name, trial_table[i].unit, trial_table[i].what, NAN, NAN};
    TRY(softbody_check(t->set, t->why));
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++)
        if (measures(i, name))
            TRY(groups[i].run(t));
    return STATUS_OK;
}

status softbody_trials(const softbody_settings *s, isa level, softbody_trial_report *out, diagnostic *why)
{
    const trials t = {s, level, out, why};
    return run_groups(&t, NULL);
}

bool softbody_has_trial(const char *name)
{
    return find_trial(name) >= 0;
}

status softbody_trial_one(const softbody_settings *s, isa level, const char *name, softbody_trial *out, diagnostic *why)
{
    softbody_trial_report report;
    const trials t = {.set = s, .level = level, .out = &report, .why = why};
    const int which = find_trial(name);
    if (which < 0)
        return diagnose(why, STATUS_BAD_INPUT, "list the values with 'cuvette motion SCENE'", "unknown value '%.64s'",
                        name);
    TRY(run_groups(&t, name));
    *out = report.value[which];
    return STATUS_OK;
}

double softbody_trial_error(const softbody_trial *t)
{
    return fabs(t->measured - t->theory);
}

/* --- bodies, steps, quantities --- */

softbody_settings trial_free_settings(const trials *t)
{
    softbody_settings s = *t->set;
    s.position = s.velocity = s.gravity = vec3_make(0.0, 0.0, 0.0);
    s.ground = s.adaptive = 0;
    return s;
}

double trial_mass_kg(const softbody_settings *s)
{
    return s->mass_kg / (double)((INT64_C(10) << 2 * s->level) + 2);
}

double trial_omega(const softbody_settings *s)
{
    return sqrt(s->stiffness / (0.5 * trial_mass_kg(s)));
}

uint64_t trial_steps(const softbody_settings *s, double time_s)
{
    const double steps = fmax(floor(time_s / s->dt_s + 0.5), 1.0);
    return steps <= TRIAL_STEPS_MAX ? (uint64_t)steps : 0;
}

status trial_run(softbody *b, uint64_t steps, trial_watch *watch, void *context, bool *completed, const trials *t)
{
    diagnostic bad = {.what = ""};
    *completed = steps > 0;
    for (uint64_t i = 0; i < steps; i++) {
        TRY(cancel_check(t->why));
        const status code = softbody_step(b, &bad);
        if (code == STATUS_BAD_INPUT) {
            *completed = false;
            return STATUS_OK;
        }
        if (code != STATUS_OK)
            return diagnose(t->why, code, bad.remedy, "%s", bad.what);
        if (watch && !watch(b, context))
            break;
    }
    return STATUS_OK;
}

double trial_energy(const softbody *b)
{
    const softbody_quantities a = softbody_measure(b);
    return a.kinetic + a.elastic + a.compression;
}

status trial_one_mass(const trials *t, const softbody_settings *s, softbody **out)
{
    const double mass_kg = trial_mass_kg(s);
    const softbody_net net = {.mass_count = 1, .position = &s->position, .mass_kg = &mass_kg};
    return softbody_create_net(&net, s, t->level, out, t->why);
}

status trial_swing(const trials *t, const softbody_settings *s, double swing, softbody **out)
{
    const double half = 0.5 * (1.0 + swing), mass_kg[2] = {trial_mass_kg(s), trial_mass_kg(s)};
    const vec3 position[2] = {{-half, 0.0, 0.0}, {half, 0.0, 0.0}};
    const softbody_spring spring = {{0, 1}, 1.0, s->stiffness, 0.0};
    const softbody_net net = {
        .mass_count = 2, .spring_count = 1, .position = position, .mass_kg = mass_kg, .springs = &spring};
    return softbody_create_net(&net, s, t->level, out, t->why);
}

swing_state trial_swing_state(const softbody *b, double omega)
{
    vec3 at[2], velocity[2];
    softbody_positions(b, at);
    softbody_velocities(b, velocity);
    return (swing_state){at[1].x - at[0].x - 1.0, (velocity[1].x - velocity[0].x) / omega};
}

status trial_each_mass(softbody *b, trial_mass *act, const void *context, bool place, diagnostic *why)
{
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at), *velocity = malloc(count * sizeof *velocity);
    const bool complete = at && velocity;
    if (complete) {
        softbody_positions(b, at);
        softbody_velocities(b, velocity);
        for (size_t i = 0; i < count; i++)
            act(context, i, &at[i], &velocity[i]);
    }
    if (complete && place)
        softbody_place(b, at, velocity);
    free(at);
    free(velocity);
    return complete ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory");
}

static void stir(const void *context, size_t i, vec3 *at, vec3 *velocity)
{
    (void)i;
    const trial_field *field = context;
    const vec3 wobble = vec3_scale(vec3_make(at->x, -2.0 * at->y, at->z), field->wobble);
    *velocity = vec3_add(vec3_add(wobble, vec3_cross(field->turn, *at)), field->drift);
}

status trial_stir(softbody *b, const trial_field *field, diagnostic *why)
{
    return trial_each_mass(b, stir, field, true, why);
}
