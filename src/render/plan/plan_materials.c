/* The materials of a plan's regions: the shading materials of each region's surface, the solid's own or those that the
 * mesh file assigns to its faces; shading classes; and the tables of sheets, crystals and scattering media. */
#include "render/plan/plan.h"

#include "base/lanes.h"
#include "geometry/shapes/shape.h"
#include "geometry/solid.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

/* The number of a shading material, see shading_material. A modified copy of a scene's material keeps its number. */
static int number_of(const scene *s, const solid *owner, const material *named)
{
    for (size_t i = 0; named && i < s->material_count; i++)
        if (named == &s->materials[i].value)
            return (int)i + 1;
    return !named && owner->material_index >= 0 ? owner->material_index + 1
                                                : (int)(s->material_count + (size_t)(owner - s->solids)) + 1;
}

/* Whether the solid has its material as the scene declares it. */
static bool has_plain_material(const scene *s, const solid *owner, const material *surface)
{
    return owner->material_index >= 0 && surface == &owner->surface &&
           memcmp(surface, &s->materials[owner->material_index].value, sizeof *surface) == 0;
}

bool region_materials_make(const scene *s, const solid *owner, const material *surface, shading_material **shared,
                           region_materials *out)
{
    const int slots = face_material_slots(s, owner);
    shading_material **const kept =
        &shared[has_plain_material(s, owner, surface) ? (size_t)owner->material_index
                                                      : s->material_count + (size_t)(owner - s->solids)];
    out->shading = (shading_rule)owner->shading;
    const bool by_end = solid_has_ends(owner);
    out->count = by_end ? END_SLOTS : slots > 0 ? slots : 1;
    if (slots == 0 && !by_end && (out->mat = *kept)) {
        out->borrowed = true;
        return true;
    }
    out->mat = calloc((size_t)out->count, sizeof *out->mat);
    if (!out->mat)
        return false;
    if (slots == 0 && !by_end)
        *kept = out->mat;
    out->mat[0] = shading_material_of_solid(s, owner, surface);
    out->mat[0].number = number_of(s, owner, NULL);
    for (int slot = 1; by_end && slot < END_SLOTS; slot++) {
        out->mat[slot] = shading_material_of_end(s, owner, surface, slot);
        out->mat[slot].number = number_of(s, owner, solid_end_material(s, owner, slot));
    }
    for (int slot = 0; slot < slots; slot++) {
        const material *named;
        const face_material *given;
        face_material_source(s, owner, slot, &named, &given);
        out->mat[slot] = shading_material_of_face(s, owner, surface, slot);
        out->mat[slot].number = number_of(s, owner, named);
    }
    return true;
}

/* Random paths find the light that rough surfaces transmit. */
static double surface_passes(const scene *s, const material *m)
{
    const double layers = material_is_layered(m, &s->render) ? material_layers_pass(m) : 1.0;
    return material_roughness(m, &s->render) > 0.0
               ? 0.0
               : m->transparency * (1.0 - material_reflectivity(m, &s->render)) * layers;
}

bool region_shadow_transmittance(const scene *s, const solid *owner, double *least, double **by_slot)
{
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? face_material_slots(s, owner) : 0;
    *by_slot = NULL;
    *least = surface_passes(s, &owner->surface);
    if (slots == 0 && !solid_has_ends(owner))
        return true;
    if (!(*by_slot = calloc((size_t)(slots ? slots : END_SLOTS), sizeof **by_slot)))
        return false;
    for (int slot = 0; slots == 0 && slot < END_SLOTS; slot++) {
        const material end = shading_material_of_end(s, owner, &owner->surface, slot).surface;
        (*by_slot)[slot] = surface_passes(s, &end);
        *least = lesser(*least, (*by_slot)[slot]);
    }
    if (slots == 0)
        return true;
    *least = 1.0;
    for (int slot = 0; slot < slots; slot++) {
        (*by_slot)[slot] = shading_material_of_face(s, owner, &owner->surface, slot).surface.transparency;
        *least = (*by_slot)[slot] < *least ? (*by_slot)[slot] : *least;
    }
    return true;
}

/* --- shading classes --- */

/* A region that may be shaded in one group with others of equal material. Textures and checkers are excluded, because
 * their coordinates depend on the solid. */
typedef struct plain_region {
    const shading_material *mat;
    int priority_index;
    bool opaque;
} plain_region;

static int compare_materials(const plain_region *a, const plain_region *b)
{
    const int order = a->mat == b->mat ? 0 : memcmp(&a->mat->surface, &b->mat->surface, sizeof a->mat->surface);
    return order ? order : (int)a->opaque - (int)b->opaque;
}

static int compare_regions(const void *one, const void *other)
{
    const plain_region *a = one, *b = other;
    const int order = compare_materials(a, b);
    return order ? order : a->priority_index - b->priority_index;
}

bool plan_is_plain(const plan *p, int priority_index)
{
    const region_materials *m = &p->shading_materials[priority_index];
    return m->count == 1 && !m->mat->img && !shading_material_is_partial(m->mat) && !(m->mat->surface.checker > 0.0) &&
           !m->mat->vertex_colors && !p->spectral;
}

