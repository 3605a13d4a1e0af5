/* Third pass, for the rays that met one primitive: the point, put back exactly on the surface, the normal there, the
 * face, and a bound on the point's error.
 *
 * The bound: local coordinates come out of at most 8 roundings of numbers no larger than the ray's start, the
 * way t d and the frame's origin; the root's own error moves the point along the ray, and putting it back on the
 * surface leaves what is across it. 32 half-ulps of the sum of these magnitudes covers it with room to spare (Higham,
 * Accuracy and Stability of Numerical Algorithms, 3.1: gamma_n), which the tests check against quadruple precision. */
#include "geometry/kernels.h"

#include "geometry/roots.h"

typedef struct local_point {
    vec3 point, normal;
    int64_t face;
} local_point;

ALWAYS_INLINE local_point halfspace_point(vec3 q, int64_t first)
{
    local_point l = {vec3_make(q.x, 0.0, q.z), vec3_make(0.0, 1.0, 0.0), first};
    return l;
}

/* The same comparisons of the same roots as in the first pass: the face is the one that bounded the interval there. */
ALWAYS_INLINE local_point cylinder_point(const primitive *p, bool round, local_ray r, vec3 q, int64_t on_side,
                                         int64_t on_bottom, int64_t on_top, int64_t leaving)
{
    double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, p->m2), inverse_y = inverse_of_component(r.dy);
    quadric_roots side = cylinder_side(p, r.x, r.z, dx, r.dz, a, 1.0 / a, on_side);
    slab_roots caps = slab_cross(r.y, inverse_y, p->bottom, p->top, on_bottom, on_top);
    /* A ray that is in it by its set and misses it by a rounding, past an edge, leaves at once (store_interval), and by
     * the side: the top of a hollow is nowhere. Its roots are no numbers then. */
    int64_t is_side = blend_int(leaving, ~mask_less_equal(caps.out, side.out), mask_less(caps.in, side.in));
    int64_t is_top =
        leaving ^ mask_less(inverse_y, 0.0); /* in from above or out upwards; -0.0 is downwards, as for the roots */
    double inverse = 1.0 / sqrt(q.x * q.x + p->m2 * q.z * q.z);
    double ux = q.x * inverse, uz = q.z * inverse, x = p->radius * ux, z = p->radius * uz;
    double slope = p->m2 * uz, norm = round ? 1.0 : 1.0 / sqrt(ux * ux + slope * slope);
    double cap = blend(is_top, p->top, p->bottom), up = blend(is_top, 1.0, -1.0);
    local_point l;
    l.point = vec3_make(blend(is_side, x, q.x), blend(is_side, q.y, cap), blend(is_side, z, q.z));
    l.normal = vec3_make(blend(is_side, ux * norm, 0.0), blend(is_side, 0.0, up), blend(is_side, slope * norm, 0.0));
    l.face = p->first_face + blend_int(is_side, 0, blend_int(is_top, 2, 1));
    return l;
}

ALWAYS_INLINE local_point box_point(const primitive *p, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    const vec3 h = p->half;
    const double inverse_x = inverse_of_component(r.dx), inverse_y = inverse_of_component(r.dy),
                 inverse_z = inverse_of_component(r.dz);
    slab_roots x = slab_cross(r.x, inverse_x, -h.x, h.x, mask_same(at, 0), mask_same(at, 1));
    slab_roots y = slab_cross(r.y, inverse_y, -h.y, h.y, mask_same(at, 2), mask_same(at, 3));
    slab_roots z = slab_cross(r.z, inverse_z, -h.z, h.z, mask_same(at, 4), mask_same(at, 5));
    int64_t is_x = blend_int(leaving, mask_less(x.out, y.out) & mask_less(x.out, z.out),
                             mask_less(y.in, x.in) & mask_less(z.in, x.in));
    int64_t is_y = ~is_x & blend_int(leaving, mask_less(y.out, z.out), mask_less(z.in, y.in));
    int64_t is_z = ~is_x & ~is_y;
    /* The face on the positive side: left when the direction is positive there, entered when it is negative. By the
     * inverses, for which -0.0 is negative: the roots were taken with them. */
    double along = blend(is_x, inverse_x, blend(is_y, inverse_y, inverse_z));
    int64_t positive = leaving ^ mask_less(along, 0.0);
    double sign = blend(positive, 1.0, -1.0);
    local_point l;
    l.point = vec3_make(blend(is_x, sign * h.x, q.x), blend(is_y, sign * h.y, q.y), blend(is_z, sign * h.z, q.z));
    l.normal = vec3_make(blend(is_x, sign, 0.0), blend(is_y, sign, 0.0), blend(is_z, sign, 0.0));
    l.face = p->first_face + blend_int(is_x, 0, blend_int(is_y, 2, 4)) + (positive & 1);
    return l;
}

