/* Parameters of lights and of the background without effect. */
#include "lint/inert_private.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "scene/model/sheet.h"
#include "scene/model/sun.h"

#include <string.h>

/* No visible surface is lit by lights, and no camera ray hits a light. */
static bool lights_nothing(const inert_case *c, const light *l)
{
    const scene *s = c->s;
    if (is_path(s) && light_has_size(l))
        return false;
    scene lit = *s; /* borrows from s; a single light with an intensity */
    light white = *l;
    white.color = vec3_make(1.0, 1.0, 1.0), white.intensity = 1.0, white.spectrum = LAMP_OF_COLOR;
    lit.lights = &white, lit.light_count = 1;
    const inert_remedy remedy = inert_set_on(first_visible(s, NULL), "diffuse=0.7");
    return !first_visible(&lit, shows_lamps) &&
           inert_say(c, "lights-nothing", remedy.text, "no visible surface is lit by lights");
}

/* Parameters of other spectra than the light's. */
static bool other_spectrum(const inert_case *c, const light *l)
{
    const char *name = c->at.row->name;
    if (strcmp(name, "color") == 0)
        return l->spectrum != LAMP_OF_COLOR &&
               inert_say(c, "colored-by-lamp", inert_set("%s.spectrum=color", c->name).text,
                         "the light's spectrum gives it its colour");
    if (strcmp(name, "temperature_k") == 0)
        return l->spectrum != LAMP_BLACK_BODY &&
               inert_say(c, "no-black-body", inert_set("%s.spectrum=black_body", c->name).text,
                         "the light is not a black body");
    return strcmp(name, "line_nm") == 0 && l->spectrum != LAMP_LINE &&
           inert_say(c, "no-line", inert_set("%s.spectrum=line", c->name).text, "the light's spectrum is not one line");
}

/* A sun's own size, and what a sun does not have. */
static bool sun_or_not(const inert_case *c, const light *l)
{
    static const struct {
        const char *name, *remedy;
    } not_of_sun[] = {{"half_angle_deg", "%s.kind=cone"},
                      {"radius", "render.integrator=path, %s.kind=point and %s.reach=8"},
                      {"width", "render.integrator=path, %s.kind=rectangle and %s.reach=8"},
                      {"height", "render.integrator=path, %s.kind=rectangle and %s.reach=8"},
                      {"roll_deg", "render.integrator=path, %s.kind=rectangle and %s.reach=8"},
                      {"reach", "%s.kind=point"}};
    const char *name = c->at.row->name;
    const bool of_sun = strcmp(name, "angular_diameter_deg") == 0;
    for (size_t i = 0; l->kind == LIGHT_SUN && i < sizeof not_of_sun / sizeof *not_of_sun; i++)
        if (strcmp(name, not_of_sun[i].name) == 0)
            return inert_say(c, "sun-lamp", inert_set(not_of_sun[i].remedy, c->name, c->name).text,
                             "a sun is infinitely far away");
    if (of_sun && l->kind != LIGHT_SUN)
        return inert_say(c, "no-sun", inert_set("%s.kind=sun", c->name).text, "the light is not a sun");
    return of_sun && !is_path(c->s) && !scene_has_soft_shadows(&c->s->render) &&
           inert_say(c, "sphere-lamp", "set render.integrator=path",
                     "only the path integrator and render.soft_shadows use the size of a light");
}

/* Parameters of other kinds of lights, and of a size that nothing samples. */
static bool other_shape(const inert_case *c, const light *l)
{
    const char *name = c->at.row->name;
    const bool of_rectangle =
                   strcmp(name, "width") == 0 || strcmp(name, "height") == 0 || strcmp(name, "roll_deg") == 0,
               of_radius = strcmp(name, "radius") == 0;
    if (strcmp(name, "target") == 0 && l->kind == LIGHT_POINT)
        return inert_say(c, "point-lamp", inert_set("%s.kind=cone", c->name).text,
                         "a point light emits in all directions");
    if (strcmp(name, "half_angle_deg") == 0 && l->kind != LIGHT_CONE && l->kind != LIGHT_SOFT_CONE)
        return inert_say(c, "point-lamp", inert_set("%s.kind=cone", c->name).text,
                         l->kind == LIGHT_POINT ? "a point light emits in all directions"
                                                : "a flat light emits by Lambert's law");
    if (of_rectangle && l->kind != LIGHT_RECTANGLE)
        return inert_say(c, "no-rectangle", inert_set("%s.kind=rectangle", c->name).text,
                         "the light is not a rectangle");
    if (of_radius && l->kind == LIGHT_RECTANGLE)
        return inert_say(c, "no-sphere", inert_set("%s.kind=disc", c->name).text, "a rectangle has width and height");
    if ((of_rectangle || of_radius) && !is_path(c->s) && !scene_has_soft_shadows(&c->s->render)) {
        const inert_remedy far = inert_set("render.integrator=path and %s.reach=8", c->name);
        return inert_say(c, "sphere-lamp", l->reach > 0.0 ? "set render.integrator=path" : far.text,
                         "only the path integrator and render.soft_shadows use the size of a light");
    }
    const bool needs_width = l->width == 0.0 && strcmp(name, "width") != 0,
               needs_height = l->height == 0.0 && strcmp(name, "height") != 0;
    return of_rectangle && (needs_width || needs_height) &&
           inert_say(c, "thin-rectangle", inert_set("%s.%s=1", c->name, needs_width ? "width" : "height").text,
                     "a rectangle without %s is a point", needs_width ? "width" : "height");
}

