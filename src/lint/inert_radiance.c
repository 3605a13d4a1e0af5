/* Conditions under which basic and classic radiance are equal: all light paths begin and end in a vacuum, where n^2 is
 * 1 (render/shade/radiance.c). */
#include "lint/inert_facts.h"
#include "scene/model/cover.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

static bool is_bare(const background *b)
{
    return b->medium == MEDIUM_IOR && b->ior == 1.0;
}

/* Radiance differs inside it. */
static bool is_dense(const scene *s, const solid *one)
{
    (void)s;
    const material *m = &one->surface;
    return one->visible && !material_is_opaque(m) && !(m->medium == MEDIUM_IOR && m->ior == 1.0);
}

/* An emitting solid, or one around the camera, may be inside a dense medium. */
static bool may_lie_in_dense(const scene *s, const solid *one)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (is_dense(s, other) && (other == one || !scene_apart(s, one, other)))
            return true;
    }
    return false;
}

static bool may_hold_eye(const scene *s, const solid *one)
{
    return is_dense(s, one) && !scene_apart_from_eye(s, one);
}

static bool glows_in_dense(const scene *s, const solid *one)
{
    const bool glows =
        one->surface.emission > 0.0 || shows_ambient(s, &one->surface) || may_have_face_materials(s, one);
    return glows && may_lie_in_dense(s, one);
}

bool inert_radiance(const inert_case *c)
{
    const scene *s = c->s;
    if (scene_has_caustics(&s->render))
        return inert_say(c, "caustics-radiance", "set render.caustics=off", "with photons, rays carry basic radiance");
    if (!is_bare(&s->background))
        return false;
    const solid *dense = first_visible(s, is_dense), *last = s->solid_count > 0 ? &s->solids[s->solid_count - 1] : NULL;
    if (!dense)
        return inert_say(c, "no-dense", inert_set_clear(last).text,
                         "no visible transparent solid has a different refractive index");
    if (first_visible(s, may_hold_eye) || first_visible(s, glows_in_dense))
        return false;
    /* paths reach light spheres by the surfaces between; where one lies in a dense medium the film tells */
    const bool outside =
        shining_lights(s) == 0 ||
        (only_spheres_shine(s) &&
         inert_same(c, "render.radiance=%s", s->render.radiance == RADIANCE_BASIC ? "classic" : "basic"));
    return outside && inert_say(c, "light-outside", inert_set("%s.emission=0.5", dense->name).text,
                                "all light paths begin and end outside transparent solids");
}
