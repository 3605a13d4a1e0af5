/* Profiles of lenses: heights and extremes of their sides, and how they bend. */
#include "geometry/shapes/lens_profile.h"
#include "geometry/shapes/parts.h"

lens_profile lens_profile_of(const solid_shape *s, int k)
{
    const double radius = k == 0 ? s->radius_1 : s->radius_2, conic = k == 0 ? s->conic_1 : s->conic_2;
    const double diameter = k == 0 ? s->diameter_1 : s->diameter_2;
    const bool ring = diameter > 0.0 && diameter < s->diameter;
    lens_profile e = {
        .e = asphere_of(radius == 0.0 ? 0.0 : 1.0 / radius, conic, k == 0 ? s->even_1 : s->even_2),
        .conic = conic,
        .vertex = k == 0 ? 0.0 : s->thickness,
        .clear = ring ? 0.5 * diameter : HUGE_VAL,
        .concave = k == 0 ? radius < 0.0 : radius > 0.0,
    };
    asphere_add_odd(&e.e, k == 0 ? s->odd_1 : s->odd_2);
    const double across = k == 0 ? s->radius_1_x : s->radius_2_x;
    const side_form form = (side_form)(k == 0 ? s->form_1 : s->form_2);
    e.twisted = form != SIDE_ROUND && (radius != 0.0 || across != 0.0 || asphere_has_terms(&e.e));
    if (e.twisted) {
        e.e.form = form, e.e.curvature_x = across == 0.0 ? 0.0 : 1.0 / across;
        e.e.stretch_x = 1.0 + (k == 0 ? s->conic_1_x : s->conic_2_x);
    }
    e.aspheric = asphere_has_terms(&e.e);
    return e;
}

double lens_clear_of(const solid_shape *s, int k)
{
    return fmin(lens_rim(s), lens_profile_of(s, k).clear);
}

static bool is_conic(const lens_profile *e)
{
    return !e->aspheric && !lens_has_ring(e);
}

double lens_seen_of(const solid_shape *s, int k)
{
    return fmin(lens_end(s, k), lens_profile_of(s, k).clear);
}

double lens_edge(const solid_shape *s, int k)
{
    const lens_profile e = lens_profile_of(s, k);
    return lens_height_at(&e, lens_end(s, k));
}

double lens_rim_edge(const solid_shape *s, int k)
{
    return lens_edge(s, k) + (k == 0 ? 1.0 : -1.0) * lens_chamfer(s, k);
}

double lens_gap_at(const solid_shape *s, double rho)
{
    const lens_profile one = lens_profile_of(s, 0), two = lens_profile_of(s, 1);
    return lens_height_at(&two, rho) - lens_height_at(&one, rho);
}

/* The function that is minimised over the radius: up (height(plus) - height(minus)) + out rho. */
typedef struct profile_sum {
    lens_profile plus, minus;
    double up, out;
} profile_sum;

static double sum_at(const profile_sum *f, double rho)
{
    return f->up * (lens_height_at(&f->plus, rho) - (lens_height_at(&f->minus, rho) - f->minus.vertex)) + f->out * rho;
}

/* The radius of the least value within the rim: the best of equidistant radii, then golden section search between its
 * neighbours; or where a ring begins. */
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
    const double golden = 0.6180339887498949;
    double low = rim * fmax(0.0, best - 1.0) / STEPS, high = rim * fmin(STEPS, best + 1.0) / STEPS;
    for (int step = 0; step < 60; step++) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (sum_at(f, a) < sum_at(f, b))
            high = b;
        else
            low = a;
    }
    double at = rim * best / STEPS;
    const double others[] = {0.5 * (low + high), fmin(rim, f->plus.clear), fmin(rim, f->minus.clear)};
    for (int i = 0; i < 3; i++)
        if (sum_at(f, others[i]) < least)
            at = others[i], least = sum_at(f, at);
    return at;
}

/* The radius at which two conics are nearest: on the axis, at the rim, or where their slopes c rho / sqrt(1 - (1 + k)
 * c^2 rho^2) are equal: rho^2 = (c1^2 - c2^2) / (c1^2 c2^2 (k2 - k1)). */
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
    const profile_sum gap = {lens_profile_of(s, 1), lens_profile_of(s, 0), 1.0, 0.0};
    if (is_conic(&gap.plus) && is_conic(&gap.minus))
        return nearest_conics(s);
    return least_within(&gap, lens_rim(s));
}

static const lens_profile level_profile = {.vertex = 0.0, .clear = HUGE_VAL};

