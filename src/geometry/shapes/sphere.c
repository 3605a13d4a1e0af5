/* sphere: x^2 + y^2 + z^2 <= radius^2. Its position is its centre. */
#include "geometry/shapes/parts.h"

PRIMITIVE_RULE(sphere);

static status check(const solid_shape *shape, diagnostic *why)
{
    return check_length(shape->radius, "radius", why);
}

static bool contains(const solid_shape *shape, vec3 p)
{
    return vec3_dot(p, p) <= shape->radius * shape->radius;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, PRIMITIVE_SPHERE, &sphere_rule, shape->radius);
    out[0].radius = shape->radius;
}

const shape_rule shape_sphere = {
    .word = "sphere",
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
};
