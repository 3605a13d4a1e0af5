/* A cylinder of liquid with a meniscus: x^2 + z^2 <= radius^2 and y >= 0. Within the tube's radius the liquid is below
 * the surface y = h(x^2 + z^2) (capillary.h). Outside it, inside the wall, it is below the height at which the surface
 * meets the wall. Faces: 0 side, 1 bottom, 2 the surface, 3 the level ring around it.
 *
 * h(r) is convex for a contact angle below 90 degrees and concave above (the curvature of a capillary surface keeps its
 * sign, Finn, 2.3). So, along a line within the tube, f = y - h, or h - y, is concave: it is positive in one interval.
 * Newton's steps from a point with f < 0 approach an end of this interval without passing it, and turn back only if
 * there is none. For a rising surface the liquid is the cylinder up to the wall's contact minus this interval, for a
 * falling one plus this interval. Either has at most two chords.
 *
 * For a ray that starts on the surface, f(0) = 0 is taken as exact: f = t times the difference quotient, whose terms do
 * not cancel. */
#include "geometry/primitives/capillary.h"
#include "geometry/primitives/kind.h"

enum { CAPILLARY_CHORDS = 2 };

static const capillary_profile *surface_of(const primitive *p)
{
    return p->details;
}

/* A line, with t measured from its base: its point nearest to the surface's middle or, if it starts on the surface, its
 * start. */
typedef struct surface_line {
    const capillary_profile *h;
    local_ray base;
    double side;    /* f = side (y - h) */
    double rho2;    /* at the base */
    bool starts_on; /* the base is on the surface */
    double from;    /* t of the base */
    double least;   /* steps up to this length are within rounding */
} surface_line;

static double above_surface(const surface_line *l, double t, double *slope)
{
    const local_ray *o = &l->base;
    const double x = o->x + t * o->dx, z = o->z + t * o->dz, rho2 = x * x + z * z;
    double by_rho2;
    const double rise = capillary_rise(l->h, rho2, &by_rho2);
    *slope = l->side * (o->dy - by_rho2 * (2.0 * (x * o->dx + z * o->dz)));
    if (!l->starts_on)
        return l->side * (o->y - l->h->level + t * o->dy - rise);
    const double turn = (x + o->x) * o->dx + (z + o->z) * o->dz; /* the difference of rho^2, divided by t */
    return t * (l->side * (o->dy - capillary_quotient(l->h, l->rho2, rho2) * turn));
}

/* The first zero of f from `start` towards `end`, an end of the interval in which f > 0. `start` if f >= 0 there;
 * infinite, in the direction of `end`, if there is none. */
static double surface_root(const surface_line *l, double start, double end)
{
    const double towards = start < end ? 1.0 : -1.0;
    double t = start;
    for (int step = 0; step < 400; step++) {
        double slope;
        const double f = above_surface(l, t, &slope);
        if (f >= 0.0)
            return t;
        const double move = -f / slope;
        if (!(move * towards > 0.0) || towards * (t + move - end) > 0.0)
            return towards * HUGE_VAL;
        t += move;
        if (magnitude(move) <= l->least + 0x1p-53 * magnitude(t))
            return t;
    }
    return t;
}

/* The interval within the tube in which f > 0. near: the interval in which the line is at heights of the surface. */
static interval positive_within(const surface_line *l, interval tube, interval near)
{
    const interval none = {HUGE_VAL, -HUGE_VAL};
    double low = greater(tube.in, near.in), high = lesser(tube.out, near.out);
    if (l->starts_on)
        low = lesser(low, 0.0), high = greater(high, 0.0);
    double slope;
    if (!(low < high)) {
        const double t = near.in > tube.out ? tube.out : tube.in;
        return l->side * (l->base.y + t * l->base.dy - 0.5 * (l->h->low + l->h->high)) > 0.0 ? tube : none;
    }
    interval found;
    if (l->starts_on) {
        above_surface(l, 0.0, &slope);
        const bool opens = slope > 0.0;
        const double end = opens ? high : low, root = surface_root(l, end, 0.0);
        const double other = root == end ? (opens ? tube.out : tube.in) : root;
        found = opens ? (interval){0.0, greater(other, 0.0)} : (interval){lesser(other, 0.0), 0.0};
        return magnitude(root) < HUGE_VAL ? found : (interval){0.0, 0.0};
    }
    found.in = surface_root(l, low, high);
    if (!(found.in < HUGE_VAL))
        return none;
    found.out = surface_root(l, high, low);
    if (found.in == low)
        found.in = tube.in;
    if (found.out == high)
        found.out = tube.out;
    return found;
}

