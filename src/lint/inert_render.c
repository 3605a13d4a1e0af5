/* Facts of the image that leave settings of the renderer and the camera without effect. */
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/camera.h"
#include "scene/model/cover.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

static const char *const WHITTED = "set render.integrator=whitted";

bool path_samples(const inert_case *c)
{
    return is_path(c->s) && c->s->render.filter == PIXEL_FILTER_BOX &&
           inert_say(c, "path-box", "set render.filter=centre", "every path has its own random point of the pixel");
}

static bool is_rough(const scene *s, const solid *one)
{
    return material_roughness(&one->surface, &s->render) > 0.0 || may_have_face_materials(s, one);
}

/* Whether the solid would be rough with a roughness of 1. */
static bool could_be_rough(const scene *s, const solid *one)
{
    material rough = one->surface;
    rough.roughness = 1.0;
    return material_roughness(&rough, &s->render) > 0.0;
}

bool no_roughness(const inert_case *c)
{
    const scene *s = c->s;
    if (first_visible(s, is_rough))
        return false;
    const solid *one = first_visible(s, could_be_rough);
    const char *name = one ? one->name : s->solid_count > 0 ? s->solids[0].name : "SOLID";
    const inert_remedy remedy =
        one ? inert_set("%s.roughness=0.5", name) : inert_set("%s.reflectivity=0.5 and %s.roughness=0.5", name, name);
    return inert_say(c, "no-roughness", remedy.text, "no visible surface is rough");
}

static inert_remedy mirror_remedy(const scene *s)
{
    return inert_set_on(first_visible(s, NULL), "reflectivity=0.5");
}

bool nothing_beyond(const inert_case *c)
{
    const scene *s = c->s;
    scene sky = *s; /* borrows from s */
    sky.render.beyond = DEPTH_LIMIT_SKY;
    if (is_dark_at_depth_limit(&sky))
        return inert_say(c, "dark-sky", "set background.color=0.5,0.5,0.5", "the background is black as well");
    /* With every value but black, cut rays have some radiance, and weights are not negative: if the film is the same
     * with black and another value, no ray is cut. */
    const bool nothing_cut = s->render.beyond != DEPTH_LIMIT_BLACK
                                 ? inert_unchanged(c, "render.beyond=black")
                                 : inert_unchanged(c, "render.beyond=sky") && inert_unchanged(c, "render.beyond=mean");
    return nothing_cut && inert_say(c, "nothing-cut", s->render.depth > 1 ? "set render.depth=1" : "set render.depth=0",
                                    "no ray beyond render.depth carries more light than the film resolves");
}

/* The lighting model affects only highlights and secondary rays. */
bool no_highlights(const inert_case *c)
{
    const scene *s = c->s;
    scene shiny = *s; /* borrows what s owns */
    shiny.render.lighting = LIGHTING_PHONG;
    bool highlight = is_drawn(s) && first_visible(s, is_clear);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        highlight |= one->visible && (shows_specular(&shiny, &one->surface) || may_have_face_materials(s, one));
    }
    if (highlight)
        return false;
    if (!integrator_traits_of(&s->render)->tree)
        return inert_say(c, "no-highlight", WHITTED,
                         "no light produces a highlight, and this render.integrator traces no secondary rays");
    return (!first_visible(s, sends_rays_on) || (s->render.depth == 0 && is_dark_at_depth_limit(s))) &&
           inert_say(c, "no-highlight", mirror_remedy(s).text,
                     "no visible surface has a highlight, reflects or refracts");
}

/* Faces from a file may be transparent under simple transmission. */
bool some_face_materials(const inert_case *c)
{
    return first_visible(c->s, may_have_face_materials) != NULL;
}

/* Weights and transmission have two values each: the film with the other value decides. */
bool same_when_drawn(const inert_case *c)
{
    const scene *s = c->s;
    const char *other = is_named(c, "weights") ? (s->render.weights == WEIGHTS_FRESNEL ? "constant" : "fresnel")
                        : s->render.transmission == TRANSMISSION_SIMPLE ? "refract"
                                                                        : "simple";
    return !follows_rays(s) && !draws_through(s) && inert_unchanged(c, "render.%s=%s", c->at.row->name, other) &&
           say_no_tree(c);
}