double lens_reach_of(const solid_shape *s, int k, double out, double up)
{
    const lens_profile e = lens_profile_of(s, k);
    const profile_sum sum = {e, level_profile, -up, -out};
    const double rho = least_within(&sum, lens_end(s, k));
    return rho * out + lens_height_at(&e, rho) * up;
}

/* --- how the sides bend ---
 *
 * Bounds by interval arithmetic, on 256 intervals of q = rho^2 per side.
 *
 * Along a line at a distance b from the axis, with q = b^2 + t^2, half the second derivative of a side's height by t is
 *
 *     h = p + 2 (q - b^2) g,  p = dz/dq, g = dp/dq.
 *
 * If p and g have the same sign, so has h. Otherwise h = 0 at b^2 = B = q + p / (2 g), whose derivative is (3 g^2 - p
 * dg/dq) / (2 g^2). Only B >= 0 counts; there p + 2 q g, half the second derivative along the meridian, has the sign of
 * g: the side may have turned. In each interval of q in which that is possible, with p > 0 > g or with p < 0 < g, h has
 * at most as many zeros on either side of the axis as B has monotonic branches: one more than T = 3 g^2 - p dg/dq has
 * changes of sign. T changes it at most once where dT/dq = 5 g dg/dq - p d^2g/dq^2 keeps its own. With n zeros the line
 * crosses the side at most 2 n + 2 times, by Rolle's theorem. */

enum { FORM_PIECES = 256, TURNS_MAX = LENS_THREE_TURNS - LENS_CONCAVE };

/* The steepest slope of a side with coefficients, and its largest curvature in units of 1 / rim. */
#define SLOPE_MOST 16.0
#define BEND_MOST 0x1p14

/* Coefficients, from the power 0 of q on, of the sums of a side's terms: of p, g, dg/dq, d^2g/dq^2, and of half the
 * second derivative along the meridian. For A_n rho^n with n = 4 + 2 i: (i + 2) q^(i + 1) in p, and n (n - 1) / 2
 * q^(i + 1) in the last. */
typedef struct form_terms {
    int count;
    double p[ASPHERE_TERMS + 1], g[ASPHERE_TERMS + 1], turn[ASPHERE_TERMS + 1], next[ASPHERE_TERMS + 1],
        bend[ASPHERE_TERMS + 1];
} form_terms;

static form_terms form_terms_of(const even_asphere *e)
{
    form_terms s = {.count = e->terms};
    for (int i = 0; i < e->terms; i++) {
        const double n = 4.0 + 2.0 * i;
        s.p[i + 1] = (i + 2.0) * e->even[i];
        s.g[i] = (i + 1.0) * s.p[i + 1];
        if (i > 0)
            s.turn[i - 1] = i * s.g[i];
        if (i > 1)
            s.next[i - 2] = (i - 1.0) * s.turn[i - 1];
        s.bend[i + 1] = 0.5 * n * (n - 1.0) * e->even[i];
    }
    return s;
}

/* asphere_range_of, and closer where terms cancel: their sum is within |half width| max |derivative| of that in the
 * middle. */
static asphere_range range_of(double conic_from, double conic_to, int terms, const double *k, double from, double to)
{
    const double middle = 0.5 * (from + to);
    double value = 0.0, slope[ASPHERE_TERMS + 1] = {0.0};
    for (int i = terms; i >= 0; i--)
        value = k[i] + middle * value;
    for (int i = 1; i <= terms; i++)
        slope[i - 1] = i * k[i];
    const asphere_range all = asphere_range_of(conic_from, conic_to, terms, k, from, to),
                        rise = asphere_range_of(0.0, 0.0, terms, slope, from, to);
    const double spread = 0.5 * (to - from) * fmax(fabs(rise.low), fabs(rise.high));
    return (asphere_range){fmax(all.low, fmin(conic_from, conic_to) + (value - spread)),
                           fmin(all.high, fmax(conic_from, conic_to) + (value + spread))};
}

/* Which sum of a side's terms, and for a rho^n its factors of a and what is less than n in the power of rho. */
enum { SUM_P, SUM_G, SUM_TURN, SUM_NEXT, SUM_BEND };

static double term_factor(int sum, double n)
{
    double factor = n / 2.0;
    if (sum == SUM_BEND)
        return n * (n - 1.0) / 2.0;
    for (int i = SUM_G; i <= sum; i++)
        factor *= (n - 2.0 * i) / 2.0;
    return factor;
}

static double power_of(double rho, int n)
{
    double power = 1.0;
    for (int i = 0; i < (n < 0 ? -n : n); i++)
        power *= rho;
    return n < 0 ? 1.0 / power : power;
}

