/* The sphere primitive: x^2 + y^2 + z^2 <= radius^2. Face 0. */
#include "geometry/primitives/kind.h"

ALWAYS_INLINE quadric_roots sphere_cross(const primitive *p, local_ray r, int64_t starts_on)
{
    vec3 o = vec3_make(r.x, r.y, r.z), d = vec3_make(r.dx, r.dy, r.dz), cross = vec3_cross(o, d);
    double a = vec3_dot(d, d);
    return quadric_cross(vec3_dot(o, d), 1.0 / a, a * (p->radius * p->radius) - vec3_dot(cross, cross), starts_on);
}

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    (void)general, (void)s, (void)i;
    int64_t starts_on = mask_same(at, 0);
    quadric_roots q = sphere_cross(p, r, starts_on);
    return (ray_span){q.in, q.out, q.hit, starts_on};
}

/* A sphere's rotation matters only for textures. */
DEFINE_SPANS(false, span)

ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general, (void)r, (void)at, (void)leaving;
    double inverse = 1.0 / vec3_length(q);
    local_point l;
    l.normal = vec3_scale(q, inverse);
    l.point = vec3_scale(l.normal, p->radius);
    l.face = p->first_face;
    return l;
}

DEFINE_POINTS(false, point)

static bool contains(const primitive *p, vec3 q)
{
    return vec3_dot(q, q) <= p->radius * p->radius;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    return one_chord(interval_of_quadric(sphere_cross(p, r, 0)), found);
}

static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    (void)face;
    const double latitude = 90.0 + elementary_atan2_deg(q.y, sqrt(q.x * q.x + q.z * q.z)), r = p->radius;
    return mapping_around(q.x, q.z, r, latitude / 180.0 * 3.141592653589793 * r, 3.141592653589793 * r, size);
}

const primitive_functions KERNEL(sphere_functions) = {1, rows, one, points, contains, chords, NULL, mapping};