bool plan_find_shading_classes(plan *p)
{
    const int regions = p->geometry->region_count;
    plain_region *all = calloc((size_t)regions + 1, sizeof *all);
    p->shading_class = calloc(p->key_count, sizeof *p->shading_class);
    if (!all || !p->shading_class) {
        free(all);
        return false;
    }
    int count = 0;
    for (size_t key = (size_t)regions + 1; key < p->key_count; key++)
        p->shading_class[key] = (int)key;
    for (int r = 1; r <= regions; r++) {
        p->shading_class[r] = r;
        if (plan_is_plain(p, r))
            all[count++] = (plain_region){p->shading_materials[r].mat, r, p->geometry->regions[r].opaque};
    }
    qsort(all, (size_t)count, sizeof *all, compare_regions);
    for (int k = 1; k < count; k++)
        if (compare_materials(&all[k - 1], &all[k]) == 0)
            p->shading_class[all[k].priority_index] = p->shading_class[all[k - 1].priority_index];
    free(all);
    return true;
}

/* --- media --- */

/* Whether light crosses the region's inside as a medium of its own. */
static bool is_clear(const region *b)
{
    return !b->opaque && !b->partial;
}

bool sheet_list_create(const scene *s, const scene_geometry *geometry, region_sheet **out)
{
    region_sheet *list = NULL;
    *out = NULL;
    for (int r = 1; r <= geometry->region_count; r++) {
        const solid *one = &s->solids[geometry->regions[r].solid];
        const material *m = &one->surface;
        if (!is_clear(&geometry->regions[r]) || !sheet_acts(m, &s->render))
            continue;
        if (!list && !(list = calloc((size_t)geometry->region_count + 1, sizeof *list)))
            return false;
        const mat3 turn = rotation_from_deg(one->shape.rotation_deg);
        list[r] = (region_sheet){.kind = (sheet_kind)m->sheet,
                                 .axis = mat3_apply(turn, vec3_normalize(m->sheet_axis)),
                                 .pass = m->sheet_pass,
                                 .block = m->sheet_block,
                                 .retardance_deg = m->retardance_deg,
                                 .birefringence = m->birefringence};
    }
    *out = list;
    return true;
}

bool crystal_list_create(const scene *s, const scene_geometry *geometry, optical_medium **out)
{
    optical_medium *list = NULL;
    *out = NULL;
    for (int r = 1; r <= geometry->region_count; r++) {
        const solid *one = &s->solids[geometry->regions[r].solid];
        if (!is_clear(&geometry->regions[r]) || !material_is_crystal(&one->surface, &s->render))
            continue;
        if (!list && !(list = calloc((size_t)geometry->region_count + 1, sizeof *list)))
            return false;
        const mat3 turn = rotation_from_deg(one->shape.rotation_deg);
        list[r] = (optical_medium){.uniaxial = true,
                                   .n_e = one->surface.extraordinary_ior,
                                   .axis = mat3_apply(turn, vec3_normalize(one->surface.optic_axis))};
    }
    *out = list;
    return true;
}

static void find_lamps(const scene *s, scatter_plan *scatter)
{
    if (s->render.light_sampling == LIGHT_SAMPLING_ONE && s->light_count > 1)
        return;
    for (size_t i = 0; i < s->light_count && scatter->lamp_count < AIRLIGHTS_MAX; i++)
        if (light_extent(&s->lights[i]) == 0.0 && s->lights[i].kind != LIGHT_SUN && s->lights[i].intensity > 0.0)
            scatter->lamps[scatter->lamp_count++] = (int)i;
}

static void join(bounds3 *a, bounds3 b)
{
    a->low = vec3_make(fmin(a->low.x, b.low.x), fmin(a->low.y, b.low.y), fmin(a->low.z, b.low.z));
    a->high = vec3_make(fmax(a->high.x, b.high.x), fmax(a->high.y, b.high.y), fmax(a->high.z, b.high.z));
}

static void add_box(scatter_plan *scatter, bounds3 around, bool many)
{
    if (scatter->box_count == 0 || !many)
        scatter->boxes[scatter->box_count++] = around;
    else
        join(&scatter->boxes[0], around);
}

static int media_that_scatter(const scene *s, const scene_geometry *geometry)
{
    int count = 0;
    for (int r = 1; r <= geometry->region_count; r++)
        count += is_clear(&geometry->regions[r]) &&
                 material_scatters(&s->solids[geometry->regions[r].solid].surface, &s->render);
    return count;
}

bool scatter_plan_create(const scene *s, const scene_geometry *geometry, scatter_plan **out)
{
    const int count = media_that_scatter(s, geometry);
    *out = NULL;
    if (count == 0)
        return true;
    scatter_plan *scatter =
        calloc(1, sizeof *scatter + ((size_t)geometry->region_count + 1) * sizeof scatter->region[0]);
    if (!scatter)
        return false;
    for (int r = 1; r <= geometry->region_count; r++) {
        const material *m = &s->solids[geometry->regions[r].solid].surface;
        if (!is_clear(&geometry->regions[r]) || !material_scatters(m, &s->render))
            continue;
        const vec3 c = vec3_scale(material_scattering(m), s->render.unit_m);
        scatter->region[r] = (region_scatter){.per_unit = c, .asymmetry = m->asymmetry};
        scatter->by_channel |= s->render.spectrum != SPECTRUM_SPECTRAL && (c.x != c.y || c.x != c.z);
        const solid_shape shape = scene_geometry_shape(geometry, r);
        add_box(scatter, shape_world_box(&shape), count > SCATTER_BOXES_MAX);
    }
    find_lamps(s, scatter);
    *out = scatter;
    return true;
}
