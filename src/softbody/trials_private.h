/* What the trials share. For src/softbody/trials*.c alone. */
#pragma once

#include "softbody/trials.h"

enum { TRIAL_STEPS_MAX = 300000 };

/* What a trial measures with; out: where its values go. */
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

/* The settings at the origin, at rest, without gravity, floor or split steps. */
softbody_settings trial_alone(const trials *t);

/* Of one of the toy's masses, and of two of them on a spring along an edge: omega^2 = k / (m / 2) (Goldstein,
 * "Classical mechanics", 3.1). */
double trial_mass_kg(const softbody_settings *s);
double trial_omega(const softbody_settings *s);

/* How many steps make up a time, at least 1; 0 when they are more than TRIAL_STEPS_MAX. */
uint64_t trial_steps(const softbody_settings *s, double time_s);

/* Takes steps and calls watch, where there is one, after each, until it says false. *held: no step blew up, and there
 * was one. */
typedef bool trial_watch(const softbody *b, void *context);
status trial_run(softbody *b, uint64_t steps, trial_watch *watch, void *context, bool *held, diagnostic *why);

/* All but gravity's. */
double trial_energy(const softbody *b);

/* One mass, or two masses on an undamped spring that is longer than its length at rest, 1, by swing. */
status trial_one_mass(const trials *t, const softbody_settings *s, softbody **out);
status trial_swing(const trials *t, const softbody_settings *s, double swing, softbody **out);

/* How much longer the swing's spring is than at rest, and how fast it grows, over omega. */
typedef struct swing_state {
    double q, p;
} swing_state;
swing_state trial_swing_state(const softbody *b, double omega);

/* Shows every mass's place and velocity to act, and puts the masses where it leaves them if that is wanted. */
typedef void trial_mass(const void *context, size_t i, vec3 *at, vec3 *velocity);
status trial_each_mass(softbody *b, trial_mass *act, const void *context, bool place, diagnostic *why);

/* A velocity field u = wobble (x, -2 y, z), which keeps the volume at first, + turn x (place) + drift. */
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
