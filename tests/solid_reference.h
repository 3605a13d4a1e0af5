/* Solids in quadruple precision as a reference for tests, only from the definitions at the head of geometry/solid.h:
 * every crossing of a line with every surface of a shape, containment, and distance to the surface. Each segment
 * between two crossings is classified at its midpoint. Pure; ownership: values. */
#pragma once

#include "geometry/solid.h"
#include "quad.h"

enum { REFERENCE_CROSSINGS_MAX = 16 }; /* of one shape with a line */

typedef struct reference_line {
    quad3 o, d;
} reference_line; /* d need not be of unit length */

static inline quad3 reference_at(const reference_line *line, quad t)
{
    return quad3_add(line->o, quad3_scale(line->d, t));
}

static inline reference_line reference_local(const solid_shape *s, const reference_line *line)
{
    reference_line l = {quad3_turn(quad3_sub(line->o, quad3_from(s->position)), s->rotation_deg, 1),
                        quad3_turn(line->d, s->rotation_deg, 1)};
    return l;
}

/* The normal of a prism's side, and its distance from the axis. */
static inline quad3 reference_prism_side(const solid_shape *s, int k, quad *apart)
{
    quad sine, cosine, half_sine;
    quad_sincos_deg((quad)180 * (2 * k + 1) / (quad)s->sides, &sine, &cosine);
    quad_sincos_deg((quad)180 / (quad)s->sides, &half_sine, apart);
    *apart *= s->radius;
    return quad3_make(sine, 0, -cosine);
}

/* a t^2 + 2 b t + c = 0 */
static inline int reference_quadratic(quad a, quad b, quad c, quad *t)
{
    quad discriminant = b * b - a * c;
    if (a == 0 || discriminant < 0)
        return 0;
    quad root = quad_sqrt(discriminant);
    t[0] = (-b - root) / a;
    t[1] = (-b + root) / a;
    return 2;
}

static inline int reference_side(const reference_line *l, quad m, quad radius, quad *t)
{
    return reference_quadratic(l->d.x * l->d.x + m * m * l->d.z * l->d.z, l->o.x * l->d.x + m * m * l->o.z * l->d.z,
                               l->o.x * l->o.x + m * m * l->o.z * l->o.z - radius * radius, t);
}

static inline int reference_level(quad o, quad d, quad level, quad *t)
{
    *t = d == 0 ? 0 : (level - o) / d;
    return d != 0;
}

static inline quad reference_polynomial(const quad *c, int degree, quad t)
{
    quad sum = c[degree];
    for (int k = degree - 1; k >= 0; k--)
        sum = sum * t + c[k];
    return sum;
}

/* Roots of c[0] + c[1] t + ... between low and high, ascending: between the extrema, by bisection and Newton steps. */
static inline int reference_roots(const quad *c, int degree, quad low, quad high, quad *roots)
{
    quad slope[4], ends[5];
    int count = 0;
    ends[0] = low;
    if (degree > 1) {
        for (int k = 0; k < degree; k++)
            slope[k] = (k + 1) * c[k + 1];
        count = reference_roots(slope, degree - 1, low, high, ends + 1);
    }
    ends[count + 1] = high;
    int found = 0;
    for (int k = 0; k <= count; k++) {
        quad a = ends[k], b = ends[k + 1], at_a = reference_polynomial(c, degree, a);
        if ((at_a < 0) == (reference_polynomial(c, degree, b) < 0))
            continue;
        quad t = (a + b) / 2;
        for (int step = 0; step < 200 && b - a > (quad)1e-33 * (1 + quad_abs(t)); step++) {
            const quad here = reference_polynomial(c, degree, t);
            if ((here < 0) == (at_a < 0))
                a = t;
            else
                b = t;
            quad fall = degree * c[degree]; /* the derivative */
            for (int i = degree - 1; i > 0; i--)
                fall = fall * t + i * c[i];
            const quad next = step % 3 == 2 || fall == 0 ? (a + b) / 2 : t - here / fall;
            if (quad_abs(next - t) <= (quad)1e-32 * (1 + quad_abs(t)))
                break;
            t = next > a && next < b ? next : (a + b) / 2;
        }
        roots[found++] = t;
    }
    return found;
}

