/* Facts of a surface that leave its parameters without effect. */
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/cover.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <string.h>

static inert_remedy set_on(const inert_case *c, const char *assignment)
{
    return inert_set("%s.%s", c->name, assignment);
}

static bool is_open(const inert_case *c)
{
    const mesh_entry *m = scene_mesh_of(c->s, c->owner);
    return m && m->data && !m->data->closed;
}

bool opaque_rule(const inert_case *c)
{
    if (c->m->transparency > 0.0)
        return false;
    const inert_remedy remedy =
        is_open(c) ? (inert_remedy){"use a closed mesh and set its transparency"} : set_on(c, "transparency=0.9");
    return inert_say(c, "opaque", remedy.text, "the solid is opaque");
}

bool mirror_rule(const inert_case *c)
{
    return material_is_mirror(c->m) &&
           inert_say(c, "mirror", set_on(c, "ior=1.5").text, "its refractive index makes it a perfect mirror");
}

static int clear_users(const inert_case *c)
{
    int count = 0;
    for (size_t i = 0; i < c->s->solid_count; i++) {
        const solid *one = &c->s->solids[i];
        count += one->visible && one->material_index == (int)c->at.index && !material_is_opaque(&one->surface);
    }
    return count;
}

/* With equal indices there is no surface: any other index would have an effect. */
static bool not_bent(const inert_case *c)
{
    const scene *s = c->s;
    if (material_is_mirror(c->m))
        return false;
    if (s->render.transmission == TRANSMISSION_SIMPLE)
        return inert_say(c, "straight", "set render.transmission=refract", "simple transmission does not refract");
    const bool makes_equal = c->at.object_group == PARAM_MATERIAL && clear_users(c) > 1;
    return !follows_rays(s) && !draws_through(s) && !s->render.radiance && !material_matches_surroundings(s, c->m) &&
           !makes_equal && say_not_bent(c);
}

bool no_index(const inert_case *c)
{
    if (c->m->transparency == 0.0 &&
        material_is_layered(c->m, &c->s->render)) /* the index of a metal, or of the matter behind a film */
        return nothing_reflected(c);
    return opaque_rule(c) || not_bent(c);
}

/* An opaque solid has no index, but another medium may make it a metal. */
bool no_medium(const inert_case *c)
{
    const render_settings *r = &c->s->render;
    /* The cases in which scene/model/check.c refuses metals. */
    const bool no_metal = has_face_materials(c->s, c->owner) || (r->polarisation && r->spectrum != SPECTRUM_SPECTRAL);
    return c->m->transparency == 0.0 && !no_metal ? nothing_reflected(c) : no_index(c);
}

bool no_law(const inert_case *c)
{
    const int64_t law = c->m->medium;
    return (law == MEDIUM_IOR || law >= MEDIUM_DATA) &&
           inert_say(c, "no-law", inert_set("%s.coefficients=1.5,0.004 and %s.medium=cauchy", c->name, c->name).text,
                     "medium %s has no coefficients", medium_words[law]);
}

/* If no light passes through surfaces, the light inside the solid is seen only by a camera inside it. */
bool unpassed(const inert_case *c)
{
    return nothing_passes(c->s) && scene_apart_from_eye(c->s, c->owner) && say_no_tree(c);
}

/* --- colour and light --- */

bool no_color(const inert_case *c)
{
    const char *text =
        is_unlit(c->s) ? "the shown layer has no colours" : "this surface reflects no ambient or diffuse light";
    return !shows_color(c->s, c->m) && inert_say(c, "no-color", color_remedy(c->s, c->m, c->name).text, "%s", text);
}

/* Measured values replace the parameter. */
bool by_data(const inert_case *c)
{
    const char *by = is_named(c, "color")           ? "color_data"
                     : is_named(c, "scatter_per_m") ? "scatter_data"
                                                    : "absorb_data";
    const material *m = c->m;
    const bool replaced = is_named(c, "color")           ? m->color_data[0]
                          : is_named(c, "scatter_per_m") ? m->scatter_data[0]
                                                         : m->absorb_data[0];
    return replaced && inert_say(c, "by-data", inert_set("%s.%s=", c->name, by).text, "its %s replace it", by);
}

