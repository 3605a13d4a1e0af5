/* Extents of placed shapes, used to test whether one covers another. Lengths are compared up to rounding. Pure. */
#pragma once

#include "geometry/shapes/shape.h"

#define PLACED_SLACK 1e-12 /* share of a length: rounding error of equal lengths */

/* A local axis (0 x, 1 y, 2 z) in the world. */
vec3 placed_axis(const mat3 *turn, int k);

/* The maximum of direction . p over all its points; INFINITY for an unbounded shape, and while its mesh is not
 * loaded. */
double placed_farthest(const placed_shape *placed, vec3 direction);
/* The same, but finite for an unbounded shape in the direction of its surface normal. */
double placed_limit(const placed_shape *placed, vec3 direction);

double round_distance(const round_frame *frame, vec3 point);
/* An upper bound of that distance over all its points. */
double placed_farthest_from(const placed_shape *placed, const round_frame *frame);

static inline bool is_within(double reach, double limit, double length)
{
    return reach <= limit + PLACED_SLACK * length;
}

/* Is the hidden shape between low and high along the cover's axis k? */
bool placed_is_between(const placed_shape *cover, const placed_shape *hidden, int k, double low, double high);
