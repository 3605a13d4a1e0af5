/* A side of a lens that is a conic of revolution, and common code of lenses with and without aspheric coefficients; for
 * kernels. Faces: 0 rim, 1 the side at y = 0, 2 the side at y = top, 3 and 4 the level rings around them, 5 and 6 the
 * bevels. Pure; cannot fail.
 *
 * The conic's equation is c (x^2 + z^2 + (1 + k) u^2) - 2 u = 0, with u measured from its vertex towards its centre of
 * curvature; c = 0 is a flat side. It holds on both halves of an ellipsoid, and on both sheets of a hyperboloid; only
 * the half or sheet at the vertex counts. Beyond an ellipsoid's centre the convex set of the side is everything within
 * the rim, so that a lens may be longer than its spheres. */
#pragma once

#include "geometry/primitives/asphere.h"
#include "geometry/primitives/kind.h"

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

/* The interval in which a line is inside the convex sheet of a conic of positive curvature; t is measured from the
 * point (x, z, u). As for a cone (cone_kernel.c), the roots of a t^2 + 2 b t + c = 0 are q / a and c / q. */
ALWAYS_INLINE quadric_roots conic_cross(const lens_side *e, double x, double z, double u, double dx, double dz,
                                        double du, int64_t starts_on)
{
    double a = e->curvature * (dx * dx + dz * dz + e->stretch * (du * du));
    double b = e->curvature * (x * dx + z * dz + e->stretch * (u * du)) - du;
    double c = blend(starts_on, 0.0, e->curvature * (x * x + z * z + e->stretch * (u * u)) - 2.0 * u);
    double discriminant = blend(starts_on, b * b, b * b - a * c), root = sqrt(greater(discriminant, 0.0));
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
    s.hit = steep | (ours & (starts_on | mask_less(0.0, discriminant)));
    return s;
}

/* The half-space u >= 0. */
ALWAYS_INLINE interval half_space(double u, double inverse_u)
{
    double t = -u * inverse_u;
    int64_t opens = mask_less(0.0, inverse_u);
    return (interval){blend(opens, t, -HUGE_VAL), blend(opens, HUGE_VAL, t)};
}

/* The interval of t in which a ray is in the convex set of a side; it is valid only within the rim. For accuracy the
 * conic is intersected from the line's point nearest to the vertex; for a ray that starts on the side, from its start,
 * where the quadratic's constant term is 0.
 *
 * Within the rim, a line is inside an ellipsoid where it crosses the plane through the centre, and stays in the convex
 * set beyond the plane: there the interval has no end. If the line touches the ellipsoid at the plane, rounding can put
 * the other end beyond the plane or lose it; then the crossing of the plane is that end. */
ALWAYS_INLINE interval lens_side_cross(const lens_side *e, local_ray r, double inverse_length2, interval rim,
                                       int64_t starts_on)
{
    double u = e->up * (r.y - e->vertex), du = e->up * r.dy, inverse_u = inverse_of_component(du);
    double from = blend(starts_on, 0.0, -(r.x * r.dx + u * du + r.z * r.dz) * inverse_length2);
    double x = r.x + from * r.dx, z = r.z + from * r.dz, v = u + from * du;
    quadric_roots sheet = conic_cross(e, x, z, v, r.dx, r.dz, du, starts_on);
    double centre = from + (e->centre - v) * inverse_u;
    int64_t opens = mask_less(0.0, inverse_u);
    int64_t late = mask_less(centre, rim.in), early = mask_less(rim.out, centre), all = blend_int(opens, late, early);
    int64_t central = ~(late | early), hit = sheet.hit | central;
    double first = from + sheet.in, last = from + sheet.out;
    double in = blend(hit, blend(central, lesser(first, centre), first), HUGE_VAL),
           out = blend(hit, blend(central, greater(last, centre), last), -HUGE_VAL);
    interval s = {blend(all | (hit & ~opens & mask_less_equal(in, centre)), -HUGE_VAL, in),
                  blend(all | (hit & opens & mask_less_equal(centre, out)), HUGE_VAL, out)};
    interval plane = half_space(blend(starts_on, 0.0, u), inverse_u);
    return (interval){blend(e->flat, plane.in, s.in), blend(e->flat, plane.out, s.out)};
}

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

