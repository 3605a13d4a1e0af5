/* The sides of lenses beyond conics. A round side is an asphere (ISO 10110-12): at a distance rho from the axis, with
 * q = rho^2, its height above its vertex is
 *
 *     z = c q / (1 + w) + A4 q^2 + A6 q^3 + ... + A20 q^10 + a1 rho + a2 q + a3 rho^3 + a5 rho^5 + ... + a15 rho^15,
 *     w = sqrt(1 - (1 + k) c^2 q),
 *
 * for the curvature c = 1 / R and the conic constant k; without coefficients it is a conic. Since dw/dq =
 * -(1 + k) c^2 / (2 w), dz/dq = c / (2 w) + 2 A4 q + 3 A6 q^2 + ... + 10 A20 q^9 + ... A side that is not round has a
 * curvature C of its own along x. A biconic one has
 *
 *     z = (C x^2 + c z'^2) / (1 + sqrt(1 - (1 + K) C^2 x^2 - (1 + k) c^2 z'^2))
 *
 * for the local coordinates x and z', and the conic constants K and k; a toric one is the curve g(z'), an asphere's
 * profile, turned about a line along z' at the distance 1 / C above the vertex:
 *
 *     z = (2 g - C g^2 + C x^2) / (1 + S),  S = sqrt((1 - C g)^2 - C^2 x^2),
 *
 * which is a cylinder for C = 0. Pure; cannot fail. */
#pragma once

#include <math.h>
#include <stdbool.h>

enum { ASPHERE_TERMS = 9, ASPHERE_ODD = 9 }; /* A4, A6, ..., A20; a1, a2, a3, a5, ..., a15 */

typedef enum side_form { SIDE_ROUND, SIDE_BICONIC, SIDE_TORIC } side_form;

typedef struct even_asphere {
    double curvature, stretch; /* c, 1 + k */
    int terms;                 /* up to the last coefficient that is not 0; 0: a conic */
    double even[ASPHERE_TERMS];
    int odd_terms;
    double odd[ASPHERE_ODD];
    side_form form;
    double curvature_x, stretch_x; /* C, 1 + K, of a side that is not round */
} even_asphere;

/* The power of the radius of odd[i]. */
static inline int asphere_odd_power(int i)
{
    return i < 2 ? i + 1 : 2 * i - 1;
}

/* even: NULL for a conic. */
static inline even_asphere asphere_of(double curvature, double conic, const double *even)
{
    even_asphere e = {.curvature = curvature, .stretch = 1.0 + conic};
    for (int i = 0; even && i < ASPHERE_TERMS; i++) {
        e.even[i] = even[i];
        if (even[i] != 0.0)
            e.terms = i + 1;
    }
    return e;
}

static inline void asphere_add_odd(even_asphere *e, const double *odd)
{
    for (int i = 0; i < ASPHERE_ODD; i++) {
        e->odd[i] = odd[i];
        if (odd[i] != 0.0)
            e->odd_terms = i + 1;
    }
}

/* The least w^2 allowed within the rim of a side with coefficients: it keeps the slope finite. */
#define ASPHERE_ROOT2_LEAST 0x1p-6

static inline bool asphere_has_terms(const even_asphere *e)
{
    return e->terms > 0 || e->odd_terms > 0 || e->form != SIDE_ROUND;
}

/* w with a lower bound: 0 or, with coefficients, a value that is below w of all points within the rim. */
static inline double asphere_root(const even_asphere *e, double q)
{
    const double under = 1.0 - e->stretch * e->curvature * e->curvature * q;
    const double least = asphere_has_terms(e) ? 0.5 * ASPHERE_ROOT2_LEAST : 0.0;
    return sqrt(under > least ? under : least);
}

/* The sum of odd[i] rho^n / rho^less times n (by_n: once) for their powers n. */
static inline double asphere_odd_sum(const even_asphere *e, double rho, int less, bool by_n)
{
    double sum = 0.0, power = 1.0, q = rho * rho; /* of rho^n; 1 for n = 0 */
    if (!(rho > 0.0))
        return less == 2 ? (by_n ? 2.0 : 1.0) * e->odd[1] : 0.0;
    for (int i = 0; i < e->odd_terms; i++) {
        power *= i < 3 ? rho : q;
        sum += (by_n ? asphere_odd_power(i) : 1.0) * e->odd[i] * power;
    }
    return less == 2 ? sum / q : sum;
}

static inline double asphere_sag(const even_asphere *e, double q)
{
    double sum = 0.0;
    for (int i = e->terms - 1; i >= 0; i--)
        sum = e->even[i] + q * sum;
    sum = e->curvature * q / (1.0 + asphere_root(e, q)) + q * q * sum;
    return e->odd_terms ? sum + asphere_odd_sum(e, sqrt(q), 0, false) : sum;
}

