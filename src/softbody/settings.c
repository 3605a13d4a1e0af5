#include "softbody/softbody.h"

static status refuse(diagnostic *why, const char *name, double value, const char *remedy)
{
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s is %g", name, value);
}

typedef struct bounded {
    const char *name;
    double value;
} bounded;

static status check_shape(const softbody_settings *s, diagnostic *why)
{
    const bounded above[] = {{"radius", s->radius}, {"mass_kg", s->mass_kg}, {"dt_s", s->dt_s}};
    const double lowest[] = {1e-6, SOFTBODY_MASS_MIN_KG, SOFTBODY_DT_MIN_S};
    for (size_t i = 0; i < sizeof above / sizeof above[0]; i++)
        if (!(above[i].value >= lowest[i] && above[i].value <= 1e6))
            return refuse(why, above[i].name, above[i].value,
                          i == 2 ? "a number of at least 1e-9" : "a number of at least 1e-6");
    const bounded least[] = {{"stiffness", s->stiffness}, {"bending", s->bending},   {"through", s->through},
                             {"damping", s->damping},     {"pressure", s->pressure}, {"friction", s->friction}};
    for (size_t i = 0; i < sizeof least / sizeof least[0]; i++)
        if (!(least[i].value >= 0.0 && least[i].value <= 1e9))
            return refuse(why, least[i].name, least[i].value, "give a number from 0 to 1e9");
    if (!(s->restitution >= 0.0 && s->restitution <= 1.0))
        return refuse(why, "restitution", s->restitution, "give a number from 0 to 1");
    if (!(fabs(s->ground_y) < 1e9))
        return refuse(why, "ground_y", s->ground_y, "give a finite number");
    const vec3 all[] = {s->position, s->velocity, s->gravity};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (!(vec3_length(all[i]) < 1e9))
            return diagnose(why, STATUS_BAD_INPUT, "finite numbers", "position, velocity or gravity is too large");
    return STATUS_OK;
}

status softbody_check(const softbody_settings *s, diagnostic *why)
{
    if (s->level < 0 || s->level > SOFTBODY_LEVEL_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "a level from 0 to 7", "a slime of level %ld", (long)s->level);
    if (s->threads < 1 || s->threads > 1024)
        return diagnose(why, STATUS_BAD_INPUT, "1 to 1024", "%ld threads", (long)s->threads);
    if (s->integrator < SOFTBODY_EULER || s->integrator > SOFTBODY_IMPLICIT)
        return diagnose(why, STATUS_BAD_INPUT, "euler, verlet or implicit", "unknown integrator %ld",
                        (long)s->integrator);
    return check_shape(s, why);
}
