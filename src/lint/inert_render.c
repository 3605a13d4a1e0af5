/* Renderer settings without effect. */
#include "lint/inert_private.h"
#include "geometry/shapes/shape.h"
#include "scene/model/camera.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "scene/model/sheet.h"

static const char *const WHITTED = "set render.integrator=whitted";

static bool path_only(const inert_case *c)
{
    return !is_path(c->s) &&
           inert_say(c, "path-only", "set render.integrator=path", "only the path integrator uses random numbers");
}

static bool samples(const inert_case *c)
{
    return is_path(c->s) && c->s->render.filter == PIXEL_FILTER_BOX &&
           inert_say(c, "path-box", "set render.filter=centre", "every path has its own random point of the pixel");
}

/* Russian roulette starts after the third surface: render/integrators/path.c. */
static bool roulette(const inert_case *c)
{
    enum { ROULETTE_DEPTH = 3 };
    if (path_only(c))
        return true;
    return c->s->render.depth <= ROULETTE_DEPTH &&
           inert_say(c, "roulette-depth", "set render.depth=8",
                     "Russian roulette starts at depth %d, and render.depth is %lld", ROULETTE_DEPTH + 1,
                     (long long)c->s->render.depth);
}

static bool is_rough(const scene *s, const solid *one)
{
    return material_roughness(&one->surface, &s->render) > 0.0 || may_have_face_materials(s, one);
}

/* The first solid that would be rough with a roughness. */
static bool could_be_rough(const scene *s, const solid *one)
{
    material rough = one->surface;
    rough.roughness = 1.0;
    return material_roughness(&rough, &s->render) > 0.0;
}

static bool energy_compensation(const inert_case *c)
{
    const scene *s = c->s;
    if (!is_path(s))
        return inert_say(c, "smooth-rays", "set render.integrator=path",
                         "only the path integrator shows roughness: all surfaces are treated as smooth");
    if (first_visible(s, is_rough))
        return false;
    const solid *one = first_visible(s, could_be_rough);
    const char *name = one ? one->name : s->solid_count > 0 ? s->solids[0].name : "SOLID";
    const inert_remedy remedy =
        one ? inert_set("%s.roughness=0.5", name) : inert_set("%s.reflectivity=0.5 and %s.roughness=0.5", name, name);
    return inert_say(c, "no-roughness", remedy.text, "no visible surface is rough");
}

static bool nothing_goes_on(const scene *s)
{
    return !first_visible(s, sends_rays_on);
}

static inert_remedy mirror_remedy(const scene *s)
{
    return inert_set_on(first_visible(s, NULL), "reflectivity=0.5");
}

/* No secondary rays. */
static bool no_tree(const inert_case *c)
{
    const scene *s = c->s;
    if (draws_through(s))
        return false;
    if (!follows_rays(s))
        return say_no_tree(c);
    return nothing_goes_on(s) &&
           inert_say(c, "no-branches", mirror_remedy(s).text, "no visible surface reflects or refracts");
}

static bool beyond(const inert_case *c)
{
    const scene *s = c->s;
    if (no_tree(c))
        return true;
    if (s->render.depth == DEPTH_UNLIMITED)
        return inert_say(c, "nothing-cut", "set render.depth=8", "render.depth is unlimited: no path is cut");
    scene sky = *s; /* borrows from s */
    sky.render.beyond = DEPTH_LIMIT_SKY;
    if (is_dark_at_depth_limit(&sky))
        return inert_say(c, "dark-sky", "set background.color=0.5,0.5,0.5", "the background is black as well");
    /* Each word except black gives cut rays some radiance, and weights are not negative: if the film is the same with
     * both, no ray is cut. */
    const bool nothing_cut = s->render.beyond != DEPTH_LIMIT_BLACK
                                 ? inert_same(c, "render.beyond=black")
                                 : inert_same(c, "render.beyond=sky") && inert_same(c, "render.beyond=mean");
    return nothing_cut && inert_say(c, "nothing-cut", s->render.depth > 1 ? "set render.depth=1" : "set render.depth=0",
                                    "no ray beyond render.depth carries more light than the film resolves");
}

