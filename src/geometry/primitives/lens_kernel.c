/* The lens primitive: x^2 + z^2 <= radius^2 between two conics of revolution about y with their vertices at y = 0 and
 * y = top (lens_side.h). Faces: 0 rim, 1 the side at 0, 2 the side at top.
 *
 * Each side bounds a convex set: the points on the hollow side of the conic, u >= sag for its own axial coordinate u,
 * measured from its vertex towards its centre of curvature. The lens is the rim's cylinder intersected with the sets
 * of its convex and flat sides, minus those of its concave ones. A line is in each set along one interval, so the lens
 * is an intersection of intervals and a difference: one chord of a lens without concave sides, at most two with one
 * and three with two. */
#include "geometry/primitives/lens_side.h"

/* The intervals of a ray's line in the sets of the rim and of both sides. */
typedef struct lens_parts {
    interval rim, side[2];
} lens_parts;

ALWAYS_INLINE lens_parts lens_cross(const primitive *p, const lens_side side[2], local_ray r, int64_t at)
{
    double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, 1.0);
    double inverse_length2 = 1.0 / (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    quadric_roots rim = cylinder_side(p, r.x, r.z, dx, r.dz, a, 1.0 / a, mask_same(at, 0));
    lens_parts l;
    l.rim = (interval){blend(rim.hit, rim.in, HUGE_VAL), blend(rim.hit, rim.out, -HUGE_VAL)};
    l.side[0] = lens_side_cross(&side[0], r, inverse_length2, l.rim, mask_same(at, 1));
    l.side[1] = lens_side_cross(&side[1], r, inverse_length2, l.rim, mask_same(at, 2));
    return l;
}

ALWAYS_INLINE int64_t starts_on_lens(int64_t at)
{
    return mask_same(at, 0) | mask_same(at, 1) | mask_same(at, 2);
}

/* --- without concave sides --- */

ALWAYS_INLINE ray_span span(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i)
{
    (void)general, (void)s, (void)i;
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    lens_parts l = lens_cross(p, side, r, at);
    double near = greater(l.rim.in, greater(l.side[0].in, l.side[1].in)),
           far = lesser(l.rim.out, lesser(l.side[0].out, l.side[1].out));
    return (ray_span){near, far, mask_less(near, far), starts_on_lens(at)};
}

DEFINE_SPANS(p->turned, span)

/* --- with concave sides --- */

enum { LENS_CHORDS = 3 }; /* the most, of a biconcave lens */

/* The chords of a line; returns their number. */
static int lens_chords(const lens_side side[2], const lens_parts *l, interval chords[LENS_CHORDS])
{
    interval list[LENS_CHORDS + 1] = {l->rim};
    for (int k = 0; k < 2; k++)
        if (!side[k].concave)
            list[0] = interval_both(list[0], l->side[k]);
    int count = list[0].in < list[0].out;
    for (int k = 0; k < 2; k++)
        if (side[k].concave)
            count = intervals_without(list, count, l->side[k]);
    for (int k = 0; k < count; k++)
        chords[k] = list[k];
    return count;
}

/* The intervals of ray i ahead, from those of its line. */
static void lens_ahead(const primitive *p, const lens_side side[2], const lens_parts *l, const ray_batch *rays, int i,
                       bool inside, interval found[LENS_CHORDS])
{
    const bool starts_on = starts_on_lens(rays->start[i] - p->first_face);
    interval chords[LENS_CHORDS];
    const int count = lens_chords(side, l, chords);
    const double length2 = rays->dx[i] * rays->dx[i] + rays->dy[i] * rays->dy[i] + rays->dz[i] * rays->dz[i];
    const crossings_of_one ahead =
        crossings_of_chords(chords, count, starts_on, inside, 0x1p-20 * p->radius / sqrt(length2));
    intervals_of_crossings(&ahead, inside, LENS_CHORDS, found);
}

