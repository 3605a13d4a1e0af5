/* Material parameters that have no effect on the material's solids. */
#include "lint/inert_private.h"
#include "geometry/shapes/shape.h"
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
    if (goes_straight(c))
        return true;
    const bool makes_equal = c->at.object_group == PARAM_MATERIAL && clear_users(c) > 1;
    return !follows_rays(s) && !draws_through(s) && !s->render.radiance && !material_matches_surroundings(s, c->m) &&
           !makes_equal && say_not_bent(c);
}

static bool index_rule(const inert_case *c)
{
    if (c->m->transparency == 0.0 &&
        material_is_layered(c->m, &c->s->render)) /* of what is behind a film, or a metal */
        return nothing_reflected(c);
    return opaque_rule(c) || not_bent(c);
}

/* An opaque solid may become a metal. */
static bool medium_rule(const inert_case *c)
{
    const render_settings *r = &c->s->render; /* where metals are refused, see check.c */
    const bool no_metal = has_face_materials(c->s, c->owner) || (r->polarisation && r->spectrum != SPECTRUM_SPECTRAL);
    return c->m->transparency == 0.0 && !no_metal ? nothing_reflected(c) : index_rule(c);
}

/* Light inside the solid is seen only by a camera inside it. */
bool unpassed(const inert_case *c)
{
    return nothing_passes(c->s) && scene_apart_from_eye(c->s, c->owner) && say_no_tree(c);
}

static bool absorption_rule(const inert_case *c)
{
    return opaque_rule(c) || unpassed(c) || mirror_rule(c);
}

static bool no_color(const inert_case *c)
{
    const char *text = integrator_traits_of(&c->s->render)->layers
                           ? "the shown layer has no colours"
                           : "this surface reflects no ambient or diffuse light";
    return !shows_color(c->s, c->m) && inert_say(c, "no-color", color_remedy(c->s, c->m, c->name).text, "%s", text);
}

/* A transparent solid also has a tint. */
static bool color_rule(const inert_case *c)
{
    const bool tints = !material_is_opaque(c->m) && !integrator_traits_of(&c->s->render)->layers;
    return !tints ? no_color(c) : !shows_color(c->s, c->m) && unpassed(c);
}

static bool tint_distance_rule(const inert_case *c)
{
    const vec3 white = c->m->color;
    return absorption_rule(c) ||
           (white.x == 1.0 && white.y == 1.0 && white.z == 1.0 &&
            inert_say(c, "no-tint", set_on(c, "color=0.9,0.7,0.5").text, "color is white: nothing is tinted"));
}

static bool is_black_surface(const inert_case *c)
{
    return is_black(c->m->color) && (c->m->checker == 0.0 || is_black(c->m->checker_color)) &&
           inert_say(c, "black", set_on(c, "color=0.8,0.8,0.8").text, "the surface's color is black");
}

static bool ambient_rule(const inert_case *c)
{
    return no_ambient_on_paths(c) || is_black_surface(c) ||
           (is_black(c->s->background.ambient) &&
            inert_say(c, "dark-ambient", "set background.ambient=1,1,1", "background.ambient is black"));
}

static bool diffuse_rule(const inert_case *c)
{
    const bool scatters = is_path(c->s) && material_is_opaque(c->m);
    return is_black_surface(c) || (!scatters && no_lamp(c));
}

/* Weights are not negative: a full highlight that changes nothing is nowhere in the image. */
static bool no_highlight(const inert_case *c)
{
    return strcmp(c->at.row->name, "specular") == 0 && c->m->specular < 1.0 &&
           inert_same(c, "%s.specular=1", c->name) &&
           inert_say(c, "unseen-highlight", "move it, the light or the camera",
                     "no lit part of it in this image reflects a light towards the camera");
}

static bool specular_rule(const inert_case *c)
{
    const scene *s = c->s;
    if (!is_path(s) && s->render.lighting == LIGHTING_LAMBERT)
        return inert_say(c, "lambert", "set render.lighting=phong", "Lambert shading has no highlights");
    return no_lamp(c) ||
           (only_spheres_shine(s) && !material_is_opaque(c->m) &&
            inert_say(c, "sphere-highlight", "set render.integrator=whitted",
                      "a transparent surface reflects the lights directly and has no Phong highlight")) ||
           no_highlight(c);
}

static bool shininess_rule(const inert_case *c)
{
    return (c->m->specular == 0.0 &&
            inert_say(c, "no-specular", set_on(c, "specular=0.5").text, "specular is 0: there is no highlight")) ||
           specular_rule(c);
}

