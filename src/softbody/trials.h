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