/* The lighting model affects only highlights and secondary rays. */
static bool lighting(const inert_case *c)
{
    const scene *s = c->s;
    if (is_path(s))
        return inert_say(c, "not-path", WHITTED, "the path integrator has one lighting model");
    scene shiny = *s; /* borrows what s owns */
    shiny.render.lighting = LIGHTING_PHONG;
    bool highlight = integrator_traits_of(&s->render)->drawn && first_visible(s, is_clear);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        highlight |= one->visible && (shows_specular(&shiny, &one->surface) || may_have_face_materials(s, one));
    }
    if (highlight)
        return false;
    if (!integrator_traits_of(&s->render)->tree)
        return inert_say(c, "no-highlight", WHITTED,
                         "no light produces a highlight, and this render.integrator traces no secondary rays");
    return (nothing_goes_on(s) || (s->render.depth == 0 && is_dark_at_depth_limit(s))) &&
           inert_say(c, "no-highlight", mirror_remedy(s).text,
                     "no visible surface has a highlight, reflects or refracts");
}

/* A plane alone is a poor example of a transparent solid. */
static inert_remedy clear_remedy(const scene *s)
{
    const solid *first = first_visible(s, NULL);
    for (size_t i = 0; i < s->solid_count; i++)
        first = first && shape_of(&first->shape)->unbounded && s->solids[i].visible ? &s->solids[i] : first;
    return inert_set_clear(first);
}

static bool no_clear(const inert_case *c)
{
    return !first_visible(c->s, is_clear) &&
           inert_say(c, "no-clear", clear_remedy(c->s).text, "no visible solid is transparent");
}

/* For two words the film with the other one decides. */
static bool same_but_for(const inert_case *c, const char *one, const char *other, bool is_one)
{
    const scene *s = c->s;
    return !follows_rays(s) && !draws_through(s) &&
           inert_same(c, "render.%s=%s", c->at.row->name, is_one ? other : one) && say_no_tree(c);
}

static bool transmission(const inert_case *c)
{
    if (first_visible(c->s, may_have_face_materials))
        return false; /* faces from a file may be transparent under simple transmission */
    return no_clear(c) || same_but_for(c, "refract", "simple", c->s->render.transmission != TRANSMISSION_SIMPLE);
}

static bool weights(const inert_case *c)
{
    return no_clear(c) || same_but_for(c, "fresnel", "constant", c->s->render.weights == WEIGHTS_FRESNEL) ||
           (c->s->render.transmission == TRANSMISSION_SIMPLE &&
            inert_say(c, "simple", "set render.transmission=refract",
                      "simple transmission uses the materials' constants"));
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
    if (!integrator_traits_of(&c->s->render)->drawn && first_visible(c->s, has_sheet))
        return false;
    return no_tree(c) || (!first_visible(c->s, is_layered) && no_clear(c));
}

/* The rays of a crystal are polarised with either setting; the settings differ for what they meet outside. */
static bool one_crystal(const inert_case *c)
{
    int clear = 0;
    for (size_t i = 0; i < c->s->solid_count; i++)
        clear += c->s->solids[i].visible && !solid_is_opaque(c->s, &c->s->solids[i]);
    return clear == 1 && scene_crystals(c->s) == 1 &&
           inert_same(c, "render.polarisation=%s", c->s->render.polarisation ? "off" : "on") &&
           inert_say(c, "one-crystal", "set camera.analyser=linear",
                     "the rays that leave the only transparent solid, a crystal, meet no other one");
}

/* An analyser halves unpolarised light, but only where polarisation is traced. */
static bool polarisation(const inert_case *c)
{
    return c->s->camera.analyser == ANALYSER_NONE && (inert_polarisation(c) || one_crystal(c));
}

