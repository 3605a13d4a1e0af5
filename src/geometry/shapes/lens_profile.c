/* Profiles of lenses: heights and extremes of their sides. */
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

static bool lens_has_asphere(const solid_shape *s)
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

/* On the axis, at the rim, or where the slopes of conics c rho / sqrt(1 - (1 + k) c^2 rho^2) are equal: rho^2 = (c1^2 -
 * c2^2) / (c1^2 c2^2 (k2 - k1)). */
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
