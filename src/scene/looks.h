/* How the faces of a mesh's slots look, as its file says it: what Phong's sum needs and a texture, by slot. Shared like the mesh that they
 * came with: looks_retain and looks_release count owners, from any thread. */
#ifndef CUVETTE_SCENE_LOOKS_H
#define CUVETTE_SCENE_LOOKS_H

#include "scene/mesh_stream.h"
#include "scene/scene.h"

typedef struct face_look {
    char name[SCENE_NAME_MAX + 1]; /* cut off where it is longer; "" for none */
    bool given;             /* the file says something; else the solid's own surface counts */
    vec3 color;             /* linear RGB, at most 1 */
    double diffuse, specular, shininess, emission;
    const texture *picture; /* one owner of it; NULL for none */
} face_look;

/* From what an importer found; reads the pictures that it names, each once, below root (base/below.h). A diagnostic names the picture's file. */
status looks_create(const mesh_import *imported, const char *root, const face_looks **out, diagnostic *why);
void looks_retain(const face_looks *l); /* NULL is allowed, here and below */
void looks_release(const face_looks *l);

/* Do the mesh's slots, not one material, say how the solid's faces look? Where it is a mesh that has several, or a file's materials, and names
 * no material itself. False before scene_load. */
bool looks_by_face(const scene *s, const solid *owner);

int looks_count(const face_looks *l); /* 0 for NULL */
const face_look *looks_at(const face_looks *l, int slot);

#endif
