/* Moves and rotates one object or the camera, for edit_parts.c and contents.c. Private to this folder. Errors as in
 * scene/model/edit/edit.h. */
#pragma once

#include "base/vec3.h"
#include "scene/model/params.h"

/* Finds an object by name. The remedy of the error also lists the names of groups. */
status edit_find(const scene *s, const char *name, param_place *at, diagnostic *why);

/* Sets a vector parameter by its path, which checks its range. */
status edit_set_vector(scene *s, const char *name, const char *row, vec3 v, diagnostic *why);

/* scene_move and scene_turn for one object or "camera". */
status edit_move(scene *s, const char *name, vec3 delta, diagnostic *why);
status edit_turn(scene *s, const char *name, vec3 degrees, diagnostic *why);
/* Fails for angles that are not finite or too large; name is used in the message. */
status edit_check_angles(const char *name, vec3 degrees, diagnostic *why);

/* Rounds an angle from an arc tangent, whose error is below 1e-12 degrees, to a nearby round number. */
double edit_settle_deg(double degrees);

/* Undoes a failed edit of values: restores those of the clone that was made before the edit. */
void edit_restore(scene *s, const scene *before);
