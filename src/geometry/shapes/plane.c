/* The shape plane: the half-space y <= 0. Its position is a point of its surface. */
#include "geometry/shapes/parts.h"

PRIMITIVE_RULE(halfspace);

static bool contains(const solid_shape *shape, vec3 p)
{
    (void)shape;
    return p.y <= 0.0;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &halfspace_rule, 0.0);
}

static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    (void)shape;
    return level_faces(&(double){0.0}, 1, i, normal, point);
}

static double farthest(const solid_shape *shape, vec3 d)
{
    (void)shape;
    return d.y >= 1.0 - PLACED_SLACK ? 0.0 : INFINITY;
}

static bool covers(const placed_shape *cover, const placed_shape *hidden)
{
    const vec3 up = placed_axis(&cover->turn, 1);
    return placed_farthest(hidden, up) <= vec3_dot(up, cover->shape.position);
}

static double thickness(const solid_shape *shape)
{
    (void)shape;
    return HUGE_VAL;
}

const shape_rule shape_plane = {
    .word = "plane",
    .meaning = "the half-space y <= 0; its position is a point of its surface",
    .unbounded = true,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
    .flat = flat,
    .farthest = farthest,
    .covers = covers,
    .thickness = thickness,
};
