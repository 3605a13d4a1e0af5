/* What several shapes share. Pure. */
#ifndef CUVETTE_GEOMETRY_SHAPES_PARTS_H
#define CUVETTE_GEOMETRY_SHAPES_PARTS_H

#include "geometry/arrangement.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"

/* STATUS_BAD_INPUT unless it is finite and above 0. */
status check_length(double value, const char *name, diagnostic *why);

static inline double largest_of(double a, double b, double c)
{
    const double m = a > b ? a : b;
    return m > c ? m : c;
}

/* In the shape's place; reach: how far it extends from its position. */
primitive primitive_placed(const solid_shape *shape, primitive_kind kind, const primitive_rule *rule, double reach);
/* Of the shape's m. */
primitive cylinder_placed(const solid_shape *shape, double radius, double bottom, double top);

/* radius, height and m of a cylinder or cup. */
status check_cylinder(const solid_shape *shape, diagnostic *why);
bool cylinder_contains(const solid_shape *shape, vec3 local);

#endif
