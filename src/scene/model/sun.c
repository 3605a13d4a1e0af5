/* The sun of the background. */
#include "scene/model/sun.h"

#include "base/elementary.h"

const light *scene_sun(const scene *s)
{
    for (size_t i = 0; i < s->light_count; i++)
        if (s->lights[i].kind == LIGHT_SUN)
            return &s->lights[i];
    return NULL;
}

vec3 scene_to_sun(const scene *s)
{
    const light *l = scene_sun(s);
    double up, level, side, ahead;
    if (l)
        return vec3_normalize(vec3_sub(l->position, l->target));
    elementary_sincos_deg(s->background.sun_elevation_deg, &up, &level);
    elementary_sincos_deg(s->background.sun_azimuth_deg, &side, &ahead);
    return vec3_make(level * side, up, level * ahead);
}
