/* Facts of lights, beams, the sky, solids, meshes and textures that leave their parameters without effect. */
#include "geometry/shapes/lens_profile.h"
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/cover.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* --- lights --- */

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

/* The polarisation of a light matters only if its light reaches matte surfaces through polarisers, or (as photons, or
 * by random paths) from transparent solids, metals or films; or if random paths see the light through the analyser. */
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
    const bool same =
        degree ? inert_unchanged(c, "%s.polarised=%d", c->name, l->polarised == 0.0)
               : inert_unchanged(c, "%s.polarisation_deg=%.17g", c->name, l->polarisation_deg / 2.0 + 45.0) &&
                     inert_unchanged(c, "%s.polarisation_deg=%.17g", c->name, l->polarisation_deg / 2.0 + 70.0);
    return same && inert_say(c, "depolarised-here", "move a polariser into the light",
                             "everything that the light passes through treats every polarisation alike");
}

/* Whether the parameter moves the sun that the background shows: the position or target of the light that is the sun,
 * or the kind of a light that is the sun or could become it. */
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

/* The film is the same with and without the beam's light: the other value turns the light on or off. A spot between the
 * samples of the pixels does not change the film, either. */
bool shows_no_light(const inert_case *c)
{
    const beam *b = &c->s->beams[c->at.index];
    const char *other = !b->lights                            ? "lights=on"
                        : !b->visible                         ? "visible=on"
                        : b->power == 0.0                     ? "power=1"
                        : beam_lights_scene(b, &c->s->render) ? "lights=off"
                                                              : "lambda_nm=550";
    return inert_unchanged(c, "%s.%s", c->name, other) &&
           inert_say(c, "beam-lights-nothing",
                     "aim it at a matte surface that the camera sees; a spot narrower than a pixel needs more samples",
                     "no sample of the image shows its light");
}

/* --- the sky --- */

/* All kinds of background look the same: the colours of the gradient are equal, there is no rain, the CIE sky is of the
 * uniform type, and there is no image. */
bool flat_sky(const inert_case *c)
{
    const background *b = &c->s->background;
    const bool flat = b->color.x == b->horizon.x && b->color.y == b->horizon.y && b->color.z == b->horizon.z;
    return flat && b->rain == 0.0 && b->sky_type == CIE_SKY_UNIFORM && b->kind != BACKGROUND_IMAGE &&
           !b->image_path[0] &&
           inert_say(c, "flat-gradient", "set background.horizon=0.5,0.4,0.3",
                     "'horizon' equals 'color', so there is no gradient");
}

/* The background's parameters of the sun have no effect: a light of kind sun replaces them, or the sky does not depend
 * on the sun. */
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

/* --- solids --- */

static bool is_opaque_pair(const solid *a, const solid *b)
{
    return a->surface.transparency == 0.0 && b->surface.transparency == 0.0;
}

/* The intersection of two opaque solids is invisible: from outside only their union matters, and each point of its
 * surface has one owner, unless faces coincide. A camera inside the intersection would see it. */
static bool meets_unseen(const scene *s, const solid *a, const solid *b)
{
    const solid_shape of_a = scene_loaded_shape(s, a), of_b = scene_loaded_shape(s, b);
    return scene_apart_from_eye(s, a) && scene_apart_from_eye(s, b) && !solid_shapes_may_coincide(&of_a, &of_b);
}

bool overlaps_unseen(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one == c->owner || !one->visible || scene_disjoint(s, c->owner, one))
            continue;
        if (!is_opaque_pair(c->owner, one) || !meets_unseen(s, c->owner, one))
            return false;
        hidden = one;
    }
    if (hidden)
        return inert_say(c, "both-opaque",
                         inert_set("%s.transparency=0.9 and %s.ior=1.3", hidden->name, hidden->name).text,
                         "%s overlaps %s, but both are opaque: the overlap is invisible", c->name, hidden->name);
    return inert_say(c, "apart", "move it into another solid", "no other visible solid overlaps %s", c->name);
}

