/* An even asphere (ISO 10110-12): at a distance rho from the axis, with q = rho^2, its height above its vertex is
 *
 *     z = c q / (1 + w) + A4 q^2 + A6 q^3 + A8 q^4,  w = sqrt(1 - (1 + k) c^2 q),
 *
 * for the curvature c = 1 / R and the conic constant k; without coefficients it is a conic. Since dw/dq =
 * -(1 + k) c^2 / (2 w), dz/dq = c / (2 w) + 2 A4 q + 3 A6 q^2 + 4 A8 q^3. Pure; cannot fail. */
#pragma once

#include <math.h>
#include <stdbool.h>

typedef struct even_asphere {
    double curvature, stretch; /* c, 1 + k */
    double even[3];            /* A4, A6, A8 */
} even_asphere;

/* The least w^2 allowed within the rim of a side with coefficients: it keeps the slope finite. */
#define ASPHERE_ROOT2_LEAST 0x1p-6

static inline bool asphere_has_terms(const even_asphere *e)
{
    return e->even[0] != 0.0 || e->even[1] != 0.0 || e->even[2] != 0.0;
}

/* w with a lower bound: 0 or, with coefficients, a value that is below w of all points within the rim. */
static inline double asphere_root(const even_asphere *e, double q)
{
    const double under = 1.0 - e->stretch * e->curvature * e->curvature * q;
    const double least = asphere_has_terms(e) ? 0.5 * ASPHERE_ROOT2_LEAST : 0.0;
    return sqrt(under > least ? under : least);
}

static inline double asphere_sag(const even_asphere *e, double q)
{
    return e->curvature * q / (1.0 + asphere_root(e, q)) + q * q * (e->even[0] + q * (e->even[1] + q * e->even[2]));
}

/* dz/dq */
static inline double asphere_slope(const even_asphere *e, double q)
{
    return 0.5 * e->curvature / asphere_root(e, q) +
           q * (2.0 * e->even[0] + q * (3.0 * e->even[1] + q * (4.0 * e->even[2])));
}

/* (z(q) - z(p)) / (q - p), without cancellation: c / (w(p) + w(q)) for the conic, the sum of p^i q^(n - 1 - i) for
 * q^n. */
static inline double asphere_quotient(const even_asphere *e, double p, double q)
{
    const double sum = p + q;
    return e->curvature / (asphere_root(e, p) + asphere_root(e, q)) + e->even[0] * sum +
           e->even[1] * (p * p + q * sum) + e->even[2] * (sum * (p * p + q * q));
}

typedef struct asphere_range {
    double low, high;
} asphere_range;

/* An interval that contains conic(q) + k0 + k1 q + k2 q^2 + k3 q^3 for 0 <= from <= q <= to: the conic part, given at
 * both ends, is monotonic. */
static inline asphere_range asphere_range_of(double conic_from, double conic_to, const double k[4], double from,
                                             double to)
{
    const bool rises = conic_from < conic_to;
    asphere_range r = {(rises ? conic_from : conic_to) + k[0], (rises ? conic_to : conic_from) + k[0]};
    double low = from, high = to;
    for (int i = 1; i < 4; i++, low *= from, high *= to) {
        r.low += k[i] * (k[i] > 0.0 ? low : high);
        r.high += k[i] * (k[i] > 0.0 ? high : low);
    }
    return r;
}

/* Bounds of the second derivatives of the height within from <= q <= to, along the meridian, z'' = c / w^3 + 12 A4 q +
 * 30 A6 q^2 + 56 A8 q^3, and across it, z' / rho = c / w + 4 A4 q + 6 A6 q^2 + 8 A8 q^3: the second derivative along
 * any straight line is a mean of these two. */
static inline asphere_range asphere_bend(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    const double along[4] = {0.0, 12.0 * e->even[0], 30.0 * e->even[1], 56.0 * e->even[2]},
                 across[4] = {0.0, 4.0 * e->even[0], 6.0 * e->even[1], 8.0 * e->even[2]};
    const asphere_range m = asphere_range_of(c * (a * a * a), c * (b * b * b), along, from, to),
                        s = asphere_range_of(c * a, c * b, across, from, to);
    return (asphere_range){m.low < s.low ? m.low : s.low, m.high > s.high ? m.high : s.high};
}
