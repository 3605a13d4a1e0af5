/* Profiles of lenses: heights, extremes and forms of their sides. */
#include "geometry/shapes/lens_profile.h"

#include "geometry/shapes/parts.h"

lens_profile lens_profile_of(const solid_shape *s, int k)
{
    const double radius = k == 0 ? s->radius_1 : s->radius_2, conic = k == 0 ? s->conic_1 : s->conic_2;
    const double *even = k == 0 ? s->even_1 : s->even_2;
    lens_profile e = {
        .e = {radius == 0.0 ? 0.0 : 1.0 / radius, 1.0 + conic, {even[0], even[1], even[2]}},
        .conic = conic,
        .vertex = k == 0 ? 0.0 : s->thickness,
        .concave = k == 0 ? radius < 0.0 : radius > 0.0,
    };
    e.aspheric = asphere_has_terms(&e.e);
    return e;
}

bool lens_has_asphere(const solid_shape *s)
{
    return lens_profile_of(s, 0).aspheric || lens_profile_of(s, 1).aspheric;
}

double lens_edge(const solid_shape *s, int k)
{
    const lens_profile e = lens_profile_of(s, k);
    return lens_height_at(&e, lens_rim(s));
}

double lens_gap_at(const solid_shape *s, double rho)
{
    const lens_profile one = lens_profile_of(s, 0), two = lens_profile_of(s, 1);
    return lens_height_at(&two, rho) - lens_height_at(&one, rho);
}

/* What is minimised over the radius: up height(second) - up height(first) + out rho. */
typedef struct profile_sum {
    lens_profile plus, minus;
    double up, out;
} profile_sum;

static double sum_at(const profile_sum *f, double rho)
{
    return f->up * (lens_height_at(&f->plus, rho) - asphere_sag(&f->minus.e, rho * rho)) + f->out * rho;
}

/* The radius of the least value within the rim: of equidistant radii, and then by the golden section between the
 * neighbours of the best. */
static double least_within(const profile_sum *f, double rim)
{
    enum { STEPS = 256 };
    int best = 0;
    double least = HUGE_VAL;
    for (int i = 0; i <= STEPS; i++) {
        const double value = sum_at(f, rim * i / STEPS);
        if (value < least)
            best = i, least = value;
    }
    const double share = 0.6180339887498949;
    double low = rim * fmax(0.0, best - 1.0) / STEPS, high = rim * fmin(STEPS, best + 1.0) / STEPS;
    for (int step = 0; step < 60; step++) {
        const double a = high - share * (high - low), b = low + share * (high - low);
        if (sum_at(f, a) < sum_at(f, b))
            high = b;
        else
            low = a;
    }
    const double at = 0.5 * (low + high), sampled = rim * best / STEPS;
    return sum_at(f, at) < least ? at : sampled;
}

/* Where slopes of conics c rho / sqrt(1 - (1 + k) c^2 rho^2) are equal: rho^2 = (c1^2 - c2^2) / (c1^2 c2^2 (k2 - k1)). */
static double nearest_conics(const solid_shape *s)
{
    const lens_profile one = lens_profile_of(s, 0), two = lens_profile_of(s, 1);
    const double a = one.e.curvature * one.e.curvature, b = two.e.curvature * two.e.curvature, rim = lens_rim(s);
    const double rho2 = (a - b) / (a * b * (two.conic - one.conic));
    double nearest = lens_gap_at(s, rim) < s->thickness ? rim : 0.0;
    if (rho2 > 0.0 && rho2 < rim * rim && lens_gap_at(s, sqrt(rho2)) < lens_gap_at(s, nearest))
        nearest = sqrt(rho2);
    return nearest;
}

double lens_nearest_sides(const solid_shape *s)
{
    if (!lens_has_asphere(s))
        return nearest_conics(s);
    const profile_sum gap = {lens_profile_of(s, 1), lens_profile_of(s, 0), 1.0, 0.0};
    return least_within(&gap, lens_rim(s));
}

static const lens_profile level_profile = {.vertex = 0.0};

double lens_reach_of(const solid_shape *s, int k, double out, double up)
{
    const lens_profile e = lens_profile_of(s, k);
    const profile_sum sum = {e, level_profile, -up, -out};
    const double rho = least_within(&sum, lens_rim(s));
    return rho * out + lens_height_at(&e, rho) * up;
}

