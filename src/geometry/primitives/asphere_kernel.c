/* A lens with a side that is an asphere, biconic or toric (asphere.h), is smaller than the rim, or ends in a bevel:
 * x^2 + z^2 <= radius^2 between two sides, each of which is such a surface or a conic up to a clear radius, and a level
 * ring beyond it; within the half cones of the bevels. Faces: 0 rim, 1 the side at 0, 2 the side at top, 3 and 4 the
 * rings around them, 5 and 6 the bevels.
 *
 * Along a line o + t d, f(t) is the height above side 1, or below side 2: positive within the lens. Its second
 * derivative is bounded by asphere_bend or asphere_curve. On an interval of half width h about m with |f''| <= K:
 *
 *     |f'(m)| >= K h: f is monotonic;  |f(m)| >= |f'(m)| h + K h^2 / 2: f has no zero (Taylor's theorem).
 *
 * An interval for which neither holds is halved, until f is within rounding of its tangent. So the signs at the ends of
 * the intervals show all crossings (as Moore's interval Newton method isolates roots: Moore, Kearfott and Cloud,
 * Introduction to Interval Analysis, ch. 8). A line far from tangency needs one interval. The most chords follow from
 * how the sides turn (shapes/lens_profile.c): there is a table of functions for each number of them.
 *
 * The cone a1 rho is convex along a line: the change of its slope is added to K h, and that times h to K h^2 / 2.
 *
 * For a ray that starts on the surface, f(0) = 0 is taken as exact: f is t times the difference quotient, whose terms
 * do not cancel, and next to 0 it has the sign of the derivative. */
#include "geometry/primitives/lens_side.h"

enum { ASPHERE_CHANGES = 10, ASPHERE_DEPTH = 64, ASPHERE_WORK = 4096, FACES_OF_LENS = 7 };

/* A line, with t measured from its base: its point nearest to the side's vertex or, if it starts on the side, its
 * start. Heights are relative to the vertex. */
typedef struct asphere_line {
    even_asphere e;
    double inwards; /* f = inwards (y - z) */
    local_ray base;
    double rho2, across2; /* at the base; dx^2 + dz^2 */
    bool starts_on;       /* the base is on the side */
    double from;          /* t of the base */
    double least, touch;  /* a step, and a height, within rounding */
} asphere_line;

static double rho2_at(const asphere_line *l, double t)
{
    const double x = l->base.x + t * l->base.dx, z = l->base.z + t * l->base.dz;
    return x * x + z * z;
}

static double height_inside(const asphere_line *l, double t, double *slope)
{
    const local_ray *o = &l->base;
    const double x = o->x + t * o->dx, z = o->z + t * o->dz, q = x * x + z * z;
    if (l->e.form != SIDE_ROUND) {
        double by_x, by_z;
        const double sag = asphere_surface(&l->e, x, z, &by_x, &by_z);
        *slope = l->inwards * (o->dy - (by_x * o->dx + by_z * o->dz));
        return l->starts_on ? t * (l->inwards * (o->dy - asphere_chord(&l->e, o->x, o->z, o->dx, o->dz, t)))
                            : l->inwards * ((o->y + t * o->dy) - sag);
    }
    *slope = l->inwards * (o->dy - asphere_slope(&l->e, q) * (2.0 * (x * o->dx + z * o->dz)));
    if (!l->starts_on)
        return l->inwards * ((o->y + t * o->dy) - asphere_sag(&l->e, q));
    const double turn = (x + o->x) * o->dx + (z + o->z) * o->dz; /* the difference of q, divided by t */
    return t * (l->inwards * (o->dy - asphere_quotient(&l->e, l->rho2, q) * turn));
}

static bool is_inside(const asphere_line *l, double t)
{
    double slope;
    return height_inside(l, t, &slope) >= 0.0;
}

/* Bounds of the height's second derivative between a and b. */
static asphere_range bend_between(const asphere_line *l, double a, double b, double q_low, double q_high)
{
    const local_ray *o = &l->base;
    if (l->e.form != SIDE_ROUND) {
        const double x_a = o->x + a * o->dx, x_b = o->x + b * o->dx, z_a = o->z + a * o->dz, z_b = o->z + b * o->dz;
        return asphere_curve(&l->e, (asphere_range){lesser(x_a, x_b), greater(x_a, x_b)},
                             (asphere_range){lesser(z_a, z_b), greater(z_a, z_b)}, o->dx, o->dz);
    }
    const asphere_range bend = asphere_bend(&l->e, q_low, q_high);
    return (asphere_range){l->across2 * bend.low, l->across2 * bend.high};
}

