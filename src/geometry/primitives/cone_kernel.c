/* The cone or frustum primitive: x^2 + z^2 <= w^2, 0 <= y <= top, w = radius + slope y, slope = (second_radius -
 * radius) / top; second_radius, at the top, may be 0. Faces: 0 side, 1 bottom, 2 top.
 *
 * The side is one half of a double cone, a t^2 + 2 b t + c <= 0: a line that is less steep than the side (a > 0) is
 * inside one of the halves between its roots; a steeper line is inside each half beyond one root. The half with w > 0
 * counts. */
#include "geometry/primitives/kind.h"

ALWAYS_INLINE double cone_slope(const primitive *p)
{
    return (p->second_radius - p->radius) / p->top;
}

ALWAYS_INLINE quadric_roots cone_side(const primitive *p, local_ray r, int64_t starts_on)
{
    return half_cone_cross(p->radius, cone_slope(p), 0.5 * p->top, r, starts_on);
}

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    (void)general, (void)s, (void)i;
    int64_t on_side = mask_same(at, 0), on_bottom = mask_same(at, 1), on_top = mask_same(at, 2);
    quadric_roots side = cone_side(p, r, on_side);
    slab_roots caps = slab_cross(r.y, inverse_of_component(r.dy), 0.0, p->top, on_bottom, on_top);
    return span_within(side, caps, on_side | on_bottom | on_top);
}

DEFINE_SPANS(p->turned, span)

/* The face is found by the same comparisons as in the first pass. The projection onto the side is perpendicular to it;
 * the normal at the apex is the axis. */
ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general;
    const double slope = cone_slope(p), cosine2 = 1.0 / (1.0 + slope * slope);
    double inverse_y = inverse_of_component(r.dy);
    quadric_roots side = cone_side(p, r, mask_same(at, 0));
    slab_roots caps = slab_cross(r.y, inverse_y, 0.0, p->top, mask_same(at, 1), mask_same(at, 2));
    int64_t is_side = blend_int(leaving, ~mask_less_equal(caps.out, side.out), mask_less(caps.in, side.in));
    int64_t is_top = leaving ^ mask_less(inverse_y, 0.0);
    double around = sqrt(q.x * q.x + q.z * q.z), inverse = inverse_of_component(around);
    double ux = q.x * inverse, uz = q.z * inverse, norm = 1.0 / sqrt(ux * ux + uz * uz + slope * slope);
    double off = (around - (p->radius + slope * q.y)) * cosine2, on = around - off;
    double cap = blend(is_top, p->top, 0.0), up = blend(is_top, 1.0, -1.0);
    local_point l;
    l.point =
        vec3_make(blend(is_side, ux * on, q.x), blend(is_side, q.y + slope * off, cap), blend(is_side, uz * on, q.z));
    l.normal =
        vec3_make(blend(is_side, ux * norm, 0.0), blend(is_side, -slope * norm, up), blend(is_side, uz * norm, 0.0));
    l.face = p->first_face + blend_int(is_side, 0, blend_int(is_top, 2, 1));
    return l;
}

DEFINE_POINTS(p->turned, point)

static bool contains(const primitive *p, vec3 q)
{
    const double w = p->radius + cone_slope(p) * q.y;
    return q.x * q.x + q.z * q.z <= w * w && q.y >= 0.0 && q.y <= p->top;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    return one_chord(interval_both(interval_of_quadric(cone_side(p, r, 0)), interval_of_slab(r.y, r.dy, 0.0, p->top)),
                     found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    flat[0] = (flat_face){1, 1, 0.0, -1.0};
    flat[1] = (flat_face){2, 1, p->top, 1.0};
    return 2;
}

/* The side: once around, with the middle of the texture image in front, and along its slant; lengths are measured at
 * the wider end. Caps as for a cylinder. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double slope = cone_slope(p), slant = sqrt(1.0 + slope * slope);
    const double r = face == 1 ? p->radius : face == 2 ? p->second_radius : fmax(p->radius, p->second_radius);
    if (face == 0)
        return mapping_around(q.x, q.z, r, q.y * slant, p->top * slant, size);
    return mapping_flat(q.x + r, face == 1 ? r - q.z : q.z + r, 2.0 * r, 2.0 * r, size);
}

const primitive_functions KERNEL(cone_functions) = {1, rows, one, points, contains, chords, flats, mapping};
