/* The solids of a scene: a shape, what it is made of, and its priority. A solid owns its name. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"

typedef enum shading_rule { SHADING_FLAT, SHADING_SMOOTH, SHADING_GOURAUD } shading_rule;

/* Of all solids together (shape_rule.primitive_count). */
enum { SCENE_PRIMITIVES_MAX = 64 };

typedef struct solid {
    char *name;
    solid_shape shape;
    int64_t priority;              /* the higher one wins where solids overlap; of equals the one listed first */
    int64_t visible;               /* 0: left out of the picture altogether */
    char mesh[SCENE_NAME_MAX + 1]; /* of a mesh: which one */
    int64_t shading;               /* shading_rule, of a mesh */
    int material_index;            /* into scene.materials; -1 when it has none */
    material surface;              /* its own copy, with its own changes */
} solid;

/* Is it of a shape with triangles, and names that mesh? */
bool solid_shows(const solid *owner, const char *mesh_name);