/* By how much the slope of the cone a1 rho, which is convex along a line, changes between a and b. */
static double cone_between(const asphere_line *l, double a, double b, double q_a, double q_b)
{
    const local_ray *o = &l->base;
    const double across = sqrt(l->across2), along = o->x * o->dx + o->z * o->dz;
    if (!(q_a > 0.0 && q_b > 0.0))
        return 2.0 * across * magnitude(l->e.odd[0]);
    return magnitude(l->e.odd[0]) * ((along + b * l->across2) / sqrt(q_b) - (along + a * l->across2) / sqrt(q_a)) +
           0x1p-50 * across * magnitude(l->e.odd[0]);
}

/* Whether f is known to change its sign at most once between a and b, up to rounding. */
static bool is_simple(const asphere_line *l, double a, double b)
{
    const double half = 0.5 * (b - a), middle = 0.5 * (a + b), q_a = rho2_at(l, a), q_b = rho2_at(l, b);
    const double nearest = -(l->base.x * l->base.dx + l->base.z * l->base.dz) / l->across2; /* to the axis */
    const double q_low = nearest > a && nearest < b ? rho2_at(l, nearest) : lesser(q_a, q_b);
    const asphere_range bend = bend_between(l, a, b, q_low, greater(q_a, q_b));
    const double most = greater(magnitude(bend.low), magnitude(bend.high)); /* of |f''| */
    double curve = 0.5 * most * half * half, turn = most * half;
    if (l->e.odd[0] != 0.0) {
        const double cone = cone_between(l, a, b, q_a, q_b);
        curve += cone * half, turn += cone;
    }
    if (curve <= l->touch)
        return true;
    double slope;
    const double height = height_inside(l, middle, &slope);
    return magnitude(slope) >= turn || magnitude(height) >= magnitude(slope) * half + curve;
}

/* The zero between a and b, where f changes its sign once: by Newton's steps within the bracket, and bisection. */
static double change_between(const asphere_line *l, double a, double b, bool inside_at_a)
{
    double t = 0.5 * (a + b);
    for (int step = 1; step < 200; step++) {
        double slope;
        const double height = height_inside(l, t, &slope);
        if (height == 0.0)
            return t;
        if ((height >= 0.0) == inside_at_a)
            a = t;
        else
            b = t;
        const double newton = t - height / slope;
        const double next = step % 8 && newton > a && newton < b ? newton : 0.5 * (a + b);
        const double move = magnitude(next - t);
        t = next;
        if (move <= l->least + 0x1p-53 * magnitude(t))
            return t;
    }
    return t;
}

/* Appends the changes of sign between a and b, in order; returns the new number. */
static int changes_between(const asphere_line *l, double a, double b, bool inside_at_a, bool inside_at_b,
                           double *changes, int count)
{
    double ends[ASPHERE_DEPTH] = {b};
    int left = 1;
    bool inside = inside_at_a;
    for (int work = 0; left > 0; work++) {
        const double end = ends[left - 1];
        if (left < ASPHERE_DEPTH && work < ASPHERE_WORK && !is_simple(l, a, end)) {
            ends[left++] = 0.5 * (a + end);
            continue;
        }
        const bool after = left == 1 ? inside_at_b : is_inside(l, end);
        if (after != inside && count < ASPHERE_CHANGES)
            changes[count++] = change_between(l, a, end, inside) + l->from;
        inside = after;
        a = end;
        left--;
    }
    return count;
}

/* The part of a line on the inner side of one side of the lens, as intervals in order. */
typedef struct asphere_part {
    int count;
    interval list[ASPHERE_CHANGES / 2 + 1];
} asphere_part;

static asphere_part part_of_changes(bool inside, const double *changes, int count)
{
    asphere_part part = {0, {{0.0, 0.0}}};
    double in = -HUGE_VAL;
    for (int k = 0; k < count; k++, inside = !inside) {
        if (inside)
            part.list[part.count++] = (interval){in, changes[k]};
        in = changes[k];
    }
    if (inside)
        part.list[part.count++] = (interval){in, HUGE_VAL};
    return part;
}

/* The part of a line on the inner side of side k, an asphere. There are no crossings outside the rim, or outside the
 * side's range of heights. */