/* Weights are not negative: if the film is unchanged with full reflection, it is unchanged with less. A coating reduces
 * transmission by what it adds to reflection; if neither 1/2 nor 1 changes the film, both paths are black. */
bool mirrors_black(const inert_case *c)
{
    const background *sky = &c->s->background;
    const bool dark = sky->kind == BACKGROUND_UNIFORM && is_black(sky->color), clear = !material_is_opaque(c->m);
    return dark && c->m->reflectivity < 1.0 && !(clear && shining_lights(c->s) > 0) &&
           inert_same(c, "%s.reflectivity=1", c->name) && (!clear || inert_same(c, "%s.reflectivity=0.5", c->name)) &&
           inert_say(c, "mirrors-black", "set background.color=0.5,0.5,0.5",
                     "everything that it could reflect in this image is black");
}

static bool say_unseen(const inert_case *c)
{
    if (integrator_traits_of(&c->s->render)->layers)
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

static bool reflectivity_rule(const inert_case *c)
{
    const scene *s = c->s;
    if (layered_reflectivity(c))
        return true;
    /* The coating of a transparent surface also attenuates shadow rays. */
    const bool coats = !material_is_opaque(c->m) && !scene_has_constant_shares(&s->render);
    if (coats)
        return (!material_matches_surroundings(s, c->m) && unpassed(c)) || mirrors_black(c);
    if (integrator_traits_of(&s->render)->drawn && !material_is_opaque(c->m))
        return false;
    if (!follows_rays(s))
        return say_no_tree(c);
    if (nothing_at_depth_0(c))
        return true;
    if (material_is_mirror(c->m) && !scene_has_constant_shares(&s->render))
        return inert_say(c, "mirror", set_on(c, "transparency=0").text,
                         "its refractive index already makes it a mirror");
    return mirrors_black(c);
}

static bool coefficients_rule(const inert_case *c)
{
    const int64_t law = c->m->medium;
    if (law == MEDIUM_IOR || law >= MEDIUM_CATALOGUE)
        return inert_say(c, "no-law",
                         inert_set("%s.coefficients=1.5,0.004 and %s.medium=cauchy", c->name, c->name).text,
                         "medium %s has no coefficients", medium_words[law]);
    return index_rule(c);
}

static bool absorb_per_m_rule(const inert_case *c)
{
    return absorption_rule(c) ||
           (c->m->absorb_spectrum.count > 0 &&
            inert_say(c, "by-spectrum", set_on(c, "absorb_spectrum=[]").text, "absorb_spectrum replaces it"));
}

static bool scattering_rule(const inert_case *c)
{
    if (absorption_rule(c))
        return true;
    if (!is_path(c->s))
        return inert_say(c, "unscattered", "set render.integrator=path",
                         "only the path integrator shows scattering: the medium is treated as clear");
    return strcmp(c->at.row->name, "asymmetry") == 0 && c->m->scatter_per_m == 0.0 &&
           inert_say(c, "no-scattering", set_on(c, "scatter_per_m=2").text,
                     "scatter_per_m is 0: its medium does not scatter");
}

static bool texture_rule(const inert_case *c)
{
    return (c->s->texture_count == 0 &&
            inert_say(c, "no-textures", "add one under textures:", "the scene has no textures")) ||
           no_color(c);
}

static bool texture_size_rule(const inert_case *c)
{
    if (shape_of(&c->owner->shape)->triangles)
        return inert_say(c, "mesh-texture", "set it on a solid other than a mesh",
                         "a mesh has its own texture coordinates");
    if (!c->m->texture[0]) {
        const inert_remedy remedy = c->s->texture_count > 0
                                        ? inert_set("%s.texture=%s", c->name, c->s->textures[0].name)
                                        : (inert_remedy){"add one under textures:"};
        return inert_say(c, "no-texture", remedy.text, "the surface has no texture");
    }
    return no_color(c);
}

static bool same_vector(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool checker_rule(const inert_case *c)
{
    return no_color(c) ||
           (same_vector(c->m->color, c->m->checker_color) &&
            inert_say(c, "one-color", set_on(c, "checker_color=0.2,0.4,0.6").text, "checker_color equals color"));
}

static bool checker_color_rule(const inert_case *c)
{
    return (c->m->checker == 0.0 &&
            inert_say(c, "no-checker", set_on(c, "checker=0.2").text, "checker is 0: there is no checker pattern")) ||
           no_color(c);
}

bool is_among(const inert_case *c, const char *const *names)
{
    while (*names && strcmp(*names, c->at.row->name) != 0)
        names++;
    return *names != NULL;
}

/* Phong terms: all reflection of a transparent surface's own lighting. */
static const char *const of_surface[] = {"ambient",      "diffuse", "specular",      "shininess", "texture",
                                         "texture_size", "checker", "checker_color", NULL};

/* The reflection of a surface that no ray hits. Light that crosses a transparent surface to another one does not count.
 * */
static bool unseen(const inert_case *c)
{
    static const char *const of_opaque[] = {"color", "emission", NULL};
    static const char *const of_mirror[] = {"reflectivity", "extinction", "medium", "film_thickness_nm",
                                            "film_ior",     "roughness",  NULL};
    const bool mirrors = is_among(c, of_mirror),
               sent_back =
                   is_among(c, of_surface) || (c->m->transparency == 0.0 && (is_among(c, of_opaque) || mirrors));
    /* photons may reach it, and what it reflects may reach what is seen: not if a full mirror changes nothing */
    const bool lights = mirrors && scene_has_caustics(&c->s->render);
    return sent_back && !(lights && !inert_same(c, "%s.reflectivity=1", c->name)) && c->frame &&
           c->frame->hits[c->owner - c->s->solids] == 0 && say_unseen(c);
}

/* A transparent solid with the index of the surroundings has no surface, unless it touches another transparent one. */
static bool no_interface(const inert_case *c)
{
    const scene *s = c->s;
    if (scene_has_constant_shares(&s->render) ||
        !(is_among(c, of_surface) || strcmp(c->at.row->name, "roughness") == 0))
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

/* Entirely inside a solid that has precedence: no ray hits it. */
static bool covered(const inert_case *c)
{
    const solid *cover = scene_cover(c->s, c->owner);
    return cover &&
           inert_say(c, "covered", inert_set("%s.priority=%lld", c->owner->name, (long long)cover->priority + 1).text,
                     "%s is entirely inside %s, which has precedence there", c->owner->name, cover->name);
}

bool inert_appearance(const inert_case *c)
{
    static const inert_row rows[] = {
        {"color", color_rule},
        {"emission", is_black_surface},
        {"ambient", ambient_rule},
        {"diffuse", diffuse_rule},
        {"specular", specular_rule},
        {"shininess", shininess_rule},
        {"reflectivity", reflectivity_rule},
        {"ior", index_rule},
        {"medium", medium_rule},
        {"extinction", extinction_rule},
        {"extraordinary_ior", crystal_rule},
        {"optic_axis", optic_axis_rule},
        {"film_thickness_nm", film_rule},
        {"film_ior", film_index_rule},
        {"sheet", sheet_rule},
        {"sheet_axis", sheet_axis_rule},
        {"sheet_pass", sheet_share_rule},
        {"sheet_block", sheet_share_rule},
        {"retardance_deg", retardance_rule},
        {"birefringence", retardance_rule},
        {"roughness", roughness_rule},
        {"coefficients", coefficients_rule},
        {"absorb_per_m", absorb_per_m_rule},
        {"absorb_spectrum", absorption_rule},
        {"scatter_per_m", scattering_rule},
        {"asymmetry", scattering_rule},
        {"tint_distance", tint_distance_rule},
        {"texture", texture_rule},
        {"texture_size", texture_size_rule},
        {"checker", checker_rule},
        {"checker_color", checker_color_rule},
        {NULL, NULL},
    };
    return inert_by_name(rows, c) || covered(c) || no_interface(c) || unseen(c);
}

bool inert_surface(const inert_case *c)
{
    return may_have_face_materials(c->s, c->owner) ? inert_faces(c) : inert_appearance(c);
}

static bool unused(const inert_case *c, const solid *hidden)
{
    const inert_remedy remedy =
        hidden ? inert_set("%s.visible=on", hidden->name) : (inert_remedy){"assign it to a visible solid"};
    return inert_say(c, "unused-material", remedy.text, "no visible solid has this material");
}

/* For each visible solid with the material, and each face with its name; the result is the first one's. */
bool inert_material(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL;
    inert_answer first = {.rule = ""}, other;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const bool by_face = may_have_face_materials(s, one);
        if (one->material_index != (int)c->at.index && !by_face)
            continue;
        hidden = one->visible || by_face ? hidden : one;
        inert_case user = *c;
        user.owner = one, user.m = &one->surface, user.out = first.rule[0] ? &other : &first;
        if (one->visible && !(by_face ? inert_named_faces(&user) : inert_appearance(&user)))
            return false;
    }
    if (!first.rule[0])
        return unused(c, hidden);
    *c->out = first;
    return true;
}