/* (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + z^2), with t measured from the point nearest to the centre. */
static inline int reference_torus(const reference_line *l, quad R, quad r, quad *t)
{
    const quad a = quad3_dot(l->d, l->d), middle = -quad3_dot(l->o, l->d) / a;
    const quad3 q = reference_at(l, middle);
    const quad k = quad3_dot(q, q) + R * R - r * r, b = quad3_dot(q, l->d);
    const quad across = l->d.x * l->d.x + l->d.z * l->d.z, rises = q.x * l->d.x + q.z * l->d.z;
    const quad c[5] = {k * k - 4 * R * R * (q.x * q.x + q.z * q.z), 4 * k * b - 8 * R * R * rises,
                       4 * b * b + 2 * a * k - 4 * R * R * across, 4 * a * b, a * a};
    const quad reach = 2 * (R + r) / quad_sqrt(a);
    const int n = reference_roots(c, 4, -reach, reach, t);
    for (int i = 0; i < n; i++)
        t[i] += middle;
    return n;
}

/* A side of a lens: c (x^2 + z^2 + (1 + k) u^2) = 2 u, with u from its vertex towards its centre of curvature and c >
 * 0; a flat side has c = 0 and u into the lens. */
typedef struct reference_lens_side {
    quad c, stretch, vertex, up;
    int concave;
} reference_lens_side;

static inline reference_lens_side reference_lens_side_of(const solid_shape *s, int k)
{
    const quad radius = k == 0 ? s->radius_1 : s->radius_2, inwards = k == 0 ? 1 : -1;
    const int concave = radius * inwards < 0;
    return (reference_lens_side){.c = radius == 0 ? 0 : 1 / quad_abs(radius),
                                 .stretch = 1 + (quad)(k == 0 ? s->conic_1 : s->conic_2),
                                 .vertex = k == 0 ? 0 : s->thickness,
                                 .up = concave ? -inwards : inwards,
                                 .concave = concave};
}

static inline int reference_lens_side_crossings(const reference_line *l, const reference_lens_side *e, quad *t)
{
    const quad u = e->up * (l->o.y - e->vertex), du = e->up * l->d.y;
    const quad a = e->c * (l->d.x * l->d.x + l->d.z * l->d.z + e->stretch * du * du),
               b = e->c * (l->o.x * l->d.x + l->o.z * l->d.z + e->stretch * u * du) - du,
               c = e->c * (l->o.x * l->o.x + l->o.z * l->o.z + e->stretch * u * u) - 2 * u;
    const quad discriminant = b * b - a * c;
    if (discriminant < 0)
        return 0;
    const quad q = -(b + (b < 0 ? -1 : 1) * quad_sqrt(discriminant)); /* no cancellation where a is small */
    int n = 0;
    if (a != 0)
        t[n++] = q / a;
    if (q != 0)
        t[n++] = c / q;
    return n;
}

/* Signed distance from a side's conic, extended, to first order. */
static inline quad reference_from_conic(const reference_lens_side *e, quad3 p)
{
    const quad u = e->up * (p.y - e->vertex), rho2 = p.x * p.x + p.z * p.z, along = e->c * e->stretch * u - 1;
    return (e->c * (rho2 + e->stretch * u * u) - 2 * u) / (2 * quad_sqrt(e->c * e->c * rho2 + along * along));
}

/* Signed distance from a side, negative within the convex set that it bounds. */
static inline quad reference_from_lens_side(const reference_lens_side *e, quad3 p)
{
    const quad u = e->up * (p.y - e->vertex), beyond = e->c * e->stretch * u;
    if (e->stretch > 0 && beyond >= 1) { /* past an ellipsoid's centre: from its widest circle */
        const quad across = 1 / (e->c * quad_sqrt(e->stretch)) - quad_sqrt(p.x * p.x + p.z * p.z),
                   along = u - 1 / (e->c * e->stretch);
        return -quad_sqrt(across * across + along * along);
    }
    if (e->stretch < 0 && beyond >= 1) /* a hyperboloid's other sheet */
        return -u;
    return reference_from_conic(e, p);
}

