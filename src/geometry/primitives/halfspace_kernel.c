/* The half-space primitive: y <= 0. Face 0. */
#include "geometry/primitives/kind.h"

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    (void)p;
    int64_t starts_on = mask_same(at, 0);
    double inverse = general ? inverse_of_component(r.dy) : s->inverse_y[i];
    double t = blend(starts_on, 0.0, -r.y * inverse);
    int64_t down = mask_less(inverse, 0.0);
    return (ray_span){blend(down, t, -HUGE_VAL), blend(down, HUGE_VAL, t), -1, starts_on};
}

DEFINE_SPANS(p->turned, span)

ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general, (void)r, (void)at, (void)leaving;
    local_point l = {vec3_make(q.x, 0.0, q.z), vec3_make(0.0, 1.0, 0.0), p->first_face};
    return l;
}

DEFINE_POINTS(p->turned, point)

static bool contains(const primitive *p, vec3 q)
{
    (void)p;
    return q.y <= 0.0;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    (void)p;
    const double t = -r.y * inverse_of_component(r.dy);
    return one_chord(r.dy < 0.0 ? (interval){t, HUGE_VAL} : (interval){-HUGE_VAL, t}, found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    (void)p;
    flat[0] = (flat_face){0, 1, 0.0, 0.0};
    return 1;
}

static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    (void)p, (void)face;
    return mapping_flat(q.x, q.z, 1.0, 1.0, size);
}

const primitive_functions KERNEL(halfspace_functions) = {1, rows, one, points, contains, chords, flats, mapping};