bool no_data_layer(const inert_case *c)
{
    return !strstr(c->m->coating, "data ") &&
           inert_say(c, "no-data-layer", inert_set("%s.coating=data 100", c->name).text,
                     "no layer of its coating is data");
}

bool not_turbid(const inert_case *c)
{
    return !material_is_turbid(c->m) &&
           inert_say(c, "clear", inert_set("%s.scatter_per_m=2", c->name).text, "its medium does not scatter light");
}

/* A transparent solid also has a tint. */
bool no_color_or_tint(const inert_case *c)
{
    const bool tints = !material_is_opaque(c->m) && !is_unlit(c->s);
    return !tints ? no_color(c) : !shows_color(c->s, c->m) && unpassed(c);
}

bool is_black_surface(const inert_case *c)
{
    return is_black(c->m->color) && (c->m->checker == 0.0 || is_black(c->m->checker_color)) &&
           inert_say(c, "black", set_on(c, "color=0.8,0.8,0.8").text, "the surface's color is black");
}

bool unlit(const inert_case *c)
{
    const bool scatters = is_path(c->s) && material_is_opaque(c->m);
    return !scatters && no_lamp(c);
}

/* Weights are not negative: a full highlight that changes nothing is nowhere in the image. */
bool no_highlight(const inert_case *c)
{
    const scene *s = c->s;
    if (!is_path(s) && s->render.lighting == LIGHTING_LAMBERT)
        return inert_say(c, "lambert", "set render.lighting=phong", "Lambert shading has no highlights");
    if (no_lamp(c))
        return true;
    if (only_spheres_shine(s) && !material_is_opaque(c->m))
        return inert_say(c, "sphere-highlight", "set render.integrator=whitted",
                         "a transparent surface reflects the lights directly and has no Phong highlight");
    return is_named(c, "specular") && c->m->specular < 1.0 && inert_unchanged(c, "%s.specular=1", c->name) &&
           inert_say(c, "unseen-highlight", "move it, the light or the camera",
                     "no lit part of it in this image reflects a light towards the camera");
}

/* --- reflection --- */

/* Weights are not negative: if the film is unchanged with full reflection, it is unchanged with less. A half mirror
 * reduces transmission by what it adds to reflection; if neither 1/2 nor 1 changes the film, both paths are black. */
static bool mirrors_black(const inert_case *c)
{
    const background *sky = &c->s->background;
    const bool dark = sky->kind == BACKGROUND_UNIFORM && is_black(sky->color), clear = !material_is_opaque(c->m);
    return dark && c->m->reflectivity < 1.0 && !(clear && shining_lights(c->s) > 0) &&
           inert_unchanged(c, "%s.reflectivity=1", c->name) &&
           (!clear || inert_unchanged(c, "%s.reflectivity=0.5", c->name)) &&
           inert_say(c, "mirrors-black", "set background.color=0.5,0.5,0.5",
                     "everything that it could reflect in this image is black");
}

static bool nothing_at_depth_0(const inert_case *c)
{
    const scene *s = c->s;
    /* A rough surface shows lights without secondary rays. */
    const bool lit = material_roughness(c->m, &s->render) > 0.0 && shining_lights(s) > 0;
    return s->render.depth == 0 && is_dark_at_depth_limit(s) && !lit &&
           inert_say(c, "depth-0", "set render.depth=4",
                     "render.depth is 0, and the radiance beyond the depth limit is black");
}

/* No ray is traced to what the surface reflects, or all of it is black. */
bool nothing_reflected(const inert_case *c)
{
    const scene *s = c->s;
    if (!follows_rays(s))
        return say_no_tree(c);
    if (nothing_at_depth_0(c))
        return true;
    /* mirrors_black varies the reflectivity, which a layered opaque surface does not use. */
    return !(c->m->transparency == 0.0 && material_is_layered(c->m, &s->render)) && mirrors_black(c);
}

static bool layered_reflectivity(const inert_case *c)
{
    const inert_remedy remedy = c->m->coating[0] ? inert_set("%s.coating=none", c->name)
                                : material_has_film(c->m)
                                    ? inert_set("%s.film_thickness_nm=0 and %s.extinction=0", c->name, c->name)
                                : material_metal(c->m) ? inert_set("%s.medium=ior", c->name)
                                                       : inert_set("%s.extinction=0", c->name);
    return c->m->transparency == 0.0 && material_is_layered(c->m, &c->s->render) &&
           inert_say(c, "layered", remedy.text, "its %s determines what it reflects",
                     c->m->coating[0]          ? "coating"
                     : material_has_film(c->m) ? "film"
                                               : "complex index");
}

