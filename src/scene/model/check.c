/* Checks parameters that depend on each other, names that must exist, and invalid combinations. The range of a single
 * value is checked when it is set (params_value.c). */
#include "base/cancel.h"
#include "geometry/scene_geometry.h"
#include "geometry/shapes/shape.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/names.h"
#include "scene/model/scene.h"

#include <string.h>

_Static_assert((int)SCENE_UNBOUNDED_MAX == (int)PRIMITIVES_MAX, "each can be a direct primitive");

static size_t count_name(const scene *s, const char *name)
{
    const size_t most = name_tally_most(&s->names, name);
    if (most <= 1)
        return most;
    size_t count = 0;
    for (int g = PARAM_MESH; g < PARAM_GROUP_COUNT; g++)
        for (size_t i = 0; i < param_place_group_size(s, (param_group)g); i++)
            count += strcmp(param_place_group_name(s, (param_group)g, i), name) == 0;
    return count;
}

static status name_taken(const char *name, diagnostic *why)
{
    return diagnose(
        why, STATUS_BAD_INPUT,
        "meshes, textures, data, lights, beams, materials and solids need different names, because paths use them",
        "the name '%s' is already in use", name);
}

status check_name_is_free(const scene *s, const char *name, diagnostic *why)
{
    return count_name(s, name) == 0 ? STATUS_OK : name_taken(name, why);
}

static status check_name_is_unique(const scene *s, const char *name, diagnostic *why)
{
    status code = check_name(name, why);
    return code != STATUS_OK || count_name(s, name) == 1 ? code : name_taken(name, why);
}

static status check_depth(const render_settings *r, diagnostic *why)
{
    return r->depth < DEPTH_UNLIMITED || integrator_traits_of(r)->by_chance
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "set render.integrator to path, or render.depth to 0..64",
                          "render.depth: only random paths can be unlimited, because ray trees grow with each level");
}

static status check_render(const scene *s, diagnostic *why)
{
    TRY(check_depth(&s->render, why));
    if (s->render.width > SCENE_PIXELS_MAX / s->render.height)
        return diagnose(why, STATUS_BAD_INPUT, "keep width times height within 268435456",
                        "an image of %lld x %lld pixels is too large", (long long)s->render.width,
                        (long long)s->render.height);
    const bool grid = s->render.filter == PIXEL_FILTER_CENTRE;
    if (integrator_traits_of(&s->render)->by_chance && s->render.error > 0.0 &&
        (s->render.spectrum == SPECTRUM_SPECTRAL || grid))
        return diagnose(why, STATUS_BAD_INPUT,
                        grid ? "set render.filter to box, or render.error to 0"
                             : "set render.spectrum to rgb, or render.error to 0",
                        "render.error does not support %s", grid ? "a grid of samples" : "a spectrum");
    if (integrator_traits_of(&s->render)->drawn && (s->render.polarisation || s->render.spectrum == SPECTRUM_SPECTRAL))
        return diagnose(why, STATUS_BAD_INPUT, "set render.integrator to raycast or whitted",
                        "the depth buffer renders RGB only: it does not support %s",
                        s->render.polarisation ? "polarisation" : "spectrum");
    if (integrator_traits_of(&s->render)->unlit && (s->render.polarisation || s->render.spectrum == SPECTRUM_SPECTRAL))
        return diagnose(why, STATUS_BAD_INPUT, "set render.integrator to raycast or whitted",
                        "layers contain no light: they do not support %s",
                        s->render.polarisation ? "polarisation" : "spectrum");
    if (s->render.polarisation && s->render.weights == WEIGHTS_CONSTANT)
        return diagnose(why, STATUS_BAD_INPUT, "set render.weights to fresnel",
                        "constant weights do not support polarisation, which requires the Fresnel equations");
    if (s->render.polarisation && s->render.transmission == TRANSMISSION_SIMPLE)
        return diagnose(why, STATUS_BAD_INPUT, "set render.transmission to refract",
                        "simple transmission does not support polarisation, which requires the Fresnel equations");
    return STATUS_OK;
}

