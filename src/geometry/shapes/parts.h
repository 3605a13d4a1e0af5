/* Functions that several shapes share. Pure. */
#pragma once

#include "geometry/mesh/mesh_generators.h"
#include "geometry/primitives/primitive.h"
#include "geometry/scene_geometry.h"
#include "geometry/shapes/shape.h"

/* A NULL-terminated list of words. */
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The number of segments of a round edge. The polygon is inside the circle by at most 1 - cos(180 deg / 256) = 8e-5 of
 * the radius. */
enum { ROUND_SEGMENTS = 256 };

/* STATUS_BAD_INPUT unless value is finite and above 0. */
status check_length(double value, const char *name, diagnostic *why);

static inline double largest_of(double a, double b, double c)
{
    const double m = a > b ? a : b;
    return m > c ? m : c;
}

/* A primitive with the shape's position and rotation; rule: NULL for a mesh; reach: its extent from the position. */
primitive primitive_placed(const solid_shape *shape, const primitive_rule *rule, double reach);
static inline double least_of_three(vec3 v)
{
    return fmin(v.x, fmin(v.y, v.z));
}

/* The extent of a box of that size about the origin. */
shape_extent extent_of_size(vec3 size);

/* A surface of revolution about y, with sharp edges where the profile turns by more than 30 degrees. */
status tessellate_lathe(const profile_point *profile, size_t count, mesh **out, diagnostic *why);

/* Horizontal faces at these heights, for a rule's `flat`. */
bool level_faces(const double *heights, size_t count, size_t i, vec3 *normal, vec3 *point);

/* --- whether one placed shape covers another; lengths are compared up to rounding --- */

#define PLACED_SLACK 1e-12 /* fraction of a length: rounding error of equal lengths */

static inline bool is_within(double reach, double limit, double length)
{
    return reach <= limit + PLACED_SLACK * length;
}

/* Whether the hidden shape is between low and high along the cover's axis k. */
bool placed_is_between(const placed_shape *cover, const placed_shape *hidden, int k, double low, double high);

/* --- scale: shape_is_scaled, shape_extent_of and shape_farthest for a shape of that rule --- */

static inline vec3 divided(vec3 a, vec3 b)
{
    return vec3_make(a.x / b.x, a.y / b.y, a.z / b.z);
}

static inline vec3 multiplied(vec3 a, vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline vec3 sizes(vec3 v)
{
    return vec3_make(fabs(v.x), fabs(v.y), fabs(v.z));
}

bool rule_scales(const shape_rule *rule, const solid_shape *s);
shape_extent rule_extent(const shape_rule *rule, const solid_shape *s);
double rule_farthest(const shape_rule *rule, const solid_shape *s, vec3 d);
