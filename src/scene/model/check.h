/* The parts of scene_check that concern one object, so that a reader can say where in a file the trouble is. Pure. */
#pragma once

#include "scene/model/params.h"

/* Letters, digits, _ and -, a letter or _ first, at most SCENE_NAME_MAX, and not a word that paths or scene
 * files use. */
status check_name(const char *name, diagnostic *why);

/* Is the name free among the scene's meshes, textures, lights, materials and solids? */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

/* One object, by itself and with what it names; render, camera and background are one each. */
status check_object(const scene *s, param_group group, size_t index, diagnostic *why);

/* Numbers of lights, materials and primitives. */
status check_limits(const scene *s, diagnostic *why);