/* Reports that what the solid or light refers to does not exist. */
static status unknown(const scene *s, param_group group, const char *owner, const char *name, diagnostic *why)
{
    char remedy[SCENE_NAME_MAX + 80];
    object_remedy(s, group, name, remedy, sizeof remedy);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s: there is no %s '%.80s'", owner, param_group_name(group),
                    name);
}

static status check_lamp_data(const scene *s, const light *lamp, diagnostic *why)
{
    if (lamp->spectrum != LAMP_DATA && !lamp->spectrum_data[0])
        return STATUS_OK;
    if (!lamp->spectrum_data[0])
        return diagnose(why, STATUS_BAD_INPUT, "set spectrum_data to the name of one of the scene's data",
                        "%.80s: its spectrum is data, but spectrum_data is not set", lamp->name);
    if (object_find(s, PARAM_DATA, lamp->spectrum_data) < 0)
        return unknown(s, PARAM_DATA, lamp->name, lamp->spectrum_data, why);
    double xyz[3] = {0.0, 1.0, 0.0};
    if (lamp->emission_data && optical_data_has_first(lamp->emission_data))
        spectrum_xyz(optical_data_emission, lamp->emission_data, xyz);
    else if (lamp->emission_data)
        xyz[1] = 0.0;
    return xyz[1] > 0.0
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "choose a table of a wavelength and a power",
                          "%.80s: the data %.80s have no power from 380 to 780 nm", lamp->name, lamp->spectrum_data);
}

static status check_light(const scene *s, const light *lamp, diagnostic *why)
{
    if ((integrator_traits_of(&s->render)->by_chance || scene_has_soft_shadows(&s->render)) &&
        light_extent(lamp) > 0.0 && lamp->reach == 0.0)
        return diagnose(why, STATUS_BAD_INPUT,
                        lamp->kind == LIGHT_RECTANGLE
                            ? "set 'reach', the distance at which the intensity applies, or set width to 0"
                            : "set 'reach', the distance at which the intensity applies, or set radius to 0",
                        "%.80s: a light with a size falls off with distance, and its reach is 0", lamp->name);
    TRY(check_lamp_data(s, lamp, why));
    const vec3 axis = vec3_sub(lamp->target, lamp->position);
    if (lamp->kind != LIGHT_POINT && !(vec3_dot(axis, axis) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "move its position or its target",
                        "%.80s: the light is at its own target", lamp->name);
    return STATUS_OK;
}

/* render/plan/spectra.h distinguishes this number of lines, in addition to the spectra of other lamps. */
enum { LINE_LAMPS_MAX = 100 };

static status check_lines(const scene *s, diagnostic *why)
{
    int count = 0;
    for (size_t i = 0; i < s->light_count; i++)
        count += s->lights[i].spectrum == LAMP_LINE;
    for (size_t i = 0; i < s->beam_count && scene_has_caustics(&s->render); i++)
        count += !s->beams[i].white && beam_lights_scene(&s->beams[i], &s->render);
    return count <= LINE_LAMPS_MAX
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "give some of them another spectrum",
                          "%d lights and beams have the spectrum line; a scene can have %d", count, LINE_LAMPS_MAX);
}

static status check_beam_leader(const scene *s, const beam *b, diagnostic *why)
{
    char remedy[SCENE_NAME_MAX + 80];
    if (b->follows[0] && scene_find_solid(s, b->follows) < 0)
        return diagnose(why, STATUS_BAD_INPUT, object_remedy(s, PARAM_SOLID, b->follows, remedy, sizeof remedy),
                        "%.80s follows '%.80s', but no solid has that name", b->name, b->follows);
    return isfinite(beam_scale(s, b))
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "scale that solid by 3 equal numbers",
                          "%.80s follows %.80s, which is not scaled evenly", b->name, b->follows);
}

