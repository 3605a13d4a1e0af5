/* Functions that several shapes share. Pure. */
#pragma once

#include "geometry/scene_geometry.h"
#include "geometry/mesh_generators.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/placed.h"

/* A NULL-terminated list of words. */
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The number of segments of a round edge: the polygon stays within 8e-5 of its radius of the circle (1 - cos(180 deg /
 * 256)). */
enum { ROUND_SEGMENTS = 256 };

/* STATUS_BAD_INPUT unless it is finite and above 0. */
status check_length(double value, const char *name, diagnostic *why);

static inline double largest_of(double a, double b, double c)
{
    const double m = a > b ? a : b;
    return m > c ? m : c;
}

/* A primitive with the shape's position and rotation; rule: NULL for a mesh; reach: its extent from the position. */
primitive primitive_placed(const solid_shape *shape, const primitive_rule *rule, double reach);
/* The elliptic cylinder with the shape's m. */
primitive cylinder_placed(const solid_shape *shape, double radius, double bottom, double top);

static inline double least_of_three(vec3 v)
{
    return fmin(v.x, fmin(v.y, v.z));
}

/* The extent of a box of that size about the origin. */
shape_extent extent_of_size(vec3 size);

/* A surface of revolution about y, with sharp edges where the profile turns by more than 30 degrees. */
status tessellate_lathe(const profile_point *profile, size_t count, mesh **out, diagnostic *why);

/* The common checks of a cylinder and the outside of a cup: radius, height and m. */
status cylinder_check(const solid_shape *shape, diagnostic *why);
bool cylinder_contains(const solid_shape *shape, vec3 local);
shape_extent cylinder_extent(const solid_shape *shape);
double cylinder_farthest(const solid_shape *shape, vec3 direction);
double cylinder_farthest_from(const placed_shape *placed, const round_frame *frame);
bool cylinder_covers(const placed_shape *cover, const placed_shape *hidden);
void cylinder_fit(solid_shape *shape, double size);
int cylinder_rings(const solid_shape *shape, shape_ring *out);
vec3 cylinder_tessellation_scale(const solid_shape *shape);
/* Horizontal faces at these heights, for a rule's `flat`. */
bool level_faces(const double *heights, size_t count, size_t i, vec3 *normal, vec3 *point);