/* A crystal polarises its rays with either value of render.polarisation; the values differ only if the rays meet
 * something outside. */
static bool one_crystal(const inert_case *c)
{
    int clear = 0;
    for (size_t i = 0; i < c->s->solid_count; i++)
        clear += c->s->solids[i].visible && !solid_is_opaque(c->s, &c->s->solids[i]);
    return clear == 1 && scene_crystals(c->s) == 1 &&
           inert_unchanged(c, "render.polarisation=%s", c->s->render.polarisation ? "off" : "on") &&
           inert_say(c, "one-crystal", "set camera.analyser=linear",
                     "the rays that leave the crystal, the only transparent solid, meet no surface that depends on "
                     "polarisation");
}

/* An analyser halves unpolarised light, but only where polarisation is traced. */
bool polarisation_unseen(const inert_case *c)
{
    return c->s->camera.analyser == ANALYSER_NONE && (inert_polarisation(c) || one_crystal(c));
}

static bool deflects_light(const scene *s, const solid *one)
{
    return one->surface.transparency > 0.0 || one->surface.reflectivity > 0.0 ||
           material_is_layered(&one->surface, &s->render) || may_have_face_materials(s, one);
}

bool no_photons(const inert_case *c)
{
    const scene *s = c->s;
    if (beams_light(s) || s->beam_count > 0) /* only the witness can decide */
        return false;
    return nothing_lit(c) ||
           (!first_visible(s, deflects_light) &&
            inert_say(c, "nothing-deflects", mirror_remedy(s).text, "no visible surface reflects or transmits light"));
}

/* render.caustics=photons also makes radiance basic and shadows opaque, which may change a film without photons. */
bool same_photons(const inert_case *c)
{
    return no_photons(c) &&
           inert_unchanged(c, "render.caustics=%s", c->s->render.caustics == CAUSTICS_OFF ? "photons" : "off");
}

bool lit_by_hits(const inert_case *c)
{
    return only_spheres_shine(c->s) && c->s->render.caustics == CAUSTICS_OFF &&
           inert_say(c, "spheres", WHITTED, "random paths hit lights that have a size");
}

/* The table asks nothing_lit first, so some light has an intensity. */
bool no_size(const inert_case *c)
{
    const scene *s = c->s;
    const light *first = NULL;
    for (size_t i = 0; i < s->light_count; i++) {
        const light *l = &s->lights[i];
        if (l->intensity > 0.0 && light_has_size(l))
            return false;
        first = !first && l->intensity > 0.0 ? l : first;
    }
    const inert_remedy sized =
        first->kind == LIGHT_SUN ? inert_set("%s.angular_diameter_deg=0.53", first->name)
        : first->kind == LIGHT_RECTANGLE
            ? inert_set("%s.reach=8, %s.width=1 and %s.height=1", first->name, first->name, first->name)
            : inert_set("%s.reach=8 and %s.radius=1", first->name, first->name);
    return inert_say(c, "no-size", sized.text, "no light has a size");
}

bool one_light(const inert_case *c)
{
    return shining_lights(c->s) < 2 && inert_say(c, "one-light", "add a second light", "only one light shines");
}

/* The wavelengths of a spectral film (render/plan/spectra.c) and the points of a lens are also random. */
bool no_random_numbers(const inert_case *c)
{
    const render_settings *r = &c->s->render;
    return !scene_has_caustics(r) && !camera_lens_is_sampled(c->s) && !scene_has_soft_shadows(r) &&
           r->spectrum != SPECTRUM_SPECTRAL && !is_path(c->s) &&
           inert_say(c, "no-random", "set render.integrator=path", "this image needs no random numbers");
}

static bool is_dispersive(const index_law *law)
{
    return law->law.kind != DISPERSION_CONSTANT || law->relative_to_air;
}

static bool has_dispersion(const scene *s, const solid *one)
{
    index_law law;
    (void)s;
    return one->surface.transparency > 0.0 && material_index_law(&one->surface, "", &law, NULL) == STATUS_OK &&
           is_dispersive(&law);
}

static bool retards_by_path(const scene *s, const solid *one)
{
    return !solid_is_opaque(s, one) && sheet_disperses(&one->surface, &s->render);
}