static bool nothing_lit(const inert_case *c)
{
    const scene *s = c->s;
    return no_lamp(c) || (!first_visible(s, shows_lamps) &&
                          inert_say(c, "nothing-lit", inert_set_on(first_visible(s, NULL), "diffuse=0.7").text,
                                    "no visible surface is lit by lights"));
}

static bool deflects_light(const scene *s, const solid *one)
{
    return one->surface.transparency > 0.0 || one->surface.reflectivity > 0.0 ||
           material_is_layered(&one->surface, &s->render) || may_have_face_materials(s, one);
}

static bool no_photons(const inert_case *c)
{
    const scene *s = c->s;
    if (integrator_traits_of(&s->render)->drawn)
        return inert_say(c, "zbuffer-caustics", WHITTED, "the depth buffer traces no light");
    if (s->render.shadows == SHADOWS_OFF)
        return inert_say(c, "no-shadows-caustics", "set render.shadows=opaque",
                         "without shadows light passes every solid undeflected");
    if (beams_light(s) || c->s->beam_count > 0) /* the witness knows */
        return false;
    return nothing_lit(c) ||
           (!first_visible(s, deflects_light) &&
            inert_say(c, "nothing-deflects", mirror_remedy(s).text, "no visible surface reflects or transmits light"));
}

