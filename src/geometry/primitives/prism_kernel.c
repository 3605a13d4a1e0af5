/* The regular prism primitive: local points within second_radius of the axis along each side's normal (the inscribed
 * circle), bottom <= y <= top. radius is the radius of the circumscribed circle; one corner is in front, at -z. Faces:
 * 0 bottom, 1 top, 2 and up the sides, to the right as seen from outside. */
#include "geometry/primitives/kind.h"

enum { FIRST_SIDE = 2 };

/* A ray's crossing of the plane of a side. enters is -1 if the ray comes from outside. */
typedef struct plane_root {
    double t;
    int64_t enters;
} plane_root;

ALWAYS_INLINE plane_root side_cross(vec3 normal, double reach, double x, double z, double dx, double dz,
                                    int64_t starts_on)
{
    double inverse = inverse_of_component(normal.x * dx + normal.z * dz);
    plane_root r = {blend(starts_on, 0.0, (reach - (normal.x * x + normal.z * z)) * inverse), mask_less(inverse, 0.0)};
    return r;
}

ALWAYS_INLINE void intervals(const primitive *p, bool general, int bit, const ray_batch *rays, double *restrict in,
                             double *restrict out)
{
    double x[ROW], z[ROW], dx[ROW], dz[ROW], near[ROW], far[ROW];
    const int64_t first = p->first_face;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, general, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        slab_roots caps = slab_cross(r.y, inverse_of_component(r.dy), p->bottom, p->top,
                                     mask_same(rays->start[i], first), mask_same(rays->start[i], first + 1));
        near[i] = caps.in, far[i] = caps.out;
        x[i] = r.x, z[i] = r.z, dx[i] = r.dx, dz[i] = r.dz;
    }
    for (int k = 0; k < p->sides; k++) {
        const vec3 normal = p->normals[k];
        const double reach = p->second_radius;
        /* VECTORISE */
        for (int i = 0; i < rays->count; i++) {
            int64_t starts_on = mask_same(rays->start[i], first + FIRST_SIDE + k);
            plane_root side = side_cross(normal, reach, x[i], z[i], dx[i], dz[i], starts_on);
            near[i] = blend(side.enters, greater(near[i], side.t), near[i]);
            far[i] = blend(side.enters, far[i], lesser(far[i], side.t));
        }
    }
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        int64_t starts_on = mask_same(rays->start[i] & ~(int64_t)(FACES_MAX - 1), first);
        store_interval(near[i], far[i], mask_less(near[i], far[i]), starts_on, inside_mask(rays->inside[i], bit),
                       &in[i], &out[i]);
    }
}

ALWAYS_INLINE void loop(const primitive *p, bool general, int bit, const ray_batch *rays, ray_scratch *s)
{
    intervals(p, general, bit, rays, s->in[bit], s->out[bit]);
}

DEFINE_ROWS(p->turned, loop)

static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found)
{
    (void)s;
    const uint64_t set = inside;
    const ray_batch ray = ray_batch_one(rays, i, &set);
    intervals(p, p->turned, 0, &ray, &found->in, &found->out);
}

/* The face that bounds the interval, by the same roots: the last face that the line enters, or the first that it
 * leaves. An inner loop over faces, so the loop over rays is not vectorised. */
static local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general;
    const double inverse_y = inverse_of_component(r.dy);
    const slab_roots caps = slab_cross(r.y, inverse_y, p->bottom, p->top, mask_same(at, 0), mask_same(at, 1));
    const int64_t is_top = leaving ^ mask_less(inverse_y, 0.0);
    double bound = blend(leaving, caps.out, caps.in);
    int hit = -1;
    for (int k = 0; k < p->sides; k++) {
        const plane_root side =
            side_cross(p->normals[k], p->second_radius, r.x, r.z, r.dx, r.dz, mask_same(at, FIRST_SIDE + k));
        if (side.enters == leaving || !(leaving ? side.t < bound : side.t > bound))
            continue;
        bound = side.t, hit = k;
    }
    if (hit < 0)
        return (local_point){vec3_make(q.x, is_top ? p->top : p->bottom, q.z), vec3_make(0.0, is_top ? 1.0 : -1.0, 0.0),
                             p->first_face + (is_top & 1)};
    const vec3 n = p->normals[hit];
    const double off = n.x * q.x + n.z * q.z - p->second_radius;
    return (local_point){vec3_make(q.x - off * n.x, q.y, q.z - off * n.z), n, p->first_face + FIRST_SIDE + hit};
}

static void points(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *hit)
{
    for (int i = 0; i < rays->count; i++)
        store_point(p, point, true, rays, t, i, bit, hit);
}

static bool contains(const primitive *p, vec3 q)
{
    bool inside = q.y >= p->bottom && q.y <= p->top;
    for (int k = 0; k < p->sides; k++)
        inside &= p->normals[k].x * q.x + p->normals[k].z * q.z <= p->second_radius;
    return inside;
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    interval chord = interval_of_slab(r.y, r.dy, p->bottom, p->top);
    for (int k = 0; k < p->sides; k++) {
        const plane_root side = side_cross(p->normals[k], p->second_radius, r.x, r.z, r.dx, r.dz, 0);
        chord = interval_both(chord, side.enters ? (interval){side.t, HUGE_VAL} : (interval){-HUGE_VAL, side.t});
    }
    return one_chord(chord, found);
}

/* The caps, and the sides that are perpendicular to x or z. */
static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    int count = 0;
    flat[count++] = (flat_face){0, 1, p->bottom, -1.0};
    flat[count++] = (flat_face){1, 1, p->top, 1.0};
    for (int k = 0; k < p->sides && count < FLATS_MAX; k++) {
        const double across[2] = {p->normals[k].x, p->normals[k].z};
        for (int j = 0; j < 2; j++)
            if (fabs(across[j]) == 1.0)
                flat[count++] = (flat_face){FIRST_SIDE + k, 2 * j, across[j] * p->second_radius, across[j]};
    }
    return count;
}

/* Each side separately, and the caps as the squares around their corners. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius;
    if (face < FIRST_SIDE)
        return mapping_flat(q.x + r, face == 0 ? r - q.z : q.z + r, 2.0 * r, 2.0 * r, size);
    const vec3 n = p->normals[face - FIRST_SIDE];
    const double half = sqrt(r * r - p->second_radius * p->second_radius), right = q.z * n.x - q.x * n.z;
    return mapping_flat(right + half, q.y - p->bottom, 2.0 * half, p->top - p->bottom, size);
}

const primitive_functions KERNEL(prism_functions) = {1, rows, one, points, contains, chords, flats, mapping};
