/* Shared code of edit_place.c and edit_whole.c. Private to them. */
#pragma once

#include "scene/model/params_path.h"
#include "scene/model/open.h"

/* Sets a vector by its path, so that its range is checked. */
status edit_set_vector(scene *s, const char *name, const char *row, vec3 v, diagnostic *why);

/* Finds the object with that name that has a position. The remedy of its error also lists the names of groups. */
status edit_find(const scene *s, const char *name, param_place *at, diagnostic *why);

/* Rounds an angle from an arc tangent, whose error is below 1e-12 degrees, to a nearby round number. */
double edit_settle_deg(double degrees);
