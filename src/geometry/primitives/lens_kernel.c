/* The lens primitive: x^2 + z^2 <= radius^2 between two conics of revolution about y with their vertices at y = 0 and
 * y = top (lens.h). Faces: 0 rim, 1 the side at 0, 2 the side at top.
 *
 * Each side bounds a convex set: the points on the hollow side of the conic, u >= sag for its own axial coordinate u,
 * measured from its vertex towards its centre of curvature. The lens is the rim's cylinder intersected with the sets
 * of its convex and flat sides, minus those of its concave ones. A line is in each set along one interval, so the lens
 * is an intersection of intervals and a difference: one chord of a lens without concave sides, at most two with one
 * and three with two.
 *
 * The conic's equation is c (x^2 + z^2 + (1 + k) u^2) - 2 u = 0, exact for flat sides too. It holds on both halves of
 * an ellipsoid, and on both sheets of a hyperboloid; only that at the vertex counts. Beyond an ellipsoid's centre the
 * set continues, so that a lens may be longer than its spheres; within the rim, that union is convex. */
#include "geometry/primitives/kind.h"
#include "geometry/primitives/lens.h"

typedef struct lens_side {
    double vertex, up;                 /* u = up (y - vertex) */
    double curvature, stretch, centre; /* |c|, 1 + k, u of an ellipsoid's centre; infinite without one */
    int64_t flat, closed, concave;     /* masks; closed: not a hyperboloid */
} lens_side;

ALWAYS_INLINE lens_side lens_side_of(const primitive *p, int k)
{
    const double c = p->lens.curvature[k], stretch = 1.0 + p->lens.conic[k];
    const double inwards = k == 0 ? 1.0 : -1.0; /* the direction from the vertex into the lens */
    const int64_t concave = mask_less(c * inwards, 0.0), flat = mask_of(c == 0.0);
    return (lens_side){.vertex = k == 0 ? 0.0 : p->top,
                       .up = blend(concave, -inwards, inwards),
                       .curvature = magnitude(c),
                       .stretch = stretch,
                       .centre = blend(mask_less(0.0, stretch) & ~flat, 1.0 / (magnitude(c) * stretch), HUGE_VAL),
                       .flat = flat,
                       .closed = ~mask_less(stretch, 0.0),
                       .concave = concave};
}

/* The interval of a line in the convex sheet of a conic, c > 0, relative to the point (x, z, u): as for a cone
 * (cone_kernel.c), with the roots of a t^2 + 2 b t + c = 0 as q / a and c / q. */
ALWAYS_INLINE quadric_roots conic_cross(const lens_side *e, double x, double z, double u, double dx, double dz,
                                        double du, int64_t own)
{
    double a = e->curvature * (dx * dx + dz * dz + e->stretch * (du * du));
    double b = e->curvature * (x * dx + z * dz + e->stretch * (u * du)) - du;
    double c = blend(own, 0.0, e->curvature * (x * x + z * z + e->stretch * (u * u)) - 2.0 * u);
    double discriminant = blend(own, b * b, b * b - a * c), root = sqrt(greater(discriminant, 0.0));
    double q = -(b + blend(mask_less(b, 0.0), -root, root)), inverse_a = inverse_of_component(a);
    double far = q * inverse_a, close = c * inverse_of_component(q);
    double first = lesser(far, close), second = greater(far, close);
    /* A line steeper than a hyperboloid's asymptotes is inside one sheet from a root on; a flatter one is inside one
     * of the sheets between the roots. */
    int64_t steep = mask_less(a, 0.0), opens = mask_less(0.0, du);
    int64_t ours = e->closed | mask_less(e->curvature * e->stretch * (u - du * (b * inverse_a)), 1.0);
    quadric_roots s;
    s.in = blend(steep, blend(opens, second, -HUGE_VAL), first);
    s.out = blend(steep, blend(opens, HUGE_VAL, first), second);
    s.hit = steep | (ours & (own | mask_less(0.0, discriminant)));
    return s;
}

/* The half-space u >= 0. */
ALWAYS_INLINE interval half_space(double u, double inverse_u)
{
    double t = -u * inverse_u;
    int64_t opens = mask_less(0.0, inverse_u);
    return (interval){blend(opens, t, -HUGE_VAL), blend(opens, HUGE_VAL, t)};
}

/* The interval of a ray in the convex set of a side, as far as the ray is within the rim. t is measured from the point
 * nearest to the vertex; for a ray that starts on the side, from its start, where c = 0.
 *
 * Where a line within the rim crosses the plane of an ellipsoid's centre, it is inside the ellipsoid. So the plane
 * decides whether the interval has an end, and is an end itself only by rounding, for a line that touches the ellipsoid
 * there. */
ALWAYS_INLINE interval lens_side_cross(const lens_side *e, local_ray r, double inverse_length2, interval rim,
                                       int64_t own)
{
    double u = e->up * (r.y - e->vertex), du = e->up * r.dy, inverse_u = inverse_of_component(du);
    double from = blend(own, 0.0, -(r.x * r.dx + u * du + r.z * r.dz) * inverse_length2);
    double x = r.x + from * r.dx, z = r.z + from * r.dz, v = u + from * du;
    quadric_roots sheet = conic_cross(e, x, z, v, r.dx, r.dz, du, own);
    double centre = from + (e->centre - v) * inverse_u;
    int64_t opens = mask_less(0.0, inverse_u);
    int64_t late = mask_less(centre, rim.in), early = mask_less(rim.out, centre), all = blend_int(opens, late, early);
    int64_t central = ~(late | early), hit = sheet.hit | central;
    double first = from + sheet.in, last = from + sheet.out;
    double in = blend(hit, blend(central, lesser(first, centre), first), HUGE_VAL),
           out = blend(hit, blend(central, greater(last, centre), last), -HUGE_VAL);
    interval s = {blend(all | (hit & ~opens & mask_less_equal(in, centre)), -HUGE_VAL, in),
                  blend(all | (hit & opens & mask_less_equal(centre, out)), HUGE_VAL, out)};
    interval plane = half_space(blend(own, 0.0, u), inverse_u);
    return (interval){blend(e->flat, plane.in, s.in), blend(e->flat, plane.out, s.out)};
}

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

