/* How each body's surface looks: its own material, or those that its mesh's file gives to its faces. */
#include "render/plan.h"

#include "scene/looks.h"
#include "scene/medium.h"
#include <stdlib.h>
#include <string.h>

/* The material of that name in the scene, which goes before the file's. */
static const material *named_material_of(const scene *s, const char *name)
{
    for (size_t i = 0; name[0] && i < s->material_count; i++)
        if (strcmp(s->materials[i].name, name) == 0)
            return &s->materials[i].value;
    return NULL;
}

static const texture *picture_of(const scene *s, const material *m)
{
    const texture_entry *t = m->texture[0] ? scene_find_texture(s, m->texture) : NULL;
    return t ? t->data : NULL;
}

/* A face's look changes what an opaque surface sends back; what the body is made of is the solid's own. */
static surface_look face_look_of(const scene *s, const material *own, const char *name, const face_look *given)
{
    const material *named = named_material_of(s, name);
    surface_look l = {.surface = *own, .picture = picture_of(s, own)};
    if (named) {
        l.surface = *named;
        l.picture = picture_of(s, named);
    } else if (given && given->given) {
        l.surface.color = given->color;
        l.surface.diffuse = given->diffuse;
        l.surface.ambient = own->ambient > 0.0 ? own->ambient : 0.1;
        l.surface.specular = given->specular;
        l.surface.emission = given->emission > 0.0 ? given->emission : own->emission;
        l.surface.shininess = given->shininess;
        l.picture = given->picture;
    }
    l.surface.transparency = own->transparency;
    if (!material_is_opaque(own)) /* shares that add up to at most 1 */
        l.surface.reflectivity = own->reflectivity;
    return l;
}

bool body_look_make(const scene *s, const solid *owner, const material *surface, body_look *out)
{
    const mesh_entry *m = owner->shape.kind == SHAPE_MESH ? scene_find_mesh(s, owner->mesh) : NULL;
    const bool by_face = looks_by_face(s, owner);
    out->shading = (shading_rule)owner->shading;
    out->count = by_face ? m->data->slot_count : 1;
    out->look = calloc((size_t)out->count, sizeof *out->look);
    if (!out->look)
        return false;
    if (!by_face)
        out->look[0] = (surface_look){*surface, picture_of(s, surface)};
    for (int slot = 0; by_face && slot < out->count; slot++) {
        const char *name = m->data->slot_names[slot];
        out->look[slot] = face_look_of(s, surface, name ? name : "", slot < looks_count(m->looks) ? looks_at(m->looks, slot) : NULL);
    }
    return true;
}