static status check_beam(const scene *s, const beam *b, diagnostic *why)
{
    TRY(check_beam_leader(s, b, why));
    const vec3 axis = beam_axis(b);
    if (!(vec3_dot(axis, axis) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "move its position or its target, or set its direction",
                        "%.80s: the beam is at its own target", b->name);
    if (b->branches && b->depth > DEPTH_TREE_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "set branches to off, or depth to 0..64",
                        "%.80s: a depth of %lld is for beams without branches", b->name, (long long)b->depth);
    if (b->lights && beam_fields(b) > 1)
        return diagnose(why, STATUS_BAD_INPUT, "set field_columns and field_rows to 1, or lights to off",
                        "%.80s: a beam that lights has one field point", b->name);
    const double length = vec3_length(b->normal);
    if (beam_is_flat(b) && length > 0.0 && vec3_length(vec3_cross(vec3_normalize(axis), b->normal)) < 1e-9 * length)
        return diagnose(why, STATUS_BAD_INPUT, "set 'normal' to a vector across the beam, or to 0,0,0",
                        "%.80s: the normal of its plane is parallel to the beam", b->name);
    return STATUS_OK;
}

static status check_camera(const scene *s, diagnostic *why)
{
    vec3 d = vec3_sub(s->camera.target, s->camera.position);
    if (s->camera.aimed && !(vec3_dot(d, d) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "move camera.position or camera.target",
                        "the camera is at its own target");
    return STATUS_OK;
}

static status check_sky_brightness(const background *sky, diagnostic *why)
{
    const double radiance = sky->brightness * (double)sky->brightest, most = (double)SCENE_SKY_MAX;
    char remedy[160];
    if (!(radiance > most))
        return STATUS_OK;
    size_t at = 0;
    while (sky->img->pixel[at] < sky->brightest)
        at++;
    snprintf(remedy, sizeof remedy,
             "set background.brightness to at most %.2g, or replace the image's sun by a light of kind sun",
             0.95 * most / (double)sky->brightest);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "the radiance of the sky is %g at column %zu, row %zu from the top; it can be at most %g", radiance,
                    at / 3 % (size_t)sky->img->width, at / 3 / (size_t)sky->img->width, most);
}

status sky_take(background *sky, const char *path, diagnostic *bad)
{
    image *img = sky->img;
    status code = image_check_light(img, img->note, &sky->brightest, bad);
    THEN(code, check_sky_brightness(sky, bad));
    for (size_t i = 0; i < 3 * (size_t)img->width * (size_t)img->height; i++)
        img->pixel[i] = img->pixel[i] < 0.0F ? 0.0F : img->pixel[i];
    return locate_failure(bad, path, code);
}

static status check_background(const scene *s, diagnostic *why)
{
    const background *sky = &s->background;
    if (sky->kind != BACKGROUND_IMAGE)
        return STATUS_OK;
    if (!sky->image_path[0])
        return diagnose(why, STATUS_BAD_INPUT, "set background.image to a " IMAGE_FORMATS " file",
                        "the background is an image, but no file is given");
    return sky->img ? check_sky_brightness(sky, why) : STATUS_OK;
}

static status check_mesh(const mesh_entry *m, diagnostic *why)
{
    if (m->source == MESH_FILE && !m->path[0])
        return diagnose(why, STATUS_BAD_INPUT,
                        "set a file, such as 'file: teapot.obj', or a generator, such as 'generate: icosphere'",
                        "%.80s: the mesh has neither a file nor a generator", m->name);
    if (m->source == MESH_LATHE && m->profile.count % 2 != 0)
        return diagnose(why, STATUS_BAD_INPUT, "write radius, height, radius, height, ...",
                        "%.80s: the profile has an odd number of values", m->name);
    return m->source == MESH_SLIME ? slime_check(m, why) : STATUS_OK;
}

static status check_texture(const texture_entry *t, diagnostic *why)
{
    if (!t->path[0] && !t->data)
        return diagnose(why, STATUS_BAD_INPUT, "set a file, such as 'file: wood.png'",
                        "%.80s: the texture has no image file", t->name);
    return STATUS_OK;
}

static status check_data(const data_entry *d, diagnostic *why)
{
    if (!d->path[0] && !d->data)
        return diagnose(why, STATUS_BAD_INPUT, "set a file, such as 'file: N-BK7.yml'", "%.80s: the data have no file",
                        d->name);
    return STATUS_OK;
}

/* A transparent solid needs an inside, which an open mesh does not have. */
static status check_closed(const scene *s, const solid *owner, const mesh_entry *m, diagnostic *why)
{
    const mesh *data = m->data;
    if (!data || data->closed || material_is_opaque(&owner->surface) || s->render.transmission == TRANSMISSION_SIMPLE)
        return STATUS_OK;
    static const char *const faults[MESH_FAULT_COUNT] = {
        [MESH_ONE_SIDED] = "turns its other side to the next one",
        [MESH_ODD] = "meets an even number of others, not 1, 3, 5 ...",
        [MESH_UNBALANCED] = "meets others that do not agree about which side is the inside",
        [MESH_CANCELLED] = "lies on one that faces the other way, as all do of this part"};
    const mesh_hole *hole = &data->hole;
    if (hole->fault == MESH_FLAT)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh with triangles, or make the solid opaque (transparency 0)",
                        "%.80s is transparent, but its mesh %.80s has no triangle with three different corners",
                        owner->name, m->name);
    const vec3 a = data->vertices[hole->from], b = data->vertices[hole->to];
    if (hole->fault != MESH_ODD || hole->sharing > 1)
        return diagnose(
            why, STATUS_BAD_INPUT,
            hole->fault == MESH_ONE_SIDED
                ? "cut the mesh, or make the solid opaque (transparency 0)"
                : "separate the parts, or remove the faces that they share, or make the solid opaque (transparency 0)",
            "%.80s is transparent, but its mesh %.80s has no inside: at the edge from (%g, %g, %g) to (%g, %g, %g), "
            "which %d share, triangle %zu %s",
            owner->name, m->name, a.x, a.y, a.z, b.x, b.y, b.z, hole->sharing, hole->triangle, faults[hole->fault]);
    return diagnose(why, STATUS_BAD_INPUT,
                    "close the mesh (cuvette mesh --close), or make the solid opaque (transparency 0)",
                    "%.80s is transparent, but its mesh %.80s is open: the edge from (%g, %g, %g) to (%g, %g, "
                    "%g) of triangle %zu belongs to 1 triangle instead of 2",
                    owner->name, m->name, a.x, a.y, a.z, b.x, b.y, b.z, hole->triangle);
}

