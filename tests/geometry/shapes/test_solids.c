/* Tests of all solids against quadruple precision. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "geometry/primitives/primitive.h"
#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

#define LENS(r1, r2, t, d, k1, k2)                                                                        \
    {                                                                                                     \
        .kind = SHAPE_LENS, .position = {0.1, -0.2, 0.2}, .radius_1 = r1, .radius_2 = r2, .thickness = t, \
        .diameter = d, .conic_1 = k1, .conic_2 = k2                                                       \
    }

static const solid_shape shapes[] = {
    {.kind = SHAPE_PLANE, .position = {0.3, -0.2, 0.1}},
    {.kind = SHAPE_CYLINDER, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .height = 1.95, .m = 1.0},
    {.kind = SHAPE_CYLINDER, .position = {-0.1, -0.4, 0.2}, .radius = 0.8, .height = 1.1, .m = 2.5},
    {.kind = SHAPE_CYLINDER, .position = {-0.1, -0.4, 0.2}, .radius = 0.7, .height = 1.3, .m = 0.4},
    {.kind = SHAPE_CYLINDER, .position = {0.1, -0.4, 0.2}, .radius = 0.9, .height = 1.2, .m = 50.0},
    {.kind = SHAPE_CYLINDER, .position = {0.1, -0.4, 0.2}, .radius = 0.05, .height = 1.2, .m = 0.02},
    {.kind = SHAPE_CYLINDER, .position = {0.0, 0.0, 0.0}, .radius = 0.01, .height = 3.0, .m = 1.0},
    {.kind = SHAPE_CUP,
     .position = {0.0, -0.999, 0.0},
     .radius = 1.0,
     .m = 1.0,
     .inner_radius = 0.9,
     .height = 3.0,
     .floor = 0.1},
    {.kind = SHAPE_CUP,
     .position = {-0.1, -0.6, 0.2},
     .radius = 0.9,
     .m = 2.5,
     .inner_radius = 0.7,
     .height = 1.4,
     .floor = 0.2},
    {.kind = SHAPE_CUP,
     .position = {-0.1, -0.6, 0.2},
     .radius = 0.6,
     .m = 0.4,
     .inner_radius = 0.55,
     .height = 1.5,
     .floor = 0.1},
    {.kind = SHAPE_BOX, .position = {0.2, 0.1, 0.0}, .size = {0.25, 3.0, 0.5}},
    {.kind = SHAPE_SPHERE, .position = {0.1, 0.2, 0.3}, .radius = 0.9},
    {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .height = 1.5, .m = 1.0},
    {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .top_radius = 0.4, .height = 0.9, .m = 1.0},
    {.kind = SHAPE_CONE, .position = {0.1, -0.7, 0.2}, .radius = 0.1, .top_radius = 1.0, .height = 1.1, .m = 1.0},
    {.kind = SHAPE_CONE, .position = {0.1, -0.2, 0.2}, .radius = 1.0, .top_radius = 0.02, .height = 0.05, .m = 1.0},
    {.kind = SHAPE_PRISM, .position = {0.1, -0.7, 0.2}, .radius = 0.95, .sides = 3, .height = 1.5, .m = 1.0},
    {.kind = SHAPE_PRISM, .position = {0.1, -0.3, 0.2}, .radius = 0.8, .sides = 6, .height = 0.7, .m = 1.0},
    {.kind = SHAPE_PRISM, .position = {0.1, -0.3, 0.2}, .radius = 0.9, .sides = 13, .height = 0.9, .m = 1.0},
    {.kind = SHAPE_TORUS, .position = {0.1, 0.2, 0.3}, .radius = 0.7, .tube_radius = 0.25},
    {.kind = SHAPE_TORUS, .position = {-0.1, 0.2, 0.0}, .radius = 0.6, .tube_radius = 0.599},
    {.kind = SHAPE_TORUS, .position = {0.1, -0.2, 0.3}, .radius = 0.9, .tube_radius = 0.002},
    LENS(1.5, -1.2, 0.6, 1.6, 0.0, 0.0), /* biconvex */
    LENS(1.5, 0.0, 0.4, 1.6, 0.0, 0.0),  /* convex and flat */
    LENS(0.0, 0.0, 0.4, 1.6, 0.0, 0.0),  /* a flat window */
    LENS(0.0, 1.5, 0.1, 1.6, 0.0, 0.0),  /* flat and concave */
    LENS(-1.5, 1.2, 0.1, 1.6, 0.0, 0.0), /* biconcave */
    LENS(1.0, 1.5, 0.3, 1.6, 0.0, 0.0),  /* menisci */
    LENS(1.2, 0.9, 0.1, 1.4, 0.0, 0.0),
    LENS(-0.9, -0.85, 0.1, 1.6, 0.0, 0.0),
    LENS(1.0, -1.0, 0.4, 1.2, 0.0, 0.0), /* sharp: thickness 2 (R - sqrt(R^2 - h^2)) */
    LENS(0.6, 0.0, 0.9, 1.2, 0.0, 0.0),  /* hemispheres */
    LENS(-0.6, 0.6, 0.2, 1.2, 0.0, 0.0),
    LENS(0.5, -0.5, 2.1, 0.9, 0.0, 0.0), /* longer than its spheres */
    LENS(1e4, -1e5, 0.2, 1.6, 0.0, 0.0), /* nearly flat */
    LENS(-1e4, 1e5, 0.2, 1.6, 0.0, 0.0),
    LENS(0.8, -0.9, 0.9, 1.6, -1.0, -2.3), /* paraboloid and hyperboloid */
    LENS(-0.8, 0.9, 0.1, 1.6, -1.0, -2.3),
    LENS(1.2, 1.1, 0.3, 1.6, 0.7, -0.5),      /* oblate and prolate ellipsoids */
    LENS(0.02, -0.02, 0.021, 0.02, 0.0, 0.0), /* tiny */
};
static const vec3 turns[] = {
    {0.0, 0.0, 0.0}, {17.0, -33.0, 71.0}, {0.0, 0.0, 30.0}, {90.0, 0.0, 0.0}, {0.1, 180.0, -0.3}};

