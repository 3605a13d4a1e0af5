/* Sides of the shape lens of any form; those that are not round (primitives/asphere.h), biconic or toric with cylinders
 * among them, are mirror images of themselves across both of their meridians, so that extremes are looked for in one
 * quadrant. */
#include "base/elementary.h"
#include "geometry/shapes/lens_profile.h"
#include "geometry/shapes/parts.h"

#include <stdio.h>

double lens_height_over(const lens_profile *e, double x, double z)
{
    double by_x, by_z;
    return e->twisted ? e->vertex + asphere_surface(&e->e, x, z, &by_x, &by_z) : lens_height_at(e, sqrt(x * x + z * z));
}

/* --- what is allowed --- */

/* Whether the side's roots stay well above 0 up to a radius, and its curve is not steep. */
static bool reaches(const even_asphere *e, double rim)
{
    enum { STEPS = 256 };
    const double most = 1.0 - ASPHERE_ROOT2_LEAST, C = e->curvature_x, c = e->curvature, rim2 = rim * rim;
    if (e->form == SIDE_BICONIC)
        return fmax(e->stretch_x * C * C, e->stretch * c * c) * rim2 <= most;
    if (e->stretch * c * c * rim2 > most)
        return false;
    for (int i = 0; i <= STEPS; i++) { /* for each z, the root is least at the rim */
        const double z = rim * i / STEPS, a = 1.0 - C * asphere_sag(e, z * z), across2 = C * C * (rim2 - z * z);
        const double root2 = a * a - across2;
        if (!(a > 0.0 && root2 >= ASPHERE_ROOT2_LEAST) || !(fabs(2.0 * z * asphere_slope(e, z * z)) <= 16.0))
            return false;
    }
    return true;
}

static status check_reach(const solid_shape *s, int k, diagnostic *why)
{
    const lens_profile side = lens_profile_of(s, k);
    double low = 0.0, high = lens_rim(s);
    if (reaches(&side.e, high))
        return STATUS_OK;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        *(reaches(&side.e, middle) ? &low : &high) = middle;
    }
    char remedy[160];
    snprintf(remedy, sizeof remedy, "use a diameter of at most %.6g, or larger radii of side %d", 2.0 * low, k + 1);
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "diameter %g is larger than side %d, which ends, or is too steep, "
                    "at a diameter of %.6g",
                    s->diameter, k + 1, 2.0 * low);
}

status lens_twisted_check(const solid_shape *s, int k, diagnostic *why)
{
    const lens_profile e = lens_profile_of(s, k);
    const int n = k + 1;
    char remedy[160];
    if (!isfinite(e.e.curvature_x) || !isfinite(e.e.stretch_x))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers; a radius of 0 is flat",
                        "radius_%d_x or conic_%d_x is not finite", n, n);
    snprintf(remedy, sizeof remedy, "set diameter_%d to 0, or form_%d to round", n, n);
    if (lens_has_ring(&e))
        return diagnose(why, STATUS_BAD_INPUT, remedy,
                        "side %d is not round: its edge is not level, and cannot end in a level ring", n);
    snprintf(remedy, sizeof remedy, "set form_%d to toric or round, or its coefficients to 0", n);
    if (e.e.form == SIDE_BICONIC && (e.e.terms > 0 || e.e.odd_terms > 0))
        return diagnose(why, STATUS_BAD_INPUT, remedy, "side %d is biconic, and has no coefficients", n);
    snprintf(remedy, sizeof remedy, "set a1_%d to 0, or form_%d to round", n, n);
    if (e.e.odd[0] != 0.0)
        return diagnose(why, STATUS_BAD_INPUT, remedy, "side %d is toric: its curve would have a corner", n);
    return check_reach(s, k, why);
}

