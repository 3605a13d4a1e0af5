/* Light transport facts that follow from the scene alone. The renderer makes the same decisions: see
 * render/shade/shading.c, render/integrators/path.c and render/core/plan.c. */
#include "lint/inert_private.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

bool is_black(vec3 color)
{
    return color.x == 0.0 && color.y == 0.0 && color.z == 0.0;
}

bool is_path(const scene *s)
{
    return integrator_traits_of(&s->render)->by_chance;
}

bool follows_rays(const scene *s)
{
    return is_path(s) || follows_trees(&s->render);
}

bool draws_through(const scene *s)
{
    return integrator_traits_of(&s->render)->drawn && s->render.lighting == LIGHTING_WHITTED &&
           first_visible(s, is_clear);
}

/* Attenuated shadow rays pass through transparent solids. */
bool nothing_passes(const scene *s)
{
    const bool lit_through = !integrator_traits_of(&s->render)->drawn && !integrator_traits_of(&s->render)->layers &&
                             s->render.shadows == SHADOWS_ATTENUATED && shining_lights(s) > 0;
    return !follows_rays(s) && !draws_through(s) && !lit_through;
}

bool say_no_tree(const inert_case *c)
{
    const bool whitted = integrator_traits_of(&c->s->render)->tree;
    return inert_say(c, "no-tree", whitted ? "set render.lighting=whitted" : "set render.integrator=whitted",
                     "no secondary rays are traced with this render.%s", whitted ? "lighting" : "integrator");
}

bool no_lamp(const inert_case *c)
{
    return shining_lights(c->s) == 0 &&
           inert_say(c, "no-lamp", lamp_remedy(c->s).text, "every light has intensity 0 or a black color");
}

bool no_ambient_on_paths(const inert_case *c)
{
    return is_path(c->s) && inert_say(c, "path-ambient", "set render.integrator=whitted",
                                      "the path integrator does not use ambient light");
}

bool goes_straight(const inert_case *c)
{
    return c->s->render.transmission == TRANSMISSION_SIMPLE &&
           inert_say(c, "straight", "set render.transmission=refract", "simple transmission does not refract");
}

bool say_not_bent(const inert_case *c)
{
    return inert_say(c, "not-bent", "set render.integrator=whitted and render.lighting=whitted",
                     "no ray is transmitted: only the equality of indices has an effect");
}

bool is_dark_at_depth_limit(const scene *s)
{
    const background *b = &s->background;
    const bool gradient = b->kind == BACKGROUND_GRADIENT || (b->kind == BACKGROUND_RAIN && b->rain == 0.0);
    const bool dark_sky = is_black(b->color) && (b->kind == BACKGROUND_UNIFORM ||
                                                 ((gradient || b->kind == BACKGROUND_CIE) && is_black(b->horizon)));
    return s->render.beyond == DEPTH_LIMIT_BLACK || dark_sky;
}

static bool shines(const light *l)
{
    return l->intensity > 0.0 && (l->spectrum != LAMP_OF_COLOR || !is_black(l->color));
}

size_t shining_lights(const scene *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->light_count; i++)
        count += shines(&s->lights[i]);
    return count;
}

bool beams_light(const scene *s)
{
    bool any = false;
    for (size_t i = 0; i < s->beam_count; i++)
        any |= beam_lights_scene(&s->beams[i], &s->render);
    return any;
}

bool only_spheres_shine(const scene *s)
{
    for (size_t i = 0; i < s->light_count; i++)
        if (shines(&s->lights[i]) && !light_has_size(&s->lights[i]))
            return false;
    return is_path(s);
}

bool may_have_face_materials(const scene *s, const solid *owner)
{
    const mesh_entry *m = owner->material_index < 0 ? scene_mesh_of(s, owner) : NULL;
    return m && (m->data ? has_face_materials(s, owner) : m->source == MESH_FILE || m->source == MESH_ARRAYS);
}

const solid *first_visible(const scene *s, solid_is *is)
{
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && (!is || is(s, &s->solids[i])))
            return &s->solids[i];
    return NULL;
}

bool is_clear(const scene *s, const solid *one)
{
    return one->surface.transparency > 0.0 ||
           (s->render.transmission == TRANSMISSION_SIMPLE && may_have_face_materials(s, one));
}

bool shows_lamps(const scene *s, const solid *one)
{
    return is_lit_by_lamps(s, &one->surface) || may_have_face_materials(s, one);
}

static bool has_color(const material *m)
{
    return !is_black(m->color) || (m->checker > 0.0 && !is_black(m->checker_color));
}

bool shows_ambient(const scene *s, const material *m)
{
    return !is_path(s) && m->ambient > 0.0 && has_color(m) && !is_black(s->background.ambient);
}

static bool shows_diffuse(const scene *s, const material *m)
{
    return m->diffuse > 0.0 && has_color(m) &&
           (shining_lights(s) > 0 || beams_light(s) || (is_path(s) && material_is_opaque(m)));
}

bool shows_specular(const scene *s, const material *m)
{
    if (m->specular == 0.0 || shining_lights(s) == 0)
        return false;
    return is_path(s) ? material_is_opaque(m) || !only_spheres_shine(s) : s->render.lighting != LIGHTING_LAMBERT;
}

bool is_lit_by_lamps(const scene *s, const material *m)
{
    return !integrator_traits_of(&s->render)->layers &&
           (shows_specular(s, m) || (beams_light(s) && m->diffuse > 0.0 && has_color(m)) ||
            (shining_lights(s) > 0 && ((m->diffuse > 0.0 && has_color(m)) || material_roughness(m, &s->render) > 0.0 ||
                                       material_scattering(m, &s->render) > 0.0)));
}

bool shows_color(const scene *s, const material *m)
{
    if (integrator_traits_of(&s->render)->layers)
        return s->render.layer == LAYER_ALBEDO;
    material white = *m;
    white.color = vec3_make(1.0, 1.0, 1.0);
    return m->emission > 0.0 || shows_ambient(s, &white) || shows_diffuse(s, &white);
}

bool sends_rays_on(const scene *s, const solid *owner)
{
    const material *m = &owner->surface;
    const bool matte = is_path(s) && m->diffuse > 0.0 && has_color(m);
    return m->transparency > 0.0 || m->reflectivity > 0.0 || material_is_layered(m, &s->render) || matte ||
           may_have_face_materials(s, owner);
}

inert_remedy lamp_remedy(const scene *s)
{
    for (size_t i = 0; i < s->light_count; i++) {
        const light *l = &s->lights[i];
        if (!shines(l))
            return l->intensity > 0.0 ? inert_set("%s.color=1,1,1", l->name) : inert_set("%s.intensity=1", l->name);
    }
    return (inert_remedy){"add a light"};
}

inert_remedy color_remedy(const scene *s, const material *m, const char *name)
{
    if (integrator_traits_of(&s->render)->layers)
        return inert_set("render.layer=albedo");
    material coated = *m;
    coated.diffuse = 0.7;
    if (shows_color(s, &coated))
        return inert_set("%s.diffuse=0.7", name);
    coated.ambient = 0.5;
    if (shows_color(s, &coated))
        return inert_set("%s.ambient=0.5", name);
    return is_path(s) ? inert_set("%s.diffuse=0.7 and %s.transparency=0", name, name)
                      : inert_set("background.ambient=1,1,1 and %s.ambient=0.5", name);
}