static vec3 double_of(quad3 v)
{
    return vec3_make((double)v.x, (double)v.y, (double)v.z);
}

/* Reports a failure: the shape, the ray and the result. */
static void report_failure(int good, const char *what, const solid_shape *s, const reference_line *line,
                           const one_hit *h)
{
    if (good)
        return;
    print_error("shape %d turned (%g %g %g): from (%.17g %.17g %.17g) along (%.17g %.17g %.17g): "
                "t %.17g face %d cos_i %g error %g normal (%.17g %.17g %.17g)\n",
                s->kind, s->rotation_deg.x, s->rotation_deg.y, s->rotation_deg.z, (double)line->o.x, (double)line->o.y,
                (double)line->o.z, (double)line->d.x, (double)line->d.y, (double)line->d.z, h->t, (int)h->face,
                h->cos_i, h->error, h->normal.x, h->normal.y, h->normal.z);
    fail_msg("%s", what);
}
#define expect(condition, s, line, h) report_failure(condition, #condition, s, line, h)

static scene_geometry *arrange_one(const solid_shape *shape)
{
    const region_source source = {.shape = shape, .medium = 1, .shadow_transmittance = 1.0};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(&source, 1, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    return a;
}

static reference_line line_of(one_ray r)
{
    return (reference_line){quad3_from(r.o), quad3_from(r.d)};
}

/* The greatest distance of the line from the surface between two crossings, from a few points. */
static quad depth_between(const solid_shape *s, const reference_line *line, quad from, quad to)
{
    quad depth = 0;
    for (int k = 1; k < 8; k++)
        depth = quad_max(depth, quad_abs(reference_distance(s, reference_at(line, from + (to - from) * k / 8))));
    return depth;
}

/* The outward unit normal of a face at a point on it, in the shape's own frame. */
static quad3 normal_of(const solid_shape *s, int64_t face, quad3 p)
{
    const int own = (int)(face % FACES_MAX);
    quad3 n = quad3_make(0, 0, 0);
    quad apart;
    if (s->kind == SHAPE_PLANE)
        n.y = 1;
    else if (s->kind == SHAPE_SPHERE)
        n = p;
    else if (s->kind == SHAPE_TORUS) {
        const quad share = 1 - s->radius / quad_sqrt(p.x * p.x + p.z * p.z);
        n = quad3_make(p.x * share, p.y, p.z * share);
    } else if (s->kind == SHAPE_BOX)
        *(own < 2 ? &n.x : own < 4 ? &n.y : &n.z) = own % 2 ? 1 : -1;
    else if (s->kind == SHAPE_LENS && own > 0) {
        const reference_lens_side e = reference_lens_side_of(s, own - 1);
        const quad along = e.up * e.c * e.stretch * e.up * (p.y - e.vertex) - e.up;
        n = quad3_scale(quad3_make(e.c * p.x, along, e.c * p.z), e.concave ? -1 : 1);
    } else if (s->kind == SHAPE_LENS)
        n = quad3_make(p.x, 0, p.z);
    else if (s->kind == SHAPE_PRISM && own < 2)
        n.y = own == 1 ? 1 : -1;
    else if (s->kind == SHAPE_PRISM)
        n = reference_prism_side(s, own - 2, &apart);
    else if (own > 0)
        n.y = own == 2 ? 1 : -1;
    else if (s->kind == SHAPE_CONE && p.x == 0 && p.z == 0)
        n.y = 1; /* the apex of a cone has no normal */
    else if (s->kind == SHAPE_CONE)
        n = quad3_make(p.x, quad_sqrt(p.x * p.x + p.z * p.z) * ((quad)s->radius - s->top_radius) / s->height, p.z);
    else
        n = quad3_make(p.x, 0, p.z * (quad)s->m * s->m);
    return quad3_scale(n, 1 / quad3_length(n));
}

/* Does the face, extended, contain the point (in its own frame)? */
static quad distance_to_face(const solid_shape *s, int64_t face, quad3 p)
{
    const int part = (int)(face / FACES_MAX), own = (int)(face % FACES_MAX);
    switch (s->kind) {
    case SHAPE_PLANE: return quad_abs(p.y);
    case SHAPE_SPHERE: return quad_abs(quad3_length(p) - s->radius);
    case SHAPE_BOX: {
        const double half = own < 2 ? s->size.x / 2 : own < 4 ? s->size.y / 2 : s->size.z / 2;
        return quad_abs((own < 2 ? p.x : own < 4 ? p.y : p.z) - (own % 2 ? half : -half));
    }
    case SHAPE_CUP:
        if (own == 0)
            return quad_abs(reference_from_side(p, s->m, part ? s->inner_radius : s->radius));
        return quad_abs(p.y - (own == 1 ? (part ? s->floor : 0.0) : s->height));
    case SHAPE_CYLINDER:
        return own == 0 ? quad_abs(reference_from_side(p, s->m, s->radius))
                        : quad_abs(p.y - (own == 1 ? 0.0 : s->height));
    case SHAPE_PRISM: {
        quad apart;
        const quad3 normal = reference_prism_side(s, own - 2, &apart);
        return quad_abs(own < 2 ? p.y - own * s->height : quad3_dot(normal, p) - apart);
    }
    case SHAPE_CONE:
        if (own == 0) {
            const quad slope = ((quad)s->top_radius - s->radius) / s->height;
            const quad apart = quad_sqrt(p.x * p.x + p.z * p.z) - s->radius - slope * p.y;
            return quad_abs(apart) / quad_sqrt(1 + slope * slope);
        }
        return quad_abs(p.y - (own == 1 ? 0.0 : s->height));
    case SHAPE_TORUS:
        return quad_abs(reference_distance(s, quad3_add(quad3_turn(p, s->rotation_deg, 0), quad3_from(s->position))));
    case SHAPE_LENS: {
        const reference_lens_side e = reference_lens_side_of(s, own == 2);
        return quad_abs(own == 0 ? reference_from_side(p, 1, (quad)s->diameter / 2) : reference_from_conic(&e, p));
    }
    case SHAPE_MESH:
    case SHAPE_COUNT: break;
    }
    return 1;
}

/* The smaller radius of curvature of a lens's side at its vertex or at its rim, where it is (R^2 - k rho^2)^(3/2) / R^2
 * along the meridian. */
static double least_side_radius(const solid_shape *s, int k)
{
    const double r = fabs(k == 0 ? s->radius_1 : s->radius_2), conic = k == 0 ? s->conic_1 : s->conic_2;
    return r == 0.0 ? HUGE_VAL : fmin(r, pow(r * r - conic * s->diameter * s->diameter / 4, 1.5) / (r * r));
}

/* The smallest radius of curvature; for a cone, that of its circle at the point. */
static double least_radius(const solid_shape *s, quad3 p)
{
    if (s->kind == SHAPE_CONE)
        return (double)quad_sqrt(p.x * p.x + p.z * p.z);
    if (s->kind == SHAPE_LENS)
        return fmin(0.5 * s->diameter, fmin(least_side_radius(s, 0), least_side_radius(s, 1)));
    if (s->kind == SHAPE_TORUS)
        return fmin(s->tube_radius, s->radius - s->tube_radius);
    const double m = s->kind == SHAPE_CYLINDER || s->kind == SHAPE_CUP ? s->m : 1.0;
    return (s->kind == SHAPE_CUP ? s->inner_radius : s->radius) * (m > 1.0 ? 1.0 / (m * m) : m);
}

static void check_point(const solid_shape *s, const scene_geometry *a, const reference_line *line, const one_hit *h)
{
    const quad3 p = quad3_from(h->point), d = quad3_scale(line->d, 1 / quad3_length(line->d)),
                n = quad3_from(h->normal);
    const quad3 local = quad3_turn(quad3_sub(p, quad3_from(s->position)), s->rotation_deg, 1);
    expect(quad_abs(reference_distance(s, p)) <= h->error, s, line, h);
    expect(distance_to_face(s, h->face, local) <= h->error, s, line, h);
    /* projected onto the surface along the radius, which is oblique on an ellipse */
    const double lean = s->kind != SHAPE_CYLINDER && s->kind != SHAPE_CUP ? 1.0 : s->m > 1.0 ? s->m : 1.0 / s->m;
    expect(quad3_length(quad3_sub(p, reference_at(line, h->t))) <= h->error * lean, s, line, h);
    expect(quad_abs(reference_distance(s, reference_at(line, h->t))) <= h->error, s, line, h);
    /* 16 roundings of the sum of magnitudes, and not more */
    expect(h->error <= 4e-15 * (3.0 * vec3_length(double_of(line->o)) + 2.0 * h->t + 6.0 * a->extent), s, line, h);
    const quad3 outward = quad3_turn(normal_of(s, h->face, local), s->rotation_deg, 0);
    const double curved = s->kind == SHAPE_PLANE || s->kind == SHAPE_BOX || s->kind == SHAPE_PRISM
                              ? 0.0
                              : h->error / least_radius(s, local);
    expect(quad_abs(quad3_length(n) - 1) <= 1e-15, s, line, h);
    expect(quad3_length(quad3_sub(n, quad3_scale(outward, quad3_dot(outward, n) < 0 ? -1 : 1))) <= 2e-15 + curved, s,
           line, h);
    expect(quad3_dot(n, d) <= 2e-15, s, line, h);
    expect(h->cos_i > 0.0 && h->cos_i <= 1.0, s, line, h);
    expect(quad_abs(h->cos_i - quad_max(-quad3_dot(n, d), 0)) <= 2e-15, s, line, h);
}

/* One ray against quadruple precision. Before the hit (everywhere, for a miss) the ray is where it should be within the
 * error bound: it crosses other surfaces by no more than that; and the hit is on the surface, which check_point
 * verifies. */
static void check_ray(const solid_shape *s, const scene_geometry *a, one_ray r)
{
    const reference_line line = line_of(r);
    quad t[REFERENCE_CROSSINGS_MAX];
    const int events = reference_events(s, &line, 0, t);
    const one_hit h = nearest_interface(a, r);
    const int missed = h.hit_primitive < 0;
    for (int k = 0; k < events && (missed || t[k] < h.t); k += 2) {
        const double bound = missed ? 4e-15 * (3.0 * vec3_length(r.o) + 6.0 * a->extent + 2.0 * (double)t[k]) : h.error;
        quad until = k + 1 < events ? t[k + 1] : t[k] + 1;
        if (!missed && h.t < until)
            until = h.t;
        expect(depth_between(s, &line, t[k], until) <= bound, s, &line, &h);
    }
    if (missed)
        return;
    check_point(s, a, &line, &h);
    expect(h.before == (reference_contains(s, reference_at(&line, 0)) ? 1 : 0), s, &line, &h);
    expect(h.after == 1 - h.before, s, &line, &h);
}

/* A start well off the surface, so that inside and outside are not a matter of rounding. */
static int start_at(const solid_shape *s, const scene_geometry *a, vec3 o, one_ray *r)
{
    const double clear = 1e-9 * (1.0 + vec3_length(o));
    if (quad_abs(reference_distance(s, quad3_from(o))) < clear)
        return 0;
    *r = (one_ray){.o = o, .start = FACE_NONE, .inside = scene_geometry_inside(a, o)};
    return 1;
}

static void aim(const solid_shape *s, const scene_geometry *a, vec3 from, vec3 direction)
{
    one_ray r;
    if (!start_at(s, a, from, &r))
        return;
    r.d = vec3_normalize(direction);
    check_ray(s, a, r);
}

typedef void ray_maker(const solid_shape *s, const scene_geometry *a, uint64_t *seed);

static void for_all_shapes_at(vec3 away, ray_maker *make, int rays)
{
    uint64_t seed = 11;
    for (size_t i = 0; i < COUNT(shapes); i++) {
        for (size_t k = 0; k < COUNT(turns); k++) {
            solid_shape s = shapes[i];
            s.rotation_deg = turns[k];
            s.position = vec3_add(s.position, away);
            scene_geometry *a = arrange_one(&s);
            for (int n = 0; n < rays; n++)
                make(&s, a, &seed);
            scene_geometry_destroy(a);
        }
    }
}

static void for_all_shapes(ray_maker *make, int rays)
{
    for_all_shapes_at(vec3_make(0.0, 0.0, 0.0), make, rays);
}

/* An important point of the shape, in the world: its centre, a rim, an edge, a corner, or anywhere near it. */
static vec3 place_on(const solid_shape *s, uint64_t *seed)
{
    static const double eighths[] = {-1.0, 1.0, 0.0, 0.5};
    const double turn = random_real(seed, 0.0, 6.3), level = random_below(seed, 2) ? s->height : 0.0;
    vec3 p = random_point(seed, 1.0);
    if (s->kind == SHAPE_BOX && random_below(seed, 3))
        p = vec3_make(eighths[random_below(seed, 4)] * s->size.x / 2, eighths[random_below(seed, 4)] * s->size.y / 2,
                      eighths[random_below(seed, 4)] * s->size.z / 2);
    else if (s->kind == SHAPE_TORUS && random_below(seed, 3)) {
        const double across = eighths[random_below(seed, 4)], up = eighths[random_below(seed, 4)],
                     from_axis = s->radius + across * s->tube_radius;
        p = vec3_make(from_axis * cos(turn), up * s->tube_radius, from_axis * sin(turn));
    } else if (s->kind == SHAPE_LENS && random_below(seed, 5)) {
        const double rim = 0.5 * s->diameter, rho = random_below(seed, 2) ? rim : rim * random_real(seed, 0.0, 1.0);
        const int k = random_below(seed, 2);
        const double r = k == 0 ? s->radius_1 : s->radius_2, c = r == 0.0 ? 0.0 : 1.0 / r,
                     stretch = 1.0 + (k == 0 ? s->conic_1 : s->conic_2),
                     sag = c * rho * rho / (1.0 + sqrt(fmax(0.0, 1.0 - stretch * c * c * rho * rho)));
        p = vec3_make(rho * cos(turn), k * s->thickness + sag, rho * sin(turn));
    } else if (s->kind == SHAPE_CONE && random_below(seed, 3)) {
        const double up = random_below(seed, 2) ? level : random_real(seed, 0.0, s->height);
        const double w = s->radius + (s->top_radius - s->radius) * (up / s->height);
        p = vec3_make(w * cos(turn), up, w * sin(turn));
    } else if (s->radius > 0.0 && s->height > 0.0 && random_below(seed, 3))
        p = s->kind == SHAPE_CUP && random_below(seed, 2)
                ? vec3_make(s->inner_radius * cos(turn), level > 0.0 ? level : s->floor,
                            s->inner_radius * sin(turn) / s->m)
                : vec3_make(s->radius * cos(turn), random_below(seed, 2) ? level : random_real(seed, 0.0, s->height),
                            s->radius * sin(turn) / s->m);
    return vec3_add(double_of(quad3_turn(quad3_from(p), s->rotation_deg, 0)), s->position);
}

static void from_near(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    vec3 from = random_point(seed, random_below(seed, 2) ? 4.0 : 1.0);
    aim(s, a, from, vec3_sub(place_on(s, seed), from));
    aim(s, a, from, random_direction(seed));
}

static void random_rays_agree_with_quadruple_precision(void **state)
{
    (void)state;
    for_all_shapes(from_near, trials_of(600));
}

static void from_far(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    vec3 from = vec3_scale(random_direction(seed), exp(random_real(seed, 2.0, 11.5)));
    aim(s, a, from, vec3_sub(place_on(s, seed), from));
}

static void distant_rays_agree_with_quadruple_precision(void **state)
{
    (void)state;
    for_all_shapes(from_far, trials_of(400));
}

static void from_beside(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    vec3 from = vec3_add(s->position, random_point(seed, 3.0));
    aim(s, a, from, vec3_sub(place_on(s, seed), from));
}

/* Ray and solid are near each other and both far from the origin: world coordinates are coarse there, and the error
 * bound must include that. */
static void solids_far_from_the_origin_agree_with_quadruple_precision(void **state)
{
    (void)state;
    for_all_shapes_at(vec3_make(3000.1, -7000.7, 5000.3), from_beside, trials_of(400));
}

/* Along a local axis except for a component that is 0, -0 or tiny. */
static void along_an_axis(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    static const double little[] = {0.0,    -0.0,   1e-320, -1e-310, 1e-300, -1e-200, 1e-160,
                                    1e-100, -1e-20, 1e-16,  -1e-12,  1e-8,   -1e-4};
    double d[3];
    const int axis = random_below(seed, 3);
    for (int k = 0; k < 3; k++)
        d[k] = k == axis ? (random_below(seed, 2) ? 1.0 : -1.0) : little[random_below(seed, COUNT(little))];
    vec3 local = vec3_make(d[0], d[1], d[2]);
    vec3 direction = random_below(seed, 2) ? local : double_of(quad3_turn(quad3_from(local), s->rotation_deg, 0));
    vec3 to = place_on(s, seed),
         from = vec3_sub(to, vec3_scale(vec3_normalize(direction), random_real(seed, 0.0, 4.0)));
    aim(s, a, from, direction);
}

static void axis_aligned_rays_agree_with_quadruple_precision(void **state)
{
    (void)state;
    for_all_shapes(along_an_axis, trials_of(800));
}

/* Past a point of the surface in its tangent plane, at a height from 1e-14 to 1 above or below it. */
static void grazing(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    vec3 from = random_point(seed, 3.0);
    one_ray r;
    if (!start_at(s, a, from, &r))
        return;
    r.d = vec3_normalize(vec3_sub(place_on(s, seed), from));
    const one_hit h = nearest_interface(a, r);
    if (h.hit_primitive < 0)
        return;
    vec3 along = vec3_normalize(vec3_cross(h.normal, random_direction(seed)));
    const double off = exp(random_real(seed, -32.0, 0.0)) * (random_below(seed, 2) ? 1.0 : -1.0),
                 tilt = exp(random_real(seed, -32.0, 0.0));
    vec3 back = vec3_sub(vec3_add(h.point, vec3_scale(h.normal, off)), vec3_scale(along, random_real(seed, 0.1, 5.0)));
    aim(s, a, back, along);
    aim(s, a, back, vec3_sub(along, vec3_scale(h.normal, tilt)));
}

static void grazing_rays_agree_with_quadruple_precision(void **state)
{
    (void)state;
    for_all_shapes(grazing, trials_of(400));
}

/* The length of a line's chords within the solid, from hit to hit. */
static double chord(const scene_geometry *a, vec3 from, vec3 direction)
{
    one_ray r = {.o = from, .d = direction, .start = FACE_NONE};
    double length = 0.0;
    for (int k = 0; k < REFERENCE_CROSSINGS_MAX; k++) {
        const one_hit h = nearest_interface(a, r);
        if (h.hit_primitive < 0)
            return length;
        length += h.before == 1 ? h.t : 0.0;
        r = (one_ray){.o = h.point, .d = direction, .start = h.face, .inside = h.inside_after};
    }
    fail_msg("a line leaves no cup after %d crossings", REFERENCE_CROSSINGS_MAX);
    return 0.0;
}

/* Cavalieri: a solid's volume is the integral of its chords over a plane across them, here by the midpoints of STEPS x
 * STEPS cells. An ellipse of half axes r and r / m has the area pi r^2 / m; a cup is one such cylinder minus
 * another. */
static void the_volume_of_an_elliptic_cup_equals_its_closed_form(void **state)
{
    (void)state;
    enum { STEPS = 400 };
    const double pi = acos(-1.0), reach = 3.5, cell = 2.0 * reach / STEPS;
    const vec3 directions[] = {{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.3, -0.5, 0.8}};
    for (size_t k = 0; k < COUNT(shapes); k++) {
        solid_shape s = shapes[k];
        if (s.kind != SHAPE_CUP)
            continue;
        s.rotation_deg = vec3_make(17.0, -33.0, 71.0);
        scene_geometry *a = arrange_one(&s);
        const double outside = s.radius * s.radius * s.height,
                     hollow = s.inner_radius * s.inner_radius * (s.height - s.floor);
        for (size_t j = 0; j < COUNT(directions); j++) {
            const vec3 d = vec3_normalize(directions[j]);
            const vec3 u = vec3_normalize(vec3_cross(d, vec3_make(0.2, 0.4, 0.9))), v = vec3_cross(d, u);
            const vec3 middle = vec3_add(s.position, vec3_scale(d, -10.0));
            double volume = 0.0;
            for (int i = 0; i < STEPS * STEPS; i++) {
                const double x = (i % STEPS + 0.5) * cell - reach, y = (i / STEPS + 0.5) * cell - reach;
                volume += cell * cell * chord(a, vec3_add(middle, vec3_add(vec3_scale(u, x), vec3_scale(v, y))), d);
            }
            const double expected = pi / s.m * (outside - hollow);
            if (!(fabs(volume - expected) < 0.01 * expected))
                fail_msg("m %g: %.6g instead of %.6g", s.m, volume, expected);
        }
        scene_geometry_destroy(a);
    }
}

static bool in_chords(const interval *chords, int count, double t)
{
    bool inside = false;
    for (int i = 0; i < count; i++)
        inside |= chords[i].in < t && t < chords[i].out;
    return inside;
}

/* Just inside and just outside of both ends, where the line does not graze the surface. */
static void check_ends(const primitive *p, vec3 from, vec3 d, interval chord)
{
    const double hair = 1e-6, ends[] = {chord.in, chord.out};
    if (chord.out - chord.in < 0.01)
        return;
    for (int i = 0; i < 2; i++) {
        const double inwards = i == 0 ? hair : -hair;
        if (isinf(ends[i]))
            continue;
        assert_true(primitive_contains(p, vec3_add(from, vec3_scale(d, ends[i] + inwards))));
        assert_false(primitive_contains(p, vec3_add(from, vec3_scale(d, ends[i] - inwards))));
    }
}

static void check_chords(const solid_shape *s, const scene_geometry *a, uint64_t *seed)
{
    const vec3 from = random_point(seed, 4.0), d = vec3_normalize(vec3_sub(place_on(s, seed), from));
    for (int k = 0; k < a->primitive_count; k++) {
        interval chords[CHORDS_MAX];
        const primitive *p = &a->primitives[k];
        const int count = primitive_chords(p, from, d, chords);
        for (int n = 0; n < 8; n++) {
            const double t = random_real(seed, -3.0, 9.0);
            double nearest = HUGE_VAL;
            for (int i = 0; i < count; i++)
                nearest = fmin(nearest, fmin(fabs(t - chords[i].in), fabs(t - chords[i].out)));
            if (nearest > 1e-9)
                assert_int_equal(in_chords(chords, count, t), primitive_contains(p, vec3_add(from, vec3_scale(d, t))));
        }
        for (int i = 0; i < count; i++)
            check_ends(p, from, d, chords[i]);
    }
}

/* By the definition of each primitive. */
static void chords_are_where_a_line_is_inside(void **state)
{
    (void)state;
    for_all_shapes(check_chords, trials_of(400));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rays_agree_with_quadruple_precision),
        cmocka_unit_test(distant_rays_agree_with_quadruple_precision),
        cmocka_unit_test(solids_far_from_the_origin_agree_with_quadruple_precision),
        cmocka_unit_test(axis_aligned_rays_agree_with_quadruple_precision),
        cmocka_unit_test(grazing_rays_agree_with_quadruple_precision),
        cmocka_unit_test(the_volume_of_an_elliptic_cup_equals_its_closed_form),
        cmocka_unit_test(chords_are_where_a_line_is_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