/* dz/dq; on the axis without a1, whose cone has no slope there */
static inline double asphere_slope(const even_asphere *e, double q)
{
    double sum = 0.0;
    for (int i = e->terms - 1; i >= 0; i--)
        sum = (i + 2.0) * e->even[i] + q * sum;
    sum = 0.5 * e->curvature / asphere_root(e, q) + q * sum;
    return e->odd_terms ? sum + 0.5 * asphere_odd_sum(e, sqrt(q), 2, true) : sum;
}

/* d2z/dq2 */
static inline double asphere_slope_rate(const even_asphere *e, double q)
{
    const double c = e->curvature, w = asphere_root(e, q);
    double sum = 0.0;
    for (int i = e->terms - 1; i >= 0; i--)
        sum = (i + 2.0) * (i + 1.0) * e->even[i] + q * sum;
    return 0.25 * e->stretch * (c * c * c) / (w * w * w) + sum;
}

/* Whether the conic part has a point there. */
static inline bool asphere_reaches(const even_asphere *e, double q)
{
    return e->stretch * (e->curvature * e->curvature) * q <= 1.0;
}

/* (z(q) - z(p)) / (q - p), without cancellation: c / (w(p) + w(q)) for the conic, the sum of p^i q^(n - 1 - i) for
 * q^n, and that of rho(p)^i rho(q)^(n - 1 - i) divided by rho(p) + rho(q) for rho^n. */
static inline double asphere_quotient(const even_asphere *e, double p, double q)
{
    double quotient = e->curvature / (asphere_root(e, p) + asphere_root(e, q)), sum = p + q, power = p * p;
    for (int i = 0; i < e->terms; i++, power *= p) {
        quotient += e->even[i] * sum;
        sum = power + q * sum;
    }
    if (!e->odd_terms)
        return quotient;
    const double a = sqrt(p), b = sqrt(q);
    double odd = 0.0;
    sum = 0.0, power = 1.0;
    for (int n = 1, i = 0; i < e->odd_terms; n++, power *= a) {
        sum = power + b * sum;
        if (asphere_odd_power(i) == n)
            odd += e->odd[i++] * sum;
    }
    return a + b > 0.0 ? quotient + odd / (a + b) : quotient + e->odd[1];
}

/* What the sides of a lens have besides their conics, for each of them. */
typedef struct lens_details {
    double even[2][ASPHERE_TERMS];
    double low[2], high[2]; /* of a side with coefficients: its least and largest height above its vertex */
    double clear[2]; /* radius up to which the side reaches; beyond it is a level ring; infinite without a ring */
    bool general[2]; /* whether what follows counts */
    double odd[2][ASPHERE_ODD];
    side_form form[2];
    double curvature_x[2], conic_x[2];
    /* The bevel between a side and the rim, at 45 degrees: the radius where it begins, infinite without a bevel, and
     * the height of its cone's apex. */
    double bevel[2], apex[2];
} lens_details;

typedef struct asphere_range {
    double low, high;
} asphere_range;

/* An interval that contains conic(q) + k0 + k1 q + ... + k_terms q^terms for 0 <= from <= q <= to: the conic part,
 * given at both ends, is monotonic. */
static inline asphere_range asphere_range_of(double conic_from, double conic_to, int terms, const double *k,
                                             double from, double to)
{
    const bool rises = conic_from < conic_to;
    asphere_range r = {(rises ? conic_from : conic_to) + k[0], (rises ? conic_to : conic_from) + k[0]};
    double low = from, high = to;
    for (int i = 1; i <= terms; i++, low *= from, high *= to) {
        r.low += k[i] * (k[i] > 0.0 ? low : high);
        r.high += k[i] * (k[i] > 0.0 ? high : low);
    }
    return r;
}

/* Bounds of the second derivatives of the height within from <= q <= to, along the meridian, z'' = c / w^3 + 12 A4 q +
 * 30 A6 q^2 + ..., and across it, z' / rho = c / w + 4 A4 q + 6 A6 q^2 + ...: for the coefficient of rho^n, n (n - 1)
 * and n. The second derivative along any straight line is a mean of these two. Without a1, whose cone has no bound of
 * that kind. */
