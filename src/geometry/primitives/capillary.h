/* The surface of a liquid in a vertical round tube, where gravity and surface tension are in balance: the axisymmetric
 * equation of Young and Laplace, (1/r) d(r sin psi)/dr = u / a^2 with tan psi = du/dr, where u is the height above the
 * level of zero pressure difference and a = sqrt(surface tension / (density g)) the capillary length (Finn, Equilibrium
 * Capillary Surfaces, 1986, ch. 2). It is level on the axis and meets the wall at the contact angle, which is measured
 * within the liquid: psi = 90 deg - contact angle there.
 *
 * Heights are stored as polynomials in q = r^2, in which the surface is smooth on the axis too. They are within
 * CAPILLARY_ERROR of the solution. Pure; cannot fail; ownership: values. */
#pragma once

#include "base/status.h"
#include <math.h>
#include <stdbool.h>

enum { CAPILLARY_DEGREE = 18, CAPILLARY_PIECES = 256 };

/* The largest radius of a tube, and the bound on the height's error, in capillary lengths. */
#define CAPILLARY_WIDEST 500.0
#define CAPILLARY_ERROR 1e-10

typedef struct capillary_piece {
    double from, width; /* in q */
    double
        c[CAPILLARY_DEGREE + 1]; /* height above the profile's level: the sum of c[k] x^k with x = (q - from) / width */
} capillary_piece;

typedef struct capillary_profile {
    double radius;     /* of the tube */
    double level;      /* of zero pressure difference, in the frame of the liquid */
    double axis, wall; /* heights at the axis and at the wall, in that frame */
    double low, high;  /* the smaller and the larger of axis and wall */
    bool rises;        /* the surface rises towards the wall: the contact angle is below 90 degrees */
    int count;
    capillary_piece piece[CAPILLARY_PIECES];
} capillary_profile;

/* The piece that contains q >= 0; beyond the wall the last one. */
static inline int capillary_piece_at(const capillary_profile *p, double q)
{
    int low = 0, high = p->count; /* piece[low].from <= q < piece[high].from */
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (p->piece[middle].from <= q)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The height above the level, and its derivative by q. */
static inline double capillary_rise(const capillary_profile *p, double q, double *slope)
{
    const capillary_piece *e = &p->piece[capillary_piece_at(p, q)];
    const double x = (q - e->from) / e->width;
    double value = e->c[CAPILLARY_DEGREE], derivative = 0.0;
    for (int k = CAPILLARY_DEGREE - 1; k >= 0; k--) {
        derivative = derivative * x + value;
        value = value * x + e->c[k];
    }
    *slope = derivative / e->width;
    return value;
}

static inline double capillary_height(const capillary_profile *p, double q)
{
    double slope;
    return p->level + capillary_rise(p, q, &slope);
}

/* The height at y less that at x, divided by y - x, within a piece; by Horner's rule, without cancellation. */
static inline double capillary_piece_quotient(const capillary_piece *e, double x, double y)
{
    double value = e->c[CAPILLARY_DEGREE], quotient = 0.0;
    for (int k = CAPILLARY_DEGREE - 1; k >= 0; k--) {
        quotient = quotient * x + value;
        value = value * y + e->c[k];
    }
    return quotient;
}

/* The difference quotient of the height between two q, which may be equal: exact also where they are close. */
static inline double capillary_quotient(const capillary_profile *p, double q1, double q2)
{
    const double a = q1 < q2 ? q1 : q2, b = q1 < q2 ? q2 : q1;
    const int i = capillary_piece_at(p, a), k = capillary_piece_at(p, b);
    const capillary_piece *e = &p->piece[i], *f = &p->piece[k];
    const double x = (a - e->from) / e->width, y = (b - f->from) / f->width;
    if (i == k)
        return capillary_piece_quotient(e, x, y) / e->width;
    const double first = capillary_piece_quotient(e, x, 1.0) * (1.0 - x),
                 last = capillary_piece_quotient(f, 0.0, y) * y;
    return (first + (f->c[0] - p->piece[i + 1].c[0]) + last) / (b - a);
}

/* Whether a point is in the liquid: within `radius` of the axis, above y = 0, and below the surface or, outside the
 * tube, below its height at the wall. rho2: squared distance of the point from the axis. */
static inline bool capillary_contains(const capillary_profile *p, double radius, double rho2, double y)
{
    const double top = rho2 < p->radius * p->radius ? capillary_height(p, rho2) : p->wall;
    return rho2 <= radius * radius && y >= 0.0 && y <= top;
}