double lens_lowest_of(const solid_shape *s, int k)
{
    const lens_profile e = lens_profile_of(s, k);
    return e.aspheric ? -lens_reach_of(s, k, 0.0, -1.0) : fmin(e.vertex, lens_edge(s, k));
}

double lens_highest_of(const solid_shape *s, int k)
{
    const lens_profile e = lens_profile_of(s, k);
    return e.aspheric ? lens_reach_of(s, k, 0.0, 1.0) : fmax(e.vertex, lens_edge(s, k));
}

/* --- forms --- */

enum { FORM_PIECES = 256 };

/* The steepest slope of a side with coefficients, and its largest curvature in units of 1 / rim. */
#define SLOPE_MOST 16.0
#define BEND_MOST 0x1p14

/* h = dz/dq + 2 (q - b^2) d2z/dq2 is half the second derivative of the height along a line at a distance b from the
 * axis. It has at most one zero if its derivative, 3 d2z/dq2 + 2 (q - b^2) d3z/dq3, keeps its sign: that is a mean of
 * its values for b^2 = q and b = 0, 3 d2z/dq2 and d/dq (dz/dq + 2 q d2z/dq2). */
static asphere_range turn_of(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to);
    const double c = 0.75 * e->stretch * e->curvature * e->curvature * e->curvature;
    const double across[4] = {6.0 * e->even[0], 18.0 * e->even[1], 36.0 * e->even[2], 0.0},
                 along[4] = {6.0 * e->even[0], 30.0 * e->even[1], 84.0 * e->even[2], 0.0};
    const asphere_range m = asphere_range_of(c * (a * a * a), c * (b * b * b), across, from, to),
                        s = asphere_range_of(c * (a * a * a * a * a), c * (b * b * b * b * b), along, from, to);
    return (asphere_range){fmin(m.low, s.low), fmax(m.high, s.high)};
}

/* The range of what has the sign of the second derivatives: where they are 0 on the axis, divided by the power of q
 * with which they rise there. */
static asphere_range sign_of_bend(const even_asphere *e, double from, double to)
{
    if (e->curvature != 0.0)
        return asphere_bend(e, from, to);
    const int first = e->even[0] != 0.0 ? 0 : e->even[1] != 0.0 ? 1 : 2;
    double along[4] = {0.0}, across[4] = {0.0};
    for (int i = first; i < 3; i++) {
        const double power = 4.0 + 2.0 * i;
        along[i - first] = power * (power - 1.0) * e->even[i], across[i - first] = power * e->even[i];
    }
    const asphere_range m = asphere_range_of(0.0, 0.0, along, from, to),
                        s = asphere_range_of(0.0, 0.0, across, from, to);
    return (asphere_range){fmin(m.low, s.low), fmax(m.high, s.high)};
}

static asphere_range turned(asphere_range r, double inwards)
{
    return inwards > 0.0 ? r : (asphere_range){-r.high, -r.low};
}

static lens_form form_of_asphere(const solid_shape *s, int k, double *within)
{
    const even_asphere e = lens_profile_of(s, k).e;
    const double inwards = k == 0 ? 1.0 : -1.0, rim = lens_rim(s);
    bool convex = true, concave = true, rises = true, falls = true;
    for (int i = 0; i < FORM_PIECES; i++) {
        const double from = rim * rim * i / FORM_PIECES, to = rim * rim * (i + 1) / FORM_PIECES;
        const asphere_range bend = asphere_bend(&e, from, to), sign = turned(sign_of_bend(&e, from, to), inwards),
                            turn = turn_of(&e, from, to);
        const double steep = 2.0 * sqrt(to) * fabs(asphere_slope(&e, to)),
                     bends = rim * fmax(fabs(bend.low), fabs(bend.high));
        convex &= sign.low >= 0.0, concave &= sign.high <= 0.0;
        rises &= turn.low >= 0.0, falls &= turn.high <= 0.0;
        *within = sqrt(from);
        if (!(steep <= SLOPE_MOST && bends <= BEND_MOST))
            return LENS_STEEP;
        if (!(convex || concave || rises || falls))
            return LENS_TURNS;
    }
    *within = rim;
    return convex ? LENS_CONVEX : concave ? LENS_CONCAVE : LENS_ONE_TURN;
}

lens_form lens_form_of(const solid_shape *s, int k, double *within)
{
    const lens_profile e = lens_profile_of(s, k);
    *within = lens_rim(s);
    return e.aspheric ? form_of_asphere(s, k, within) : e.concave ? LENS_CONCAVE : LENS_CONVEX;
}
