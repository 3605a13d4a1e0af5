/* Origins and directions of the rays of a fan or a beam. Pure; plain values. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <stdbool.h>

/* axis, across and normal are orthonormal; normal is perpendicular to the plane of the rays. */
typedef struct ray_axes {
    vec3 from, axis, across, normal;
} ray_axes;

/* normal: only its part perpendicular to the axis is used. NULL: up for a horizontal axis, else horizontal, so that the
 * plane is vertical. Returns STATUS_BAD_INPUT if the axis is zero or the normal is along it. */
status ray_axes_set(ray_axes *a, vec3 from, vec3 axis, const vec3 *normal, diagnostic *why);

/* Ray i of n in the plane: parallel, `size` scene units between the first and the last, or from one point, `size`
 * degrees between them; a single ray is on the axis. Returns the ray's offset from the axis, in the unit of size. */
double ray_axes_in_plane(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction);

/* Ray i of n over a disc of the diameter `size`, or within a cone of the full angle `size`, evenly distributed (by
 * solid angle) along a spiral: H. Vogel, Mathematical Biosciences 44 (1979). A single ray is on the axis. */
void ray_axes_round(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction);
