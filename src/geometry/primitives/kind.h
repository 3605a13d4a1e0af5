/* Functions that all kinds of primitives share: the loops over rays, into which each kind inserts its formulas.
 *
 * The third pass computes, for the rays that hit one primitive, the point, projected exactly onto the surface, the
 * normal there, the face, and a bound on the point's error.
 *
 * The bound: local coordinates result from at most 8 roundings of numbers no larger than the ray's start, the
 * displacement t d and the frame's origin. The error of the root itself moves the point along the ray, and the
 * projection onto the surface leaves only the part across the surface. 32 half-ulps of the sum of these magnitudes
 * covers it with a wide margin (Higham, Accuracy and Stability of Numerical Algorithms, 3.1: gamma_n), which the tests
 * check against quadruple precision. Pure; cannot fail. */
#pragma once

#include "base/isa.h"
#include "geometry/primitives/primitive.h"

static inline interval interval_both(interval a, interval b)
{
    return (interval){fmax(a.in, b.in), fmin(a.out, b.out)};
}

static inline interval interval_of_quadric(quadric_roots q)
{
    return q.hit ? (interval){q.in, q.out} : (interval){HUGE_VAL, -HUGE_VAL};
}

/* The interval, in the ray's t, in which a ray is in the infinite half cone x^2 + z^2 <= w^2, w = radius + slope y > 0.
 * The discriminant is computed by Lagrange's identity for x^2 + z^2 - w^2. The quadratic is solved from the line's
 * point nearest to the axis's point at `middle`; for a ray that starts on the cone, from its start, where c = 0. */
ALWAYS_INLINE quadric_roots half_cone_cross(double radius, double slope, double middle, local_ray r, int64_t starts_on)
{
    const double dx = cylinder_dx(r.dx, r.dz), dw = slope * r.dy;
    double up = r.y - middle;
    double nearest = -(r.x * r.dx + up * r.dy + r.z * r.dz) / (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
    double from = blend(starts_on, 0.0, nearest);
    double x = r.x + from * dx, z = r.z + from * r.dz, w = radius + slope * (r.y + from * r.dy);
    double a = dx * dx + r.dz * r.dz - dw * dw, b = x * dx + z * r.dz - w * dw;
    double c = blend(starts_on, 0.0, x * x + z * z - w * w);
    double mx = x * dw - w * dx, mz = z * dw - w * r.dz, mw = x * r.dz - z * dx;
    double discriminant = blend(starts_on, b * b, mx * mx + mz * mz - mw * mw);
    double root = sqrt(greater(discriminant, 0.0));
    double q = -(b + blend(mask_less(b, 0.0), -root, root));
    double far = q * inverse_of_component(a), close = c * inverse_of_component(q);
    double first = lesser(far, close), second = greater(far, close);
    int64_t steep = mask_less(a, 0.0), opens = mask_less(0.0, dw);
    int64_t upper = mask_less(0.0, w - dw * (b * inverse_of_component(a))); /* halfway between the roots */
    quadric_roots s;
    s.in = from + blend(steep, blend(opens, second, -HUGE_VAL), first);
    s.out = from + blend(steep, blend(opens, HUGE_VAL, first), second);
    s.hit = steep | (upper & (starts_on | mask_less(0.0, discriminant)));
    return s;
}

static inline interval interval_of_slab(double y, double dy, double low, double high)
{
    const slab_roots s = slab_cross(y, inverse_of_component(dy), low, high, 0, 0);
    return (interval){s.in, s.out};
}

/* The chord of a convex primitive as a list. */
static inline int one_chord(interval chord, interval chords[CHORDS_MAX])
{
    chords[0] = chord;
    return chord.in < chord.out;
}

/* Stores the one interval of a convex primitive, consistent with the ray's set and the face that the ray starts on:
 * see intervals_kernel.c. */
ALWAYS_INLINE void store_interval(double near, double far, int64_t hit, int64_t starts_on, int64_t inside, double *in,
                                  double *out)
{
    int64_t ahead = hit & ~starts_on & mask_less(0.0, near + far);
    double outside_in = blend(ahead, greater(near, 0.0), HUGE_VAL), outside_out = blend(ahead, far, -HUGE_VAL);
    *in = blend(inside, -HUGE_VAL, outside_in);
    *out = blend(inside, blend(hit, greater(far, 0.0), 0.0), outside_out);
}

/* Tests the sign: gcc 14 makes a _Bool of any other test of a bit, and then does not vectorise the loop. */
ALWAYS_INLINE int64_t inside_mask(uint64_t set, int shift)
{
    return mask_of((int64_t)(set << (63 - shift)) < 0);
}

/* The one interval of a ray's line in a convex primitive; starts_on: the ray starts on the primitive. */
typedef struct ray_span {
    double near, far;
    int64_t hit, starts_on;
} ray_span;

/* The intersection of the intervals of the side and of the caps. */
ALWAYS_INLINE ray_span span_within(quadric_roots side, slab_roots caps, int64_t starts_on)
{
    double near = greater(side.in, caps.in), far = lesser(side.out, caps.out);
    return (ray_span){near, far, side.hit & mask_less(near, far), starts_on};
}

/* Computes the interval of ray i, which is r in the local frame. at: the primitive's face that the ray starts on, from
 * 0; a number that no face has if it starts elsewhere. */
typedef ray_span span_function(const primitive *p, bool general, local_ray r, int64_t at, const ray_scratch *s, int i);

ALWAYS_INLINE void spans_in(const primitive *p, span_function *span, bool general, int bit, const ray_batch *rays,
                            ray_scratch *s)
{
    double *__restrict in = s->in[bit], *__restrict out = s->out[bit];
    const int64_t first = p->first_face;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, general, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        ray_span m = span(p, general, r, rays->start[i] - first, s, i);
        store_interval(m.near, m.far, m.hit, m.starts_on, inside_mask(rays->inside[i], bit), &in[i], &out[i]);
    }
}