static inline quad reference_from_lens(const solid_shape *s, quad3 p)
{
    quad most = quad_sqrt(p.x * p.x + p.z * p.z) - (quad)s->diameter / 2;
    for (int k = 0; k < 2; k++) {
        const reference_lens_side e = reference_lens_side_of(s, k);
        const quad from = reference_from_lens_side(&e, p);
        most = quad_max(most, e.concave ? -from : from);
    }
    return most;
}

/* Every t, positive or negative, where the line crosses one of the shape's surfaces or their extensions; unordered. */
static inline int reference_crossings(const solid_shape *s, const reference_line *line, quad *t)
{
    const reference_line l = reference_local(s, line);
    const double half[3] = {s->size.x / 2, s->size.y / 2, s->size.z / 2};
    const quad o[3] = {l.o.x, l.o.y, l.o.z}, d[3] = {l.d.x, l.d.y, l.d.z};
    int n = 0;
    switch (s->kind) {
    case SHAPE_PLANE: return reference_level(l.o.y, l.d.y, 0, t);
    case SHAPE_SPHERE:
        return reference_quadratic(quad3_dot(l.d, l.d), quad3_dot(l.o, l.d),
                                   quad3_dot(l.o, l.o) - (quad)s->radius * s->radius, t);
    case SHAPE_BOX:
        for (int k = 0; k < 3; k++) {
            n += reference_level(o[k], d[k], -half[k], t + n);
            n += reference_level(o[k], d[k], half[k], t + n);
        }
        return n;
    case SHAPE_CUP:
        n += reference_side(&l, s->m, s->inner_radius, t);
        n += reference_level(l.o.y, l.d.y, s->floor, t + n);
        n += reference_side(&l, s->m, s->radius, t + n);
        n += reference_level(l.o.y, l.d.y, 0, t + n);
        return n + reference_level(l.o.y, l.d.y, s->height, t + n);
    case SHAPE_CYLINDER:
        n += reference_side(&l, s->m, s->radius, t);
        n += reference_level(l.o.y, l.d.y, 0, t + n);
        return n + reference_level(l.o.y, l.d.y, s->height, t + n);
    case SHAPE_CONE: {
        const quad slope = ((quad)s->top_radius - s->radius) / s->height, w = s->radius + slope * l.o.y,
                   dw = slope * l.d.y;
        n += reference_quadratic(l.d.x * l.d.x + l.d.z * l.d.z - dw * dw, l.o.x * l.d.x + l.o.z * l.d.z - w * dw,
                                 l.o.x * l.o.x + l.o.z * l.o.z - w * w, t);
        n += reference_level(l.o.y, l.d.y, 0, t + n);
        return n + reference_level(l.o.y, l.d.y, s->height, t + n);
    }
    case SHAPE_PRISM:
        for (int k = 0; k < s->sides; k++) {
            quad apart;
            const quad3 normal = reference_prism_side(s, k, &apart);
            n += reference_level(quad3_dot(normal, l.o), quad3_dot(normal, l.d), apart, t + n);
        }
        n += reference_level(l.o.y, l.d.y, 0, t + n);
        return n + reference_level(l.o.y, l.d.y, s->height, t + n);
    case SHAPE_TORUS: return reference_torus(&l, s->radius, s->tube_radius, t);
    case SHAPE_LENS:
        for (int k = 0; k < 2; k++) {
            const reference_lens_side e = reference_lens_side_of(s, k);
            n += reference_lens_side_crossings(&l, &e, t + n);
        }
        return n + reference_side(&l, 1, (quad)s->diameter / 2, t + n);
    case SHAPE_MESH:
    case SHAPE_COUNT: break;
    }
    return 0;
}