static inline asphere_range asphere_bend(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    double along[ASPHERE_TERMS + 1] = {0.0}, across[ASPHERE_TERMS + 1] = {0.0};
    for (int i = 0; i < e->terms; i++) {
        const double n = 4.0 + 2.0 * i;
        along[1 + i] = n * (n - 1.0) * e->even[i], across[1 + i] = n * e->even[i];
    }
    asphere_range m = asphere_range_of(c * (a * a * a), c * (b * b * b), e->terms, along, from, to),
                  s = asphere_range_of(c * a, c * b, e->terms, across, from, to);
    double low = 1.0, high = 1.0, least = e->odd_terms ? sqrt(from) : 0.0, most = e->odd_terms ? sqrt(to) : 0.0;
    for (int i = 1; i < e->odd_terms; i++) { /* low, high: powers n - 2 of the radius */
        const double n = asphere_odd_power(i), k = n * e->odd[i];
        low *= i < 2 ? 1.0 : i < 3 ? least : from, high *= i < 2 ? 1.0 : i < 3 ? most : to;
        const double one = k * low, two = k * high;
        s.low += one < two ? one : two, s.high += one < two ? two : one;
        m.low += (n - 1.0) * (one < two ? one : two), m.high += (n - 1.0) * (one < two ? two : one);
    }
    return (asphere_range){m.low < s.low ? m.low : s.low, m.high > s.high ? m.high : s.high};
}

/* --- sides of any form --- */

/* The root in the height of a side that is not round, with a lower bound for rounding beyond the rim; g: of a toric
 * one. */
static inline double asphere_twisted_root(const even_asphere *e, double x, double z, double g)
{
    const double a = 1.0 - e->curvature_x * g, cx = e->curvature_x * x, cz = e->curvature * z;
    const double under = e->form == SIDE_TORIC ? (a > 0.0 ? a * a - cx * cx : 0.0)
                                               : 1.0 - e->stretch_x * (cx * cx) - e->stretch * (cz * cz);
    return sqrt(under > 0.5 * ASPHERE_ROOT2_LEAST ? under : 0.5 * ASPHERE_ROOT2_LEAST);
}

/* The height above the vertex, and its derivatives by x and z. */
static inline double asphere_surface(const even_asphere *e, double x, double z, double *by_x, double *by_z)
{
    const double q = x * x + z * z, C = e->curvature_x;
    if (e->form == SIDE_ROUND) {
        const double twice = 2.0 * asphere_slope(e, q);
        *by_x = twice * x, *by_z = twice * z;
        return asphere_sag(e, q);
    }
    if (e->form == SIDE_BICONIC) {
        const double root = asphere_twisted_root(e, x, z, 0.0), c = e->curvature;
        const double h = (C * (x * x) + c * (z * z)) / (1.0 + root);
        *by_x = C * x * (2.0 + h * (e->stretch_x * C) / root) / (1.0 + root);
        *by_z = c * z * (2.0 + h * (e->stretch * c) / root) / (1.0 + root);
        return h;
    }
    const double g = asphere_sag(e, z * z), root = asphere_twisted_root(e, x, z, g);
    *by_x = C * x / root;
    *by_z = (1.0 - C * g) * (2.0 * z * asphere_slope(e, z * z)) / root;
    return (2.0 * g - C * (g * g) + C * (x * x)) / (1.0 + root);
}

/* The difference of heights at t and at 0 along the line (x + t dx, z + t dz), divided by t, without cancellation. */
static inline double asphere_chord(const even_asphere *e, double x, double z, double dx, double dz, double t)
{
    const double x1 = x + t * dx, z1 = z + t * dz, of_x = (x1 + x) * dx, of_z = (z1 + z) * dz;
    const double C = e->curvature_x, c = e->curvature;
    if (e->form == SIDE_ROUND)
        return asphere_quotient(e, x * x + z * z, x1 * x1 + z1 * z1) * (of_x + of_z);
    if (e->form == SIDE_BICONIC) {
        const double w = asphere_twisted_root(e, x, z, 0.0), w1 = asphere_twisted_root(e, x1, z1, 0.0);
        const double h = (C * (x * x) + c * (z * z)) / (1.0 + w);
        const double under = e->stretch_x * (C * C) * of_x + e->stretch * (c * c) * of_z;
        return (C * of_x + c * of_z + h * under / (w + w1)) / (1.0 + w1);
    }
    const double g = asphere_sag(e, z * z), g1 = asphere_sag(e, z1 * z1), both = 2.0 - C * g - C * g1;
    const double roots = asphere_twisted_root(e, x, z, g) + asphere_twisted_root(e, x1, z1, g1);
    return (asphere_quotient(e, z * z, z1 * z1) * of_z * both + C * of_x) / roots;
}

