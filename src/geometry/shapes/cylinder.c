/* cylinder: x^2 + m^2 z^2 <= radius^2, 0 <= y <= height. Its position is the centre of its base. */
#include "geometry/shapes/parts.h"

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = cylinder_placed(shape, shape->radius, 0.0, shape->height);
}

const shape_rule shape_cylinder = {
    .word = "cylinder",
    .check = check_cylinder,
    .contains = cylinder_contains,
    .primitive_count = 1,
    .primitives = primitives,
};
