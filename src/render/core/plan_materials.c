/* The shading materials of each region's surface: the solid's own material, or those that the mesh file assigns to its
 * faces. */
#include "render/core/plan.h"
#include "scene/model/scene.h"

#include <stdlib.h>

/* The number of a shading material, see shading_material. A modified copy of a scene's material keeps its number. */
static int number_of(const scene *s, const solid *owner, const material *named)
{
    for (size_t i = 0; named && i < s->material_count; i++)
        if (named == &s->materials[i].value)
            return (int)i + 1;
    return !named && owner->material_index >= 0 ? owner->material_index + 1
                                                : (int)(s->material_count + (size_t)(owner - s->solids)) + 1;
}

bool region_materials_make(const scene *s, const solid *owner, const material *surface, region_materials *out)
{
    const int slots = face_material_slots(s, owner);
    out->shading = (shading_rule)owner->shading;
    out->count = slots > 0 ? slots : 1;
    out->mat = calloc((size_t)out->count, sizeof *out->mat);
    if (!out->mat)
        return false;
    out->mat[0] = shading_material_of_solid(s, surface);
    out->mat[0].number = number_of(s, owner, NULL);
    for (int slot = 0; slot < slots; slot++) {
        const material *named;
        const face_material *given;
        face_material_source(s, owner, slot, &named, &given);
        out->mat[slot] = shading_material_of_face(s, owner, surface, slot);
        out->mat[slot].number = number_of(s, owner, named);
    }
    return true;
}

bool region_shadow_transmittance(const scene *s, const solid *owner, double *least, double **by_slot)
{
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? face_material_slots(s, owner) : 0;
    *by_slot = NULL;
    *least = owner->surface.transparency * (1.0 - material_coating(&owner->surface, &s->render));
    if (slots == 0)
        return true;
    if (!(*by_slot = calloc((size_t)slots, sizeof **by_slot)))
        return false;
    *least = 1.0;
    for (int slot = 0; slot < slots; slot++) {
        (*by_slot)[slot] = shading_material_of_face(s, owner, &owner->surface, slot).surface.transparency;
        *least = (*by_slot)[slot] < *least ? (*by_slot)[slot] : *least;
    }
    return true;
}