static bool is_polariser(const scene *s, const solid *one)
{
    return !solid_is_opaque(s, one) && sheet_is_polariser(&one->surface);
}

static bool shows_polarisation(const scene *s, const solid *one)
{
    return material_is_layered(&one->surface, &s->render) || is_clear(s, one);
}

/* Of light that matte surfaces receive through polarisers, or as photons from clear solids, metals or films, or that
 * random paths bring from these. */
static bool polarisation(const inert_case *c, const light *l)
{
    const scene *s = c->s;
    const bool degree = strcmp(c->at.row->name, "polarised") == 0;
    const bool photons = (scene_has_caustics(&s->render) || is_path(s)) && first_visible(s, shows_polarisation),
               through = s->render.shadows == SHADOWS_ATTENUATED && first_visible(s, is_polariser);
    if (!degree && strcmp(c->at.row->name, "polarisation_deg") != 0)
        return false;
    if (unpolarised(c))
        return true;
    if (!degree && l->polarised == 0.0)
        return inert_say(c, "unpolarised-lamp", inert_set("%s.polarised=1", c->name).text, "the light is unpolarised");
    const bool seen = is_path(s) && s->camera.analyser != ANALYSER_NONE && light_has_size(l);
    if (!photons && !through && !seen) {
        const inert_remedy clear = inert_set_clear(first_visible(s, NULL));
        return inert_say(c, "depolarised",
                         first_visible(s, shows_polarisation) ? "set render.caustics=photons" : clear.text,
                         "matte surfaces reflect light of every polarisation alike");
    }
    const bool same = degree
                          ? inert_same(c, "%s.polarised=%d", c->name, l->polarised == 0.0)
                          : inert_same(c, "%s.polarisation_deg=%.17g", c->name, l->polarisation_deg / 2.0 + 45.0) &&
                                inert_same(c, "%s.polarisation_deg=%.17g", c->name, l->polarisation_deg / 2.0 + 70.0);
    return same && inert_say(c, "depolarised-here", "move a polariser into the light",
                             "all that the light passes treats every polarisation alike");
}

/* The place, or the kind, of the light that the background's sun is, or would be. */
static bool moves_sky(const inert_case *c, const light *l)
{
    const background *b = &c->s->background;
    const light *shown = scene_sun(c->s);
    const cie_sky_type type = cie_sky_type_of((int)b->sky_type);
    const bool shows = b->kind == BACKGROUND_CIE ? type.c > 0.0 : b->kind == BACKGROUND_RAIN && b->rain > 0.0;
    const char *name = c->at.row->name;
    const bool place = strcmp(name, "position") == 0 || strcmp(name, "target") == 0;
    return shows && ((place && l == shown) || (strcmp(name, "kind") == 0 && (!shown || l == shown)));
}

bool inert_light(const inert_case *c)
{
    const light *l = &c->s->lights[c->at.index];
    const char *name = c->at.row->name;
    const bool of_color = strcmp(name, "color") == 0 || strcmp(name, "spectrum") == 0,
               of_intensity = strcmp(name, "intensity") == 0;
    if (moves_sky(c, l))
        return false;
    if (other_spectrum(c, l))
        return true;
    if (!of_intensity && l->intensity == 0.0)
        return inert_say(c, "dark-lamp", inert_set("%s.intensity=1", c->name).text, "the light's intensity is 0");
    if (!of_color && l->spectrum == LAMP_OF_COLOR && is_black(l->color))
        return inert_say(c, "dark-lamp", inert_set("%s.color=1,1,1", c->name).text, "the light's color is black");
    if (polarisation(c, l) || sun_or_not(c, l) || other_shape(c, l))
        return true;
    return lights_nothing(c, l);
}

static bool background_color(const inert_case *c)
{
    return c->s->background.kind == BACKGROUND_IMAGE &&
           inert_say(c, "picture-sky", "set background.kind=uniform", "the background is an image");
}