bool no_dispersion(const inert_case *c)
{
    const scene *s = c->s;
    const index_law around = surrounding_index_law(&s->background);
    return !is_dispersive(&around) && !first_visible(s, has_dispersion) && !first_visible(s, retards_by_path) &&
           inert_say(c, "no-dispersion", inert_set_on(first_visible(s, is_clear), "medium=bk7").text,
                     "the index of every transparent medium is constant");
}

static bool absorbs(const scene *s, const solid *one)
{
    return !material_is_opaque(&one->surface) &&
           (material_absorbs(&one->surface) || material_scatters(&one->surface, &s->render));
}

bool no_absorption(const inert_case *c)
{
    const scene *s = c->s;
    const solid *clear = first_visible(s, is_clear);
    const inert_remedy remedy = clear ? inert_set("%s.absorb_per_m=0.2,0.4,0.8", clear->name)
                                      : inert_set("background.absorb_per_m=0.01,0.02,0.04");
    return !surroundings_absorb(&s->background) && !first_visible(s, absorbs) && !first_visible(s, retards_by_path) &&
           inert_say(c, "no-absorption", remedy.text, "no medium that light passes through absorbs or scatters");
}

static bool shows_texture(const scene *s, const solid *one)
{
    return (one->surface.texture[0] && shows_color(s, &one->surface)) || may_have_face_materials(s, one);
}

bool untextured(const inert_case *c)
{
    const solid *first = first_visible(c->s, NULL);
    const inert_remedy remedy = first && c->s->texture_count > 0
                                    ? inert_set("%s.texture=%s", first->name, c->s->textures[0].name)
                                    : (inert_remedy){"give a visible solid a texture"};
    return !first_visible(c->s, shows_texture) &&
           inert_say(c, "untextured", remedy.text, "no visible surface has a texture");
}

/* With any aperture, all rays pass through the centre of the lens. */
bool lens_unsampled(const inert_case *c)
{
    scene wide = *c->s; /* borrows what c->s owns */
    wide.camera.aperture = 1.0;
    if (camera_lens_is_sampled(&wide))
        return false;
    if (is_drawn(c->s) || is_unlit(c->s))
        return inert_say(c, "chief-rays", "set render.integrator=whitted and render.samples=16",
                         "this render.integrator uses only rays through the centre of the lens");
    return inert_say(c, "one-ray", is_path(c->s) ? "set render.paths=64" : "set render.samples=16",
                     "the only ray of a pixel passes through the centre of the lens");
}

/* --- basic and classic radiance are equal if all light paths begin and end in a vacuum, because n^2 is 1 there
 * (render/shade/radiance.c) --- */

static bool is_bare(const background *b)
{
    return b->medium == MEDIUM_IOR && b->ior == 1.0;
}

/* Basic and classic radiance differ inside the solid. */
static bool is_dense(const scene *s, const solid *one)
{
    (void)s;
    const material *m = &one->surface;
    return one->visible && !material_is_opaque(m) && !(m->medium == MEDIUM_IOR && m->ior == 1.0);
}

/* The solid is dense, or may be inside a dense one. */
static bool may_be_in_dense(const scene *s, const solid *one)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (is_dense(s, other) && (other == one || !scene_disjoint(s, one, other)))
            return true;
    }
    return false;
}

static bool may_contain_camera(const scene *s, const solid *one)
{
    return is_dense(s, one) && !scene_apart_from_eye(s, one);
}

static bool glows_in_dense(const scene *s, const solid *one)
{
    const bool glows =
        one->surface.emission > 0.0 || shows_ambient(s, &one->surface) || may_have_face_materials(s, one);
    return glows && may_be_in_dense(s, one);
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
    if (first_visible(s, may_contain_camera) || first_visible(s, glows_in_dense))
        return false;
    /* random paths reach lights with a size through the surfaces between; a light may be in a dense medium, so the film
     * decides */
    const bool outside =
        shining_lights(s) == 0 ||
        (only_spheres_shine(s) &&
         inert_unchanged(c, "render.radiance=%s", s->render.radiance == RADIANCE_BASIC ? "classic" : "basic"));
    return outside && inert_say(c, "light-outside", inert_set("%s.emission=0.5", dense->name).text,
                                "all light paths begin and end outside transparent solids");
}
