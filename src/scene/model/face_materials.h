/* The materials in a mesh file, by slot: the coefficients of Phong's equation and a texture. Reference counted like
 * their mesh: face_materials_retain and face_materials_release are thread safe. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include "scene/model/material.h"
#include "scene/model/mesh_entry.h"
#include "scene/model/open.h"
#include "scene/model/solids.h"

typedef struct face_material {
    char name[SCENE_NAME_MAX + 1]; /* truncated if longer; "" for none */
    bool given;                    /* the file defines the material; otherwise the solid's own material is used */
    vec3 color;                    /* linear RGB, each at most 1 */
    double diffuse, specular, shininess, emission, opacity;
    const texture *img; /* one reference; NULL for none */
} face_material;

/* Converts the importer's result; reads its image files, each once, below root (base/file.h). A diagnostic has the
 * path of the image file. */
status face_materials_create(const mesh_import *imported, const char *root, const face_materials **out,
                             diagnostic *why);
/* Of a list of materials; takes over its references to images, also after an error. STATUS_FAILURE without memory. */
status face_materials_of(const face_material *list, int count, const face_materials **out, diagnostic *why);
void face_materials_retain(const face_materials *l); /* NULL is allowed here and in the functions below */
void face_materials_release(const face_materials *l);

/* Whether the mesh's slots determine the materials of the solid's faces: the solid has no material of its own, and the
 * file, or the scene by a slot's name, gives one to some slot (face_material_source). A file without materials has
 * none. False before scene_load. */
bool has_face_materials(const scene *s, const solid *owner);

/* The material of one kind of face of a solid; the texture is borrowed. */
typedef struct shading_material {
    material surface;
    const texture *img;
    int number; /* 1-based index of a scene material; for a surface without one, the number of materials plus the
                   1-based index of the solid */
} shading_material;

/* The source of a slot's material: the scene's material of the same name, else the file's; both NULL if the solid's own
 * material is used. For solids with a loaded mesh. */
void face_material_source(const scene *s, const solid *owner, int slot, const material **named,
                          const face_material **given);

/* The number of slots that determine materials; 0 if a single material does. */
int face_material_slots(const scene *s, const solid *owner);

/* The material of a slot's faces: the scene's material of the slot's name, else the file's, else own, the solid's
 * material. Under simple transmission it has its own transparency (MTL's d or Tr, glTF's alpha; own's if the file has
 * 1) and reflectivity; otherwise the solid's. */
shading_material shading_material_of_face(const scene *s, const solid *owner, const material *own, int slot);
/* That of a solid without slots. */
shading_material shading_material_of_solid(const scene *s, const material *own);

/* Whether all its faces are opaque. */
bool solid_is_opaque(const scene *s, const solid *owner);
/* How many solids that can be seen are clear crystals. */
int scene_crystals(const scene *s);

/* Whether its faces have a transparency or reflectivity without effect, because the solid refracts. */
bool ignores_face_transparency(const scene *s, const solid *owner);

int face_materials_count(const face_materials *l); /* 0 for NULL */
const face_material *face_materials_at(const face_materials *l, int slot);
