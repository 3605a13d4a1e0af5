/* Functions that several shapes share. */
#include "geometry/shapes/parts.h"

#include <math.h>

status check_length(double value, const char *name, diagnostic *why)
{
    if (isfinite(value) && value > 0.0)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use a length above 0", "%s is %g", name, value);
}

primitive primitive_placed(const solid_shape *shape, const primitive_rule *rule, double reach)
{
    primitive p = {.rule = rule, .origin = shape->position, .m2 = 1.0};
    const vec3 r = shape->rotation_deg;
    p.rotation = rotation_from_deg(r);
    p.turned = r.x != 0.0 || r.y != 0.0 || r.z != 0.0;
    p.extent = largest_of(fabs(p.origin.x), fabs(p.origin.y), fabs(p.origin.z)) + reach;
    return p;
}

shape_extent extent_of_size(vec3 size)
{
    const vec3 half = vec3_scale(size, 0.5);
    return (shape_extent){{vec3_scale(half, -1.0), half}, 0.5 * vec3_length(size)};
}

status tessellate_lathe(const profile_point *profile, size_t count, mesh **out, diagnostic *why)
{
    return generate_lathe(profile, count, ROUND_SEGMENTS, 30.0, out, why);
}

bool level_faces(const double *heights, size_t count, size_t i, vec3 *normal, vec3 *point)
{
    *normal = vec3_make(0.0, 1.0, 0.0);
    *point = vec3_make(0.0, i < count ? heights[i] : 0.0, 0.0);
    return i < count;
}