static asphere_part part_of_asphere(const primitive *p, int k, local_ray r, interval rim, bool starts_on)
{
    const double vertex = k == 0 ? 0.0 : p->top, y = r.y - vertex;
    const double length2 = r.dx * r.dx + r.dy * r.dy + r.dz * r.dz, inverse = 1.0 / length2;
    const double from = starts_on ? 0.0 : -(r.x * r.dx + y * r.dy + r.z * r.dz) * inverse, dx = cylinder_dx(r.dx, r.dz);
    const asphere_line l = {.e = lens_asphere(p, k),
                            .inwards = k == 0 ? 1.0 : -1.0,
                            .base = {r.x + from * r.dx, y + from * r.dy, r.z + from * r.dz, dx, r.dy, r.dz},
                            .rho2 = r.x * r.x + r.z * r.z,
                            .across2 = cylinder_axial(dx, r.dz, 1.0),
                            .starts_on = starts_on,
                            .from = from,
                            .least = 0x1p-55 * p->radius * sqrt(inverse),
                            .touch = 0x1p-54 * p->radius};
    const lens_details *d = p->details;
    const double low = d->low[k], high = d->high[k], spare = 0x1p-20 * (high - low) + 0x1p-40 * p->radius;
    const interval near = interval_of_slab(l.base.y, r.dy, low - spare, high + spare);
    double a = greater(rim.in - from, near.in), b = lesser(rim.out - from, near.out);
    if (starts_on)
        a = lesser(a, 0.0), b = greater(b, 0.0);
    if (!(a < b)) {
        const double t = near.in > rim.out - from ? rim.out - from : rim.in - from;
        return part_of_changes(l.inwards * (l.base.y + t * r.dy - 0.5 * (low + high)) > 0.0, NULL, 0);
    }
    double changes[ASPHERE_CHANGES];
    if (!starts_on) {
        const bool first = is_inside(&l, a);
        return part_of_changes(first, changes, changes_between(&l, a, b, first, is_inside(&l, b), changes, 0));
    }
    double slope;
    height_inside(&l, 0.0, &slope);
    const bool enters = slope > 0.0, first = a < 0.0 ? is_inside(&l, a) : !enters;
    int count = a < 0.0 ? changes_between(&l, a, 0.0, first, !enters, changes, 0) : 0;
    if (count < ASPHERE_CHANGES)
        changes[count++] = 0.0;
    if (b > 0.0)
        count = changes_between(&l, 0.0, b, enters, is_inside(&l, b), changes, count);
    return part_of_changes(first, changes, count);
}

static asphere_part part_of_conic(const primitive *p, int k, local_ray r, interval rim, int64_t starts_on)
{
    const lens_side e = lens_side_of(p, k);
    const double inverse_length2 = 1.0 / (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    const interval set = lens_side_cross(&e, r, inverse_length2, rim, starts_on);
    const double ends[2] = {set.in, set.out};
    return part_of_changes(e.concave != 0, ends, set.in < set.out ? 2 : 0);
}

/* Adds to a part, in order, what its intervals and `more` have in common; the ends of intervals that touch are no
 * crossings. */
static void extend_part(asphere_part *part, interval within, const interval *more, int count)
{
    for (int i = 0; i < count; i++) {
        const interval both = interval_both(within, more[i]);
        if (!(both.in < both.out))
            continue;
        if (part->count > 0 && both.in <= part->list[part->count - 1].out)
            part->list[part->count - 1].out = both.out;
        else if (part->count <= ASPHERE_CHANGES / 2)
            part->list[part->count++] = both;
    }
}

/* The part of a line on the inner side of side k within the interval `bounds`, of its clear cylinder or the rim. */
static asphere_part part_within(const primitive *p, int k, local_ray r, interval bounds, int64_t at)
{
    const even_asphere e = lens_asphere(p, k);
    return asphere_has_terms(&e) ? part_of_asphere(p, k, r, bounds, at == 1 + k)
                                 : part_of_conic(p, k, r, bounds, mask_same(at, 1 + k));
}

/* The part of a line on the inner side of side k with its ring: of the side within its clear cylinder, and of the
 * ring's plane outside it. */
static asphere_part part_of_side(const primitive *p, int k, local_ray r, interval rim, int64_t at)
{
    const double clear = lens_clear(p, k);
    if (clear == HUGE_VAL)
        return part_within(p, k, r, rim, at);
    const double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, 1.0), cross = r.x * r.dz - r.z * dx,
                 middle = r.x * dx + r.z * r.dz;
    const interval core = interval_of_quadric(quadric_cross(middle, 1.0 / a, a * clear * clear - cross * cross, 0));
    const double up = k == 0 ? 1.0 : -1.0, u = at == 3 + k ? 0.0 : up * (r.y - lens_ring(p, k));
    const interval plane = half_space(u, inverse_of_component(up * r.dy));
    asphere_part part = {0, {{0.0, 0.0}}};
    if (!(core.in < core.out)) {
        extend_part(&part, rim, &plane, 1);
        return part;
    }
    const asphere_part side = part_within(p, k, r, core, at);
    extend_part(&part, (interval){-HUGE_VAL, core.in}, &plane, 1);
    extend_part(&part, core, side.list, side.count);
    extend_part(&part, (interval){core.out, HUGE_VAL}, &plane, 1);
    return part;
}

