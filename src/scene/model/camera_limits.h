/* Bounds of camera moves, so that no gesture loses the scene: the camera stays above the grounds that it is above, and
 * its distance from the pivot stays within the scene's scale. A ground is a visible opaque plane that faces up. Lengths
 * in scene units. Pure; cannot fail. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include <stdbool.h>

/* Whether a camera that moves from one point to another keeps its distance from every ground below the first. */
bool camera_is_clear(const scene *s, vec3 from, vec3 to, double gap);
/* The nearest such point above `to`, for one ground; for several, one that is clear of each in turn. */
vec3 camera_lifted(const scene *s, vec3 from, vec3 to, double gap);

/* A distance from the pivot within bounds: a thousandth of the scene's extent about the pivot, and twenty times it. A
 * camera that is already beyond a bound may stay there. */
double camera_distance_within(const scene *s, vec3 pivot, double now, double wanted);

/* A ball around all visible solids with bounds; false for none. */
bool camera_scene_ball(const scene *s, vec3 *centre, double *radius);
