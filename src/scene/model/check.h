/* The parts of scene_check for one object, so that a reader can locate an error in a file. Pure. */
#pragma once

#include "scene/model/params.h"

/* Letters, digits, _ and -, not starting with a digit or -, at most SCENE_NAME_MAX bytes, and not a reserved word of
 * paths or scene files. */
status check_name(const char *name, diagnostic *why);

/* Whether no mesh, texture, light, material or solid of the scene has that name. */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

/* Checks one object and its references; render, camera and background are single objects. */
status check_object(const scene *s, param_group group, size_t index, diagnostic *why);

/* Numbers of lights, materials and primitives. */
status check_limits(const scene *s, diagnostic *why);
