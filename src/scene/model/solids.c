/* The reference-counted materials of mesh files, loaded data of meshes and textures, and checks of slimes. */
#include "scene/model/solids.h"
#include "geometry/shapes/shape.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- materials in a mesh file --- */

struct face_materials {
    atomic_int references;
    int count;
    char note[300];
    face_material mat[];
};

/* Only the reference count changes; all other fields are constant. */
static face_materials *mutable_count(const face_materials *materials)
{
    return (face_materials *)(uintptr_t)materials;
}

/* NULL: out of memory. */
static face_materials *allocate(int count)
{
    face_materials *materials = calloc(1, sizeof *materials + (size_t)count * sizeof materials->mat[0]);
    if (!materials)
        return NULL;
    atomic_init(&materials->references, 1);
    materials->count = count;
    return materials;
}

status face_materials_of(const face_material *list, int count, const char *note, const face_materials **out,
                         diagnostic *why)
{
    face_materials *materials = allocate(count);
    if (materials)
        snprintf(materials->note, sizeof materials->note, "%s", note);
    for (int i = 0; i < count; i++)
        if (materials)
            materials->mat[i] = list[i];
        else
            texture_release(list[i].img), texture_release(list[i].glow_img);
    *out = materials;
    return materials ? STATUS_OK : out_of_memory(why);
}

void face_materials_retain(const face_materials *materials)
{
    if (materials)
        atomic_fetch_add(&mutable_count(materials)->references, 1);
}

void face_materials_release(const face_materials *materials)
{
    if (!materials || atomic_fetch_sub(&mutable_count(materials)->references, 1) > 1)
        return;
    for (int i = 0; i < materials->count; i++)
        texture_release(materials->mat[i].img), texture_release(materials->mat[i].glow_img);
    free(mutable_count(materials));
}

const char *face_materials_note(const face_materials *materials)
{
    return materials ? materials->note : "";
}

int face_materials_count(const face_materials *materials)
{
    return materials ? materials->count : 0;
}

const face_material *face_materials_at(const face_materials *materials, int slot)
{
    return &materials->mat[slot];
}

/* --- loaded data --- */

void mesh_entry_unload(mesh_entry *m)
{
    mesh_release(m->data);
    face_materials_release(m->shading_materials);
    m->data = NULL;
    m->shading_materials = NULL;
    m->account = (softbody_quantities){.steps = 0};
    m->motion_s = 0.0;
}

void texture_entry_unload(texture_entry *t)
{
    texture_release(t->data);
    t->data = NULL;
}

void data_entry_unload(data_entry *d)
{
    optical_data_release(d->data);
    d->data = NULL;
}

bool solid_shows_mesh(const solid *owner, const char *mesh_name)
{
    return shape_of(&owner->shape)->triangles && strcmp(owner->mesh, mesh_name) == 0;
}

bool solid_uses_mesh(const solid *owner, const char *mesh_name)
{
    const bool repeated = owner->points[0] && shape_has(shape_of(&owner->shape), "points");
    return solid_shows_mesh(owner, mesh_name) || (repeated && strcmp(owner->points, mesh_name) == 0);
}

/* --- slimes --- */

softbody_settings slime_settings(const mesh_entry *m)
{
    softbody_settings settings = m->slime;
    settings.level = m->level;
    return settings;
}

static status check_steps(const mesh_entry *m, double time_s, const char *remedy, diagnostic *why)
{
    if (time_s / m->slime.dt_s > SLIME_STEPS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, remedy, "%.80s: %g s with time steps of %g s exceed %g steps", m->name,
                        time_s, m->slime.dt_s, SLIME_STEPS_MAX);
    return STATUS_OK;
}

status slime_check(const mesh_entry *m, diagnostic *why)
{
    const softbody_settings settings = slime_settings(m);
    diagnostic bad = {.what = ""};
    const status code = softbody_check(&settings, &bad);
    if (code != STATUS_OK)
        return diagnose(why, code, bad.remedy, "%.80s: %s", m->name, bad.what);
    return check_steps(m, m->time_s, "raise dt_s, or lower time_s", why);
}

status slime_check_end(const mesh_entry *m, double end_s, diagnostic *why)
{
    return check_steps(m, end_s, "raise dt_s, or end earlier", why);
}