/* range_of for a side with odd coefficients, term by term, as each is monotonic; with the lowest power taken out if
 * only the sign counts. */
static asphere_range range_with_odd(const even_asphere *e, int sum, double conic_from, double conic_to, bool sign,
                                    double from, double to)
{
    const asphere_range r = {fmin(conic_from, conic_to), fmax(conic_from, conic_to)};
    double k[2 * ASPHERE_TERMS + 3] = {0.0};
    for (int i = 0; i < ASPHERE_ODD; i++)
        k[asphere_odd_power(i)] = e->odd[i];
    for (int i = 0; i < ASPHERE_TERMS; i++)
        k[4 + 2 * i] = e->even[i];
    int lowest = 1;
    while (k[lowest] == 0.0)
        lowest++;
    const int less = sign && e->curvature == 0.0 ? lowest : sum == SUM_BEND ? 2 : 2 + 2 * sum;
    asphere_range all = r, rise = {0.0, 0.0};
    double value = 0.0;
    for (int n = 1; n < 2 * ASPHERE_TERMS + 3; n++) {
        const double factor = k[n] * term_factor(sum, n), by_q = 0.5 * factor * (n - less);
        if (factor == 0.0)
            continue;
        const double one = factor * power_of(sqrt(from), n - less), two = factor * power_of(sqrt(to), n - less);
        all.low += fmin(one, two), all.high += fmax(one, two);
        value += factor * power_of(sqrt(0.5 * (from + to)), n - less);
        if (by_q == 0.0)
            continue;
        const double a = by_q * power_of(sqrt(from), n - less - 2), b = by_q * power_of(sqrt(to), n - less - 2);
        rise.low += fmin(a, b), rise.high += fmax(a, b);
    }
    const double spread = 0.5 * (to - from) * fmax(fabs(rise.low), fabs(rise.high)); /* as in range_of */
    if (!isfinite(spread))
        return all;
    return (asphere_range){fmax(all.low, r.low + (value - spread)), fmin(all.high, r.high + (value + spread))};
}

/* An interval that contains the sum conic / w^power + k0 + k1 q + ... If the side has no curvature, the sum is divided
 * by its lowest power of q, which leaves its sign unchanged. */
static asphere_range sign_of(const even_asphere *e, int sum, double conic, int power, const double *k, double from,
                             double to)
{
    double a = conic, b = conic, shifted[ASPHERE_TERMS + 1] = {0.0};
    int first = 0;
    for (int i = 0; i < power; i++)
        a /= asphere_root(e, from), b /= asphere_root(e, to);
    if (e->odd_terms)
        return range_with_odd(e, sum, a, b, true, from, to);
    while (e->curvature == 0.0 && first < e->terms && k[first] == 0.0)
        first++;
    for (int i = first; i <= e->terms; i++)
        shifted[i - first] = k[i];
    return range_of(a, b, e->terms, shifted, from, to);
}

/* 1 or -1: times a - b has that sign in its whole range; 0: unknown. */
static int sign_of_difference(double times, asphere_range a, asphere_range b)
{
    return times * a.low - b.high >= 0.0 ? 1 : times * a.high - b.low <= 0.0 ? -1 : 0;
}

/* The sign of T, or that of dT/dq if T may change it; 0: unknown. */
typedef struct form_turning {
    int sign, rise;
} form_turning;

static form_turning turning_of(const even_asphere *e, const form_terms *k, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    const double a2 = a * a, b2 = b * b, bend = e->stretch * c * c;
    const double c3 = 0.25 * bend * c, c5 = 1.5 * bend * c3, c7 = 2.5 * bend * c5;
    const double ends[4][2] = {{0.5 * c * a, 0.5 * c * b},
                               {c3 * a2 * a, c3 * b2 * b},
                               {c5 * a2 * a2 * a, c5 * b2 * b2 * b},
                               {c7 * a2 * a2 * a2 * a, c7 * b2 * b2 * b2 * b}};
    const double *const terms[4] = {k->p, k->g, k->turn, k->next};
    asphere_range of[4];
    for (int i = 0; i < 4; i++) {
        of[i] = e->odd_terms ? range_with_odd(e, i, ends[i][0], ends[i][1], false, from, to)
                             : range_of(ends[i][0], ends[i][1], k->count, terms[i], from, to);
        if (i != SUM_TURN)
            continue;
        const int sign = sign_of_difference(3.0, asphere_square(of[SUM_G]), asphere_times(of[SUM_P], of[SUM_TURN]));
        if (sign != 0)
            return (form_turning){sign, 0};
    }
    return (form_turning){
        0, sign_of_difference(5.0, asphere_times(of[SUM_G], of[SUM_TURN]), asphere_times(of[SUM_P], of[SUM_NEXT]))};
}