ALWAYS_INLINE void span_of_one(const primitive *p, span_function *span, bool general, const ray_batch *rays, int i,
                               bool inside, const ray_scratch *s, interval *found)
{
    local_ray r =
        ray_to_local(p, general, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    ray_span m = span(p, general, r, rays->start[i] - p->first_face, s, i);
    store_interval(m.near, m.far, m.hit, m.starts_on, mask_of(inside), &found->in, &found->out);
}

/* Removes the hole from the intervals, which are in order; returns their new number. */
static inline int intervals_without(interval *list, int count, interval hole)
{
    int remaining = 0;
    interval rest[CHORDS_MAX + 1];
    for (int k = 0; k < count; k++) {
        const interval before = {list[k].in, fmin(list[k].out, hole.in)},
                       after = {fmax(list[k].in, hole.out), list[k].out};
        const bool is_hit = hole.in < hole.out && hole.in < list[k].out && list[k].in < hole.out;
        if (!is_hit)
            rest[remaining++] = list[k];
        if (is_hit && before.in < before.out)
            rest[remaining++] = before;
        if (is_hit && after.in < after.out)
            rest[remaining++] = after;
    }
    for (int k = 0; k < remaining; k++)
        list[k] = rest[k];
    return remaining;
}

/* The crossings of a line with a primitive that is not convex: an even number, in order. */
enum { CROSSINGS_OF_ONE_MAX = 2 * CHORDS_MAX };
typedef struct crossings_of_one {
    int count;
    double t[CROSSINGS_OF_ONE_MAX];
} crossings_of_one;

/* The crossings ahead of a ray, selected from the crossings of its line other than its start: an odd number if the ray
 * is inside, otherwise an even one. If rounding makes the parity wrong, the ray's set decides: a crossing is added at
 * the start, or the next one is removed.
 * - The ray starts on another surface, within rounding of this one: the crossing nearest to the start is on the wrong
 *   side of it.
 * - The ray starts on this surface (starts_on), and its direction contradicts the set. Inside, it leaves at once.
 *   Outside, it does not enter, so the crossing at which it would leave is removed.
 * - The same, but the ray grazes the concave side: a crossing within `grazing` is the start itself, which rounding put
 *   on the wrong side. */
static inline crossings_of_one crossings_ahead(const crossings_of_one *line, bool starts_on, bool inside,
                                               double grazing)
{
    int first = 0;
    while (first < line->count && line->t[first] <= 0.0)
        first++;
    crossings_of_one ahead;
    ahead.count = 0;
    if ((line->count - first) % 2 != (int)inside) {
        const double behind = first > 0 ? -line->t[first - 1] : HUGE_VAL;
        const double next = first < line->count ? line->t[first] : HUGE_VAL;
        const bool now = !starts_on ? behind <= next : inside ? next > grazing : behind <= grazing;
        if (now)
            ahead.t[ahead.count++] = 0.0; /* a crossing is added at the start */
        else
            first++; /* the next crossing is removed */
    }
    for (int k = first; k < line->count; k++)
        ahead.t[ahead.count++] = line->t[k];
    return ahead;
}

/* crossings_ahead for the chords of the line, one of which may end at the ray's start if that is on the surface. */
static inline crossings_of_one crossings_of_chords(const interval *chords, int count, bool starts_on, bool inside,
                                                   double grazing)
{
    crossings_of_one line;
    line.count = 0;
    bool is_start = starts_on; /* the crossing at the ray's start is left out */
    for (int k = 0; k < 2 * count; k++) {
        const double t = k % 2 ? chords[k / 2].out : chords[k / 2].in;
        if (is_start && t == 0.0)
            is_start = false;
        else
            line.t[line.count++] = t;
    }
    return crossings_ahead(&line, starts_on, inside, grazing);
}

/* The intervals between the crossings ahead, of a kind with that many rows. */
static inline void intervals_of_crossings(const crossings_of_one *ahead, bool inside, int rows, interval *found)
{
    int next = 0;
    for (int k = 0; k < rows; k++) {
        found[k].in = k == 0 && inside ? -HUGE_VAL : next < ahead->count ? ahead->t[next++] : HUGE_VAL;
        found[k].out = next < ahead->count ? ahead->t[next++] : -HUGE_VAL;
    }
}

typedef struct local_point {
    vec3 point, normal; /* the normal points outwards */
    int64_t face;
} local_point;

/* Projects q, the point of r at t, onto the surface; at: the face that r starts on, from 0. */
typedef local_point point_function(const primitive *p, bool general, local_ray r, vec3 q, int64_t at, int64_t leaving);

/* Stores the point of ray i. */
ALWAYS_INLINE void store_point(const primitive *p, point_function *project, bool general, const ray_batch *rays,
                               const double *__restrict t, int i, int bit, surface_batch *__restrict s)
{
    local_ray r =
        ray_to_local(p, general, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    vec3 d = vec3_make(r.dx, r.dy, r.dz), o = vec3_make(r.x, r.y, r.z), path = vec3_scale(d, t[i]),
         q = vec3_add(o, path);
    int64_t at = rays->start[i] - p->first_face, leaving = -(int64_t)((rays->inside[i] & (uint64_t)1 << bit) != 0);
    local_point l = project(p, general, r, q, at, leaving);
    double side = blend(leaving, -1.0, 1.0); /* the normal faces the ray */
    vec3 n = vec3_scale(l.normal, side), point = l.point;
    double cosine = -vec3_dot(d, n);
    double size =
        magnitude(o.x) + magnitude(o.y) + magnitude(o.z) + magnitude(path.x) + magnitude(path.y) + magnitude(path.z);
    if (general) {
        n = mat3_apply(p->rotation, n);
        point = mat3_apply(p->rotation, point);
    }
    s->px[i] = point.x + p->origin.x;
    s->py[i] = point.y + p->origin.y;
    s->pz[i] = point.z + p->origin.z;
    s->nx[i] = n.x;
    s->ny[i] = n.y;
    s->nz[i] = n.z;
    s->cos_i[i] = lesser(greater(cosine, DBL_MIN), 1.0);
    s->error[i] = POINT_ERROR * (size + p->extent);
    s->face[i] = l.face;
}

ALWAYS_INLINE void points_on(const primitive *p, point_function *project, bool general, const ray_batch *rays,
                             const double *__restrict t, int bit, surface_batch *__restrict s)
{
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++)
        store_point(p, project, general, rays, t, i, bit, s);
}

/* Define rows and points with a body that is compiled for both values of is_general, an expression in p: whether the
 * primitive needs the general code, because it is rotated or an elliptic cylinder. */
#define DEFINE_ROWS(is_general, body)                                                               \
    static void rows(const primitive *__restrict p, int bit, const ray_batch *rays, ray_scratch *s) \
    {                                                                                               \
        if (is_general)                                                                             \
            body(p, true, bit, rays, s);                                                            \
        else                                                                                        \
            body(p, false, bit, rays, s);                                                           \
    }
/* The same for a convex primitive. */
#define DEFINE_SPANS(is_general, span)                                                                         \
    ALWAYS_INLINE void spans(const primitive *p, bool general, int bit, const ray_batch *rays, ray_scratch *s) \
    {                                                                                                          \
        spans_in(p, span, general, bit, rays, s);                                                              \
    }                                                                                                          \
    DEFINE_ROWS(is_general, spans)                                                                             \
    static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s,       \
                    interval *found)                                                                           \
    {                                                                                                          \
        if (is_general)                                                                                        \
            span_of_one(p, span, true, rays, i, inside, s, found);                                             \
        else                                                                                                   \
            span_of_one(p, span, false, rays, i, inside, s, found);                                            \
    }
#define DEFINE_POINTS(is_general, point)                                                               \
    static void points(const primitive *__restrict p, const ray_batch *rays, const double *t, int bit, \
                       surface_batch *out)                                                             \
    {                                                                                                  \
        if (is_general)                                                                                \
            points_on(p, point, true, rays, t, bit, out);                                              \
        else                                                                                           \
            points_on(p, point, false, rays, t, bit, out);                                             \
    }
