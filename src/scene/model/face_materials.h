/* The materials of a solid's faces: the solid's, or one per slot of its mesh, defined by the mesh file, or by the
 * scene's material with the slot's name. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* Whether the mesh's slots determine the materials of the solid's faces: no material is assigned to the solid, and
 * face_material_source finds one for some slot. False before scene_load. */
bool has_face_materials(const scene *s, const solid *owner);

/* The material of one kind of face of a solid; the texture is borrowed. */
typedef struct shading_material {
    material surface;
    const texture *img, *covered; /* covered: of img, where its alpha counts; else NULL */
    double opacity; /* multiplies the image's alpha; below 1 only from a mesh file with alpha other than opaque */
    bool glows; /* of a mesh file: emits surface.emission times glow and glow_img, instead of times its own colour */
    vec3 glow;
    const texture *glow_img; /* NULL: none */
    bool vertex_colors;      /* on a mesh, its vertices' colours multiply the surface's */
    int number; /* 1-based index of a scene material; for a surface without one, the number of materials plus the
                   1-based index of the solid */
} shading_material;

/* The source of a slot's material: the scene's material with the slot's name, else the file's; both NULL if the solid's
 * material is used. Only for solids with a loaded mesh. */
void face_material_source(const scene *s, const solid *owner, int slot, const material **named,
                          const face_material **given);

/* The number of slots; 0 if all faces have the solid's material. */
int face_material_slots(const scene *s, const solid *owner);

/* The material of a slot's faces: the scene's material with the slot's name, else the file's, else `base`, the solid's.
 * Under simple transmission the slot's transparency (MTL's d or Tr, glTF's alpha; base's if the file has opacity 1) and
 * reflectivity apply; otherwise the solid's. */
shading_material shading_material_of_face(const scene *s, const solid *owner, const material *base, int slot);
/* The material of a solid without slots, which has the material `base`. */
shading_material shading_material_of_solid(const scene *s, const solid *owner, const material *base);
/* Whether the colours of the vertices of the solid's mesh show on some of its faces: they belong to the materials of
 * the mesh's file, and are left out with a material of the scene. */
bool solid_shows_vertex_colors(const scene *s, const solid *owner);

/* --- materials of the ends of solids that are not meshes --- */

/* Whether some of the solid's ends, or the rest of its surface, has a material of its own. */
bool solid_has_ends(const solid *owner);
/* Slots: 0 for surface of the solid that another solid exposes, 1 and 2 for its ends, 3 for the rest. */
enum { END_SLOTS = 4 };
/* The slot of a face of a solid of this shape, by the face's number in its only primitive. */
int solid_end_slot(const solid_shape *shape, int64_t face);
/* The scene's material of a slot; NULL: the solid's own. */
const material *solid_end_material(const scene *s, const solid *owner, int slot);
/* The material of a slot. An opaque material is used whole, whatever the solid consists of, and light meets it as from
 * outside from both sides; of another one the surface only: coating, film, roughness, reflectivity and Phong's terms.
 * */
shading_material shading_material_of_end(const scene *s, const solid *owner, const material *base, int slot);

/* Whether alpha removes a part of the surface, and how much of it is there at texture coordinates (u, v), 0 to 1: with
 * alpha mask 0 or 1. */
bool shading_material_is_partial(const shading_material *m);
double shading_material_cover(const shading_material *m, double u, double v);
/* Whether the material of some face of an opaque solid is partial. False where the rasteriser draws, which ignores
 * alpha. */
bool solid_is_partial(const scene *s, const solid *owner);

/* Whether all faces of the solid are opaque. */
bool solid_is_opaque(const scene *s, const solid *owner);
/* The number of visible, transparent solids that are crystals. */
int scene_crystals(const scene *s);

/* Whether faces have a transparency or reflectivity that has no effect, because the solid refracts. */
bool ignores_face_transparency(const scene *s, const solid *owner);

/* The operands of a solid's mesh (hierarchy_operands), whose union rays see; an opaque solid, whose inside they do not
 * see, and an open mesh have one. *count is 0 without a loaded mesh. The mesh owns the list. */
status scene_mesh_operands(const scene *s, const solid *owner, const mesh *const **operands, int *count,
                           diagnostic *why);
