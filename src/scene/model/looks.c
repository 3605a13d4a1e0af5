#include "scene/model/looks.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EMISSION_MAX 1e4 /* as in the parameter table */

struct face_looks {
    atomic_int owners;
    int count;
    face_look look[];
};

/* Owners come and go while everything else of it stays as it was made. */
static face_looks *counted(const face_looks *l)
{
    return (face_looks *)(uintptr_t)l;
}

static double at_most_one(double value)
{
    return value < 1.0 ? value : 1.0;
}

/* Shared with a slot before it where that has the same picture. */
static status read_picture(const mesh_import *imported, int slot, const char *root, face_looks *looks, diagnostic *why)
{
    const char *path = imported->materials[slot].texture;
    for (int i = 0; i < slot; i++) {
        const char *other = imported->materials[i].texture;
        if (other && looks->look[i].picture && strcmp(other, path) == 0) {
            looks->look[slot].picture = looks->look[i].picture;
            texture_retain(looks->look[i].picture);
            return STATUS_OK;
        }
    }
    texture *picture;
    const status code =
        texture_read_below(path, root, TEXTURE_SRGB, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_TRILINEAR, &picture, why);
    if (code == STATUS_OK)
        looks->look[slot].picture = picture;
    return code;
}

static double brightest(vec3 color)
{
    return fmax(color.x, fmax(color.y, color.z));
}

/* Emitted light has the surface's colour here, and is as bright in its brightest channel as the file says; a lamp whose
 * surface is black has the light's own colour. */
static void emit(face_look *look, const imported_material *m)
{
    const vec3 sent = vec3_make(m->emissive[0], m->emissive[1], m->emissive[2]);
    if (!(brightest(sent) > 0.0))
        return;
    if (brightest(look->color) == 0.0) {
        look->color = vec3_scale(sent, 1.0 / brightest(sent));
        look->diffuse = 0.0;
    }
    look->emission = fmin(brightest(sent) / brightest(look->color), EMISSION_MAX);
}

/* A material file has a colour for each term where Phong's sum here has a coefficient: the brightest channel. */
static face_look look_of(const imported_material *m)
{
    face_look look = {.given = m->given, .diffuse = 1.0, .shininess = m->shininess, .opacity = m->opacity};
    snprintf(look.name, sizeof look.name, "%s", m->name ? m->name : "");
    look.color = vec3_make(at_most_one(m->color[0]), at_most_one(m->color[1]), at_most_one(m->color[2]));
    /* A file that gives a highlight no exponent means none: to the power of 0 it would cover everything. */
    for (int c = 0; c < 3 && m->shininess > 0.0; c++)
        look.specular = m->specular[c] > look.specular ? at_most_one(m->specular[c]) : look.specular;
    emit(&look, m);
    return look;
}

status looks_create(const mesh_import *imported, const char *root, const face_looks **out, diagnostic *why)
{
    face_looks *looks = calloc(1, sizeof *looks + (size_t)imported->material_count * sizeof looks->look[0]);
    if (!looks)
        return out_of_memory(why);
    atomic_init(&looks->owners, 1);
    looks->count = imported->material_count;
    for (int i = 0; i < looks->count; i++) {
        looks->look[i] = look_of(&imported->materials[i]);
        const status code = imported->materials[i].texture ? read_picture(imported, i, root, looks, why) : STATUS_OK;
        if (code != STATUS_OK) {
            looks_release(looks);
            return code;
        }
    }
    *out = looks;
    return STATUS_OK;
}

void looks_retain(const face_looks *l)
{
    if (l)
        atomic_fetch_add(&counted(l)->owners, 1);
}

void looks_release(const face_looks *l)
{
    if (!l || atomic_fetch_sub(&counted(l)->owners, 1) > 1)
        return;
    for (int i = 0; i < l->count; i++)
        texture_release(l->look[i].picture);
    free(counted(l));
}

bool looks_by_face(const scene *s, const solid *owner)
{
    const mesh_entry *m = owner->material_index < 0 ? scene_mesh_of(s, owner) : NULL;
    return m && m->data && (m->looks || m->data->slot_count > 1);
}

int looks_count(const face_looks *l)
{
    return l ? l->count : 0;
}

const face_look *looks_at(const face_looks *l, int slot)
{
    return &l->look[slot];
}
