/* Measured properties of the motion and their theory: the behaviour of a spring, a fall, a bounce and a free toy with
 * the integrator, step and stiffness of the settings, as a list of named values. Each trial uses some of the settings:
 *   spring.*, stable_dt.spring_s  two masses of the toy (mass_kg over their number), one spring of `stiffness` and no
 *                                 damping, integrator, dt_s
 *   fall.*, bounce.height         one mass; gravity's y, restitution, integrator, dt_s
 *   bounce.body                   the toy over a floor, gravity's y, all settings except initial position and velocity
 *   volume.drift                  the toy on a floor, all settings except initial position and velocity
 *   energy.*, momentum.*,         the toy without gravity and floor; energy.drift and energy.end also without damping
 *   angular_momentum.*
 *   stable_dt.toy_s               the same, with damping
 *   rate.*                        the toy of volume.drift, after it
 * Springs, falls, bounce.height and stable_dt.* use steps of dt_s without splitting; the others follow `adaptive`.
 * Hands are ignored.
 *
 * A diverged simulation is a result, not an error: values that cannot be measured then are NaN, and so are the values
 * of trials that would take more than 300000 steps. All values except rate.step_s and rate.simulated_s_per_s are
 * bit-identical for any number of threads and any instruction set.
 *
 * Cost, with steps of 1 ms, mostly of some 15000 steps of the toy (implicit: 8000), in seconds of one core:
 *                 euler   verlet   implicit
 *     level 2     0.2     0.2      0.5
 *     level 4     2.3     2.0      10
 *
 * Ownership: values. Errors: STATUS_BAD_INPUT for settings that softbody_check refuses, STATUS_FAILURE if memory runs
 * out. */
#pragma once

#include "softbody/softbody.h"

typedef struct softbody_trial {
    const char *name;        /* "spring.period_s" */
    const char *unit;        /* "" for ratios */
    const char *what;        /* one line: the measured quantity, and the source of its theory */
    double measured, theory; /* NaN: none */
} softbody_trial;

enum { SOFTBODY_TRIAL_COUNT = 19 };

/* The values in a fixed order, with the same names for all settings. */
typedef struct softbody_trial_report {
    softbody_trial value[SOFTBODY_TRIAL_COUNT];
} softbody_trial_report;

status softbody_trials(const softbody_settings *s, isa level, softbody_trial_report *out, diagnostic *why);

/* Measures one value, without running the other groups; STATUS_BAD_INPUT for an unknown name. */
status softbody_trial_one(const softbody_settings *s, isa level, const char *name, softbody_trial *out,
                          diagnostic *why);
bool softbody_has_trial(const char *name);

/* |measured - theory|; NaN if one of them is. */
double softbody_trial_error(const softbody_trial *t);

/* Shared code of the trials. Private to src/softbody/trials*.c. */

enum { TRIAL_STEPS_MAX = 300000 };

/* Context of a trial; out: where its values are stored. */
typedef struct trials {
    const softbody_settings *set;
    isa level;
    softbody_trial_report *out;
    diagnostic *why;
} trials;

typedef enum trial_name {
    SPRING_PERIOD,
    SPRING_PERIOD_DISCRETE,
    SPRING_DECAY,
    SPRING_ORDER,
    FALL_DEPTH,
    FALL_DEPTH_DISCRETE,
    BOUNCE_HEIGHT,
    BOUNCE_BODY,
    ENERGY_DRIFT,
    ENERGY_END,
    ENERGY_RISE,
    MOMENTUM_DRIFT,
    ANGULAR_MOMENTUM_DRIFT,
    VOLUME_DRIFT,
    STABLE_SPRING,
    STABLE_TOY,
    RATE_SUBSTEPS,
    RATE_STEP,
    RATE_SIMULATED
} trial_name;

static inline void trial_put(const trials *t, trial_name name, double measured, double theory)
{
    t->out->value[name].measured = measured;
    t->out->value[name].theory = theory;
}

/* The settings at the origin, at rest, without gravity, floor or splitting. */
softbody_settings trial_free_settings(const trials *t);

/* The mass at one of the toy's vertices, and omega of two such masses on a spring along an edge: omega^2 = k / (m / 2)
 * (Goldstein, "Classical mechanics", 3.1). */
double trial_mass_kg(const softbody_settings *s);
double trial_omega(const softbody_settings *s);

/* The number of steps in a time, at least 1; 0 if they are more than TRIAL_STEPS_MAX. */
uint64_t trial_steps(const softbody_settings *s, double time_s);

/* Runs steps and calls watch, if not NULL, after each until it returns false. *completed: no step diverged, and there
 * was at least one. STATUS_INTERRUPTED when cancelled. */
typedef bool trial_watch(const softbody *b, void *context);
status trial_run(softbody *b, uint64_t steps, trial_watch *watch, void *context, bool *completed, const trials *t);

/* All energy except gravity's. */
double trial_energy(const softbody *b);

/* One mass, or two masses on an undamped spring of rest length 1, stretched by swing. */
status trial_one_mass(const trials *t, const softbody_settings *s, softbody **out);
status trial_swing(const trials *t, const softbody_settings *s, double swing, softbody **out);

/* q: the elongation of the spring; p: its rate of change, divided by omega. */
typedef struct swing_state {
    double q, p;
} swing_state;
swing_state trial_swing_state(const softbody *b, double omega);

/* Calls act with every mass's position and velocity; place: stores its changes. */
typedef void trial_mass(const void *context, size_t i, vec3 *at, vec3 *velocity);
status trial_each_mass(softbody *b, trial_mass *act, const void *context, bool place, diagnostic *why);

/* A velocity field u = wobble (x, -2 y, z), which initially preserves the volume, + turn x (position) + drift. */
typedef struct trial_field {
    double wobble;
    vec3 turn, drift;
} trial_field;
status trial_stir(softbody *b, const trial_field *field, diagnostic *why);

status trials_spring(const trials *t);
status trials_fall(const trials *t);
status trials_bounce(const trials *t);
status trials_free(const trials *t);
status trials_rest(const trials *t);
status trials_stable(const trials *t);
