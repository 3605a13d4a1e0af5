#include "geometry/shapes/parts.h"

#include <math.h>

PRIMITIVE_RULE(cylinder);

status check_length(double value, const char *name, diagnostic *why)
{
    if (isfinite(value) && value > 0.0) {
        return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "give a length above 0", "%s is %g", name, value);
}

primitive primitive_placed(const solid_shape *shape, primitive_kind kind, const primitive_rule *rule, double reach)
{
    primitive p = {.kind = kind, .rule = rule, .origin = shape->position, .m2 = 1.0};
    const vec3 r = shape->rotation_deg;
    p.rotation = rotation_from_deg(r);
    p.turned = r.x != 0.0 || r.y != 0.0 || r.z != 0.0;
    p.extent = largest_of(fabs(p.origin.x), fabs(p.origin.y), fabs(p.origin.z)) + reach;
    return p;
}

primitive cylinder_placed(const solid_shape *shape, double radius, double bottom, double top)
{
    primitive p = primitive_placed(shape, PRIMITIVE_CYLINDER, &cylinder_rule, shape->height + radius);
    p.radius = radius;
    p.m2 = shape->m * shape->m;
    p.bottom = bottom;
    p.top = top;
    if (p.m2 < 1.0) { /* the long axis is radius / m */
        p.extent += radius / shape->m;
    }
    return p;
}

status check_cylinder(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->radius, "radius", why);
    if (code == STATUS_OK) {
        code = check_length(shape->height, "height", why);
    }
    return code == STATUS_OK ? check_length(shape->m, "m", why) : code;
}

bool cylinder_contains(const solid_shape *shape, vec3 p)
{
    const double m = shape->m, r = shape->radius;
    return p.x * p.x + m * m * p.z * p.z <= r * r && p.y >= 0.0 && p.y <= shape->height;
}
