/* Origins and directions of the rays of a fan or a beam. Pure; plain values. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "scene/model/lights.h"
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

/* Places over a disc or in a cone. count: the number of rays, as many as requested on a spiral and of Sobol'; else the
 * most, at least 1, that fill rings or a square grid. side: squares along the grid's edge. */
typedef struct ray_pattern {
    beam_pattern kind;
    int count;
    int64_t side;
} ray_pattern;

ray_pattern ray_pattern_of(beam_pattern kind, int wanted);

/* Ray i of a pattern over a disc of the diameter `size`, or within a cone of the full angle `size`. Each ray stands for
 * an equal part of the disc's area or the cone's solid angle:
 *   spiral  H. Vogel, Mathematical Biosciences 44 (1979); a single ray is on the axis;
 *   rings   ring k = 1, 2, ... has 6 k rays, at the radius that halves the area of its ring; ray 0 is on the axis;
 *   square  the centres within the disc of side x side equal squares around it, row by row;
 *   sobol   r^2 and the angle, over a full turn, are the coordinates of Sobol's first two dimensions, in natural order
 *           (Joe and Kuo 2008), not scrambled; ray 0 is on the axis. */
void ray_axes_round(const ray_axes *a, const ray_pattern *pattern, bool spreads, double size, int i, vec3 *origin,
                    vec3 *direction);

/* Field point of a grid of columns x rows, row by row: the axes turned (parallel rays, size in degrees between the
 * outermost directions) or moved across the axis (size in scene units). Columns are side by side along the
 * horizontal (x for an upright axis), rows one above the other. */
void ray_axes_field(const ray_axes *a, bool spreads, double size, int i, int columns, int rows, vec3 *from, vec3 *axis);