/* Whether the surface has the same colour everywhere. */
static bool is_plain(const scene *s, const material *m)
{
    const bool checkered = m->checker > 0.0 && memcmp(&m->color, &m->checker_color, sizeof m->color) != 0;
    return !shows_color(s, m) || !(checkered || m->texture[0]);
}

/* A side of a lens without radii and coefficients is flat in any form. */
bool flat_side(const inert_case *c)
{
    const solid_shape *s = &c->owner->shape;
    const int k = strcmp(c->at.row->name, "form_2") == 0;
    const lens_profile side = lens_profile_of(s, k);
    if (!lens_is_flat(&side) || (k == 0 ? s->radius_1_x : s->radius_2_x) != 0.0)
        return false;
    return inert_say(c, "flat-side",
                     inert_set("%s.radius_%d_x=%.9g", c->name, k + 1, (k == 0 ? 2.0 : -2.0) * s->diameter).text,
                     "side %d of %s is flat, in every form", k + 1, c->name);
}

bool looks_the_same(const inert_case *c)
{
    /* The depth buffer rasterises a sphere as triangles, which rotate with it. */
    if (!shape_is_isotropic(&c->owner->shape) || !is_plain(c->s, c->m) || is_drawn(c->s))
        return false;
    const inert_remedy color = color_remedy(c->s, c->m, c->name);
    const inert_remedy remedy = shows_color(c->s, c->m)
                                    ? inert_set("%s.checker=0.2 and %s.checker_color=0.3,0.5,0.7", c->name, c->name)
                                    : inert_set("%s.checker=0.2 and %s", c->name, color.text + strlen("set "));
    return inert_say(c, "round", remedy.text, "a %s without checker or texture looks the same after this rotation",
                     shape_of(&c->owner->shape)->word);
}

bool unshaded(const inert_case *c)
{
    const scene *s = c->s;
    const bool textured = c->m->texture[0] && shows_color(s, c->m); /* the texture footprint depends on the normal */
    if (textured || is_lit_by_lamps(s, c->m) || may_have_face_materials(s, c->owner) ||
        (follows_rays(s) && sends_rays_on(s, c->owner)))
        return false;
    if (is_unlit(s))
        return s->render.layer != LAYER_NORMAL &&
               inert_say(c, "no-normals", "set render.layer=normal", "the shown layer has no normals");
    const inert_remedy remedy = shining_lights(s) > 0 ? inert_set("%s.diffuse=0.7", c->name) : lamp_remedy(s);
    return inert_say(c, "unshaded", remedy.text, "it is not lit by lights and has no secondary rays");
}

bool one_mesh(const inert_case *c)
{
    return c->s->mesh_count == 1 && inert_say(c, "one-mesh", "add another under meshes:", "the scene has one mesh");
}

bool no_point_files(const inert_case *c)
{
    for (size_t i = 0; i < c->s->mesh_count; i++)
        if (!c->s->meshes[i].data || c->s->meshes[i].data->triangle_count == 0)
            return false;
    return inert_say(c, "no-point-files", "add one under meshes:", "the scene has no file of points");
}

/* --- meshes and textures --- */

/* No visible solid uses the mesh. The remedy names a hidden solid that uses it, or a visible solid that could. */
bool unused_mesh(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL, *other = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const bool shows = solid_uses_mesh(one, c->name);
        if (shows && one->visible)
            return false;
        hidden = shows ? one : hidden;
        other = !shows && one->visible && shape_of(&one->shape)->triangles ? one : other;
    }
    const inert_remedy remedy = hidden  ? inert_set("%s.visible=on", hidden->name)
                                : other ? inert_set("%s.mesh=%s", other->name, c->name)
                                        : (inert_remedy){"add a solid with it"};
    return inert_say(c, "unused-mesh", remedy.text, "no visible solid uses this mesh");
}