static void concave_one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s,
                        interval *found)
{
    (void)s;
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    const local_ray r =
        ray_to_local(p, p->turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    const lens_parts l = lens_cross(p, side, r, rays->start[i] - p->first_face);
    lens_ahead(p, side, &l, rays, i, inside, found);
}

/* The intervals of the parts are computed by vectors, their difference ray by ray, because few rays hit a lens. */
static void concave_rows(const primitive *__restrict p, int bit, const ray_batch *rays, ray_scratch *s)
{
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    double rim_in[ROW], rim_out[ROW], in_1[ROW], out_1[ROW], in_2[ROW], out_2[ROW];
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, true, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        lens_parts l = lens_cross(p, side, r, rays->start[i] - p->first_face);
        rim_in[i] = l.rim.in, rim_out[i] = l.rim.out;
        in_1[i] = l.side[0].in, out_1[i] = l.side[0].out;
        in_2[i] = l.side[1].in, out_2[i] = l.side[1].out;
    }
    for (int i = 0; i < rays->count; i++) {
        const lens_parts l = {{rim_in[i], rim_out[i]}, {{in_1[i], out_1[i]}, {in_2[i], out_2[i]}}};
        interval found[LENS_CHORDS];
        lens_ahead(p, side, &l, rays, i, rays->inside[i] >> bit & 1, found);
        for (int k = 0; k < p->rows; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

/* --- points, for both --- */

/* The distance of t from the root at which the ray enters or leaves a part. A ray that enters the lens enters the sets
 * of the rim and of convex sides, and leaves those of concave ones. If rounding leaves no such root: the distance of
 * the point from the surface. */
ALWAYS_INLINE double root_apart(interval part, int64_t leaving, double t, double surface)
{
    double root = blend(leaving, part.out, part.in);
    return blend(mask_less(magnitude(root), HUGE_VAL), magnitude(root - t), surface);
}

ALWAYS_INLINE vec3 blend_vec3(int64_t mask, vec3 a, vec3 b)
{
    return vec3_make(blend(mask, a.x, b.x), blend(mask, a.y, b.y), blend(mask, a.z, b.z));
}

/* The face is the one whose root in the first pass is nearest to t. */
ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general;
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    lens_parts parts = lens_cross(p, side, r, at);
    side_point one = point_on_side(&side[0], q), two = point_on_side(&side[1], q);
    vec3 d = vec3_make(r.dx, r.dy, r.dz);
    double t = vec3_dot(vec3_sub(q, vec3_make(r.x, r.y, r.z)), d) / vec3_dot(d, d);
    double from_axis = sqrt(q.x * q.x + q.z * q.z), inverse = p->radius / from_axis, to_unit = 1.0 / p->radius;
    double x = q.x * inverse, z = q.z * inverse;
    double to_rim = root_apart(parts.rim, leaving, t, magnitude(from_axis - p->radius)),
           to_1 = root_apart(parts.side[0], leaving ^ side[0].concave, t, one.apart),
           to_2 = root_apart(parts.side[1], leaving ^ side[1].concave, t, two.apart);
    int64_t is_2 = mask_less(to_2, to_1), is_side = mask_less(lesser(to_1, to_2), to_rim);
    double turn_1 = blend(side[0].concave, -1.0, 1.0), turn_2 = blend(side[1].concave, -1.0, 1.0);
    vec3 normal = blend_vec3(is_2, vec3_scale(two.normal, turn_2), vec3_scale(one.normal, turn_1));
    local_point l;
    l.point = blend_vec3(is_side, blend_vec3(is_2, two.point, one.point), vec3_make(x, q.y, z));
    l.normal = blend_vec3(is_side, normal, vec3_make(x * to_unit, 0.0, z * to_unit));
    l.face = p->first_face + (is_side & blend_int(is_2, 2, 1));
    return l;
}

DEFINE_POINTS(p->turned, point)

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    const lens_parts l = lens_cross(p, side, r, FACE_NONE);
    return lens_chords(side, &l, found);
}

const primitive_functions KERNEL(lens_functions) = {1,      rows,       one,         points, lens_contains,
                                                    chords, lens_flats, lens_mapping};
const primitive_functions KERNEL(meniscus_functions) = {2,      concave_rows, concave_one, points, lens_contains,
                                                        chords, lens_flats,   lens_mapping};
const primitive_functions KERNEL(biconcave_functions) = {LENS_CHORDS,   concave_rows, concave_one, points,
                                                         lens_contains, chords,       lens_flats,  lens_mapping};
