/* Facts of light transport that follow from the scene. The renderer makes the same decisions: see
 * render/shade/shading.c, render/integrators/path.c and render/plan/plan.c. */
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* --- notes --- */

bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
{
    scene_note *note = &c->out->note;
    va_list arguments;
    va_start(arguments, text);
    vsnprintf(note->text, sizeof note->text, text, arguments);
    va_end(arguments);
    snprintf(note->remedy, sizeof note->remedy, "%s", remedy);
    c->out->rule = rule;
    return true;
}

inert_remedy inert_set(const char *format, ...)
{
    inert_remedy r = {"set "};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r.text + 4, sizeof r.text - 4, format, arguments);
    va_end(arguments);
    return r;
}

inert_remedy inert_set_on(const solid *one, const char *assignment)
{
    return one ? inert_set("%s.%s", one->name, assignment) : (inert_remedy){"add a solid"};
}

inert_remedy inert_set_clear(const solid *one)
{
    return one ? inert_set("%s.transparency=0.9 and %s.ior=1.5", one->name, one->name) : inert_set_on(one, "");
}

bool inert_unchanged(const inert_case *c, const char *format, ...)
{
    char assignment[NOTE_TEXT_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(assignment, sizeof assignment, format, arguments);
    va_end(arguments);
    return c->witness->same && c->witness->same(c->witness->context, assignment);
}

/* --- facts about the scene --- */

bool is_black(vec3 color)
{
    return color.x == 0.0 && color.y == 0.0 && color.z == 0.0;
}

bool is_path(const scene *s)
{
    return integrator_traits_of(&s->render)->by_chance;
}

bool is_drawn(const scene *s)
{
    return integrator_traits_of(&s->render)->drawn;
}

bool is_unlit(const scene *s)
{
    return integrator_traits_of(&s->render)->unlit;
}

bool is_named(const inert_case *c, const char *name)
{
    return strcmp(c->at.row->name, name) == 0;
}

bool is_among(const inert_case *c, const char *const *names)
{
    while (*names && !is_named(c, *names))
        names++;
    return *names != NULL;
}

bool follows_rays(const scene *s)
{
    return is_path(s) || traces_ray_trees(&s->render);
}

bool draws_through(const scene *s)
{
    return is_drawn(s) && s->render.lighting == LIGHTING_WHITTED && first_visible(s, is_clear);
}

/* Attenuated shadow rays cross transparent solids, too. */
bool nothing_passes(const scene *s)
{
    const bool lit_through =
        !is_drawn(s) && !is_unlit(s) && s->render.shadows == SHADOWS_ATTENUATED && shining_lights(s) > 0;
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
    return shining_lights(c->s) == 0 && inert_say(c, "no-lamp", lamp_remedy(c->s).text, "no light shines");
}

bool say_not_bent(const inert_case *c)
{
    return inert_say(c, "not-bent", "set render.integrator=whitted and render.lighting=whitted",
                     "no ray is transmitted: an index has an effect only if it equals the index on the other side");
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
    return !is_unlit(s) &&
           (shows_specular(s, m) || (beams_light(s) && m->diffuse > 0.0 && has_color(m)) ||
            (shining_lights(s) > 0 && ((m->diffuse > 0.0 && has_color(m)) || material_roughness(m, &s->render) > 0.0 ||
                                       material_scatters(m, &s->render))));
}

bool shows_color(const scene *s, const material *m)
{
    if (is_unlit(s))
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
    if (is_unlit(s))
        return inert_set("render.layer=albedo");
    material lit = *m;
    lit.diffuse = 0.7;
    if (shows_color(s, &lit))
        return inert_set("%s.diffuse=0.7", name);
    lit.ambient = 0.5;
    if (shows_color(s, &lit))
        return inert_set("%s.ambient=0.5", name);
    return is_path(s) ? inert_set("%s.diffuse=0.7 and %s.transparency=0", name, name)
                      : inert_set("background.ambient=1,1,1 and %s.ambient=0.5", name);
}

/* --- facts of several groups --- */

bool no_tree(const inert_case *c)
{
    const scene *s = c->s;
    if (draws_through(s))
        return false;
    if (!follows_rays(s))
        return say_no_tree(c);
    return !first_visible(s, sends_rays_on) &&
           inert_say(c, "no-branches", inert_set_on(first_visible(s, NULL), "reflectivity=0.5").text,
                     "no visible surface reflects or refracts");
}

/* Prefers a bounded solid: a transparent plane is a poor example. */
static inert_remedy clear_remedy(const scene *s)
{
    const solid *first = first_visible(s, NULL);
    for (size_t i = 0; i < s->solid_count; i++)
        first = first && shape_of(&first->shape)->unbounded && s->solids[i].visible ? &s->solids[i] : first;
    return inert_set_clear(first);
}

bool no_clear(const inert_case *c)
{
    return !first_visible(c->s, is_clear) &&
           inert_say(c, "no-clear", clear_remedy(c->s).text, "no visible solid is transparent");
}

bool nothing_lit(const inert_case *c)
{
    const scene *s = c->s;
    return no_lamp(c) || (!first_visible(s, shows_lamps) &&
                          inert_say(c, "nothing-lit", inert_set_on(first_visible(s, NULL), "diffuse=0.7").text,
                                    "no visible surface is lit by lights"));
}

bool unpolarised(const inert_case *c)
{
    const render_settings *r = &c->s->render;
    const char *first = is_drawn(c->s) || is_unlit(c->s)         ? "render.integrator=whitted and "
                        : r->weights == WEIGHTS_CONSTANT         ? "render.weights=fresnel and "
                        : r->transmission == TRANSMISSION_SIMPLE ? "render.transmission=refract and "
                                                                 : "";
    return !r->polarisation && inert_say(c, "unpolarised", inert_set("%srender.polarisation=on", first).text,
                                         "light is traced without its polarisation");
}

static bool is_layered(const scene *s, const solid *one)
{
    return material_is_layered(&one->surface, &s->render);
}

static bool has_sheet(const scene *s, const solid *one)
{
    return !solid_is_opaque(s, one) && (sheet_is_polariser(&one->surface) || sheet_retards(&one->surface));
}

bool inert_polarisation(const inert_case *c)
{
    if (!is_drawn(c->s) && first_visible(c->s, has_sheet))
        return false;
    return no_tree(c) || (!first_visible(c->s, is_layered) && no_clear(c));
}