/* The interval of a line in the half cones of the bevels. at: the face that it starts on. */
static interval within_bevels(const primitive *p, local_ray r, int64_t at)
{
    interval within = {-HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < 2; k++) {
        if (!lens_has_bevel(p, k))
            continue;
        const double up = bevel_slope(k);
        const quadric_roots cone = half_cone_cross(-up * lens_apex(p, k), up, 0.5 * p->top, r, mask_same(at, 5 + k));
        within = interval_both(within, interval_of_quadric(cone));
    }
    return within;
}

/* The most chords of a line in it. */
static int most_chords(const primitive *p)
{
    return p->rule->ISA_BASELINE->intervals;
}

/* The chords of a line; returns their number. at: the face that it starts on. */
static int cross_lens(const primitive *p, local_ray r, int64_t at, interval chords[CHORDS_MAX])
{
    const double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, 1.0);
    const interval rim = interval_of_quadric(cylinder_side(p, r.x, r.z, dx, r.dz, a, 1.0 / a, mask_same(at, 0)));
    if (!(rim.in < rim.out))
        return 0;
    asphere_part part[2];
    for (int k = 0; k < 2; k++)
        part[k] = part_of_side(p, k, r, rim, at);
    const interval body = lens_has_bevels(p) ? interval_both(rim, within_bevels(p, r, at)) : rim;
    const int most = most_chords(p);
    int count = 0;
    for (int i = 0; i < part[0].count; i++)
        for (int k = 0; k < part[1].count; k++) {
            const interval both = interval_both(body, interval_both(part[0].list[i], part[1].list[k]));
            if (both.in < both.out && count < most)
                chords[count++] = both;
        }
    return count;
}

