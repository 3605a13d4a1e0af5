/* Intersections of a line with planes and quadrics in a primitive's own frame: the only set of these formulas, used
 * both by the pass over all rays and for the face of a hit (primitives/). No branches; pure.
 *
 * The root of the face that a ray starts on is exactly zero. A zero component of a direction is replaced by 1e-300, and
 * a line along a cylinder's axis is tilted by 1e-140: the roots are then at 1e130 or beyond, in effect at infinity,
 * without a special case. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/scene_geometry.h"
#include <math.h>

typedef struct local_ray {
    double x, y, z, dx, dy, dz;
} local_ray;

ALWAYS_INLINE local_ray ray_to_local(const primitive *p, bool turned, double ox, double oy, double oz, double dx,
                                     double dy, double dz)
{
    local_ray r = {ox - p->origin.x, oy - p->origin.y, oz - p->origin.z, dx, dy, dz};
    if (turned) {
        vec3 o = mat3_apply_transposed(p->rotation, vec3_make(r.x, r.y, r.z));
        vec3 d = mat3_apply_transposed(p->rotation, vec3_make(dx, dy, dz));
        r = (local_ray){o.x, o.y, o.z, d.x, d.y, d.z};
    }
    return r;
}

ALWAYS_INLINE double inverse_of_component(double d)
{
    double sign = lanes_double((lanes_bits(d) & INT64_MIN) | lanes_bits(1e-300));
    return 1.0 / blend(mask_less(magnitude(d), 1e-300), sign, d);
}

/* Roots of the planes y = bottom and y = top. */
typedef struct slab_roots {
    double in, out;
} slab_roots;

ALWAYS_INLINE slab_roots slab_cross(double y, double inverse_y, double low, double high, int64_t on_low,
                                    int64_t on_high)
{
    double a = blend(on_low, 0.0, (low - y) * inverse_y), b = blend(on_high, 0.0, (high - y) * inverse_y);
    slab_roots s = {lesser(a, b), greater(a, b)};
    return s;
}

/* Roots of a quadric a t^2 + 2 b t + c = 0, given its reduced discriminant b^2 - a c: [in, out], and whether it is
 * hit. */
typedef struct quadric_roots {
    double in, out;
    int64_t hit;
} quadric_roots;

/* For a miss the roots are NaN and hit is 0. */
ALWAYS_INLINE quadric_roots quadric_cross(double b, double inverse_a, double discriminant, int64_t own)
{
    double middle = -b * inverse_a;
    double half = blend(own, magnitude(middle), sqrt(discriminant) * inverse_a);
    quadric_roots q = {middle - half, middle + half, own | mask_less(0.0, discriminant)};
    return q;
}

/* dx of a ray in a cylinder's frame, kept from being zero together with dz. */
ALWAYS_INLINE double cylinder_dx(double dx, double dz)
{
    return blend(mask_less(magnitude(dx), 1e-140) & mask_less(magnitude(dz), 1e-140), 1e-140, dx);
}

/* The leading coefficient of a cylinder's quadric, for dx as cylinder_dx gives it. */
ALWAYS_INLINE double cylinder_axial(double dx, double dz, double m2)
{
    return dx * dx + m2 * dz * dz;
}

/* The infinite cylinder x^2 + m2 z^2 = radius^2; dx as returned by cylinder_dx, inverse_a = 1/a. The discriminant is a
 * r^2 - m2 (x dz - z dx)^2 (Lagrange's identity), which does not cancel as b^2 - a c does far from the cylinder. */
ALWAYS_INLINE quadric_roots cylinder_side(const primitive *p, double x, double z, double dx, double dz, double a,
                                          double inverse_a, int64_t own)
{
    double r2 = p->radius * p->radius, cross = x * dz - z * dx;
    return quadric_cross(x * dx + p->m2 * z * dz, inverse_a, a * r2 - p->m2 * (cross * cross), own);
}
