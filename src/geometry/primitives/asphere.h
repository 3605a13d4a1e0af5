/* An even asphere (ISO 10110-12): at a distance rho from the axis, with q = rho^2, its height above its vertex is
 *
 *     z = c q / (1 + w) + A4 q^2 + A6 q^3 + ... + A20 q^10,  w = sqrt(1 - (1 + k) c^2 q),
 *
 * for the curvature c = 1 / R and the conic constant k; without coefficients it is a conic. Since dw/dq =
 * -(1 + k) c^2 / (2 w), dz/dq = c / (2 w) + 2 A4 q + 3 A6 q^2 + ... + 10 A20 q^9. Pure; cannot fail. */
#pragma once

#include <math.h>
#include <stdbool.h>

enum { ASPHERE_TERMS = 9 }; /* A4, A6, ..., A20 */

typedef struct even_asphere {
    double curvature, stretch; /* c, 1 + k */
    int terms;                 /* up to the last coefficient that is not 0; 0: a conic */
    double even[ASPHERE_TERMS];
} even_asphere;

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

/* The least w^2 allowed within the rim of a side with coefficients: it keeps the slope finite. */
#define ASPHERE_ROOT2_LEAST 0x1p-6

static inline bool asphere_has_terms(const even_asphere *e)
{
    return e->terms > 0;
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
    double sum = 0.0;
    for (int i = e->terms - 1; i >= 0; i--)
        sum = e->even[i] + q * sum;
    return e->curvature * q / (1.0 + asphere_root(e, q)) + q * q * sum;
}

/* dz/dq */
static inline double asphere_slope(const even_asphere *e, double q)
{
    double sum = 0.0;
    for (int i = e->terms - 1; i >= 0; i--)
        sum = (i + 2.0) * e->even[i] + q * sum;
    return 0.5 * e->curvature / asphere_root(e, q) + q * sum;
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
 * q^n. */
static inline double asphere_quotient(const even_asphere *e, double p, double q)
{
    double quotient = e->curvature / (asphere_root(e, p) + asphere_root(e, q)), sum = p + q, power = p * p;
    for (int i = 0; i < e->terms; i++, power *= p) {
        quotient += e->even[i] * sum;
        sum = power + q * sum;
    }
    return quotient;
}

/* What the sides of a lens have besides their conics, for each of them. */
typedef struct lens_details {
    double even[2][ASPHERE_TERMS];
    double low[2], high[2]; /* of a side with coefficients: its least and largest height above its vertex */
    double clear[2]; /* radius up to which the side reaches; beyond it is a level ring; infinite without a ring */
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
 * and n. The second derivative along any straight line is a mean of these two. */
static inline asphere_range asphere_bend(const even_asphere *e, double from, double to)
{
    const double a = 1.0 / asphere_root(e, from), b = 1.0 / asphere_root(e, to), c = e->curvature;
    double along[ASPHERE_TERMS + 1] = {0.0}, across[ASPHERE_TERMS + 1] = {0.0};
    for (int i = 0; i < e->terms; i++) {
        const double n = 4.0 + 2.0 * i;
        along[1 + i] = n * (n - 1.0) * e->even[i], across[1 + i] = n * e->even[i];
    }
    const asphere_range m = asphere_range_of(c * (a * a * a), c * (b * b * b), e->terms, along, from, to),
                        s = asphere_range_of(c * a, c * b, e->terms, across, from, to);
    return (asphere_range){m.low < s.low ? m.low : s.low, m.high > s.high ? m.high : s.high};
}
