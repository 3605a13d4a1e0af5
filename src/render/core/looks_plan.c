/* How each body's surface looks: its own material, or those that its mesh's file gives to its faces. */
#include "render/core/plan.h"
#include "scene/model/scene.h"

#include <stdlib.h>

bool body_look_make(const scene *s, const solid *owner, const material *surface, body_look *out)
{
    const int slots = looks_slots(s, owner);
    out->shading = (shading_rule)owner->shading;
    out->count = slots > 0 ? slots : 1;
    out->look = calloc((size_t)out->count, sizeof *out->look);
    if (!out->look)
        return false;
    out->look[0] = looks_whole(s, surface);
    for (int slot = 0; slot < slots; slot++)
        out->look[slot] = looks_face(s, owner, surface, slot);
    return true;
}

bool body_clearness_make(const scene *s, const solid *owner, double *least, double **by_slot)
{
    const int slots = s->render.transmission == TRANSMISSION_SIMPLE ? looks_slots(s, owner) : 0;
    *by_slot = NULL;
    *least = owner->surface.transparency * (1.0 - material_coating(&owner->surface, &s->render));
    if (slots == 0)
        return true;
    if (!(*by_slot = calloc((size_t)slots, sizeof **by_slot)))
        return false;
    *least = 1.0;
    for (int slot = 0; slot < slots; slot++) {
        (*by_slot)[slot] = looks_face(s, owner, &owner->surface, slot).surface.transparency;
        *least = (*by_slot)[slot] < *least ? (*by_slot)[slot] : *least;
    }
    return true;
}
