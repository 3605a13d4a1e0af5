/* The solids of a scene: shape, material and priority. A solid owns its name. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"

typedef enum shading_rule { SHADING_FLAT, SHADING_SMOOTH, SHADING_GOURAUD } shading_rule;

/* Maximum numbers of all solids together (shape_places), and of those among them that have no bounds, or triangles. */
enum { SCENE_PRIMITIVES_MAX = (1 << 21) - 1, SCENE_UNBOUNDED_MAX = 64 };

typedef struct solid {
    char *name;
    solid_shape shape;
    int64_t priority;              /* the higher one takes precedence where solids overlap; among equals the one listed
                                      first */
    int64_t visible;               /* 0: omitted from the scene */
    char mesh[SCENE_NAME_MAX + 1]; /* name of the mesh, for shape mesh */
    int64_t shading;               /* shading_rule, for meshes */
    int material_index;            /* index in scene.materials; -1 for none */
    material surface;              /* own copy of the material, with the solid's changes */
} solid;

/* Whether its shape has triangles and it refers to that mesh. */
bool solid_shows(const solid *owner, const char *mesh_name);