/* Biconic: h (1 + w) = P is |y|^2 / tau for linear y and concave tau if 1 + k and 1 + K are not negative, which is
 * convex (Boyd and Vandenberghe, Convex Optimization, 3.2.6). Otherwise its polynomial P^2 - 2 P h + Q h^2 and
 * that of a conic turned about a line are of degree 4: a line crosses the side at most four times. A curve that
 * bends as it is turned is convex in all directions. */
static lens_form twisted_form(const solid_shape *s, int k)
{
    const even_asphere e = lens_profile_of(s, k).e;
    const double inwards = k == 0 ? 1.0 : -1.0, C = inwards * e.curvature_x, c = inwards * e.curvature;
    const lens_form of_x = C < 0.0 ? LENS_CONCAVE : LENS_CONVEX, of_z = c < 0.0 ? LENS_CONCAVE : LENS_CONVEX;
    const bool terms = e.terms > 0 || e.odd_terms > 0;
    if (e.form == SIDE_TORIC) {
        double within;
        const lens_form curve = lens_round_form(s, k, &within);
        if (C == 0.0 || curve == LENS_STEEP)
            return curve;
        if (c == 0.0 && !terms)
            return of_x;
        return curve == of_x ? of_x : terms ? LENS_TURNS : LENS_ONE_TURN;
    }
    if (C == 0.0 || c == 0.0)
        return C == 0.0 ? of_z : of_x;
    const bool alike = e.stretch_x >= 0.0 && e.stretch >= 0.0, round = C == c && e.stretch_x == e.stretch;
    return of_x == of_z && (alike || round) ? of_x : LENS_ONE_TURN;
}

lens_form lens_form_of(const solid_shape *s, int k, double *within)
{
    if (!lens_profile_of(s, k).twisted)
        return lens_round_form(s, k, within);
    *within = lens_rim(s);
    return twisted_form(s, k);
}

/* --- extremes --- */

/* What is minimised over a quadrant: up (height(plus) - height(minus)) + across . (x, z). */
typedef struct quadrant_sum {
    lens_profile plus, minus;
    double up, x, z, rim;
} quadrant_sum;

static double value_at(const quadrant_sum *f, double rho, double deg)
{
    double sine, cosine;
    elementary_sincos_deg(deg, &sine, &cosine);
    const double x = rho * cosine, z = rho * sine;
    return f->up * (lens_height_over(&f->plus, x, z) - lens_height_over(&f->minus, x, z)) + f->x * x + f->z * z;
}

/* Golden section search along one coordinate, within one step of the grid. */
static void refine(const quadrant_sum *f, bool radius, double step, double least[3])
{
    const double golden = 0.6180339887498949, most = radius ? f->rim : 90.0;
    double low = fmax(0.0, least[radius ? 0 : 1] - step), high = fmin(most, least[radius ? 0 : 1] + step);
    for (int i = 0; i < 50; i++) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        const double at_a = radius ? value_at(f, a, least[1]) : value_at(f, least[0], a),
                     at_b = radius ? value_at(f, b, least[1]) : value_at(f, least[0], b);
        *(at_a < at_b ? &high : &low) = at_a < at_b ? b : a;
    }
    const double at = 0.5 * (low + high), value = radius ? value_at(f, at, least[1]) : value_at(f, least[0], at);
    if (value < least[2])
        least[radius ? 0 : 1] = at, least[2] = value;
}

/* The radius, the angle and the value of the least one. */
static void least_of_quadrant(const quadrant_sum *f, double least[3])
{
    enum { STEPS = 24, ROUNDS = 4 };
    least[2] = HUGE_VAL;
    for (int i = 0; i <= STEPS; i++)
        for (int j = 0; j <= STEPS; j++) {
            const double value = value_at(f, f->rim * i / STEPS, 90.0 * j / STEPS);
            if (value < least[2])
                least[0] = f->rim * i / STEPS, least[1] = 90.0 * j / STEPS, least[2] = value;
        }
    for (int i = 0; i < ROUNDS; i++) {
        refine(f, true, f->rim / STEPS, least);
        refine(f, false, 90.0 / STEPS, least);
    }
}