/* A spectral film needs one spectrum per material: textures and materials by face have none. */
static status check_colors(const scene *s, const solid *owner, diagnostic *why)
{
    const bool by_face = has_face_materials(s, owner);
    if (s->render.spectrum != SPECTRUM_SPECTRAL || !(by_face || owner->surface.texture[0]))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT,
                    by_face ? "set render.spectrum to rgb, or give the solid a material" : "set render.spectrum to rgb",
                    "%.80s: %s cannot be rendered with a spectrum", owner->name,
                    by_face ? "materials by face" : "textures");
}

/* A fraction of light above 1 is probably in percent; a little more is the noise of a measurement. */
#define FRACTION_MOST 1.05
static status check_data_of(const scene *s, const material *m, const char *owner, diagnostic *why)
{
    const char *const names[] = {m->medium_data, m->color_data, m->absorb_data, m->scatter_data, m->coating_data};
    const optical_data *const values[] = {NULL, m->color_values, m->absorb_values, m->scatter_values,
                                          m->coating_values}; /* of curves */
    double least, most = 0.0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i][0] && object_find(s, PARAM_DATA, names[i]) < 0)
            return unknown(s, PARAM_DATA, owner, names[i], why);
    for (size_t i = 1; i < sizeof names / sizeof *names; i++)
        if (values[i] && !optical_data_has_first(values[i]))
            return diagnose(why, STATUS_BAD_INPUT, "choose a table of a wavelength and a value",
                            "%.80s: the data %.80s have only k", owner, names[i]);
    if (m->color_values)
        optical_data_extremes(m->color_values, &least, &most);
    if (most > FRACTION_MOST)
        return diagnose(why, STATUS_BAD_INPUT, "if it is in percent, set its scale to 0.01",
                        "%.80s: the data %.80s reach %g, but a surface reflects at most 1", owner, m->color_data, most);
    return STATUS_OK;
}

