/* Phase functions: how particles and drops scatter light, by angle. Ownership: plain values; the caller owns the
 * arrays. Pure; cannot fail. */
#pragma once

#include "base/lanes.h"
#include <math.h>

/* ---- Henyey and Greenstein ---- */

/* The density per solid angle, with integral 1, of the angle between the directions before and after scattering; its
 * mean cosine is the asymmetry g, -1 < g < 1. "Diffuse radiation in the galaxy", Astrophysical Journal 93, 70 (1941),
 * eq. (2). */

/* In 1/sr. The denominator 1 + g^2 - 2 g c is computed without cancellation, as (1 - |g|)^2 + 2 |g| (1 -+ c). */
static inline double henyey_greenstein(double cosine, double g)
{
    const double size = fabs(g), off = g < 0.0 ? 1.0 + cosine : 1.0 - cosine,
                 base = (1.0 - size) * (1.0 - size) + 2.0 * size * greater(off, 0.0), four_pi = 12.566370614359172954;
    return (1.0 - size) * (1.0 + size) / (four_pi * base * sqrt(base));
}

/* The cosine for a uniform random number u in (0, 1): the inverse of the distribution, c = (1 + g^2 - ((1 - g^2) / (1 +
 * g s))^2) / (2 g) with s = 2 u - 1, multiplied out, so that g may be 0. */
static inline double henyey_greenstein_cosine(double u, double g)
{
    const double s = 2.0 * u - 1.0, g2 = g * g, below = 1.0 + g * s;
    const double c = (s * (1.0 + g2) + 0.5 * g * (s * s * (1.0 + g2) + 3.0 - g2)) / (below * below);
    return lesser(greater(c, -1.0), 1.0);
}

/* ---- a drop of rain ---- */

/* How a drop scatters sunlight, in geometric optics: parallel light falls on a sphere; rays are reflected outside, or
 * leave after no, one or two internal reflections, at the angles of Snell and with the powers of Fresnel (unpolarised
 * light). One internal reflection makes the primary rainbow, two the secondary. Light of more reflections, diffraction
 * and interference are left out: drops are large. Only + - * / and sqrt: the same bits everywhere. */

enum {
    DROP_ORDERS = 4,          /* reflected outside; then 0, 1, 2 internal reflections */
    DROP_BINS = 3600,         /* of the angle from the antisolar point, 0 .. 180 degrees */
    DROP_RAYS = 512,          /* steps of the angle of incidence, 0 .. 90 degrees */
    DROP_DISC_BINS_MAX = 100, /* on either side of a bin; a disc of 5 degrees */
};
#define DROP_BIN_DEG (180.0 / DROP_BINS)

/* Angular radius of the sun at 1 au: 959.63 arcseconds. Astronomical Almanac; IAU. */
#define SUN_RADIUS_DEG 0.26656

/* Tables that do not depend on the refractive index. */
typedef struct drop_angles {
    double edge_cosine[DROP_BINS + 1];
    double sine[DROP_RAYS + 1], cosine[DROP_RAYS + 1]; /* of the angles of incidence */
    int disc_bins;
    double disc[2 * DROP_DISC_BINS_MAX + 1]; /* the fractions of a bin's light that spread over its neighbours */
} drop_angles;

/* Fills the tables for light from a uniform disc of that angular radius, at most 4.9 degrees; 0: from a point. */
void drop_angles_make(double disc_radius_deg, drop_angles *out);

/* The scattering function p by bin, relative to a scatterer that sends all light that falls on its cross-section evenly
 * in all directions: its mean over the sphere is the fraction of light in these orders, nearly 1. n: index of the drop
 * relative to its surroundings, above 0. */
void drop_scattering(const drop_angles *a, double n, double p[DROP_BINS]);

/* The fraction of the sphere in a bin. */
static inline double drop_bin_fraction(const drop_angles *a, int bin)
{
    return 0.5 * (a->edge_cosine[bin] - a->edge_cosine[bin + 1]);
}
