/* How the sides of lenses bend: bounds by intervals of q = rho^2, of which a side has 256.
 *
 * Along a line at a distance b from the axis, with q = b^2 + t^2, half the second derivative of a side's height by t is
 *
 *     h = p + 2 (q - b^2) g,  p = dz/dq, g = dp/dq.
 *
 * Where p and g have one sign, so has h. Elsewhere h = 0 at b^2 = q + p / (2 g), whose derivative is (3 g^2 - p dg/dq)
 * / (2 g^2). So if only one of the cases p > 0 > g and p < 0 < g occurs, and 3 g^2 - p dg/dq keeps its sign there, then
 * h has at most one zero on either side of the axis, and by Rolle's theorem the line crosses the side at most four
 * times. The case occurs in one interval: where g = 0, that sign is the direction in which g changes, always the same;
 * and where p = 0, it changes in the direction of g, and returns only in the other case. */
#include "geometry/shapes/lens_profile.h"

enum { FORM_PIECES = 256 };

/* The steepest slope of a side with coefficients, and its largest curvature in units of 1 / rim. */
#define SLOPE_MOST 16.0
#define BEND_MOST 0x1p14

/* sum conic / w^power + k0 + k1 q + k2 q^2 + k3 q^3; if the side has no curvature, divided by the power of q with which
 * the sum rises on the axis: that has its sign. */
static asphere_range sign_of(const even_asphere *e, double conic, int power, const double k[4], double from, double to)
{
    double a = conic, b = conic, shifted[4] = {0.0};
    int first = 0;
    for (int i = 0; i < power; i++)
        a /= asphere_root(e, from), b /= asphere_root(e, to);
    while (e->curvature == 0.0 && first < 3 && k[first] == 0.0)
        first++;
    for (int i = first; i < 4; i++)
        shifted[i - first] = k[i];
    return asphere_range_of(a, b, shifted, from, to);
}

static asphere_range sign_of_bend(const even_asphere *e, double from, double to)
{
    const double c = e->curvature;
    const double *a = e->even;
    const double along[4] = {0.0, 12.0 * a[0], 30.0 * a[1], 56.0 * a[2]},
                 across[4] = {0.0, 4.0 * a[0], 6.0 * a[1], 8.0 * a[2]};
    const asphere_range m = sign_of(e, c, 3, along, from, to), s = sign_of(e, c, 1, across, from, to);
    return (asphere_range){fmin(m.low, s.low), fmax(m.high, s.high)};
}

/* 3 g^2 - p dg/dq */
static asphere_range turning_of(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    const double *k = e->even;
    const double c3 = 0.25 * e->stretch * c * c * c, c5 = 1.5 * e->stretch * c * c * c3;
    const double first[4] = {0.0, 2.0 * k[0], 3.0 * k[1], 4.0 * k[2]},
                 second[4] = {2.0 * k[0], 6.0 * k[1], 12.0 * k[2], 0.0}, third[4] = {6.0 * k[1], 24.0 * k[2], 0.0, 0.0};
    const asphere_range p = asphere_range_of(0.5 * c * a, 0.5 * c * b, first, from, to),
                        g = asphere_range_of(c3 * a * a * a, c3 * b * b * b, second, from, to),
                        d = asphere_range_of(c5 * a * a * a * a * a, c5 * b * b * b * b * b, third, from, to);
    const double most = fmax(fabs(g.low), fabs(g.high)),
                 least = g.low > 0.0 || g.high < 0.0 ? fmin(fabs(g.low), fabs(g.high)) : 0.0;
    const double corners[4] = {p.low * d.low, p.low * d.high, p.high * d.low, p.high * d.high};
    return (asphere_range){
        3.0 * least * least - fmax(fmax(corners[0], corners[1]), fmax(corners[2], corners[3])),
        3.0 * most * most - fmin(fmin(corners[0], corners[1]), fmin(corners[2], corners[3])),
    };
}

/* What is known from the axis up to a radius. */
typedef struct form_so_far {
    bool convex, concave;
    bool falls, rises; /* p > 0 > g, p < 0 < g: may it be? */
    bool up, down;     /* 3 g^2 - p dg/dq >= 0, <= 0 where it may */
} form_so_far;

static bool turns_once(const form_so_far *f)
{
    return !(f->falls && f->rises) && (f->up || f->down);
}

static void extend(form_so_far *f, const even_asphere *e, double inwards, double from, double to)
{
    const double c = e->curvature;
    const double *k = e->even;
    const double first[4] = {0.0, 2.0 * k[0], 3.0 * k[1], 4.0 * k[2]},
                 second[4] = {2.0 * k[0], 6.0 * k[1], 12.0 * k[2], 0.0};
    const asphere_range bend = sign_of_bend(e, from, to), p = sign_of(e, 0.5 * c, 1, first, from, to),
                        g = sign_of(e, 0.25 * e->stretch * c * c * c, 3, second, from, to);
    f->convex &= inwards > 0.0 ? bend.low >= 0.0 : bend.high <= 0.0;
    f->concave &= inwards > 0.0 ? bend.high <= 0.0 : bend.low >= 0.0;
    const bool falls = p.high > 0.0 && g.low < 0.0, rises = p.low < 0.0 && g.high > 0.0;
    if (falls || rises) {
        const asphere_range turning = turning_of(e, from, to);
        f->up &= turning.low >= 0.0, f->down &= turning.high <= 0.0;
    }
    f->falls |= falls, f->rises |= rises;
}

static bool is_steep(const even_asphere *e, double rim, double from, double to)
{
    const asphere_range bend = asphere_bend(e, from, to);
    const double slope = 2.0 * sqrt(to) * fabs(asphere_slope(e, to)),
                 bends = rim * fmax(fabs(bend.low), fabs(bend.high));
    return !(slope <= SLOPE_MOST && bends <= BEND_MOST);
}

static lens_form form_of_asphere(const solid_shape *s, int k, double *within)
{
    const even_asphere e = lens_profile_of(s, k).e;
    const double inwards = k == 0 ? 1.0 : -1.0, rim = lens_rim(s);
    form_so_far f = {.convex = true, .concave = true, .up = true, .down = true};
    for (int i = 0; i < FORM_PIECES; i++) {
        const double from = rim * rim * i / FORM_PIECES, to = rim * rim * (i + 1) / FORM_PIECES;
        *within = sqrt(from);
        if (is_steep(&e, rim, from, to))
            return LENS_STEEP;
        extend(&f, &e, inwards, from, to);
        if (!f.convex && !f.concave && !turns_once(&f))
            return LENS_TURNS;
    }
    *within = rim;
    return f.convex ? LENS_CONVEX : f.concave ? LENS_CONCAVE : LENS_ONE_TURN;
}

lens_form lens_form_of(const solid_shape *s, int k, double *within)
{
    const lens_profile e = lens_profile_of(s, k);
    *within = lens_rim(s);
    return e.aspheric ? form_of_asphere(s, k, within) : e.concave ? LENS_CONCAVE : LENS_CONVEX;
}
