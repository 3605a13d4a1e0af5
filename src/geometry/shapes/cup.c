/* cup: a cylinder of radius, m and height less one of inner_radius and the same m that stands on the floor's thickness
 * and is open at the top. Its position is the centre of its base. The ellipses are similar, so that the wall is
 * radius - inner_radius thick along x, and 1 / m of that along z. */
#include "geometry/shapes/parts.h"

#include <math.h>

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = check_cylinder(shape, why);
    if (code == STATUS_OK) {
        code = check_length(shape->inner_radius, "inner_radius", why);
    }
    if (code == STATUS_OK) {
        code = check_length(shape->floor, "floor", why);
    }
    if (code != STATUS_OK) {
        return code;
    }
    if (shape->inner_radius >= shape->radius) {
        return diagnose(why, STATUS_BAD_INPUT, "make inner_radius smaller than radius, or the cup has no wall",
                        "inner_radius %g is not smaller than radius %g", shape->inner_radius, shape->radius);
    }
    if (shape->floor >= shape->height) {
        return diagnose(why, STATUS_BAD_INPUT, "make floor smaller than height, or the cup holds nothing",
                        "floor %g is not smaller than height %g", shape->floor, shape->height);
    }
    return STATUS_OK;
}

/* The cup is closed, so its hollow is open: the hollow's own surface belongs to the cup. */
static bool contains(const solid_shape *shape, vec3 p)
{
    const double m = shape->m, r = shape->inner_radius;
    return cylinder_contains(shape, p) && !(p.x * p.x + m * m * p.z * p.z < r * r && p.y > shape->floor);
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = cylinder_placed(shape, shape->radius, 0.0, shape->height);
    out[1] = cylinder_placed(shape, shape->inner_radius, shape->floor, HUGE_VAL);
}

const shape_rule shape_cup = {
    .word = "cup",
    .check = check,
    .contains = contains,
    .primitive_count = 2,
    .primitives = primitives,
};