static bool soft_shadows(const inert_case *c)
{
    const scene *s = c->s;
    if (is_path(s))
        return inert_say(c, "always-soft", WHITTED, "random paths always sample the size of lights");
    if (integrator_traits_of(&s->render)->drawn)
        return inert_say(c, "no-shadows", WHITTED, "the depth-buffer integrator renders no shadows");
    if (s->render.shadows == SHADOWS_OFF)
        return inert_say(c, "no-soft-shadows", "set render.shadows=opaque", "render.shadows is off");
    if (nothing_lit(c))
        return true;
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

/* Photons also make radiance basic and shadows opaque, which may act where they do not. */
static bool caustics(const inert_case *c)
{
    return no_photons(c) &&
           inert_same(c, "render.caustics=%s", c->s->render.caustics == CAUSTICS_OFF ? "photons" : "off");
}

static bool photons(const inert_case *c)
{
    const bool off = c->s->render.caustics == CAUSTICS_OFF && !integrator_traits_of(&c->s->render)->drawn;
    return (off && inert_say(c, "no-photons", "set render.caustics=photons", "render.caustics is off")) ||
           no_photons(c);
}

/* Wavelengths of the spectral film are also random, render/shade/spectra.c, and so are points of a lens. */
static bool seed(const inert_case *c)
{
    if (scene_has_caustics(&c->s->render) || camera_lens_is_sampled(c->s) || scene_has_soft_shadows(&c->s->render))
        return false;
    return c->s->render.spectrum != SPECTRUM_SPECTRAL && path_only(c);
}

/* A pilot has 16 paths: render/core/path_counts.h. */
static bool error(const inert_case *c)
{
    enum { PILOT_PATHS = 16 };
    return path_only(c) ||
           (c->s->render.paths <= PILOT_PATHS &&
            inert_say(c, "few-paths", "set render.paths=256",
                      "render.paths, the largest number of paths, is not above the pilot's %d", PILOT_PATHS));
}

static bool light_sampling(const inert_case *c)
{
    if (path_only(c) || nothing_lit(c))
        return true;
    return shining_lights(c->s) < 2 && inert_say(c, "one-light", "add a second light", "the scene has one light");
}

static bool shadows(const inert_case *c)
{
    const scene *s = c->s;
    if (integrator_traits_of(&s->render)->drawn)
        return inert_say(c, "no-shadows", WHITTED, "the depth-buffer integrator renders no shadows");
    return nothing_lit(c) || (only_spheres_shine(s) && s->render.caustics == CAUSTICS_OFF &&
                              inert_say(c, "spheres", WHITTED, "random paths hit lights that have a size"));
}

static bool min_weight(const inert_case *c)
{
    if (is_path(c->s))
        return inert_say(c, "whitted-only", WHITTED,
                         "the path integrator has no ray tree: render.roulette ends faint paths");
    return no_tree(c) || (c->s->render.depth == 0 && inert_say(c, "depth-0", "set render.depth=4",
                                                               "render.depth is 0: no secondary rays are traced"));
}

static bool wavelengths(const inert_case *c)
{
    return c->s->render.spectrum != SPECTRUM_SPECTRAL &&
           inert_say(c, "spectral-only", "set render.spectrum=spectral", "the film is RGB");
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

static bool lambda(const inert_case *c)
{
    const scene *s = c->s;
    if (s->render.spectrum == SPECTRUM_SPECTRAL)
        return inert_say(c, "rgb-only", "set render.spectrum=rgb",
                         "the spectral film uses the index of each wavelength");
    const index_law around = surrounding_index_law(&s->background);
    return no_clear(c) ||
           (!is_dispersive(&around) && !first_visible(s, has_dispersion) && !first_visible(s, retards_by_path) &&
            inert_say(c, "no-dispersion", inert_set_on(first_visible(s, is_clear), "medium=bk7").text,
                      "the index of every transparent medium is constant"));
}

static bool absorbs(const scene *s, const solid *one)
{
    return !material_is_opaque(&one->surface) &&
           (material_absorbs(&one->surface) || material_scattering(&one->surface, &s->render) > 0.0);
}

static bool unit(const inert_case *c)
{
    const scene *s = c->s;
    const solid *clear = first_visible(s, is_clear);
    const inert_remedy remedy = clear ? inert_set("%s.absorb_per_m=0.2,0.4,0.8", clear->name)
                                      : inert_set("background.absorb_per_m=0.01,0.02,0.04");
    return !surroundings_absorb(&s->background) && !first_visible(s, absorbs) && !first_visible(s, retards_by_path) &&
           inert_say(c, "no-absorption", remedy.text, "no medium that light passes absorbs or scatters");
}

static bool shows_texture(const scene *s, const solid *one)
{
    return (one->surface.texture[0] && shows_color(s, &one->surface)) || may_have_face_materials(s, one);
}

static bool texturing(const inert_case *c)
{
    if (!integrator_traits_of(&c->s->render)->drawn)
        return inert_say(c, "zbuffer-only", "set render.integrator=zbuffer",
                         "ray tracing is always perspective-correct");
    const solid *first = first_visible(c->s, NULL);
    const inert_remedy remedy = first && c->s->texture_count > 0
                                    ? inert_set("%s.texture=%s", first->name, c->s->textures[0].name)
                                    : (inert_remedy){"give a visible solid a texture"};
    return !first_visible(c->s, shows_texture) &&
           inert_say(c, "untextured", remedy.text, "no visible surface has a texture");
}

bool inert_render(const inert_case *c)
{
    static const inert_row rows[] = {
        {"depth", no_tree},
        {"beyond", beyond},
        {"lighting", lighting},
        {"weights", weights},
        {"transmission", transmission},
        {"shadows", shadows},
        {"soft_shadows", soft_shadows},
        {"caustics", caustics},
        {"photons", photons},
        {"min_weight", min_weight},
        {"paths", path_only},
        {"samples", samples},
        {"error", error},
        {"sampler", path_only},
        {"filter", path_only},
        {"light_sampling", light_sampling},
        {"roulette", roulette},
        {"energy_compensation", energy_compensation},
        {"seed", seed},
        {"radiance", inert_radiance},
        {"polarisation", polarisation},
        {"wavelengths", wavelengths},
        {"lambda_nm", lambda},
        {"unit_m", unit},
        {"texturing", texturing},
        {NULL, NULL},
    };
    return inert_by_name(rows, c);
}
