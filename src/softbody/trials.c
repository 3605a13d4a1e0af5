/* The table of trials, and the selection of those to run. */
#include "softbody/trials.h"
#include "base/cancel.h"

#include <stdio.h>
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
