/* Parameters of crystals that have no effect. */
#include "lint/inert_private.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

bool crystal_rule(const inert_case *c)
{
    const scene *s = c->s;
    if (opaque_rule(c) || mirror_rule(c))
        return true;
    if (!integrator_traits_of(&s->render)->tree)
        return inert_say(c, "one-ray", "set render.integrator=whitted",
                         "only integrator whitted splits rays in crystals");
    if (!follows_rays(s))
        return say_no_tree(c);
    if (goes_straight(c))
        return true;
    return scene_has_constant_shares(&s->render) &&
           inert_say(c, "constant-crystal", "set render.weights=fresnel", "with constant weights rays are not split");
}

bool optic_axis_rule(const inert_case *c)
{
    return crystal_rule(c) || (c->m->extraordinary_ior == 0.0 &&
                               inert_say(c, "no-crystal", inert_set("%s.extraordinary_ior=1.7", c->name).text,
                                         "extraordinary_ior is 0: it is not a crystal"));
}
