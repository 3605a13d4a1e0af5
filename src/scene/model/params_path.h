/* The target of a parameter path: `lamp.position.x` refers to the row, the light and the element. Ownership: a place
 * borrows the scene. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/params.h"
#include "scene/model/solids.h"

typedef struct param_place {
    const param *row;
    param_group object_group; /* from the path's first word: PARAM_SOLID for vessel.ior, whose row is a material's */
    size_t index;             /* index of the light, material or solid */
    int element;              /* 0..2, or -1 for the whole value */
} param_place;

/* STATUS_BAD_INPUT, with the nearest valid path as remedy, for an invalid path. */
status param_place_find(const scene *s, const char *path, param_place *out, diagnostic *why);

/* The same for a path's first word alone: an object's name, camera, background or render. Row and element say nothing.
 */
status param_place_find_object(const scene *s, const char *name, param_place *out, diagnostic *why);

/* Whether the film can depend on a parameter: not on those that affect only performance or what is shown with an image,
 * nor on those of a beam that does not light the scene, except for the one that makes it a lamp. */
bool scene_film_depends_on(const scene *s, const char *path);

/* Whether the row applies to the solid (its shape has that dimension). */
bool solid_has(const solid *owner, const param *row);

/* The name of a light, material or solid; "camera" and so on for the other groups. */
const char *param_place_group_name(const scene *s, param_group group, size_t index);

/* The number of objects in a group: 1, or the scene's lights, materials or solids. */
size_t param_place_group_size(const scene *s, param_group group);

/* "sphere" */
const char *shape_name(shape_kind kind);