bool no_reflectivity(const inert_case *c)
{
    const scene *s = c->s;
    if (layered_reflectivity(c))
        return true;
    /* A half mirror also attenuates shadow rays. */
    const bool halves = !material_is_opaque(c->m) && !scene_has_constant_weights(&s->render);
    if (halves)
        return (!material_matches_surroundings(s, c->m) && unpassed(c)) || mirrors_black(c);
    if (is_drawn(s) && !material_is_opaque(c->m))
        return false;
    if (!follows_rays(s))
        return say_no_tree(c);
    if (nothing_at_depth_0(c))
        return true;
    if (material_is_mirror(c->m) && !scene_has_constant_weights(&s->render))
        return inert_say(c, "mirror", set_on(c, "transparency=0").text,
                         "its refractive index already makes it a mirror");
    return mirrors_black(c);
}

/* --- films, facets and sheets --- */

/* Films and rough surfaces need the Fresnel equations. */
bool constant_weights(const inert_case *c)
{
    return !material_is_opaque(c->m) && scene_has_constant_weights(&c->s->render) &&
           inert_say(c, "constant", "set render.weights=fresnel and render.transmission=refract",
                     "a %s needs the Fresnel equations, and this scene has constant weights",
                     is_named(c, "roughness")                                      ? "rough surface"
                     : is_named(c, "film_thickness_nm") || is_named(c, "film_ior") ? "film"
                                                                                   : "coating");
}

/* A film makes a surface visible even if the solid has the index of the surroundings. */
bool film_unseen(const inert_case *c)
{
    return !(!material_is_opaque(c->m) && material_matches_surroundings(c->s, c->m)) && nothing_reflected(c);
}

/* A rough surface may show lights that a smooth one does not, such as points. */
bool nothing_rough(const inert_case *c)
{
    const scene *s = c->s;
    material rough = *c->m;
    rough.roughness = 1.0;
    if (!(material_roughness(&rough, &s->render) > 0.0))
        return inert_say(c, "matte", set_on(c, "reflectivity=0.3").text,
                         "the surface reflects no rays that roughness could scatter");
    return shining_lights(s) == 0 && film_unseen(c);
}

bool sheet_unpassed(const inert_case *c)
{
    return !material_matches_surroundings(c->s, c->m) && unpassed(c);
}

/* Whether the polariser or retarder treats both directions alike, so that its axis has no effect. */
bool axis_unseen(const inert_case *c)
{
    if (c->m->sheet == SHEET_RETARDER)
        return !sheet_retards(c->m) &&
               inert_say(c, "no-retardance", set_on(c, "retardance_deg=90").text, "its retardance is 0");
    return c->m->sheet_pass == c->m->sheet_block &&
           inert_say(c, "grey", inert_set("%s.sheet_pass=1 and %s.sheet_block=0", c->name, c->name).text,
                     "sheet_pass equals sheet_block: it is a grey filter");
}

/* --- textures --- */

static bool has_mesh_coordinates(const inert_case *c)
{
    return shape_of(&c->owner->shape)->triangles && inert_say(c, "mesh-texture", "set it on a solid other than a mesh",
                                                              "a mesh has its own texture coordinates");
}

bool no_texture(const inert_case *c)
{
    const bool size = is_named(c, "texture_size");
    const scene *s = c->s;
    if (size && has_mesh_coordinates(c))
        return true;
    if (s->texture_count == 0)
        return inert_say(c, "no-textures", "add one under textures:", "the scene has no textures");
    return size && !c->m->texture[0] &&
           inert_say(c, "no-texture", inert_set("%s.texture=%s", c->name, s->textures[0].name).text,
                     "the surface has no texture");
}

static bool say_no_alpha(const inert_case *c, const char *why)
{
    return inert_say(c, "no-alpha", "use a texture with alpha, on an opaque solid and with rays", "%s", why);
}