static inline asphere_range asphere_times(asphere_range a, asphere_range b)
{
    const double k[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    asphere_range r = {k[0], k[0]};
    for (int i = 1; i < 4; i++)
        r = (asphere_range){k[i] < r.low ? k[i] : r.low, k[i] > r.high ? k[i] : r.high};
    return r;
}

/* a + f b */
static inline asphere_range asphere_plus(asphere_range a, double f, asphere_range b)
{
    return f < 0.0 ? (asphere_range){a.low + f * b.high, a.high + f * b.low}
                   : (asphere_range){a.low + f * b.low, a.high + f * b.high};
}

static inline asphere_range asphere_square(asphere_range a)
{
    const double one = a.low * a.low, two = a.high * a.high, most = one > two ? one : two;
    return (asphere_range){a.low > 0.0 || a.high < 0.0 ? (one < two ? one : two) : 0.0, most};
}

/* a / b, for b above 0 */
static inline asphere_range asphere_ratio(asphere_range a, asphere_range b)
{
    return asphere_times(a, (asphere_range){1.0 / b.high, 1.0 / b.low});
}

/* The range of a root whose square is within `under`. */
static inline asphere_range asphere_roots(asphere_range under)
{
    const double least = 0.5 * ASPHERE_ROOT2_LEAST;
    return (asphere_range){sqrt(under.low > least ? under.low : least), sqrt(under.high > least ? under.high : least)};
}

/* Bounds of the second derivative of the height of a side that is not round along a line, x and z being within these
 * ranges, by interval arithmetic (Moore, Kearfott and Cloud, chapter 5). Biconic, with P = C x^2 + c z^2 and w:
 * h (1 + w) = P, so h'' = (P'' - 2 h' w' - h w'') / (1 + w). Toric, with A = 1 - C g and primes for derivatives along
 * the line: h' = (A g' + C x x') / S, h'' = (A g'' + C (x'^2 - g'^2 + h'^2)) / S. */
static inline asphere_range asphere_curve(const even_asphere *e, asphere_range x, asphere_range z, double dx, double dz)
{
    const double C = e->curvature_x, c = e->curvature, C2 = e->stretch_x * (C * C), c2 = e->stretch * (c * c);
    const asphere_range one = {1.0, 1.0}, none = {0.0, 0.0}, x2 = asphere_square(x), z2 = asphere_square(z);
    if (e->form == SIDE_BICONIC) {
        const asphere_range w = asphere_roots(asphere_plus(asphere_plus(one, -C2, x2), -c2, z2)),
                            more = {1.0 + w.low, 1.0 + w.high};
        const asphere_range h = asphere_ratio(asphere_plus(asphere_plus(none, C, x2), c, z2), more);
        const asphere_range w_1 =
            asphere_ratio(asphere_plus(asphere_plus(none, -C2 * dx, x), -c2 * dz, z), w); /* w w' = Q */
        const double turn = -C2 * (dx * dx) - c2 * (dz * dz), bend = 2.0 * (C * (dx * dx) + c * (dz * dz));
        const asphere_range w_2 =
            asphere_ratio(asphere_plus((asphere_range){turn, turn}, -1.0, asphere_square(w_1)), w);
        const asphere_range p_1 = asphere_plus(asphere_plus(none, 2.0 * C * dx, x), 2.0 * c * dz, z);
        const asphere_range h_1 = asphere_ratio(asphere_plus(p_1, -1.0, asphere_times(h, w_1)), more);
        const asphere_range sum = asphere_plus((asphere_range){bend, bend}, -2.0, asphere_times(h_1, w_1));
        return asphere_ratio(asphere_plus(sum, -1.0, asphere_times(h, w_2)), more);
    }
    const double middle = 0.5 * (z.low + z.high), half = 0.5 * (z.high - z.low);
    const asphere_range b = asphere_bend(e, z2.low, z2.high);
    const double slope = 2.0 * middle * asphere_slope(e, middle * middle), sag = asphere_sag(e, middle * middle),
                 most = half * (-b.low > b.high ? -b.low : b.high);
    const asphere_range by_z = {slope - most, slope + most};
    const double rise = half * (-by_z.low > by_z.high ? -by_z.low : by_z.high);
    const asphere_range g = {sag - rise, sag + rise}, A = asphere_plus(one, -C, g), g_1 = asphere_plus(none, dz, by_z),
                        g_2 = asphere_plus(none, dz * dz, b);
    const asphere_range S = asphere_roots(asphere_plus(asphere_square(A), -C * C, x2));
    const asphere_range h_1 = asphere_ratio(asphere_plus(asphere_times(A, g_1), C * dx, x), S);
    const double turn = C * (dx * dx);
    const asphere_range sum = asphere_plus(asphere_times(A, g_2), -C, asphere_square(g_1));
    return asphere_ratio(asphere_plus(asphere_plus((asphere_range){turn, turn}, 1.0, sum), C, asphere_square(h_1)), S);
}
