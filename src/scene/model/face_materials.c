/* Finds the material of a face: the scene's, the mesh file's or the solid's. */
#include "scene/model/face_materials.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/shapes/shape.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <string.h>

/* The material of that name in the scene, which takes precedence over the file's. */
static const material *named_material_of(const scene *s, const char *name)
{
    for (size_t i = 0; name[0] && i < s->material_count; i++)
        if (strcmp(s->materials[i].name, name) == 0)
            return &s->materials[i].value;
    return NULL;
}

void face_material_source(const scene *s, const solid *owner, int slot, const material **named,
                          const face_material **given)
{
    const mesh_entry *m = scene_mesh_of(s, owner);
    const char *name = m->data->slot_names[slot];
    *named = named_material_of(s, name ? name : "");
    *given = !*named && slot < face_materials_count(m->shading_materials) &&
                     face_materials_at(m->shading_materials, slot)->given
                 ? face_materials_at(m->shading_materials, slot)
                 : NULL;
}

bool has_face_materials(const scene *s, const solid *owner)
{
    const mesh_entry *m = owner->material_index < 0 ? scene_mesh_of(s, owner) : NULL;
    for (int slot = 0; m && m->data && slot < m->data->slot_count; slot++) {
        const material *named;
        const face_material *given;
        face_material_source(s, owner, slot, &named, &given);
        if (named || given)
            return true;
    }
    return false;
}

static const texture *image_of(const scene *s, const material *m)
{
    const texture_entry *t = m->texture[0] ? scene_find_texture(s, m->texture) : NULL;
    return t ? t->data : NULL;
}

bool solid_shows_vertex_colors(const scene *s, const solid *owner)
{
    const mesh_entry *m = owner->material_index < 0 ? scene_mesh_of(s, owner) : NULL;
    return m && m->data && m->data->colors;
}

static void apply_file_material(shading_material *mat, const material *base, const face_material *given)
{
    mat->surface.color = given->color;
    mat->surface.diffuse = given->diffuse;
    mat->surface.ambient = base->ambient > 0.0 ? base->ambient : 0.1;
    mat->surface.specular = given->specular;
    mat->surface.emission = given->emission > 0.0 ? given->emission : base->emission;
    mat->surface.shininess = given->shininess;
    mat->surface.alpha = given->alpha;
    mat->surface.alpha_cutoff = given->alpha_cutoff;
    mat->opacity = given->alpha != ALPHA_OPAQUE ? given->opacity : 1.0;
    mat->img = given->img;
    mat->glows = given->emission > 0.0;
    mat->glow = given->glow;
    mat->glow_img = given->glow_img;
}

static shading_material with_alpha(shading_material mat)
{
    mat.covered = mat.img && mat.surface.alpha != ALPHA_OPAQUE ? texture_covered(mat.img) : NULL;
    return mat;
}

/* With refraction, medium and transparency are properties of the solid, and a face's material affects only the
 * reflection of opaque surfaces. Without refraction, transparency and reflectivity are properties of each face. */
shading_material shading_material_of_face(const scene *s, const solid *owner, const material *base, int slot)
{
    const material *named;
    const face_material *given;
    face_material_source(s, owner, slot, &named, &given);
    shading_material mat = {.surface = *base,
                            .img = image_of(s, named ? named : base),
                            .opacity = 1.0,
                            .vertex_colors = !named && solid_shows_vertex_colors(s, owner)};
    if (named)
        mat.surface = material_as_measured(named);
    else if (given)
        apply_file_material(&mat, base, given);
    if (s->render.transmission == TRANSMISSION_SIMPLE) {
        const bool clear = given && given->opacity < 1.0 && given->alpha == ALPHA_OPAQUE;
        mat.surface.transparency = named ? named->transparency : clear ? 1.0 - given->opacity : base->transparency;
        return with_alpha(mat);
    }
    mat.surface.transparency = base->transparency;
    if (!material_is_opaque(base)) { /* both fractions are the solid's, so that their sum is at most 1 */
        mat.surface.reflectivity = base->reflectivity;
        mat.surface.roughness = base->roughness;
    }
    return with_alpha(mat);
}

shading_material shading_material_of_solid(const scene *s, const solid *owner, const material *base)
{
    return with_alpha((shading_material){.surface = *base,
                                         .img = image_of(s, base),
                                         .opacity = 1.0,
                                         .vertex_colors = solid_shows_vertex_colors(s, owner)});
}

bool solid_has_ends(const solid *owner)
{
    return (owner->ends[0][0] || owner->ends[1][0] || owner->ends[2][0]) &&
           shape_has(shape_of(&owner->shape), "material_1");
}

int solid_end_slot(const solid_shape *shape, int64_t face)
{
    const shape_rule *rule = shape_of(shape);
    return face == rule->ends[0] ? 1 : face == rule->ends[1] ? 2 : 3;
}