static interval surface_interval(const primitive *p, local_ray r, interval tube, int64_t at)
{
    const capillary_profile *h = p->details;
    const bool starts_on = mask_same(at, 2) != 0;
    const double middle = 0.5 * (h->low + h->high), length2 = r.dx * r.dx + r.dy * r.dy + r.dz * r.dz;
    const double from = starts_on ? 0.0 : -(r.x * r.dx + (r.y - middle) * r.dy + r.z * r.dz) / length2;
    const surface_line l = {.h = h,
                            .base = {r.x + from * r.dx, r.y + from * r.dy, r.z + from * r.dz, r.dx, r.dy, r.dz},
                            .side = h->rises ? 1.0 : -1.0,
                            .rho2 = r.x * r.x + r.z * r.z,
                            .starts_on = starts_on,
                            .from = from,
                            .least = 0x1p-55 * p->radius / sqrt(length2)};
    const double spare = 0x1p-20 * (h->high - h->low) + 0x1p-40 * p->radius;
    const slab_roots near = slab_cross(l.base.y, inverse_of_component(r.dy), h->low - spare, h->high + spare, 0, 0);
    const interval found =
        positive_within(&l, (interval){tube.in - from, tube.out - from}, (interval){near.in, near.out});
    return (interval){found.in + from, found.out + from};
}

/* The chords of a line; returns their number. */
static int cross_liquid(const primitive *p, local_ray r, int64_t at, interval chords[CHORDS_MAX])
{
    const capillary_profile *h = p->details;
    const double dx = cylinder_dx(r.dx, r.dz), a = cylinder_axial(dx, r.dz, 1.0), inverse_a = 1.0 / a;
    const double inverse_y = inverse_of_component(r.dy), cross = r.x * r.dz - r.z * dx;
    const int64_t on_side = mask_same(at, 0), on_bottom = mask_same(at, 1), on_ring = mask_same(at, 3);
    const interval side = interval_of_quadric(cylinder_side(p, r.x, r.z, dx, r.dz, a, inverse_a, on_side));
    const interval tube = h->radius < p->radius
                              ? interval_of_quadric(quadric_cross(r.x * dx + r.z * r.dz, inverse_a,
                                                                  a * (h->radius * h->radius) - cross * cross, 0))
                              : side;
    const slab_roots slab = slab_cross(r.y, inverse_y, 0.0, h->wall, on_bottom, on_ring),
                     raised = slab_cross(r.y, inverse_y, 0.0, HUGE_VAL, on_bottom, 0);
    const interval cylinder = interval_both(side, (interval){slab.in, slab.out});
    const interval surface = tube.in < tube.out ? surface_interval(p, r, tube, at) : (interval){HUGE_VAL, -HUGE_VAL};
    chords[0] = cylinder;
    if (h->rises)
        return intervals_without(chords, cylinder.in < cylinder.out, surface);
    const interval middle = interval_both(interval_both(tube, surface), (interval){raised.in, raised.out});
    if (!(middle.in < middle.out))
        return cylinder.in < cylinder.out;
    if (!(cylinder.in < cylinder.out)) {
        chords[0] = middle;
        return 1;
    }
    if (middle.in <= cylinder.out && cylinder.in <= middle.out) {
        chords[0] = (interval){fmin(middle.in, cylinder.in), fmax(middle.out, cylinder.out)};
        return 1;
    }
    chords[0] = middle.in < cylinder.in ? middle : cylinder;
    chords[1] = middle.in < cylinder.in ? cylinder : middle;
    return 2;
}

