/* Measured properties of the motion, theory beside them: what the settings' own integrator, step and stiffness make of
 * a spring, a fall, a bounce and a free toy, as a list of named values. Each trial builds what it needs from the part
 * of the settings that it is about:
 *   spring.*, stable_dt.spring_s  two masses of the toy's (mass_kg over their number), one spring of `stiffness` and no
 *                                 damping, integrator, dt_s
 *   fall.*, bounce.height         one mass; gravity's y, restitution, integrator, dt_s
 *   bounce.body, volume.drift     the toy over a floor, all settings but place and speed at the beginning
 *   energy.*, momentum.*          the toy without gravity and floor; energy.drift and energy.end also without damping
 *   stable_dt.toy_s               the same, with damping
 *   rate.*                        the toy on a floor, all settings
 * Springs, falls and stable_dt.* take steps of dt_s that are not split; the others follow `adaptive`. Hands have no
 * part in it.
 *
 * A body that blows up is an answer here and no error: NaN for what could not be measured then, and where a trial would
 * take more than 300000 steps. All values but rate.step_s and rate.simulated_s_per_s are the same to the bit for any
 * number of threads and any instruction set.
 *
 * Cost, with steps of 1 ms, mostly of some 15000 steps of the toy (implicit: 8000), in seconds of one core:
 *                 euler   verlet   implicit
 *     level 2     0.2     0.2      0.5
 *     level 4     2.3     2.0      10
 *
 * Ownership: values. Errors: STATUS_BAD_INPUT for settings that softbody_check refuses, STATUS_FAILURE when memory is
 * out. */
#pragma once

#include "softbody/softbody.h"

typedef struct softbody_trial {
    const char *name;        /* "spring.period_s" */
    const char *unit;        /* "" for ratios */
    const char *what;        /* one line: what is measured, and where theory has it from */
    double measured, theory; /* NaN: none */
} softbody_trial;

enum { SOFTBODY_TRIAL_COUNT = 19 };

/* In a fixed order, the same names for all settings. */
typedef struct softbody_trial_report {
    softbody_trial value[SOFTBODY_TRIAL_COUNT];
} softbody_trial_report;

status softbody_trials(const softbody_settings *s, isa level, softbody_trial_report *out, diagnostic *why);

/* |measured - theory|; NaN where one of them is. */
double softbody_trial_error(const softbody_trial *t);
