/* The cylinder primitive: x^2 + m2 z^2 <= radius^2, bottom <= y <= top; top may be infinite, as for a cup's hollow.
 * Faces: 0 side, 1 bottom, 2 top. */
#include "geometry/primitives/kind.h"

/* Whether the general code is needed. An upright elliptic cylinder uses it with the identity rotation, which changes no
 * bit. */
static bool is_general(const primitive *p)
{
    return p->turned || p->m2 != 1.0;
}

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    int64_t on_side = mask_same(at, 0), on_bottom = mask_same(at, 1), on_top = mask_same(at, 2);
    double dx = general ? cylinder_dx(r.dx, r.dz) : s->axial_dx[i];
    double a = general ? cylinder_axial(dx, r.dz, p->m2) : s->axial[i]; /* the same for all upright round cylinders */
    double inverse_a = general ? 1.0 / a : s->inverse_axial[i];
    double inverse_y = general ? inverse_of_component(r.dy) : s->inverse_y[i];
    quadric_roots side = cylinder_side(p, r.x, r.z, dx, r.dz, a, inverse_a, on_side);
    slab_roots caps = slab_cross(r.y, inverse_y, p->bottom, p->top, on_bottom, on_top);
    return span_within(side, caps, on_side | on_bottom | on_top);
}

DEFINE_SPANS(is_general(p), span)

/* Compares the same roots as the first pass: the face is the one that bounded the interval there. */
ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, p->m2), inverse_y = inverse_of_component(r.dy);
    quadric_roots side = cylinder_side(p, r.x, r.z, dx, r.dz, a, 1.0 / a, mask_same(at, 0));
    slab_roots caps = slab_cross(r.y, inverse_y, p->bottom, p->top, mask_same(at, 1), mask_same(at, 2));
    /* A ray that is inside by its set and misses the primitive past an edge, by rounding, leaves at once
     * (store_interval). It leaves by the side, because the top of a hollow is at infinity. The side's roots are then
     * NaN. */
    int64_t is_side = blend_int(leaving, ~mask_less_equal(caps.out, side.out), mask_less(caps.in, side.in));
    /* the ray enters from above or leaves upwards; -0.0 counts as downwards, as for the roots */
    int64_t is_top = leaving ^ mask_less(inverse_y, 0.0);
    double inverse = 1.0 / sqrt(q.x * q.x + p->m2 * q.z * q.z);
    double ux = q.x * inverse, uz = q.z * inverse, x = p->radius * ux, z = p->radius * uz;
    double slope = p->m2 * uz, norm = general ? 1.0 / sqrt(ux * ux + slope * slope) : 1.0;
    double cap = blend(is_top, p->top, p->bottom), up = blend(is_top, 1.0, -1.0);
    local_point l;
    l.point = vec3_make(blend(is_side, x, q.x), blend(is_side, q.y, cap), blend(is_side, z, q.z));
    l.normal = vec3_make(blend(is_side, ux * norm, 0.0), blend(is_side, 0.0, up), blend(is_side, slope * norm, 0.0));
    l.face = p->first_face + blend_int(is_side, 0, blend_int(is_top, 2, 1));
    return l;
}

DEFINE_POINTS(is_general(p), point)

static bool contains(const primitive *p, vec3 q)
{
    return q.x * q.x + p->m2 * q.z * q.z <= p->radius * p->radius && q.y >= p->bottom && q.y <= p->top;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    const double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, p->m2);
    return one_chord(interval_both(interval_of_quadric(cylinder_side(p, r.x, r.z, dx, r.dz, a, 1.0 / a, 0)),
                                   interval_of_slab(r.y, r.dy, p->bottom, p->top)),
                     found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    flat[0] = (flat_face){1, 1, p->bottom, -1.0};
    flat[1] = (flat_face){2, 1, p->top, 1.0};
    return 2;
}

/* Texture coordinates. A cup's hollow has no top and is seen from within. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius, diameter = 2.0 * r;
    const bool hollow = !(p->top < HUGE_VAL);
    if (face == 0)
        return mapping_around(hollow ? -q.x : q.x, q.z, r, q.y - p->bottom, hollow ? diameter : p->top - p->bottom,
                              size);
    return mapping_flat(q.x + r, face == 1 && !hollow ? r - q.z : q.z + r, diameter, diameter, size);
}

const primitive_functions KERNEL(cylinder_functions) = {1, rows, one, points, contains, chords, flats, mapping};
