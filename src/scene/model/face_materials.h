/* The materials of a solid's faces: its own, or those of its mesh by slot, which a mesh file defines, or the scene by
 * the slot's name. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

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
/* The number of visible solids that are clear crystals. */
int scene_crystals(const scene *s);

/* Whether its faces have a transparency or reflectivity without effect, because the solid refracts. */
bool ignores_face_transparency(const scene *s, const solid *owner);
