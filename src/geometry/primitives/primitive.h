/* The interface of a kind of primitive: one constant table of functions, in the file of its name in this folder,
 * compiled for each instruction set. A primitive points to its kind's rule, so that there is no list of kinds: a new
 * kind is one file, and the shapes that use it declare it with PRIMITIVE_RULE. The formulas that kinds share come
 * first: roots of planes and quadrics, and texture coordinates.
 *
 * Points and rays are in the primitive's local frame; faces are numbered from 0. Functions are pure and cannot fail. A
 * mesh has no rule (geometry/regions/instance_set.h): the functions at the end return false, 0 or zeros for it. */
#pragma once

#include "base/elementary.h"
#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/rays.h"
#include "geometry/scene_geometry.h"
#include <math.h>

/* --- intersections of a line with planes and quadrics in a primitive's own frame ---
 *
 * The same formulas are used by the first pass over all rays and for the face of a hit. No branches.
 *
 * The root of the face that a ray starts on is exactly zero. A zero component of a direction is replaced by 1e-300, and
 * a line along a cylinder's axis is tilted by 1e-140: the roots are then at 1e130 or beyond, in effect at infinity,
 * without a special case. */

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

/* Roots of the planes y = low and y = high. */
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
ALWAYS_INLINE quadric_roots quadric_cross(double b, double inverse_a, double discriminant, int64_t starts_on)
{
    double middle = -b * inverse_a;
    double half = blend(starts_on, magnitude(middle), sqrt(discriminant) * inverse_a);
    quadric_roots q = {middle - half, middle + half, starts_on | mask_less(0.0, discriminant)};
    return q;
}

/* dx of a ray in a cylinder's frame, kept from being zero together with dz. */
ALWAYS_INLINE double cylinder_dx(double dx, double dz)
{
    return blend(mask_less(magnitude(dx), 1e-140) & mask_less(magnitude(dz), 1e-140), 1e-140, dx);
}

/* The leading coefficient of a cylinder's quadric, for dx as returned by cylinder_dx. */
ALWAYS_INLINE double cylinder_axial(double dx, double dz, double m2)
{
    return dx * dx + m2 * dz * dz;
}

/* The infinite cylinder x^2 + m2 z^2 = radius^2; dx as returned by cylinder_dx, inverse_a = 1/a. The discriminant is a
 * r^2 - m2 (x dz - z dx)^2 (Lagrange's identity), which does not cancel as b^2 - a c does far from the cylinder. */
ALWAYS_INLINE quadric_roots cylinder_side(const primitive *p, double x, double z, double dx, double dz, double a,
                                          double inverse_a, int64_t starts_on)
{
    double r2 = p->radius * p->radius, cross = x * dz - z * dx;
    return quadric_cross(x * dx + p->m2 * z * dz, inverse_a, a * r2 - p->m2 * (cross * cross), starts_on);
}

/* --- texture coordinates ---
 *
 * u to the right and v up as seen from outside, in units of the texture image; per_length is the number of repetitions
 * of the texture per scene unit, in the direction where they are closer. size is the extent of the texture image in
 * scene units; 0 scales one image to a face. */

typedef struct surface_mapping {
    double u, v, per_length;
} surface_mapping;

/* Flat faces: along two local axes, from the face's lower left corner as seen from outside. */
static inline surface_mapping mapping_flat(double x, double y, double width, double height, double size)
{
    const double across = size > 0.0 ? size : width, up = size > 0.0 ? size : height;
    return (surface_mapping){x / across, y / up, 1.0 / (across < up ? across : up)};
}

/* Around the axis, by the angle (one image) or by arc length: to the right as seen from outside, the middle of the
 * image in front, at -z, as on the solids of geometry/mesh/mesh_generators.h. */
static inline surface_mapping mapping_around(double x, double z, double radius, double v, double height, double size)
{
    const double turn = 0.5 + elementary_atan2_deg(x, -z) / 360.0, arc = 6.283185307179586 * radius;
    return mapping_flat(turn * arc, v, arc, height, size);
}