ALWAYS_INLINE local_point sphere_point(const primitive *p, vec3 q)
{
    double inverse = 1.0 / vec3_length(q);
    local_point l;
    l.normal = vec3_scale(q, inverse);
    l.point = vec3_scale(l.normal, p->radius);
    l.face = p->first_face;
    return l;
}

ALWAYS_INLINE void points_on(const primitive *p, primitive_kind kind, bool turned, bool round, const ray_batch *rays,
                             const double *restrict t, int bit, surface_batch *restrict s)
{
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        vec3 d = vec3_make(r.dx, r.dy, r.dz), o = vec3_make(r.x, r.y, r.z), way = vec3_scale(d, t[i]),
             q = vec3_add(o, way);
        int64_t at = rays->start[i] - p->first_face, leaving = -(int64_t)((rays->inside[i] & (uint64_t)1 << bit) != 0);
        local_point l = kind == PRIMITIVE_HALFSPACE  ? halfspace_point(q, p->first_face)
                        : kind == PRIMITIVE_CYLINDER ? cylinder_point(p, round, r, q, mask_same(at, 0),
                                                                      mask_same(at, 1), mask_same(at, 2), leaving)
                        : kind == PRIMITIVE_BOX      ? box_point(p, r, q, at, leaving)
                                                     : sphere_point(p, q);
        double side = blend(leaving, -1.0, 1.0); /* the normal faces the ray */
        vec3 n = vec3_scale(l.normal, side), point = l.point;
        double cosine = -vec3_dot(d, n);
        double size =
            magnitude(o.x) + magnitude(o.y) + magnitude(o.z) + magnitude(way.x) + magnitude(way.y) + magnitude(way.z);
        if (turned) {
            n = mat3_apply(p->rotation, n);
            point = mat3_apply(p->rotation, point);
        }
        s->px[i] = point.x + p->origin.x;
        s->py[i] = point.y + p->origin.y;
        s->pz[i] = point.z + p->origin.z;
        s->nx[i] = n.x;
        s->ny[i] = n.y;
        s->nz[i] = n.z;
        s->cos_i[i] = lesser(greater(cosine, DBL_MIN), 1.0);
        s->error[i] = POINT_ERROR * (size + p->extent);
        s->face[i] = l.face;
    }
}

void KERNEL(surface_points)(const primitive *primitive_met, const ray_batch *rays, const double *t, int bit,
                            surface_batch *points)
{
    const primitive p = *primitive_met;
    const bool round = p.m2 == 1.0;
    switch (p.kind) {
    case PRIMITIVE_HALFSPACE:
        if (p.turned)
            points_on(&p, PRIMITIVE_HALFSPACE, true, true, rays, t, bit, points);
        else
            points_on(&p, PRIMITIVE_HALFSPACE, false, true, rays, t, bit, points);
        break;
    case PRIMITIVE_CYLINDER:
        if (p.turned || !round)
            points_on(&p, PRIMITIVE_CYLINDER, true, false, rays, t, bit, points);
        else
            points_on(&p, PRIMITIVE_CYLINDER, false, true, rays, t, bit, points);
        break;
    case PRIMITIVE_BOX:
        if (p.turned)
            points_on(&p, PRIMITIVE_BOX, true, true, rays, t, bit, points);
        else
            points_on(&p, PRIMITIVE_BOX, false, true, rays, t, bit, points);
        break;
    case PRIMITIVE_SPHERE: points_on(&p, PRIMITIVE_SPHERE, false, true, rays, t, bit, points); break;
    case PRIMITIVE_MESH: break; /* see forest_surface */
    }
}
