/* How the faces of a mesh's slots look, as its file says it: what Phong's sum needs and a texture, by slot. Shared like
 * the mesh that they came with: face_materials_retain and face_materials_release count owners, from any thread. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include "scene/model/material.h"
#include "scene/model/mesh_entry.h"
#include "scene/model/open.h"
#include "scene/model/solids.h"

typedef struct face_material {
    char name[SCENE_NAME_MAX + 1]; /* cut off where it is longer; "" for none */
    bool given;                    /* the file says something; else the solid's own surface counts */
    vec3 color;                    /* linear RGB, at most 1 */
    double diffuse, specular, shininess, emission, opacity;
    const texture *img; /* one owner of it; NULL for none */
} face_material;

/* From what an importer found; reads the pictures that it names, each once, below root (base/below.h). A diagnostic
 * names the picture's file. */
status face_materials_create(const mesh_import *imported, const char *root, const face_materials **out,
                             diagnostic *why);
void face_materials_retain(const face_materials *l); /* NULL is allowed, here and below */
void face_materials_release(const face_materials *l);

/* Do the mesh's slots, not one material, say how the solid's faces look? Where it is a mesh that has several, or a
 * file's materials, and names no material itself. False before scene_load. */
bool has_face_materials(const scene *s, const solid *owner);

/* What one kind of face of a solid looks like; the picture is borrowed. */
typedef struct shading_material {
    material surface;
    const texture *img;
    int number; /* of a scene's material: 1 for the first; of a surface that is none of them: how many there are, and
                   the solid's number, 1 for the first */
} shading_material;

/* What says how a slot's faces look: the scene's material of its name, else what the file gives; both NULL where the
 * solid's own surface does. Of a solid that looks by face. */
void face_material_source(const scene *s, const solid *owner, int slot, const material **named,
                          const face_material **given);

/* How many slots say so; 0 where one material does. */
int face_material_slots(const scene *s, const solid *owner);

/* The look of a slot's faces, of a solid with slots whose own material, as it is traced, is own: that of the scene's
 * material of the slot's name, else the file's, else own. Under simple transmission with its own transparency (MTL's d
 * or Tr, glTF's alpha; own's where the file says 1) and reflectivity; else with the solid's. */
shading_material shading_material_of_face(const scene *s, const solid *owner, const material *own, int slot);
/* That of a solid without slots. */
shading_material shading_material_of_solid(const scene *s, const material *own);

/* Does no light pass any of its faces? */
bool solid_is_opaque(const scene *s, const solid *owner);

/* Do its faces have a transparency or reflectivity that has no effect, because light is bent? */
bool ignores_face_transparency(const scene *s, const solid *owner);

int face_materials_count(const face_materials *l); /* 0 for NULL */
const face_material *face_materials_at(const face_materials *l, int slot);
