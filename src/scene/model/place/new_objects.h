/* Adds objects with one command: each is placed where the camera looks (scene/model/place/placement.h), has a suitable
 * size, and is visible. Use a copy of the scene, and discard it after an error. wanted: the requested name; NULL: a new
 * one; name returns it in both cases. Errors: STATUS_BAD_INPUT as in scene/model/edit/edit.h. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"
#include "scene/model/open.h"

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
