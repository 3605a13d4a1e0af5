/* Code that all trials use: bodies, steps, and observed quantities. */
#include "base/cancel.h"
#include "softbody/trials.h"
#include <stdlib.h>

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
