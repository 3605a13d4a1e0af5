/* The parts of scene_check for one object, so that a reader can locate an error in a file. Pure. */
#pragma once

#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/view_settings.h"

/* Fails if an object of the scene has that name. */
status check_name_is_free(const scene *s, const char *name, diagnostic *why);

/* Checks one object and its references; index is 0 for render, camera and background. */
status check_object(const scene *s, param_group group, size_t index, diagnostic *why);

/* Fails if the scene has too many objects of a kind, or primitives. */
status check_limits(const scene *s, diagnostic *why);

/* Checks the image of a sky that was just read (image_check_light) and its brightness, replaces small negative
 * values by 0, notes that, and sets sky->brightest. path: for the diagnostic. */
status sky_take(background *sky, const char *path, diagnostic *bad);