/* Signed distance to x^2 + m^2 z^2 = radius^2, negative inside; to first order for an ellipse. */
static inline quad reference_from_side(quad3 p, quad m, quad radius)
{
    quad level = quad_sqrt(p.x * p.x + m * m * p.z * p.z);
    if (m == 1 || level == 0)
        return level - radius;
    return (level - radius) * level / quad_sqrt(p.x * p.x + m * m * m * m * p.z * p.z);
}

/* Combines the distances to the two surfaces of a corner: outside both, their hypotenuse; otherwise the larger. */
static inline quad reference_corner(quad a, quad b)
{
    return a > 0 && b > 0 ? quad_sqrt(a * a + b * b) : quad_max(a, b);
}

static inline quad reference_from_cylinder(quad3 p, quad m, quad radius, quad bottom, quad top)
{
    return reference_corner(reference_from_side(p, m, radius), quad_max(bottom - p.y, p.y - top));
}

/* Distance from the shape's surface, negative inside; exact near the surface. */
static inline quad reference_distance(const solid_shape *s, quad3 point)
{
    const quad3 p = quad3_turn(quad3_sub(point, quad3_from(s->position)), s->rotation_deg, 1);
    switch (s->kind) {
    case SHAPE_PLANE: return p.y;
    case SHAPE_SPHERE: return quad3_length(p) - s->radius;
    case SHAPE_BOX: {
        quad x = quad_abs(p.x) - s->size.x / 2, y = quad_abs(p.y) - s->size.y / 2, z = quad_abs(p.z) - s->size.z / 2;
        return reference_corner(reference_corner(x, y), z);
    }
    case SHAPE_CUP: {
        quad hollow = reference_from_cylinder(p, s->m, s->inner_radius, s->floor, 1e30);
        return quad_max(reference_from_cylinder(p, s->m, s->radius, 0, s->height), -hollow);
    }
    case SHAPE_CYLINDER: return reference_from_cylinder(p, s->m, s->radius, 0, s->height);
    case SHAPE_CONE: {
        const quad slope = ((quad)s->top_radius - s->radius) / s->height, slant = quad_sqrt(1 + slope * slope);
        const quad side = (quad_sqrt(p.x * p.x + p.z * p.z) - s->radius - slope * p.y) / slant;
        return quad_max(side, quad_max(-p.y, p.y - s->height));
    }
    case SHAPE_PRISM: {
        quad most = quad_max(-p.y, p.y - s->height);
        for (int k = 0; k < s->sides; k++) {
            quad apart;
            const quad3 normal = reference_prism_side(s, k, &apart);
            most = quad_max(most, quad3_dot(normal, p) - apart);
        }
        return most;
    }
    case SHAPE_TORUS: {
        const quad apart = quad_sqrt(p.x * p.x + p.z * p.z) - s->radius;
        return quad_sqrt(apart * apart + p.y * p.y) - s->tube_radius;
    }
    case SHAPE_LENS: return reference_from_lens(s, p);
    case SHAPE_MESH:
    case SHAPE_COUNT: break;
    }
    return 1;
}

static inline int reference_contains(const solid_shape *s, quad3 point)
{
    return reference_distance(s, point) <= 0;
}

static inline void reference_sort(quad *t, int n)
{
    for (int i = 1; i < n; i++)
        for (int k = i; k > 0 && t[k - 1] > t[k]; k--) {
            quad swap = t[k];
            t[k] = t[k - 1];
            t[k - 1] = swap;
        }
}

/* Every t > after where the line really enters or leaves the shape, in order. */
static inline int reference_events(const solid_shape *s, const reference_line *line, quad after, quad *t)
{
    quad all[REFERENCE_CROSSINGS_MAX];
    const int n = reference_crossings(s, line, all);
    reference_sort(all, n);
    int events = 0;
    for (int i = 0; i < n; i++) {
        quad before = i > 0 ? (all[i - 1] + all[i]) / 2 : all[i] - 1,
             behind = i < n - 1 ? (all[i] + all[i + 1]) / 2 : all[i] + 1;
        if (all[i] > after &&
            reference_contains(s, reference_at(line, before)) != reference_contains(s, reference_at(line, behind)))
            t[events++] = all[i];
    }
    return events;
}
