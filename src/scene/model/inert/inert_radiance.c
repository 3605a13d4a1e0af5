/* Why basic and classic radiance are the same in a scene: all light begins and ends in a vacuum, where n^2 is 1
 * (render/shade/radiance.c). */
#include "scene/model/inert/inert_private.h"
#include "scene/model/cover.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

static bool is_bare(const background *b)
{
    return b->medium == MEDIUM_IOR && b->ior == 1.0;
}

/* Light has another radiance in it. */
static bool is_dense(const solid *one)
{
    const material *m = &one->surface;
    return one->visible && !material_is_opaque(m) && !(m->medium == MEDIUM_IOR && m->ior == 1.0);
}

static const solid *first_dense(const scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        if (is_dense(&s->solids[i])) {
            return &s->solids[i];
        }
    }
    return NULL;
}

/* A solid that shines by itself, or one that stands for the eye, may lie in a dense one. */
static bool may_lie_in_dense(const scene *s, const solid *one)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (is_dense(other) && (other == one || !scene_apart(s, one, other))) {
            return true;
        }
    }
    return false;
}

static bool eye_may_lie_in_dense(const scene *s)
{
    bool may = false;
    for (size_t i = 0; i < s->solid_count && !may; i++) {
        may = is_dense(&s->solids[i]) && !scene_apart_from_eye(s, &s->solids[i]);
    }
    return may;
}

static bool light_begins_in_dense(const scene *s)
{
    bool begins = eye_may_lie_in_dense(s);
    for (size_t i = 0; i < s->solid_count && !begins; i++) {
        const solid *one = &s->solids[i];
        const bool glows = one->surface.emission > 0.0 || shows_ambient(s, &one->surface) || may_look_by_face(s, one);
        begins = one->visible && glows && may_lie_in_dense(s, one);
    }
    return begins;
}

bool inert_radiance(const inert_case *c)
{
    const scene *s = c->s;
    if (integrator_of(&s->render)->drawn) {
        return inert_say(c, "zbuffer-radiance", "set render.integrator=whitted",
                         "the depth buffer follows no light through a surface");
    }
    if (s->render.transmission == TRANSMISSION_SIMPLE) {
        return inert_say(c, "straight", "set render.transmission=refract", "simple transmission bends no light");
    }
    if (!is_bare(&s->background)) {
        return false;
    }
    const solid *dense = first_dense(s), *last = s->solid_count > 0 ? &s->solids[s->solid_count - 1] : NULL;
    if (!dense) {
        const inert_remedy remedy = last ? inert_set("%s.transparency=0.9 and %s.ior=1.5", last->name, last->name)
                                         : (inert_remedy){"add a solid"};
        return inert_say(c, "no-dense", remedy.text, "no visible clear solid has an index of its own");
    }
    return shining_lights(s) == 0 && !light_begins_in_dense(s) &&
           inert_say(c, "light-outside", inert_set("%s.emission=0.5", dense->name).text,
                     "all light begins and ends outside of clear solids");
}