static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found)
{
    (void)s;
    const int64_t at = rays->start[i] - p->first_face;
    const local_ray r =
        ray_to_local(p, p->turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    interval chords[CHORDS_MAX];
    const int count = cross_lens(p, r, at, chords);
    const double length = sqrt(r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    const crossings_of_one ahead =
        crossings_of_chords(chords, count, at >= 0 && at < FACES_OF_LENS, inside, 0x1p-20 * p->radius / length);
    intervals_of_crossings(&ahead, inside, most_chords(p), found);
}

/* Ray by ray, as few rays hit a lens. */
static void rows(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    for (int i = 0; i < rays->count; i++) {
        interval found[CHORDS_MAX];
        one(p, rays, i, rays->inside[i] >> bit & 1, s, found);
        for (int k = 0; k < p->rows; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

/* A point projected onto side k by one Newton step along the gradient (-dh/dx, 1, -dh/dz) of y less the height h, the
 * normal out of the lens, and the distance. */
static side_point point_on_asphere(const primitive *p, int k, vec3 q)
{
    const even_asphere e = lens_asphere(p, k);
    double by_x, by_z;
    const double vertex = k == 0 ? 0.0 : p->top, out = k == 0 ? -1.0 : 1.0;
    const double level = (q.y - vertex) - asphere_surface(&e, q.x, q.z, &by_x, &by_z), gx = -by_x, gz = -by_z;
    const double g2 = 1.0 + gx * gx + gz * gz, inverse = 1.0 / sqrt(g2), step = -level / g2;
    return (side_point){.point = vec3_make(q.x + step * gx, q.y + step, q.z + step * gz),
                        .normal = vec3_scale(vec3_make(gx, 1.0, gz), out * inverse),
                        .apart = magnitude(level) * inverse};
}

/* A side counts within its clear radius, its ring beyond it up to the bevel: elsewhere they are `outside` farther than
 * they are. */
static side_point point_on_ring(const primitive *p, int k, vec3 q, double from_axis, double outside)
{
    const double y = lens_clear(p, k) < HUGE_VAL ? lens_ring(p, k) : HUGE_VAL;
    return (side_point){.point = vec3_make(q.x, y, q.z),
                        .normal = vec3_make(0.0, k == 0 ? -1.0 : 1.0, 0.0),
                        .apart = magnitude(q.y - y) + (from_axis < lens_clear(p, k) ? outside : 0.0)};
}

static side_point point_on_bevel(const primitive *p, int k, vec3 q, double from_axis, double outside)
{
    const double up = bevel_slope(k), half = 0x1.6a09e667f3bcdp-1; /* sqrt(1/2) */
    const double off = 0.5 * (from_axis - up * (q.y - lens_apex(p, k))), x = q.x / from_axis, z = q.z / from_axis;
    return (side_point){.point = vec3_make(x * (from_axis - off), q.y + up * off, z * (from_axis - off)),
                        .normal = vec3_make(x * half, -up * half, z * half),
                        .apart = magnitude(off) / half + (from_axis < lens_bevel(p, k) ? outside : 0.0)};
}

static side_point point_on(const primitive *p, int k, vec3 q)
{
    const even_asphere e = lens_asphere(p, k);
    if (asphere_has_terms(&e))
        return point_on_asphere(p, k, q);
    const lens_side side = lens_side_of(p, k);
    side_point s = point_on_side(&side, q);
    s.normal = vec3_scale(s.normal, side.concave ? -1.0 : 1.0);
    return s;
}

/* Projects q onto the nearest face that the ray can cross there in its direction: a ray leaves along the outward
 * normal, and enters against it. */
ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general, (void)at;
    const double from_axis = sqrt(q.x * q.x + q.z * q.z), along = leaving ? 1.0 : -1.0;
    const double x = q.x / from_axis, z = q.z / from_axis, outside = 0x1p-30 * p->radius;
    side_point faces[FACES_OF_LENS] = {{.point = vec3_make(x * p->radius, q.y, z * p->radius),
                                        .normal = vec3_make(x, 0.0, z),
                                        .apart = magnitude(from_axis - p->radius)},
                                       point_on(p, 0, q),
                                       point_on(p, 1, q)};
    int best = 0, count = 3;
    double least = HUGE_VAL;
    for (int k = 0; k < 2 && p->details; k++) {
        faces[count++] = point_on_ring(p, k, q, from_axis, outside);
        faces[1 + k].apart += from_axis > lens_clear(p, k) ? outside : 0.0;
    }
    for (int k = 0; k < 2 && lens_has_bevels(p); k++) {
        for (int j = 0; j < 2; j++) /* the side and its ring */
            faces[1 + k + 2 * j].apart += from_axis > lens_bevel(p, k) ? outside : 0.0;
        faces[count++] =
            lens_has_bevel(p, k) ? point_on_bevel(p, k, q, from_axis, outside) : (side_point){.apart = HUGE_VAL};
    }
    for (int k = 0; k < count; k++) {
        const double turned = vec3_dot(vec3_make(r.dx, r.dy, r.dz), faces[k].normal);
        const double cost = faces[k].apart + (turned * along > 0.0 ? 0.0 : outside);
        if (cost < least)
            best = k, least = cost;
    }
    return (local_point){.point = faces[best].point, .normal = faces[best].normal, .face = p->first_face + best};
}

static void points(const primitive *__restrict p, const ray_batch *rays, const double *t, int bit, surface_batch *out)
{
    for (int i = 0; i < rays->count; i++)
        store_point(p, point, true, rays, t, i, bit, out);
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    return cross_lens(p, r, FACE_NONE, found);
}

/* By the most chords of a line. */
#define ASPHERE_FUNCTIONS(name, most) \
    const primitive_functions KERNEL(name) = {most, rows, one, points, lens_contains, chords, lens_flats, lens_mapping}
ASPHERE_FUNCTIONS(asphere_functions, 3);
ASPHERE_FUNCTIONS(asphere_5_functions, 5);
ASPHERE_FUNCTIONS(asphere_7_functions, 7);
ASPHERE_FUNCTIONS(asphere_9_functions, 9);
