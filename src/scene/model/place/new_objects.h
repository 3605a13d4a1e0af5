/* What can be added to a scene with one word: each stands where the camera looks (scene/model/place/placement.h), fits,
 * and can be seen. Called on a copy of the scene that is thrown away after an error. wanted: the name that it is to
 * have; NULL: one is made that is free, which name then says, wanted or not. Errors: STATUS_BAD_INPUT as
 * scene/model/edit/edit.h has them. */
#pragma once

#include "geometry/solid.h"
#include "scene/model/material.h"
#include "scene/model/open.h"

typedef char object_name[SCENE_NAME_MAX + 1];

/* base, or base2, base3 .. */
status new_name(const scene *s, const char *base, object_name name, diagnostic *why);

/* A mesh is a torus. A plane is a floor, or a wall where there is one. */
status new_solid(scene *s, shape_kind shape, const char *wanted, object_name name, diagnostic *why);
status new_light(scene *s, const char *wanted, object_name name, diagnostic *why);
status new_material(scene *s, const char *wanted, object_name name, diagnostic *why);
/* A soft ball of clear green jelly. */
status new_slime(scene *s, const char *wanted, object_name name, diagnostic *why);
/* path: as the scene names it. */
status new_texture(scene *s, const char *path, const char *wanted, object_name name, diagnostic *why);
/* loaded: a scene with one mesh, which has its triangles from that path; path: as the scene names it. name is the
 * solid's. */
status new_model(scene *s, const scene *loaded, const char *path, const char *wanted, object_name name,
                 diagnostic *why);
/* Another one like it, beside it. */
status new_copy(scene *s, const char *of, object_name name, diagnostic *why);