/* The motion parameters of a slime have no effect before its first time step. */
bool at_rest(const inert_case *c)
{
    static const char *const always[] = {"time_s", "radius", "position", NULL};
    const mesh_entry *m = &c->s->meshes[c->at.index];
    const double steps = is_named(c, "dt_s") ? m->time_s > 0.0 : rint(m->time_s / m->slime.dt_s);
    return c->at.row->makers != 0 && m->source == MESH_SLIME && !is_among(c, always) && steps < 1.0 &&
           inert_say(c, "time-0", inert_set("%s.time_s=0.5", c->name).text, "time_s is %g: the slime has not moved yet",
                     m->time_s);
}

static bool uses_texture(const scene *s, const solid *one, const char *name)
{
    return one->visible && (may_have_face_materials(s, one) ||
                            (strcmp(one->surface.texture, name) == 0 && shows_color(s, &one->surface)));
}

bool unused_texture(const inert_case *c)
{
    const scene *s = c->s;
    const solid *bare = NULL, *dull = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (uses_texture(s, one, c->name))
            return false;
        const bool has = one->visible && strcmp(one->surface.texture, c->name) == 0;
        dull = has ? one : dull;
        bare = !has && one->visible ? one : bare;
    }
    if (dull)
        return inert_say(c, "unused-texture", color_remedy(s, &dull->surface, dull->name).text,
                         "no light reaches the surfaces that have it");
    const inert_remedy remedy = bare ? inert_set("%s.texture=%s", bare->name, c->name) : inert_set_on(NULL, "");
    return inert_say(c, "unused-texture", remedy.text, "no visible solid has this texture");
}

bool unused_data(const inert_case *c)
{
    const scene *s = c->s;
    const solid *clear = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const material *m = &one->surface;
        if (one->visible &&
            ((m->medium == MEDIUM_DATA && strcmp(m->medium_data, c->name) == 0) ||
             strcmp(m->color_data, c->name) == 0 || strcmp(m->absorb_data, c->name) == 0 ||
             strcmp(m->scatter_data, c->name) == 0 || (m->coating[0] && strcmp(m->coating_data, c->name) == 0)))
            return false;
        clear = one->visible && !material_is_opaque(&one->surface) ? one : clear;
    }
    const inert_remedy remedy =
        clear ? inert_set("%s.medium=data and %s.medium_data=%s", clear->name, clear->name, c->name)
              : inert_set_clear(NULL);
    for (size_t i = 0; i < s->light_count; i++)
        if (s->lights[i].spectrum == LAMP_DATA && strcmp(s->lights[i].spectrum_data, c->name) == 0)
            return false;
    return inert_say(c, "unused-data", remedy.text, "no visible solid or light uses these data");
}

static bool ends_in(const char *path, const char *ending)
{
    const size_t length = strlen(path), size = strlen(ending);
    return length >= size && strcasecmp(path + length - size, ending) == 0;
}

/* Each kind of file has its own parameters: scene/data/optical_files.h. */
bool not_of_file(const inert_case *c)
{
    const char *path = c->s->data[c->at.index].path;
    const bool glasses = ends_in(path, ".agf"), database = ends_in(path, ".yml") || ends_in(path, ".yaml");
    if (is_named(c, "glass") && !glasses)
        return inert_say(c, "no-catalogue", "use a catalogue, which ends in .agf",
                         "the file is no catalogue of glasses");
    if ((is_named(c, "column") || is_named(c, "scale")) && (glasses || database))
        return inert_say(c, "no-columns", "use a table, such as one that ends in .csv", "the file has no columns");
    return false;
}

/* Float images are linear already: image/texture.c. */
bool of_floats(const inert_case *c)
{
    const char *path = c->s->textures[c->at.index].path, *dot = strrchr(path, '.');
    return (image_format_is_float(image_format_of(path)) || (dot && strcasecmp(dot, ".hdr") == 0)) &&
           inert_say(c, "float-texture", "use a PNG or JPEG file", "the values of a file of floats are linear");
}
