/* mesh: a triangle mesh, each axis times scale, as often as copies says, spacing apart. A closed mesh is solid; an open
 * one is a skin, which contains nothing. Copies may touch but not overlap, and a mesh's own parts neither. */
#include "geometry/shapes/parts.h"

#include <math.h>

static bool is_whole(double value)
{
    return value >= 1.0 && value <= COPIES_MAX && value == floor(value);
}

static status check(const solid_shape *shape, diagnostic *why)
{
    const vec3 n = shape->copies, s = shape->scale, step = shape->spacing;
    if (!is_whole(n.x) || !is_whole(n.y) || !is_whole(n.z) || n.x * n.y * n.z > COPIES_MAX) {
        return diagnose(why, STATUS_BAD_INPUT, "give three whole numbers from 1, at most 4194304 copies in all",
                        "copies is %g, %g, %g", n.x, n.y, n.z);
    }
    if (!(s.x > 0.0 && s.y > 0.0 && s.z > 0.0) || !vec3_is_finite(s) || !vec3_is_finite(step)) {
        return diagnose(why, STATUS_BAD_INPUT, "give numbers above 0", "scale is %g, %g, %g", s.x, s.y, s.z);
    }
    return STATUS_OK;
}

/* How far its copies reach from its position. */
static double reach(const solid_shape *shape)
{
    const bounds3 b = shape->mesh->bounds;
    const vec3 low = b.low, high = b.high, scale = shape->scale, n = shape->copies, step = shape->spacing;
    const double x = largest_of(fabs(low.x), fabs(high.x), 0.0) * scale.x + (n.x - 1.0) * fabs(step.x);
    const double y = largest_of(fabs(low.y), fabs(high.y), 0.0) * scale.y + (n.y - 1.0) * fabs(step.y);
    const double z = largest_of(fabs(low.z), fabs(high.z), 0.0) * scale.z + (n.z - 1.0) * fabs(step.z);
    return shape->mesh->triangle_count > 0 ? x + y + z : 0.0;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, PRIMITIVE_MESH, NULL, reach(shape));
}

const shape_rule shape_mesh = {
    .word = "mesh",
    .triangles = true,
    .check = check,
    .primitive_count = 1,
    .primitives = primitives,
};