static inline even_asphere lens_asphere(const primitive *p, int k)
{
    const lens_details *d = p->details;
    even_asphere e = asphere_of(p->lens.curvature[k], p->lens.conic[k], d ? d->even[k] : NULL);
    if (d && d->general[k]) {
        asphere_add_odd(&e, d->odd[k]);
        e.form = d->form[k], e.curvature_x = d->curvature_x[k], e.stretch_x = 1.0 + d->conic_x[k];
    }
    return e;
}

/* The radius up to which a side reaches, infinite without a ring. */
static inline double lens_clear(const primitive *p, int k)
{
    const lens_details *d = p->details;
    return d ? d->clear[k] : HUGE_VAL;
}

static inline double lens_height(const primitive *p, int k, double x, double z)
{
    const even_asphere e = lens_asphere(p, k);
    const double clear = lens_clear(p, k), rho2 = x * x + z * z;
    double by_x, by_z;
    return (k == 0 ? 0.0 : p->top) + (e.form == SIDE_ROUND ? asphere_sag(&e, lesser(rho2, clear * clear))
                                                           : asphere_surface(&e, x, z, &by_x, &by_z));
}

/* The height of the ring around a side. */
static inline double lens_ring(const primitive *p, int k)
{
    return lens_height(p, k, 0.0, HUGE_VAL);
}

/* --- bevels: the half cones rho <= w = up (y - apex) --- */

static inline double bevel_slope(int k)
{
    return k == 0 ? 1.0 : -1.0;
}

/* The radius where the bevel of side k begins, infinite without one. */
static inline double lens_bevel(const primitive *p, int k)
{
    const lens_details *d = p->details;
    return d ? d->bevel[k] : HUGE_VAL;
}

static inline bool lens_has_bevel(const primitive *p, int k)
{
    return lens_bevel(p, k) < HUGE_VAL;
}

static inline bool lens_has_bevels(const primitive *p)
{
    return lens_has_bevel(p, 0) || lens_has_bevel(p, 1);
}

static inline double lens_apex(const primitive *p, int k)
{
    const lens_details *d = p->details;
    return d->apex[k];
}

static inline bool is_within_bevel(const primitive *p, int k, vec3 q)
{
    return !lens_has_bevel(p, k) || sqrt(q.x * q.x + q.z * q.z) <= bevel_slope(k) * (q.y - lens_apex(p, k));
}

static inline bool lens_contains(const primitive *p, vec3 q)
{
    return is_within_bevel(p, 0, q) && is_within_bevel(p, 1, q) && q.x * q.x + q.z * q.z <= p->radius * p->radius &&
           q.y >= lens_height(p, 0, q.x, q.z) && q.y <= lens_height(p, 1, q.x, q.z);
}

/* The height at which the rim with its bevel ends: the outermost one if it is not the same all around. */
static inline double lens_rim_end(const primitive *p, int k)
{
    const lens_details *d = p->details;
    if (d && d->form[k] != SIDE_ROUND)
        return k == 0 ? d->low[0] : p->top + d->high[1];
    return lens_height(p, k, 0.0, lesser(p->radius, lens_bevel(p, k)));
}

static inline int lens_flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    int count = 0;
    for (int k = 0; k < 2; k++) {
        const even_asphere e = lens_asphere(p, k);
        if (e.curvature == 0.0 && !asphere_has_terms(&e))
            flat[count++] = (flat_face){1 + k, 1, k == 0 ? 0.0 : p->top, k == 0 ? -1.0 : 1.0};
        if (lens_clear(p, k) < HUGE_VAL)
            flat[count++] = (flat_face){3 + k, 1, lens_ring(p, k), k == 0 ? -1.0 : 1.0};
    }
    return count;
}

/* Texture coordinates. On the rim and its bevels, the image goes once around, its middle in front; on the sides it is
 * projected along the axis. */
static inline surface_mapping lens_mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius, bottom = lens_rim_end(p, 0), top = lens_rim_end(p, 1);
    if (face == 0 || face >= 5)
        return mapping_around(q.x, q.z, r, q.y - bottom, top - bottom, size);
    return mapping_flat(q.x + r, face == 1 || face == 3 ? r - q.z : q.z + r, 2.0 * r, 2.0 * r, size);
}
