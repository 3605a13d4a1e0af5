/* Position and size of a new object in a scene: at the centre of the image, next to existing objects, on the ground if
 * it is visible; its size is a sixth of the distance from the camera, or a fifth of the height of an orthographic view.
 * Lengths in scene units. Pure. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/solids.h"
#include <stdbool.h>

typedef struct placement {
    vec3 looked_at;   /* the camera's target, or a point ahead of it */
    vec3 right, away; /* horizontal unit vectors of the camera */
    double distance;  /* from the camera to looked_at */
    double size;      /* of a new object */
} placement;

placement placement_of(const scene *s);

/* The lowest point of a free place for an object of this size. */
vec3 placement_free(const scene *s, const placement *where, double size);

/* The height of the highest floor plane below the camera, at x and z; false for none. */
bool placement_ground(const scene *s, double x, double z, double *y);

/* A bounding ball of the solid, estimated for a mesh that is not loaded; false for a plane. */
bool placement_bounding_sphere(const scene *s, const solid *of, vec3 *centre, double *radius);

/* Half of the solid's extent along a unit vector, estimated for a mesh that is not loaded; 0 for a plane. */
double placement_half_size(const scene *s, const solid *of, vec3 along);

bool placement_in_view(const scene *s, vec3 point);

/* Rounds a value to the digits that an object of this size needs. */
double placement_round(double value, double size);

/* Adds objects with one command: each is placed where the camera looks (see above), has a suitable
 * size, and is visible. Use a copy of the scene, and discard it after an error. wanted: the requested name; NULL: a new
 * one; name returns it in both cases. Errors: STATUS_BAD_INPUT as in scene/model/edit/edit.h. */

typedef char object_name[SCENE_NAME_MAX + 1];

/* The first free name of base, base2, base3 .. */
status new_name(const scene *s, const char *base, object_name name, diagnostic *why);

/* A mesh is a torus. A plane is a floor, or a wall if there is a floor. */
status new_solid(scene *s, shape_kind shape, const char *wanted, object_name name, diagnostic *why);
status new_beam(scene *s, const char *wanted, object_name name, diagnostic *why);
status new_light(scene *s, const char *wanted, object_name name, diagnostic *why);
status new_material(scene *s, const char *wanted, object_name name, diagnostic *why);
/* A soft ball of clear green jelly. */
status new_slime(scene *s, const char *wanted, object_name name, diagnostic *why);
/* Textures and optical data of a file, after which they are named unless `wanted` is not NULL. path: as written in the
 * scene. */
status new_data(scene *s, const char *path, const char *wanted, object_name name, diagnostic *why);
status new_texture(scene *s, const char *path, const char *wanted, object_name name, diagnostic *why);
/* Adds a mesh and a solid. loaded: a scene with only this mesh, already loaded; path: as written in the scene; name:
 * the solid's. */
status new_model(scene *s, const scene *loaded, const char *path, const char *wanted, object_name name,
                 diagnostic *why);
/* A copy next to the original. */
status new_copy(scene *s, const char *of, object_name name, diagnostic *why);