static double twisted_gap(const solid_shape *s, double *at)
{
    double least[3];
    const quadrant_sum f = {lens_profile_of(s, 1), lens_profile_of(s, 0), 1.0, 0.0, 0.0, lens_rim(s)};
    least_of_quadrant(&f, least);
    *at = least[0];
    return least[2];
}

double lens_twisted_reach(const solid_shape *s, int k, vec3 d)
{
    double least[3];
    const quadrant_sum f = {
        lens_profile_of(s, k), (lens_profile){.clear = HUGE_VAL}, -d.y, -fabs(d.x), -fabs(d.z), lens_rim(s)};
    least_of_quadrant(&f, least);
    return -least[2];
}

double lens_least_gap(const solid_shape *s, double *at)
{
    if (lens_profile_of(s, 0).twisted || lens_profile_of(s, 1).twisted)
        return twisted_gap(s, at);
    *at = lens_nearest_sides(s);
    return lens_gap_at(s, *at);
}

/* Of a conic, the extremes are at its vertex or its edge. */
static double extreme_of(const solid_shape *s, int k, double up)
{
    const lens_profile e = lens_profile_of(s, k);
    if (e.twisted)
        return lens_twisted_reach(s, k, vec3_make(0.0, up, 0.0));
    return e.aspheric ? lens_reach_of(s, k, 0.0, up) : fmax(up * e.vertex, up * lens_edge(s, k));
}

double lens_lowest_of(const solid_shape *s, int k)
{
    return -extreme_of(s, k, -1.0);
}

double lens_highest_of(const solid_shape *s, int k)
{
    return extreme_of(s, k, 1.0);
}

/* --- drawings --- */

/* Points of the side on its meridians, as flat rings, and four between them: all of them are on the surface. */
static int put_points(const solid_shape *s, int k, int part, double rho, bool between, shape_ring *out)
{
    const lens_profile e = lens_profile_of(s, k);
    const double half = rho * 0.70710678118654752440;
    out[0] = (shape_ring){.part = part, .y = lens_height_over(&e, rho, 0.0), .x = rho};
    out[1] = (shape_ring){.part = part, .y = lens_height_over(&e, 0.0, rho), .z = rho};
    if (between)
        out[2] = (shape_ring){part, lens_height_over(&e, half, half), rho, rho, 4, 45.0};
    return between ? 3 : 2;
}

int lens_twisted_rings(const solid_shape *s, int k, int piece, shape_ring *out)
{
    int count = 0;
    out[count++] = (shape_ring){.part = piece, .y = lens_profile_of(s, k).vertex};
    count += put_points(s, k, piece, 0.5 * lens_rim(s), false, out + count);
    count += put_points(s, k, piece, lens_rim(s), true, out + count);
    return piece ? count + put_points(s, k, 0, lens_rim(s), true, out + count) : count;
}

status lens_twist_mesh(const solid_shape *s, mesh *m, diagnostic *why)
{
    const lens_profile side[2] = {lens_profile_of(s, 0), lens_profile_of(s, 1)};
    for (size_t v = 0; v < m->vertex_count; v++) {
        vec3 *p = &m->vertices[v], *n = &m->normals[v];
        const int k = p->y > 0.5;
        double by_x = 0.0, by_z = 0.0;
        const double rho = sqrt(p->x * p->x + p->z * p->z);
        if (rho <= side[k].clear)
            asphere_surface(&side[k].e, p->x, p->z, &by_x, &by_z);
        p->y = lens_height_over(&side[k], p->x, p->z);
        if (fabs(n->y) > 0.5)
            *n = k == 0 ? vec3_make(by_x, -1.0, by_z) : vec3_make(-by_x, 1.0, -by_z);
    }
    return mesh_move(m, m->vertices, m->normals, why);
}
