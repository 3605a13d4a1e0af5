/* Shared code of the trials. Private to src/softbody/trials*.c. */
#pragma once

#include "softbody/trials.h"

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
