/* box: |x| <= size.x / 2, |y| <= size.y / 2, |z| <= size.z / 2. Its position is its centre. */
#include "geometry/shapes/parts.h"

#include <math.h>

PRIMITIVE_RULE(box);

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->size.x, "size.x", why);
    if (code == STATUS_OK) {
        code = check_length(shape->size.y, "size.y", why);
    }
    return code == STATUS_OK ? check_length(shape->size.z, "size.z", why) : code;
}

static bool contains(const solid_shape *shape, vec3 p)
{
    const vec3 size = shape->size;
    return fabs(p.x) <= size.x / 2 && fabs(p.y) <= size.y / 2 && fabs(p.z) <= size.z / 2;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, PRIMITIVE_BOX, &box_rule, largest_of(shape->size.x, shape->size.y, shape->size.z));
    out[0].half = vec3_scale(shape->size, 0.5);
}

const shape_rule shape_box = {
    .word = "box",
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
};