bool no_alpha(const inert_case *c)
{
    const texture_entry *t = c->m->texture[0] ? scene_find_texture(c->s, c->m->texture) : NULL;
    if (is_drawn(c->s))
        return say_no_alpha(c, "the rasteriser ignores alpha");
    if (c->m->transparency > 0.0)
        return say_no_alpha(c, "the surface of a transparent solid has no alpha");
    if (!t || (t->data && !texture_covered(t->data)))
        return say_no_alpha(c, t ? "its texture has no alpha" : "the surface has no texture");
    return is_named(c, "alpha_cutoff") && c->m->alpha != ALPHA_MASK &&
           inert_say(c, "no-mask", set_on(c, "alpha=mask").text, "its alpha is not mask");
}

bool one_color(const inert_case *c)
{
    const vec3 a = c->m->color, b = c->m->checker_color;
    return a.x == b.x && a.y == b.y && a.z == b.z &&
           inert_say(c, "one-color", set_on(c, "checker_color=0.2,0.4,0.6").text, "checker_color equals color");
}

/* --- what no ray meets --- */

static bool say_unseen(const inert_case *c)
{
    if (is_unlit(c->s))
        return inert_say(c, "unseen", "set render.integrator=whitted", "no camera ray of this image hits %s first",
                         c->owner->name);
    int64_t highest = c->owner->priority;
    for (size_t i = 0; i < c->s->solid_count; i++) {
        const solid *one = &c->s->solids[i];
        highest = one->visible && one->priority > highest ? one->priority : highest;
    }
    const inert_remedy higher =
        inert_set("%s.priority=%lld, or move it or the camera", c->owner->name, (long long)highest + 1);
    return inert_say(c, "unseen", highest > c->owner->priority ? higher.text : "move it, or the camera",
                     "no ray of this image hits a surface of %s", c->owner->name);
}

/* Parameters of the Phong terms, which opaque and transparent surfaces reflect. */
static const char *const phong_parameters[] = {"ambient",      "diffuse", "specular",      "shininess", "texture",
                                               "texture_size", "checker", "checker_color", NULL};

/* The parameter affects only reflected light, and no ray hits the surface. Parameters of transmitted light are left
 * out: transmitted light may reach visible surfaces. */
bool unseen(const inert_case *c)
{
    static const char *const opaque_parameters[] = {"color", "emission", NULL};
    static const char *const mirror_parameters[] = {"reflectivity",      "extinction", "medium",
                                                    "film_thickness_nm", "film_ior",   "coating",
                                                    "coating_data",      "roughness",  NULL};
    const bool mirrors = is_among(c, mirror_parameters),
               reflects_only = is_among(c, phong_parameters) ||
                               (c->m->transparency == 0.0 && (is_among(c, opaque_parameters) || mirrors));
    /* photons that it reflects may reach a visible surface, unless even a full mirror changes nothing */
    const bool lights = mirrors && scene_has_caustics(&c->s->render);
    return reflects_only && !(lights && !inert_unchanged(c, "%s.reflectivity=1", c->name)) && c->frame &&
           c->frame->hits[c->owner - c->s->solids] == 0 && say_unseen(c);
}

/* A transparent solid with the index of the surroundings has no surface, unless it touches another transparent one. */
bool no_interface(const inert_case *c)
{
    const scene *s = c->s;
    if (scene_has_constant_weights(&s->render) || !(is_among(c, phong_parameters) || is_named(c, "roughness")))
        return false;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const material *m = &one->surface;
        const bool plain = m->reflectivity == 0.0 && m->emission == 0.0 && !material_has_film(m) &&
                           !material_is_crystal(m, &s->render) && material_matches_surroundings(s, m);
        if (one->visible && ((!material_is_opaque(m) && !plain) || may_have_face_materials(s, one)))
            return false;
    }
    return !material_is_opaque(c->m) &&
           inert_say(c, "no-interface", set_on(c, "ior=1.5").text,
                     "its refractive index equals that of the surrounding medium: it has no visible surface");
}

/* The solid is entirely inside one that has precedence: no ray hits it. */
bool covered(const inert_case *c)
{
    const solid *cover = scene_cover(c->s, c->owner);
    return cover &&
           inert_say(c, "covered", inert_set("%s.priority=%lld", c->owner->name, (long long)cover->priority + 1).text,
                     "%s is entirely inside %s, which has precedence there", c->owner->name, cover->name);
}
