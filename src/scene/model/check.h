/* The parts of scene_check for one object, so that a reader can locate an error in a file. Pure. */
#pragma once

#include "image/image.h"
#include "scene/model/names.h"
#include "scene/model/params.h"

/* Whether no mesh, texture, light, material or solid of the scene has that name. */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

/* Checks one object and its references; render, camera and background are single objects. */
status check_object(const scene *s, param_group group, size_t index, diagnostic *why);

/* Numbers of lights, materials and primitives. */
status check_limits(const scene *s, diagnostic *why);

/* Whether an image can be a sky: its radiance must not be negative, and must fit the film. path: for the diagnostic. */
status sky_check(const image *sky, const char *path, diagnostic *bad);