static bool horizon(const inert_case *c)
{
    return c->s->background.kind != BACKGROUND_GRADIENT && c->s->background.kind != BACKGROUND_RAIN &&
           c->s->background.kind != BACKGROUND_CIE &&
           inert_say(c, "no-gradient", "set background.kind=gradient", "the background is not a gradient");
}

/* A gradient between equal colours is uniform, and so is one type of CIE sky; an image background needs a file; rain
 * may be black. */
static bool kind(const inert_case *c)
{
    const background *b = &c->s->background;
    const bool flat = b->color.x == b->horizon.x && b->color.y == b->horizon.y && b->color.z == b->horizon.z;
    return flat && b->rain == 0.0 && b->sky_type == CIE_SKY_UNIFORM && b->kind != BACKGROUND_IMAGE &&
           !b->image_path[0] &&
           inert_say(c, "flat-gradient", "set background.horizon=0.5,0.4,0.3",
                     "'horizon' equals 'color', so there is no gradient");
}

static bool sunlit_rain(const inert_case *c)
{
    const background *b = &c->s->background;
    if (b->kind != BACKGROUND_RAIN)
        return inert_say(c, "no-rain", "set background.kind=rain", "the background is not rain");
    return strcmp(c->at.row->name, "rain") != 0 && b->rain == 0.0 &&
           inert_say(c, "no-rain", "set background.rain=0.3", "background.rain is 0: nothing scatters the sun's light");
}

static bool sky_type(const inert_case *c)
{
    return c->s->background.kind != BACKGROUND_CIE &&
           inert_say(c, "no-cie-sky", "set background.kind=cie", "the background is not a CIE sky");
}

/* Of rain or of a CIE sky. */
static bool sun(const inert_case *c)
{
    const background *b = &c->s->background;
    const light *lamp = scene_sun(c->s);
    const cie_sky_type type = cie_sky_type_of((int)b->sky_type);
    if (lamp && (b->kind == BACKGROUND_CIE || b->kind == BACKGROUND_RAIN))
        return inert_say(c, "sun-is-light", inert_set("%s.kind=point", lamp->name).text,
                         "the background's sun is where the light of kind sun is");
    if (b->kind != BACKGROUND_CIE)
        return sunlit_rain(c);
    return type.c == 0.0 &&
           inert_say(c, "even-sky", "set background.sky_type=12", "a CIE sky of this type does not depend on the sun");
}

static bool azimuth(const inert_case *c)
{
    const double elevation = c->s->background.sun_elevation_deg;
    return sun(c) || ((elevation == 90.0 || elevation == -90.0) &&
                      inert_say(c, "sun-overhead", "set background.sun_elevation_deg=20",
                                "the sun is vertically above or below, where it has no azimuth"));
}

static bool has_ambient(const scene *s, const solid *one)
{
    return shows_ambient(s, &one->surface) || may_have_face_materials(s, one);
}

static bool ambient(const inert_case *c)
{
    const scene *s = c->s;
    if (no_ambient_on_paths(c))
        return true;
    scene bright = *s; /* borrows from s */
    bright.background.ambient = vec3_make(1.0, 1.0, 1.0);
    const inert_remedy remedy = inert_set_on(first_visible(s, NULL), "ambient=0.5");
    return !first_visible(&bright, has_ambient) &&
           inert_say(c, "no-ambient", remedy.text, "no visible surface has an ambient term");
}

static bool matches_surroundings(const scene *s, const solid *one)
{
    return !material_is_opaque(&one->surface) && material_matches_surroundings(s, &one->surface);
}

static bool surrounding_index(const inert_case *c)
{
    const scene *s = c->s;
    if (!first_visible(s, is_clear))
        return inert_say(c, "no-clear", inert_set_clear(first_visible(s, NULL)).text,
                         "no visible solid is transparent: nothing refracts");
    return goes_straight(c) || (!follows_rays(s) && !draws_through(s) && !s->render.radiance &&
                                !first_visible(s, matches_surroundings) && say_not_bent(c));
}

static bool surrounding_absorption(const inert_case *c)
{
    return integrator_traits_of(&c->s->render)->drawn &&
           inert_say(c, "drawn-surroundings", "set render.integrator=whitted",
                     "the depth buffer ignores absorption by the surrounding medium");
}

bool inert_background(const inert_case *c)
{
    static const inert_row rows[] = {
        {"kind", kind},
        {"color", background_color},
        {"horizon", horizon},
        {"rain", sunlit_rain},
        {"drops", sunlit_rain},
        {"sun_elevation_deg", sun},
        {"sun_azimuth_deg", azimuth},
        {"sky_type", sky_type},
        {"ambient", ambient},
        {"ior", surrounding_index},
        {"medium", surrounding_index},
        {"absorb_per_m", surrounding_absorption},
        {NULL, NULL},
    };
    return inert_by_name(rows, c);
}