static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found)
{
    (void)s;
    const int64_t at = rays->start[i] - p->first_face;
    const local_ray r =
        ray_to_local(p, p->turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    interval chords[CHORDS_MAX + 1];
    const int count = cross_liquid(p, r, at, chords);
    const double length = sqrt(r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    const crossings_of_one ahead =
        crossings_of_chords(chords, count, at >= 0 && at <= 3, inside, 0x1p-20 * p->radius / length);
    intervals_of_crossings(&ahead, inside, CAPILLARY_CHORDS, found);
}

static void rows(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    for (int i = 0; i < rays->count; i++) {
        interval found[CHORDS_MAX];
        one(p, rays, i, rays->inside[i] >> bit & 1, s, found);
        for (int k = 0; k < CAPILLARY_CHORDS; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

/* Projects q onto the nearest face that the ray can cross there in its direction: a ray leaves along the outward
 * normal, and enters against it. */
ALWAYS_INLINE local_point point(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving)
{
    (void)general, (void)at;
    const capillary_profile *h = p->details;
    const double rho2 = q.x * q.x + q.z * q.z, rho = sqrt(rho2), along = leaving ? 1.0 : -1.0;
    const bool within = rho <= h->radius;
    double by_rho2;
    const double rise = h->level + capillary_rise(h, fmin(rho2, h->radius * h->radius), &by_rho2);
    const double gx = -2.0 * by_rho2 * q.x, gz = -2.0 * by_rho2 * q.z, inverse = 1.0 / sqrt(1.0 + gx * gx + gz * gz);
    const vec3 out = vec3_make(q.x / rho, 0.0, q.z / rho), up = vec3_make(0.0, 1.0, 0.0);
    const vec3 normals[] = {out, vec3_make(0.0, -1.0, 0.0), vec3_make(gx * inverse, inverse, gz * inverse), up};
    const vec3 points[] = {vec3_make(out.x * p->radius, q.y, out.z * p->radius), vec3_make(q.x, 0.0, q.z),
                           vec3_make(q.x, rise, q.z), vec3_make(q.x, h->wall, q.z)};
    const double outside = 0x1p-30 * p->radius;
    /* q is past the edge between surface and ring only by rounding: its distance from the edge is added */
    const double apart[] = {magnitude(rho - p->radius), magnitude(q.y),
                            magnitude(q.y - rise) * inverse + (within ? 0.0 : rho - h->radius),
                            magnitude(q.y - h->wall) + (within ? h->radius - rho : 0.0)};
    int best = 0;
    double least = HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        const double turned = r.dx * normals[k].x + r.dy * normals[k].y + r.dz * normals[k].z;
        const double cost = apart[k] + (turned * along > 0.0 ? 0.0 : outside);
        if (cost < least)
            best = k, least = cost;
    }
    return (local_point){.point = points[best], .normal = normals[best], .face = p->first_face + best};
}

static void points(const primitive *__restrict p, const ray_batch *rays, const double *t, int bit, surface_batch *out)
{
    for (int i = 0; i < rays->count; i++)
        store_point(p, point, true, rays, t, i, bit, out);
}

static bool contains(const primitive *p, vec3 q)
{
    return capillary_contains(surface_of(p), p->radius, q.x * q.x + q.z * q.z, q.y);
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    interval list[CHORDS_MAX + 1];
    const int count = cross_liquid(p, r, FACE_NONE, list);
    for (int k = 0; k < count; k++)
        found[k] = list[k];
    return count;
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    flat[0] = (flat_face){1, 1, 0.0, -1.0};
    flat[1] = (flat_face){3, 1, surface_of(p)->wall, 1.0};
    return surface_of(p)->radius < p->radius ? 2 : 1;
}

/* As on a cylinder, up to the contact with the wall; the surface as seen along the axis. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius, diameter = 2.0 * r;
    if (face == 0)
        return mapping_around(q.x, q.z, r, q.y, surface_of(p)->wall, size);
    return mapping_flat(q.x + r, face == 1 ? r - q.z : q.z + r, diameter, diameter, size);
}

const primitive_functions KERNEL(capillary_functions) = {CAPILLARY_CHORDS, rows,   one,   points,
                                                         contains,         chords, flats, mapping};
