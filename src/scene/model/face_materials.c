#include "scene/model/face_materials.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EMISSION_MAX 1e4 /* as in the parameter table */

struct face_materials {
    atomic_int owners;
    int count;
    face_material mat[];
};

/* Only the owner count changes; all other fields are constant. */
static face_materials *counted(const face_materials *l)
{
    return (face_materials *)(uintptr_t)l;
}

static double at_most_one(double value)
{
    return value < 1.0 ? value : 1.0;
}

/* Shared with an earlier slot that has the same image file. */
static status read_image(const mesh_import *imported, int slot, const char *root, face_materials *shading_materials,
                         diagnostic *why)
{
    const char *path = imported->materials[slot].texture;
    for (int i = 0; i < slot; i++) {
        const char *other = imported->materials[i].texture;
        if (other && shading_materials->mat[i].img && strcmp(other, path) == 0) {
            shading_materials->mat[slot].img = shading_materials->mat[i].img;
            texture_retain(shading_materials->mat[i].img);
            return STATUS_OK;
        }
    }
    texture *img;
    const status code =
        texture_read_below(path, root, TEXTURE_SRGB, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_TRILINEAR, &img, why);
    if (code == STATUS_OK)
        shading_materials->mat[slot].img = img;
    return code;
}

static double brightest(vec3 color)
{
    return fmax(color.x, fmax(color.y, color.z));
}

/* Emission is the surface's colour times a scalar in this program: the scalar is the brightest channel of the file's
 * emission; an emitter with a black surface takes the colour of the emission. */
static void emit(face_material *mat, const imported_material *m)
{
    const vec3 sent = vec3_make(m->emissive[0], m->emissive[1], m->emissive[2]);
    if (!(brightest(sent) > 0.0))
        return;
    if (brightest(mat->color) == 0.0) {
        mat->color = vec3_scale(sent, 1.0 / brightest(sent));
        mat->diffuse = 0.0;
    }
    mat->emission = fmin(brightest(sent) / brightest(mat->color), EMISSION_MAX);
}

/* Material files have a colour for each term of Phong's equation, this program a coefficient: the brightest channel. */
static face_material look_of(const imported_material *m)
{
    face_material mat = {.given = m->given, .diffuse = 1.0, .shininess = m->shininess, .opacity = m->opacity};
    snprintf(mat.name, sizeof mat.name, "%s", m->name ? m->name : "");
    mat.color = vec3_make(at_most_one(m->color[0]), at_most_one(m->color[1]), at_most_one(m->color[2]));
    /* A highlight without an exponent is ignored: with exponent 0 it would cover the whole surface. */
    for (int c = 0; c < 3 && m->shininess > 0.0; c++)
        mat.specular = m->specular[c] > mat.specular ? at_most_one(m->specular[c]) : mat.specular;
    emit(&mat, m);
    return mat;
}

/* NULL: out of memory. */
static face_materials *allocate(int count)
{
    face_materials *l = calloc(1, sizeof *l + (size_t)count * sizeof l->mat[0]);
    if (!l)
        return NULL;
    atomic_init(&l->owners, 1);
    l->count = count;
    return l;
}

status face_materials_create(const mesh_import *imported, const char *root, const face_materials **out, diagnostic *why)
{
    face_materials *shading_materials = allocate(imported->material_count);
    if (!shading_materials)
        return out_of_memory(why);
    for (int i = 0; i < shading_materials->count; i++) {
        shading_materials->mat[i] = look_of(&imported->materials[i]);
        const status code =
            imported->materials[i].texture ? read_image(imported, i, root, shading_materials, why) : STATUS_OK;
        if (code != STATUS_OK) {
            face_materials_release(shading_materials);
            return code;
        }
    }
    *out = shading_materials;
    return STATUS_OK;
}

status face_materials_of(const face_material *list, int count, const face_materials **out, diagnostic *why)
{
    face_materials *l = allocate(count);
    for (int i = 0; i < count; i++)
        if (l)
            l->mat[i] = list[i];
        else
            texture_release(list[i].img);
    *out = l;
    return l ? STATUS_OK : out_of_memory(why);
}

void face_materials_retain(const face_materials *l)
{
    if (l)
        atomic_fetch_add(&counted(l)->owners, 1);
}

void face_materials_release(const face_materials *l)
{
    if (!l || atomic_fetch_sub(&counted(l)->owners, 1) > 1)
        return;
    for (int i = 0; i < l->count; i++)
        texture_release(l->mat[i].img);
    free(counted(l));
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

int face_materials_count(const face_materials *l)
{
    return l ? l->count : 0;
}

const face_material *face_materials_at(const face_materials *l, int slot)
{
    return &l->mat[slot];
}