static status check_points(const scene *s, const solid *owner, diagnostic *why)
{
    const mesh_entry *points = scene_points_of(s, owner);
    if (!points && shape_has(shape_of(&owner->shape), "points"))
        return unknown(s, PARAM_MESH, owner->name, owner->points, why);
    if (points && points->data && (points->data->triangle_count > 0 || points->data->vertex_count == 0))
        return diagnose(why, STATUS_BAD_INPUT, "give the mesh a file of points, which ends in .xyz",
                        "%.80s: %.80s is not a file of points", owner->name, points->name);
    return STATUS_OK;
}

/* The objects to which the solid refers must exist. */
static status check_references(const scene *s, const solid *owner, diagnostic *why)
{
    const mesh_entry *m = scene_mesh_of(s, owner);
    if (owner->surface.texture[0] && !scene_find_texture(s, owner->surface.texture))
        return unknown(s, PARAM_TEXTURE, owner->name, owner->surface.texture, why);
    TRY(check_data_of(s, &owner->surface, owner->name, why));
    if (owner->points[0])
        TRY(check_points(s, owner, why));
    if (!shape_of(&owner->shape)->triangles)
        return check_colors(s, owner, why);
    if (!owner->mesh[0])
        return diagnose(why, STATUS_BAD_INPUT, "add 'mesh: NAME', the name of one of the meshes",
                        "%.80s: no mesh is given", owner->name);
    if (!m)
        return unknown(s, PARAM_MESH, owner->name, owner->mesh, why);
    TRY(check_colors(s, owner, why));
    if (m->source == MESH_FILE && m->data && m->data->triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "use it as the points of another solid", "%.80s: %.80s has no triangles",
                        owner->name, m->name);
    TRY(check_closed(s, owner, m, why));
    const mesh *const *operands;
    int count;
    return scene_mesh_operands(s, owner, &operands, &count, why);
}

/* reflectivity + transparency must not exceed 1 for any kind of face, either. */
static status check_faces(const scene *s, const solid *owner, diagnostic *why)
{
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? face_material_slots(s, owner) : 0;
    for (int slot = 0; slot < slots; slot++) {
        const material m = shading_material_of_face(s, owner, &owner->surface, slot).surface;
        const char *name = scene_find_mesh(s, owner->mesh)->data->slot_names[slot];
        if (m.reflectivity + m.transparency > 1.0 + 1e-12)
            return diagnose(why, STATUS_BAD_INPUT, "lower one of them, or set render.transmission to refract",
                            "%.80s: with simple transmission, its faces of %.80s have reflectivity %g + transparency "
                            "%g, which exceeds 1",
                            owner->name, name && name[0] ? name : "no material", m.reflectivity, m.transparency);
    }
    return STATUS_OK;
}

static const char *layer_remedy(const char *first, const char *film, char remedy[120])
{
    snprintf(remedy, 120, "%s, or %s", first, film);
    return remedy;
}

