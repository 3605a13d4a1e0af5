/* Where placed shapes end, for those that may hold others. Lengths are compared up to rounding. Pure. */
#pragma once

#include "geometry/shapes/shape.h"

#define PLACED_SLACK 1e-12 /* share of a length: rounding of what is equal */

/* A local axis, x, y or z by 0, 1 or 2, in the world. */
vec3 placed_axis(const mat3 *turn, int k);

/* The most of direction . p over all its points; INFINITY of an unbounded one, and while its mesh is not loaded. */
double placed_farthest(const placed_shape *placed, vec3 direction);
/* The same, but of an unbounded one along the direction in which it ends, too. */
double placed_limit(const placed_shape *placed, vec3 direction);

double round_distance(const round_frame *frame, vec3 point);
/* Not less than the most of that over all its points. */
double placed_farthest_from(const placed_shape *placed, const round_frame *frame);

static inline bool is_within(double reach, double limit, double length)
{
    return reach <= limit + PLACED_SLACK * length;
}

/* Does the other one lie between low and high along the cover's axis k? */
bool placed_is_between(const placed_shape *cover, const placed_shape *hidden, int k, double low, double high);
