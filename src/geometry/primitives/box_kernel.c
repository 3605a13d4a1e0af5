/* The box primitive: |x| <= half.x and so on. Faces: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z. */
#include "geometry/primitives/kind.h"

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    const vec3 h = p->half;
    slab_roots x = slab_cross(r.x, general ? inverse_of_component(r.dx) : s->inverse_x[i], -h.x, h.x, mask_same(at, 0),
                              mask_same(at, 1));
    slab_roots y = slab_cross(r.y, general ? inverse_of_component(r.dy) : s->inverse_y[i], -h.y, h.y, mask_same(at, 2),
                              mask_same(at, 3));
    slab_roots z = slab_cross(r.z, general ? inverse_of_component(r.dz) : s->inverse_z[i], -h.z, h.z, mask_same(at, 4),
                              mask_same(at, 5));
    double near = greater(greater(x.in, y.in), z.in), far = lesser(lesser(x.out, y.out), z.out);
    return (ray_span){near, far, mask_less(near, far), mask_same(at & ~(int64_t)(FACES_MAX - 1), 0)};
}

DEFINE_SPANS(p->turned, span)

ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general;
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
    /* The face on the positive side is the exit for a positive direction and the entry for a negative one. The sign is
     * taken from the inverses, for which -0.0 is negative, because the roots were computed with them. */
    double along = blend(is_x, inverse_x, blend(is_y, inverse_y, inverse_z));
    int64_t positive = leaving ^ mask_less(along, 0.0);
    double sign = blend(positive, 1.0, -1.0);
    local_point l;
    l.point = vec3_make(blend(is_x, sign * h.x, q.x), blend(is_y, sign * h.y, q.y), blend(is_z, sign * h.z, q.z));
    l.normal = vec3_make(blend(is_x, sign, 0.0), blend(is_y, sign, 0.0), blend(is_z, sign, 0.0));
    l.face = p->first_face + blend_int(is_x, 0, blend_int(is_y, 2, 4)) + (positive & 1);
    return l;
}

DEFINE_POINTS(p->turned, point)

static bool contains(const primitive *p, vec3 q)
{
    return fabs(q.x) <= p->half.x && fabs(q.y) <= p->half.y && fabs(q.z) <= p->half.z;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    return one_chord(interval_both(interval_of_slab(r.x, r.dx, -p->half.x, p->half.x),
                                   interval_both(interval_of_slab(r.y, r.dy, -p->half.y, p->half.y),
                                                 interval_of_slab(r.z, r.dz, -p->half.z, p->half.z))),
                     found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    const double half[3] = {p->half.x, p->half.y, p->half.z};
    for (int k = 0; k < 6; k++)
        flat[k] = (flat_face){k, k / 2, k % 2 ? half[k / 2] : -half[k / 2], k % 2 ? 1.0 : -1.0};
    return 6;
}

static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const vec3 h = p->half;
    const double x = q.x + h.x, y = q.y + h.y, z = q.z + h.z, w = 2.0 * h.x, t = 2.0 * h.y, d = 2.0 * h.z;
    switch (face) {
    case 0: return mapping_flat(d - z, y, d, t, size);
    case 1: return mapping_flat(z, y, d, t, size);
    case 2: return mapping_flat(x, d - z, w, d, size);
    case 3: return mapping_flat(x, z, w, d, size);
    case 4: return mapping_flat(x, y, w, t, size);
    default: return mapping_flat(w - x, y, w, t, size);
    }
}

const primitive_functions KERNEL(box_functions) = {1, rows, one, points, contains, chords, flats, mapping};