/* Refuses combinations with metals and films that the renderer does not support. */
static status check_layers(const scene *s, const solid *owner, diagnostic *why)
{
    const material *m = &owner->surface;
    const render_settings *r = &s->render;
    if (material_metal(m) && m->transparency > 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set its transparency to 0, or choose another medium",
                        "%.80s: %s is a metal, and not transparent", owner->name, material_medium_name(m));
    if (!owner->visible || !material_is_layered(m, r))
        return STATUS_OK;
    const char *what = m->coating[0] ? "a coating" : material_has_film(m) ? "a film" : "a metal";
    const char *film = m->coating[0] ? "its coating to none" : "its film_thickness_nm to 0";
    char remedy[120];
    if (m->alpha != ALPHA_OPAQUE)
        return diagnose(why, STATUS_BAD_INPUT, "set its alpha to opaque", "%.80s: alpha cannot remove a part of %s",
                        owner->name, what);
    if (has_face_materials(s, owner))
        return diagnose(why, STATUS_BAD_INPUT, "give the solid a material",
                        "%.80s: a solid with materials by face cannot have %s", owner->name, what);
    if (r->polarisation && r->spectrum != SPECTRUM_SPECTRAL)
        return diagnose(why, STATUS_BAD_INPUT, "set render.spectrum to spectral, or render.polarisation to off",
                        "%.80s: polarisation by %s depends on the wavelength", owner->name, what);
    if (integrator_traits_of(r)->drawn && !material_is_opaque(m))
        return diagnose(why, STATUS_BAD_INPUT, layer_remedy("set render.integrator to whitted", film, remedy),
                        "%.80s: the depth buffer does not support %s on a transparent solid", owner->name, what);
    if (scene_has_basic_radiance(r) && !scene_has_caustics(r) && !material_is_opaque(m)) /* shadow rays have no film */
        return diagnose(why, STATUS_BAD_INPUT, layer_remedy("set render.radiance to classic", film, remedy),
                        "%.80s: basic radiance does not support %s on a transparent solid", owner->name, what);
    return STATUS_OK;
}

/* Refuses metals and films among the scene's materials that a mesh assigns to faces by name. */
static status check_face_layers(const scene *s, const solid *owner, diagnostic *why)
{
    for (int slot = 0; slot < face_material_slots(s, owner); slot++) {
        const material *named;
        const face_material *given;
        face_material_source(s, owner, slot, &named, &given);
        if (named &&
            (material_metal(named) || named->extinction > 0.0 || named->film_thickness_nm > 0.0 || named->coating[0]))
            return diagnose(why, STATUS_BAD_INPUT, "give the solid a material",
                            "%.80s: a metal or a film cannot cover only some faces of a mesh", owner->name);
    }
    return STATUS_OK;
}

/* Materials of ends must exist, and be opaque on an opaque solid; and what holds for the solid's own surface holds for
 * theirs. */
static status check_end(const scene *s, const solid *owner, int slot, diagnostic *why)
{
    const material *named = solid_end_material(s, owner, slot);
    if (!owner->ends[slot - 1][0])
        return STATUS_OK;
    if (!named)
        return unknown(s, PARAM_MATERIAL, owner->name, owner->ends[slot - 1], why);
    if (material_is_mirror(named))
        return diagnose(why, STATUS_BAD_INPUT, "set its transparency to 0 and its reflectivity to 1",
                        "%.80s: a mirror by its index, %.80s, cannot cover a part of a surface", owner->name,
                        owner->ends[slot - 1]);
    if (named->alpha != ALPHA_OPAQUE)
        return diagnose(why, STATUS_BAD_INPUT, "set its alpha to opaque",
                        "%.80s: %.80s, the material of a part of its surface, has alpha", owner->name,
                        owner->ends[slot - 1]);
    if (material_is_opaque(&owner->surface) && named->transparency > 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set its transparency to 0",
                        "%.80s is opaque, but %.80s, the material of a part of its surface, is not", owner->name,
                        owner->ends[slot - 1]);
    solid part = *owner;
    part.surface = shading_material_of_end(s, owner, &owner->surface, slot).surface;
    return check_layers(s, &part, why);
}

