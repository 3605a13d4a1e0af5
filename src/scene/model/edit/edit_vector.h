/* What the files that move things share (edit_place.c, edit_whole.c). Nobody else includes it. */
#pragma once

#include "scene/model/params_path.h"
#include "scene/model/open.h"

/* Sets a vector by its path, so that its range is checked as a person's would be. */
status edit_set_vector(scene *s, const char *name, const char *row, vec3 v, diagnostic *why);

/* The one object of that name that may be placed; else the remedy has the words of several, too. */
status edit_find(const scene *s, const char *name, param_place *at, diagnostic *why);

/* An angle that came out of an arc tangent, whose error is under 1e-12 degrees: a round one is what was meant. */
double edit_settle_deg(double degrees);
