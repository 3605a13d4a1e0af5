/* plane: the half-space y <= 0. */
#include "geometry/shapes/parts.h"

PRIMITIVE_RULE(halfspace);

static bool contains(const solid_shape *shape, vec3 p)
{
    (void)shape;
    return p.y <= 0.0;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, PRIMITIVE_HALFSPACE, &halfspace_rule, 0.0);
}

const shape_rule shape_plane = {
    .word = "plane",
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
};
