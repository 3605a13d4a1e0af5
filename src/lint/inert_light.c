/* Facts of lights, beams and the sky that leave their parameters without effect. */
#include "lint/inert_facts.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "scene/model/sheet.h"
#include "scene/model/sun.h"

static const light *light_of(const inert_case *c)
{
    return &c->s->lights[c->at.index];
}

/* No visible surface is lit by lights, and no camera ray hits a light. */
bool lights_nothing(const inert_case *c)
{
    const scene *s = c->s;
    const light *l = light_of(c);
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
bool depolarised(const inert_case *c)
{
    const scene *s = c->s;
    const light *l = light_of(c);
    const bool degree = is_named(c, "polarised");
    const bool photons = (scene_has_caustics(&s->render) || is_path(s)) && first_visible(s, shows_polarisation),
               through = s->render.shadows == SHADOWS_ATTENUATED && first_visible(s, is_polariser);
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
bool moves_sky(const inert_case *c)
{
    const background *b = &c->s->background;
    const light *l = light_of(c);
    const light *shown = scene_sun(c->s);
    const cie_sky_type type = cie_sky_type_of((int)b->sky_type);
    const bool shows = b->kind == BACKGROUND_CIE ? type.c > 0.0 : b->kind == BACKGROUND_RAIN && b->rain > 0.0;
    return shows && (l == shown || (is_named(c, "kind") && !shown));
}

bool black_lamp(const inert_case *c)
{
    const light *l = light_of(c);
    return !is_named(c, "color") && !is_named(c, "spectrum") && l->spectrum == LAMP_OF_COLOR && is_black(l->color) &&
           inert_say(c, "dark-lamp", inert_set("%s.color=1,1,1", c->name).text, "the light's color is black");
}

bool size_unsampled(const inert_case *c)
{
    const light *l = light_of(c);
    const inert_remedy far = inert_set("render.integrator=path and %s.reach=8", c->name);
    return !is_path(c->s) && !scene_has_soft_shadows(&c->s->render) &&
           inert_say(c, "sphere-lamp", l->kind == LIGHT_SUN || l->reach > 0.0 ? "set render.integrator=path" : far.text,
                     "only the path integrator and render.soft_shadows use the size of a light");
}

/* --- beams --- */

bool unseen_beam(const inert_case *c)
{
    const beam *b = &c->s->beams[c->at.index];
    return !b->white && (b->lambda_nm < OBSERVER_LOW_NM || b->lambda_nm > OBSERVER_HIGH_NM) &&
           !is_named(c, "lambda_nm") && !is_named(c, "white") &&
           inert_say(c, "unseen-beam", inert_set("%s.lambda_nm=550", c->name).text,
                     "the eye does not see its wavelength");
}

bool thin_beam(const inert_case *c)
{
    const beam *b = &c->s->beams[c->at.index];
    const bool parallel = beam_is_parallel(b);
    return (parallel ? b->width : b->angle_deg) == 0.0 &&
           inert_say(c, "thin-beam", inert_set(parallel ? "%s.width=0.5" : "%s.angle_deg=10", c->name).text,
                     "all its rays are on its axis");
}

/* The film is the same with the beam's light and without it. If the parameter in question makes the beam dark, light is
 * that of another value. A spot between the samples of the pixels is in no film, too. */
bool shows_no_light(const inert_case *c)
{
    const beam *b = &c->s->beams[c->at.index];
    const char *other = !b->lights                            ? "lights=on"
                        : !b->visible                         ? "visible=on"
                        : b->power == 0.0                     ? "power=1"
                        : beam_lights_scene(b, &c->s->render) ? "lights=off"
                                                              : "lambda_nm=550";
    return inert_same(c, "%s.%s", c->name, other) &&
           inert_say(c, "beam-lights-nothing",
                     "aim it at a matte surface that the camera sees; a spot narrower than a pixel needs more samples",
                     "no sample of the image shows its light");
}

/* --- the sky --- */

/* A gradient between equal colours is uniform, and so is one type of CIE sky; an image background needs a file; rain
 * may be black. */
bool flat_sky(const inert_case *c)
{
    const background *b = &c->s->background;
    const bool flat = b->color.x == b->horizon.x && b->color.y == b->horizon.y && b->color.z == b->horizon.z;
    return flat && b->rain == 0.0 && b->sky_type == CIE_SKY_UNIFORM && b->kind != BACKGROUND_IMAGE &&
           !b->image_path[0] &&
           inert_say(c, "flat-gradient", "set background.horizon=0.5,0.4,0.3",
                     "'horizon' equals 'color', so there is no gradient");
}

/* The sun of rain or of a CIE sky is a light, or has no effect. */
bool no_own_sun(const inert_case *c)
{
    const background *b = &c->s->background;
    const light *lamp = scene_sun(c->s);
    if (lamp)
        return inert_say(c, "sun-is-light", inert_set("%s.kind=point", lamp->name).text,
                         "the background's sun is where the light of kind sun is");
    if (b->kind == BACKGROUND_RAIN)
        return b->rain == 0.0 && inert_say(c, "no-rain", "set background.rain=0.3",
                                           "background.rain is 0: nothing scatters the sun's light");
    return cie_sky_type_of((int)b->sky_type).c == 0.0 &&
           inert_say(c, "even-sky", "set background.sky_type=12", "a CIE sky of this type does not depend on the sun");
}

static bool has_ambient(const scene *s, const solid *one)
{
    return shows_ambient(s, &one->surface) || may_have_face_materials(s, one);
}

bool no_ambient(const inert_case *c)
{
    const scene *s = c->s;
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

bool nothing_refracts(const inert_case *c)
{
    const scene *s = c->s;
    return !first_visible(s, is_clear) && inert_say(c, "no-clear", inert_set_clear(first_visible(s, NULL)).text,
                                                    "no visible solid is transparent: nothing refracts");
}

bool not_bent_outside(const inert_case *c)
{
    const scene *s = c->s;
    return !follows_rays(s) && !draws_through(s) && !s->render.radiance && !first_visible(s, matches_surroundings) &&
           say_not_bent(c);
}