static status check_ends(const scene *s, const solid *owner, diagnostic *why)
{
    if (!solid_has_ends(owner) || !owner->visible)
        return STATUS_OK;
    if (integrator_traits_of(&s->render)->drawn && !material_is_opaque(&owner->surface))
        return diagnose(why, STATUS_BAD_INPUT, "set render.integrator to whitted, or remove material_1 .. material_rim",
                        "%.80s: the depth buffer does not support materials of parts of a transparent solid",
                        owner->name);
    if (owner->surface.extraordinary_ior > 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set its extraordinary_ior to 0, or remove material_1 .. material_rim",
                        "%.80s: a crystal has one material", owner->name);
    for (int slot = 1; slot < END_SLOTS; slot++)
        TRY(check_end(s, owner, slot, why));
    return STATUS_OK;
}

/* A surface with holes, or that is there in part, is open: nothing can be behind it that refracts. */
static status check_alpha(const solid *owner, diagnostic *why)
{
    const material *m = &owner->surface;
    if (!owner->visible || m->alpha == ALPHA_OPAQUE || m->transparency == 0.0)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "set its transparency to 0, or its alpha to opaque",
                    "%.80s: the surface of a transparent solid cannot have alpha: %s", owner->name,
                    m->alpha == ALPHA_MASK ? "mask" : "blend");
}

/* Photons do not scatter, so light that enters a scattering medium would be lost. */
static status check_scattering(const scene *s, const solid *owner, diagnostic *why)
{
    if (!owner->visible || !scene_has_caustics(&s->render) || !material_scatters(&owner->surface, &s->render))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "set render.caustics to off, or its scattering to none",
                    "%.80s: caustics by photons do not support its scattering medium", owner->name);
}

/* Leaders come first, and follow no other solid, so that each place is known. */
static status check_leader(const scene *s, const solid *owner, diagnostic *why)
{
    if (!solid_follows(owner))
        return STATUS_OK;
    char remedy[SCENE_NAME_MAX + 80];
    const int at = scene_find_solid(s, owner->follows);
    if (at < 0)
        return diagnose(why, STATUS_BAD_INPUT, object_remedy(s, PARAM_SOLID, owner->follows, remedy, sizeof remedy),
                        "%.80s follows '%.80s', but no solid before it has that name", owner->name, owner->follows);
    if (&s->solids[at] >= owner)
        return diagnose(why, STATUS_BAD_INPUT, "move the solid that is followed before those that follow it",
                        "%.80s follows %.80s, which does not come before it", owner->name, owner->follows);
    const vec3 k = s->solids[at].scale, turn = owner->rotation_deg;
    if ((k.x != k.y || k.x != k.z) && (turn.x != 0.0 || turn.y != 0.0 || turn.z != 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "scale it by 3 equal numbers, or set the rotation to 0,0,0",
                        "%.80s is rotated in the frame of %.80s, which is not scaled evenly", owner->name,
                        owner->follows);
    if (!solid_follows(&s->solids[at]))
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "let it follow %s", s->solids[at].follows);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s follows %.80s, which follows another solid", owner->name,
                    owner->follows);
}

static status check_solid(const scene *s, const solid *owner, diagnostic *why)
{
    diagnostic shape = {.what = ""};
    status code = solid_shape_check(&owner->shape, &shape);
    if (code != STATUS_OK)
        return diagnose(why, code, shape.remedy, "%.80s: %s", owner->name, shape.what);
    TRY(check_references(s, owner, why));
    TRY(check_leader(s, owner, why));
    index_law unused;
    TRY(material_index_law(&owner->surface, owner->name, &unused, why));
    TRY(material_ior_check(&owner->surface, owner->name, why));
    TRY(check_alpha(owner, why));
    TRY(material_absorption_check(&owner->surface, owner->name, why));
    TRY(sheet_check(&owner->surface, owner->name, why));
    TRY(material_crystal_check(&owner->surface, owner->name, why));
    TRY(material_coating_check(&owner->surface, owner->name, why));
    TRY(check_layers(s, owner, why));
    TRY(check_face_layers(s, owner, why));
    TRY(check_ends(s, owner, why));
    TRY(check_scattering(s, owner, why));
    /* A surface must not return more light than it receives; the tolerance is for sums such as 0.7 + 0.2 + 0.1. Under
     * Fresnel weights R + T = 1 always holds, and reflectivity applies only to opaque surfaces. */
    double sum = owner->surface.reflectivity + owner->surface.transparency;
    if (scene_has_constant_weights(&s->render) && sum > 1.0 + 1e-12) {
        const bool simple = s->render.transmission == TRANSMISSION_SIMPLE;
        return diagnose(why, STATUS_BAD_INPUT,
                        simple ? "lower one of them, or set render.transmission to refract"
                               : "lower one of them, or set render.weights to fresnel",
                        "%.80s: with %s, reflectivity %g + transparency %g exceeds 1", owner->name,
                        simple ? "simple transmission" : "constant weights", owner->surface.reflectivity,
                        owner->surface.transparency);
    }
    return check_faces(s, owner, why);
}