const material *solid_end_material(const scene *s, const solid *owner, int slot)
{
    return slot > 0 ? named_material_of(s, owner->ends[slot - 1]) : NULL;
}

static material surface_of(const material *base, const material *named)
{
    material m = *base;
    m.film_thickness_nm = named->film_thickness_nm, m.film_ior = named->film_ior;
    memcpy(m.coating, named->coating, sizeof m.coating);
    memcpy(m.coating_data, named->coating_data, sizeof m.coating_data);
    m.coating_values = named->coating_values, m.coating_in_air = named->coating_in_air;
    m.roughness = named->roughness, m.reflectivity = named->reflectivity, m.emission = named->emission;
    m.ambient = named->ambient, m.diffuse = named->diffuse;
    m.specular = named->specular, m.shininess = named->shininess;
    return m;
}

shading_material shading_material_of_end(const scene *s, const solid *owner, const material *base, int slot)
{
    const material *named = solid_end_material(s, owner, slot);
    if (!named)
        return shading_material_of_solid(s, owner, base);
    if (named->transparency > 0.0)
        return (shading_material){.surface = surface_of(base, named), .opacity = 1.0};
    return (shading_material){.surface = material_as_measured(named), .img = image_of(s, named), .opacity = 1.0};
}

bool shading_material_is_partial(const shading_material *m)
{
    const bool whole =
        m->surface.alpha == ALPHA_OPAQUE || (m->surface.alpha == ALPHA_MASK && m->surface.alpha_cutoff == 0.0);
    return !whole && (m->opacity < 1.0 || m->covered);
}

double shading_material_cover(const shading_material *m, double u, double v)
{
    if (!shading_material_is_partial(m))
        return 1.0;
    const double alpha = m->opacity * (m->covered ? texture_alpha(m->covered, u, v) : 1.0);
    return m->surface.alpha == ALPHA_BLEND ? alpha : alpha >= m->surface.alpha_cutoff ? 1.0 : 0.0;
}

bool solid_is_partial(const scene *s, const solid *owner)
{
    if (integrator_traits_of(&s->render)->drawn || !solid_is_opaque(s, owner))
        return false;
    const int slots = face_material_slots(s, owner);
    const shading_material own = shading_material_of_solid(s, owner, &owner->surface);
    bool partial = slots == 0 && shading_material_is_partial(&own);
    for (int slot = 0; slot < slots && !partial; slot++) {
        const shading_material mat = shading_material_of_face(s, owner, &owner->surface, slot);
        partial = shading_material_is_partial(&mat);
    }
    return partial;
}

int face_material_slots(const scene *s, const solid *owner)
{
    return has_face_materials(s, owner) ? scene_mesh_of(s, owner)->data->slot_count : 0;
}

bool solid_is_opaque(const scene *s, const solid *owner)
{
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? face_material_slots(s, owner) : 0;
    bool opaque = slots > 0 || material_is_opaque(&owner->surface);
    for (int slot = 0; slot < slots; slot++)
        opaque &= shading_material_of_face(s, owner, &owner->surface, slot).surface.transparency == 0.0;
    return opaque;
}

int scene_crystals(const scene *s)
{
    int count = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        count += one->visible && !solid_is_opaque(s, one) && material_is_crystal(&one->surface, &s->render);
    }
    return count;
}

bool ignores_face_transparency(const scene *s, const solid *owner)
{
    const material *base = &owner->surface;
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? 0 : face_material_slots(s, owner);
    for (int slot = 0; slot < slots; slot++) {
        const material *named;
        const face_material *given;
        face_material_source(s, owner, slot, &named, &given);
        const bool clear = !material_is_opaque(base);
        if ((named &&
             (named->transparency != base->transparency || (clear && named->reflectivity != base->reflectivity))) ||
            (!named && given && given->alpha == ALPHA_OPAQUE && given->opacity < 1.0 &&
             1.0 - given->opacity != base->transparency))
            return true;
    }
    return false;
}

status scene_mesh_operands(const scene *s, const solid *owner, const mesh *const **operands, int *count,
                           diagnostic *why)
{
    const mesh_entry *m = scene_mesh_of(s, owner);
    if (!m || !m->data || !m->data->closed || (m->data->shell_count < 2 && !m->data->crowded) ||
        solid_is_opaque(s, owner)) {
        *operands = m && m->data ? &m->data : NULL;
        *count = *operands ? 1 : 0;
        return STATUS_OK;
    }
    diagnostic bad = {.what = ""};
    const status code = hierarchy_operands(m->data, scene_build_threads(&s->render), operands, count, &bad);
    return code == STATUS_OK ? code : diagnose(why, code, bad.remedy, "%.80s: %s", owner->name, bad.what);
}
