/* How the sides of lenses bend: bounds by intervals of q = rho^2, of which a side has 256.
 *
 * Along a line at a distance b from the axis, with q = b^2 + t^2, half the second derivative of a side's height by t is
 *
 *     h = p + 2 (q - b^2) g,  p = dz/dq, g = dp/dq.
 *
 * Where p and g have one sign, so has h. Elsewhere h = 0 at b^2 = B = q + p / (2 g), whose derivative is (3 g^2 - p
 * dg/dq) / (2 g^2). Only B >= 0 counts, where p + 2 q g, half the second derivative along the meridian, has the sign of
 * g: so the side has turned there. If that happens in one interval, in only one of the cases p > 0 > g and p < 0 < g,
 * and B rises in it, then h has at most one zero on either side of the axis, and by Rolle's theorem the line crosses
 * the side at most four times. */
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

/* A lower bound of 3 g^2 - p dg/dq. */
static double least_turning(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    const double *k = e->even;
    const double c3 = 0.25 * e->stretch * c * c * c, c5 = 1.5 * e->stretch * c * c * c3;
    const double first[4] = {0.0, 2.0 * k[0], 3.0 * k[1], 4.0 * k[2]},
                 second[4] = {2.0 * k[0], 6.0 * k[1], 12.0 * k[2], 0.0}, third[4] = {6.0 * k[1], 24.0 * k[2], 0.0, 0.0};
    const asphere_range p = asphere_range_of(0.5 * c * a, 0.5 * c * b, first, from, to),
                        g = asphere_range_of(c3 * a * a * a, c3 * b * b * b, second, from, to),
                        d = asphere_range_of(c5 * a * a * a * a * a, c5 * b * b * b * b * b, third, from, to);
    const double least = g.low > 0.0 || g.high < 0.0 ? fmin(fabs(g.low), fabs(g.high)) : 0.0;
    return 3.0 * least * least - fmax(fmax(p.low * d.low, p.low * d.high), fmax(p.high * d.low, p.high * d.high));
}

/* What is known from the axis up to a radius. */
typedef struct form_so_far {
    bool convex, concave;
    bool falls, rises; /* may B >= 0, with p > 0 > g, or p < 0 < g? */
    bool steady;       /* B rises where it may */
    bool within;       /* such an interval goes on */
    int intervals;
} form_so_far;

static bool turns_once(const form_so_far *f)
{
    return !(f->falls && f->rises) && f->steady && f->intervals <= 1;
}

static void extend(form_so_far *f, const even_asphere *e, double inwards, double from, double to)
{
    const double c = e->curvature;
    const double *k = e->even;
    const double first[4] = {0.0, 2.0 * k[0], 3.0 * k[1], 4.0 * k[2]},
                 second[4] = {2.0 * k[0], 6.0 * k[1], 12.0 * k[2], 0.0},
                 bends[4] = {0.0, 6.0 * k[0], 15.0 * k[1], 28.0 * k[2]};
    const asphere_range p = sign_of(e, 0.5 * c, 1, first, from, to), bend = sign_of(e, 0.5 * c, 3, bends, from, to),
                        g = sign_of(e, 0.25 * e->stretch * c * c * c, 3, second, from, to);
    const bool up = p.low >= 0.0 && bend.low >= 0.0, down = p.high <= 0.0 && bend.high <= 0.0;
    f->convex &= inwards > 0.0 ? up : down;
    f->concave &= inwards > 0.0 ? down : up;
    const bool falls = p.high > 0.0 && g.low < 0.0 && bend.low <= 0.0,
               rises = p.low < 0.0 && g.high > 0.0 && bend.high >= 0.0;
    if (falls || rises) {
        f->steady &= least_turning(e, from, to) >= 0.0;
        f->intervals += !f->within;
    }
    f->within = falls || rises;
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
    form_so_far f = {.convex = true, .concave = true, .steady = true};
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