status check_limits(const scene *s, diagnostic *why)
{
    size_t primitives = 0, unbounded = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        const shape_rule *rule = shape_of(&s->solids[i].shape);
        const solid_shape shape = s->solids[i].points[0] ? scene_loaded_shape(s, &s->solids[i]) : s->solids[i].shape;
        primitives += (size_t)shape_primitive_slots(&shape) * solid_shape_count(&shape);
        unbounded += rule->unbounded || rule->triangles;
    }
    if (primitives > SCENE_PRIMITIVES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 2097151; a cup and a torus count as two, a lens as three",
                        "more than 2097151 solids");
    if (unbounded > SCENE_UNBOUNDED_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64 of them, and any number of other solids",
                        "more than 64 planes and solids of meshes");
    if (s->light_count > SCENE_LIGHTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 1024 lights", "more than 1024 lights");
    TRY(check_lines(s, why));
    if (s->mesh_count > SCENE_MESHES_MAX || s->texture_count > SCENE_TEXTURES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64 meshes and 64 textures", "more than 64 %s",
                        s->mesh_count > SCENE_MESHES_MAX ? "meshes" : "textures");
    if (s->data_count > SCENE_DATA_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64 files of data", "more than 64 files of data");
    if (s->material_count > SCENE_MATERIALS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 256 materials", "more than 256 materials");
    return STATUS_OK;
}

static status check_names(const scene *s, diagnostic *why)
{
    status code = STATUS_OK;
    for (int g = PARAM_MESH; g < PARAM_GROUP_COUNT; g++)
        for (size_t i = 0; i < param_place_group_size(s, (param_group)g) && code == STATUS_OK; i++)
            code = check_name_is_unique(s, param_place_group_name(s, (param_group)g, i), why);
    return code;
}

status check_object(const scene *s, param_group group, size_t index, diagnostic *why)
{
    switch (group) {
    case PARAM_RENDER: return check_render(s, why);
    case PARAM_CAMERA: return check_camera(s, why);
    case PARAM_BACKGROUND: return check_background(s, why);
    case PARAM_MESH: return check_mesh(&s->meshes[index], why);
    case PARAM_TEXTURE: return check_texture(&s->textures[index], why);
    case PARAM_DATA: return check_data(&s->data[index], why);
    case PARAM_LIGHT: return check_light(s, &s->lights[index], why);
    case PARAM_BEAM: return check_beam(s, &s->beams[index], why);
    case PARAM_SOLID: return check_solid(s, &s->solids[index], why);
    case PARAM_MATERIAL: /* all else is checked with each solid that has it */
        return check_data_of(s, &s->materials[index].value, s->materials[index].name, why);
    case PARAM_GROUP_COUNT: break;
    }
    return STATUS_OK;
}

status scene_check(const scene *s, diagnostic *why)
{
    status code = check_limits(s, why);
    THEN(code, check_names(s, why));
    for (int g = 0; g < PARAM_GROUP_COUNT; g++)
        for (size_t i = 0; i < param_place_group_size(s, (param_group)g) && code == STATUS_OK; i++)
            code = check_object(s, (param_group)g, i, why);
    return code;
}