/* What is known about a side from the axis up to a radius. */
typedef struct form_so_far {
    bool convex, concave;
    int within; /* in the last piece B >= 0 was possible, with p > 0 > g (1), with p < 0 < g (2), or either (3); or 0 */
    int turns;  /* the most zeros of h */
    int sign;   /* of T, in the last piece; 0: not known yet in this interval of q */
    int change; /* T may have taken that sign since; 0: it has not changed */
    bool bounded;
} form_so_far;

/* One more piece in which B >= 0 is possible. */
static void count_branches(form_so_far *f, form_turning t)
{
    if (f->change != 0 && t.sign != -f->change && !(t.sign == 0 && t.rise == f->change)) {
        f->turns++;
        f->sign = f->change;
    }
    if (t.sign != 0 || t.rise != f->change)
        f->change = 0;
    if (t.sign != 0) {
        f->turns += f->sign == -t.sign;
        f->sign = t.sign;
    } else if (t.rise == 0) {
        f->bounded = false;
    } else if (f->sign != t.rise) {
        f->change = t.rise;
    }
}

static void extend(form_so_far *f, const even_asphere *e, const form_terms *k, double inwards, double from, double to)
{
    const double c = e->curvature;
    const asphere_range p = sign_of(e, SUM_P, 0.5 * c, 1, k->p, from, to),
                        bend = sign_of(e, SUM_BEND, 0.5 * c, 3, k->bend, from, to),
                        g = sign_of(e, SUM_G, 0.25 * e->stretch * c * c * c, 3, k->g, from, to);
    const bool up = p.low >= 0.0 && bend.low >= 0.0, down = p.high <= 0.0 && bend.high <= 0.0;
    f->convex &= inwards > 0.0 ? up : down;
    f->concave &= inwards > 0.0 ? down : up;
    const bool falls = p.high > 0.0 && g.low < 0.0 && bend.low <= 0.0,
               rises = p.low < 0.0 && g.high > 0.0 && bend.high >= 0.0;
    const int within = (falls ? 1 : 0) + (rises ? 2 : 0);
    if (within == 0 || f->within == 0) { /* an interval of q ends here, or begins */
        f->turns += f->change != 0;
        f->turns += within != 0;
        f->sign = f->change = 0;
    }
    f->bounded &= within != 3 && within + f->within != 3;
    f->within = within;
    if (within != 0)
        count_branches(f, turning_of(e, k, from, to));
}

/* The most zeros of h on either side of the axis. */
static int turns_of(const form_so_far *f)
{
    return f->turns + (f->change != 0);
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
    const form_terms terms = form_terms_of(&e);
    const double inwards = k == 0 ? 1.0 : -1.0, rim = lens_clear_of(s, k);
    form_so_far f = {.convex = true, .concave = true, .bounded = true};
    for (int i = 0; i < FORM_PIECES; i++) {
        const double from = rim * rim * i / FORM_PIECES, to = rim * rim * (i + 1) / FORM_PIECES;
        *within = sqrt(from);
        if (is_steep(&e, rim, from, to))
            return LENS_STEEP;
        extend(&f, &e, &terms, inwards, from, to);
        if (!f.convex && !f.concave && !(f.bounded && turns_of(&f) <= TURNS_MAX))
            return LENS_TURNS;
    }
    *within = rim;
    return f.convex    ? LENS_CONVEX
           : f.concave ? LENS_CONCAVE
                       : (lens_form)(LENS_CONCAVE + (turns_of(&f) > 1 ? turns_of(&f) : 1));
}

lens_form lens_round_form(const solid_shape *s, int k, double *within)
{
    const lens_profile e = lens_profile_of(s, k);
    *within = lens_clear_of(s, k);
    return e.aspheric ? form_of_asphere(s, k, within) : e.concave ? LENS_CONCAVE : LENS_CONVEX;
}

int lens_chords_of(const solid_shape *s, const lens_form form[2])
{
    int intervals = -1;
    for (int k = 0; k < 2; k++) {
        const lens_profile e = lens_profile_of(s, k);
        /* The ring of a side that is not concave can be crossed besides the side. */
        intervals += (int)form[k] + (lens_has_ring(&e) && !lens_is_flat(&e) && form[k] != LENS_CONCAVE);
    }
    return intervals;
}