/* --- the rule of a kind --- */

typedef struct interval {
    double in, out;
} interval;

/* Intervals of a line inside a primitive. A line crosses a biconcave lens up to six times, a lens whose sides turn
 * between convex and concave more often; each kind has a bound of its own. */
enum { CHORDS_MAX = 9 };

/* A face with a constant local coordinate: axis 0 x, 1 y, 2 z. `outwards` is the direction away from the primitive: +1
 * or -1; 0 for a surface whose textures are looked up on the surface itself and not just inside it. */
enum { FLATS_MAX = 6 };
typedef struct flat_face {
    int face, axis;
    double at, outwards;
} flat_face;

typedef struct primitive_functions {
    int intervals; /* the most intervals of a line in a primitive: 1 if it is convex, otherwise up to CHORDS_MAX */
    /* First pass (intervals_kernel.c): fills s->in and s->out for every ray, in `intervals` rows from row `bit` on. */
    void (*rows)(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s);
    /* The intervals of ray i of the batch only. inside: whether its start is in the primitive. s has the terms that are
     * common to the rays of the batch (intervals_kernel.c). */
    void (*one)(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found);
    /* Third pass: geometry_kernels.surface. */
    void (*points)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);
    /* Whether the primitive contains q, by its definition, surfaces included. */
    bool (*contains)(const primitive *p, vec3 q);
    /* The intervals in which the line of r, infinite in both directions, is in the primitive, in order; returns their
     * number. */
    int (*chords)(const primitive *p, local_ray r, interval chords[CHORDS_MAX]);
    /* The faces perpendicular to a local axis; returns their number. NULL: none. */
    int (*flats)(const primitive *p, flat_face flat[FLATS_MAX]);
    /* Texture coordinates of the point q on a face. */
    surface_mapping (*mapping)(const primitive *p, int64_t face, vec3 q, double size);
} primitive_functions;

typedef struct primitive_rule {
#define PRIMITIVE_RULE_MEMBER(set, ...) const primitive_functions *set;
    ISA_EACH(PRIMITIVE_RULE_MEMBER, )
} primitive_rule;

/* Declares name_rule, the rule of the kind in name_kernel.c. */
#define PRIMITIVE_RULE(name)                                 \
    ISA_DECLARE(const primitive_functions, name##_functions) \
    static const primitive_rule name##_rule = ISA_ARRAY(name##_functions)

/* --- queries in world coordinates --- */

/* Whether the primitive contains the point, in world coordinates. */
static inline bool primitive_contains(const primitive *p, vec3 point)
{
    return p->rule &&
           p->rule->ISA_BASELINE->contains(p, mat3_apply_transposed(p->rotation, vec3_sub(point, p->origin)));
}

/* The intervals of a line (world coordinates) in the primitive; returns their number. */
static inline int primitive_chords(const primitive *p, vec3 origin, vec3 direction, interval chords[CHORDS_MAX])
{
    if (!p->rule)
        return 0;
    const local_ray r = ray_to_local(p, true, origin.x, origin.y, origin.z, direction.x, direction.y, direction.z);
    return p->rule->ISA_BASELINE->chords(p, r, chords);
}

/* The primitive's faces perpendicular to a local axis; returns their number. */
static inline int primitive_flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    return p->rule && p->rule->ISA_BASELINE->flats ? p->rule->ISA_BASELINE->flats(p, flat) : 0;
}

/* Texture coordinates of a point (world coordinates) on a face (a face number, see scene_geometry.h). */
static inline surface_mapping primitive_mapping(const primitive *p, int64_t face, vec3 point, double size)
{
    if (!p->rule)
        return (surface_mapping){0.0, 0.0, 0.0};
    const vec3 moved = vec3_sub(point, p->origin), q = p->turned ? mat3_apply_transposed(p->rotation, moved) : moved;
    return p->rule->ISA_BASELINE->mapping(p, face - p->first_face, q, size);
}