ALWAYS_INLINE int64_t is_own(int64_t at)
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
    return (ray_span){near, far, mask_less(near, far), is_own(at)};
}

DEFINE_SPANS(p->turned, span)

/* --- with concave sides --- */

/* The chords of a line; returns their number. */
static int lens_chords(const lens_side side[2], const lens_parts *l, interval chords[CHORDS_MAX])
{
    interval list[CHORDS_MAX + 1] = {l->rim};
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
                       bool inside, interval found[CHORDS_MAX])
{
    const bool own = is_own(rays->start[i] - p->first_face);
    interval chords[CHORDS_MAX];
    const int count = lens_chords(side, l, chords);
    const double length2 = rays->dx[i] * rays->dx[i] + rays->dy[i] * rays->dy[i] + rays->dz[i] * rays->dz[i];
    const crossings_of_one ahead = crossings_of_chords(chords, count, own, inside, 0x1p-20 * p->radius / sqrt(length2));
    intervals_of_crossings(&ahead, inside, found);
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

/* The intervals of the parts by vectors; their difference ray by ray, as few rays hit a lens. */
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
        interval found[CHORDS_MAX];
        lens_ahead(p, side, &l, rays, i, rays->inside[i] >> bit & 1, found);
        for (int k = 0; k < p->rows; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

/* --- points, for both --- */

/* A point projected onto a side's conic; the normal is out of the convex set. */
typedef struct side_point {
    vec3 point, normal;
    double
        apart; /* distance of the given point; infinite past an ellipsoid's centre and on a hyperboloid's other sheet */
} side_point;

/* One Newton step along the gradient, whose error is of second order in q's distance. */
ALWAYS_INLINE side_point point_on_side(const lens_side *e, vec3 q)
{
    double u = e->up * (q.y - e->vertex), c = e->curvature;
    double level = c * (q.x * q.x + q.z * q.z + e->stretch * (u * u)) - 2.0 * u;
    double gx = c * q.x, gz = c * q.z, gu = c * e->stretch * u - 1.0, g2 = gx * gx + gz * gz + gu * gu;
    double step = -0.5 * level / g2, inverse = 1.0 / sqrt(g2);
    side_point s;
    s.point = vec3_make(q.x + step * gx, e->vertex + e->up * (u + step * gu), q.z + step * gz);
    s.normal = vec3_make(gx * inverse, e->up * gu * inverse, gz * inverse);
    s.apart = blend(mask_less(gu, 0.0), magnitude(0.5 * level * inverse), HUGE_VAL);
    return s;
}

/* The distance of t from a part's root in the ray's direction through it: where the ray enters the lens, it enters the
 * sets of the rim and of convex sides, and leaves those of concave ones. Without such a root, by rounding, that of the
 * point from the surface. */
ALWAYS_INLINE double root_apart(interval part, int64_t leaving, double t, double surface)
{
    double root = blend(leaving, part.out, part.in);
    return blend(mask_less(magnitude(root), HUGE_VAL), magnitude(root - t), surface);
}

ALWAYS_INLINE vec3 blend_vec3(int64_t mask, vec3 a, vec3 b)
{
    return vec3_make(blend(mask, a.x, b.x), blend(mask, a.y, b.y), blend(mask, a.z, b.z));
}

/* The face is that whose root, as in the first pass, is nearest to t. */
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

static bool contains(const primitive *p, vec3 q)
{
    const double rho2 = q.x * q.x + q.z * q.z;
    return rho2 <= p->radius * p->radius && q.y >= lens_sag(p->lens.curvature[0], p->lens.conic[0], rho2) &&
           q.y - p->top <= lens_sag(p->lens.curvature[1], p->lens.conic[1], rho2);
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    const lens_side side[2] = {lens_side_of(p, 0), lens_side_of(p, 1)};
    const lens_parts l = lens_cross(p, side, r, FACE_NONE);
    return lens_chords(side, &l, found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    int count = 0;
    for (int k = 0; k < 2; k++)
        if (p->lens.curvature[k] == 0.0)
            flat[count++] = (flat_face){1 + k, 1, k == 0 ? 0.0 : p->top, k == 0 ? -1.0 : 1.0};
    return count;
}

/* The rim: once around, with the middle of the texture image in front. The sides: seen along the axis. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius, bottom = lens_sag(p->lens.curvature[0], p->lens.conic[0], r * r),
                 top = p->top + lens_sag(p->lens.curvature[1], p->lens.conic[1], r * r);
    if (face == 0)
        return mapping_around(q.x, q.z, r, q.y - bottom, top - bottom, size);
    return mapping_flat(q.x + r, face == 1 ? r - q.z : q.z + r, 2.0 * r, 2.0 * r, size);
}

const primitive_functions KERNEL(lens_functions) = {1, rows, one, points, contains, chords, flats, mapping};
const primitive_functions KERNEL(meniscus_functions) = {2,        concave_rows, concave_one, points,
                                                        contains, chords,       flats,       mapping};
const primitive_functions KERNEL(biconcave_functions) = {3,        concave_rows, concave_one, points,
                                                         contains, chords,       flats,       mapping};
