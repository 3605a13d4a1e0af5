/* Parameters of metals, films and rough surfaces that have no effect. */
#include "lint/inert_private.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

bool nothing_at_depth_0(const inert_case *c)
{
    const scene *s = c->s;
    const bool lit = material_roughness(c->m, &s->render) > 0.0 && shining_lights(s) > 0; /* lamps reach facets */
    return s->render.depth == 0 && is_dark_at_depth_limit(s) && !lit &&
           inert_say(c, "depth-0", "set render.depth=4",
                     "render.depth is 0, and the radiance beyond the depth limit is black");
}

/* No ray brings what the surface reflects. */
bool nothing_reflected(const inert_case *c)
{
    const scene *s = c->s;
    if (!follows_rays(s))
        return say_no_tree(c);
    if (nothing_at_depth_0(c))
        return true;
    /* A layered opaque surface does not use the reflectivity with which that is found out. */
    return !(c->m->transparency == 0.0 && material_is_layered(c->m, &s->render)) && mirrors_black(c);
}

bool extinction_rule(const inert_case *c)
{
    const material *m = c->m;
    if (m->transparency > 0.0)
        return inert_say(c, "clear", inert_set("%s.transparency=0", c->name).text,
                         "the solid is transparent: what it absorbs is set by absorb_per_m");
    if (m->medium != MEDIUM_IOR)
        return inert_say(c, "by-medium", inert_set("%s.medium=ior", c->name).text,
                         "the extinction of medium %s is not set here", medium_words[m->medium]);
    return nothing_reflected(c);
}

bool film_rule(const inert_case *c)
{
    const scene *s = c->s;
    const bool clear = !material_is_opaque(c->m);
    if (mirror_rule(c))
        return true;
    if (clear && scene_has_constant_shares(&s->render))
        return inert_say(c, "constant-film", "set render.weights=fresnel and render.transmission=refract",
                         "a film needs the Fresnel equations, and this scene has constant weights");
    /* A film on what has the index of the surroundings makes a surface of it. */
    return !(clear && material_matches_surroundings(s, c->m)) && nothing_reflected(c);
}

bool film_index_rule(const inert_case *c)
{
    return (c->m->film_thickness_nm == 0.0 &&
            inert_say(c, "no-film", inert_set("%s.film_thickness_nm=300", c->name).text,
                      "film_thickness_nm is 0: there is no film")) ||
           mirror_rule(c) || (film_rule(c)) || nothing_reflected(c);
}

bool layered_reflectivity(const inert_case *c)
{
    const inert_remedy remedy = material_has_film(c->m)
                                    ? inert_set("%s.film_thickness_nm=0 and %s.extinction=0", c->name, c->name)
                                : material_metal(c->m) ? inert_set("%s.medium=ior", c->name)
                                                       : inert_set("%s.extinction=0", c->name);
    return c->m->transparency == 0.0 && material_is_layered(c->m, &c->s->render) &&
           inert_say(c, "layered", remedy.text, "its %s determines what it reflects",
                     material_has_film(c->m) ? "film" : "complex index");
}

/* Lamps that a smooth surface does not show, such as points, may appear on a rough one. */
bool roughness_rule(const inert_case *c)
{
    const scene *s = c->s;
    const material *m = c->m;
    material rough = *m;
    rough.roughness = 1.0;
    if (!is_path(s))
        return inert_say(c, "smooth-rays", "set render.integrator=path",
                         "only the path integrator shows roughness: the surface is treated as smooth");
    if (!material_is_opaque(m) && scene_has_constant_shares(&s->render))
        return inert_say(c, "constant-rough", "set render.weights=fresnel and render.transmission=refract",
                         "facets need the Fresnel equations, and this scene has constant weights");
    if (!(material_roughness(&rough, &s->render) > 0.0))
        return inert_say(c, "matte", inert_set("%s.reflectivity=0.3", c->name).text,
                         "the surface reflects no rays that roughness could scatter");
    return shining_lights(s) == 0 && !(!material_is_opaque(m) && material_matches_surroundings(s, m)) &&
           nothing_reflected(c);
}
