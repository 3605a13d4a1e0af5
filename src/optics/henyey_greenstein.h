/* The phase function of Henyey and Greenstein, "Diffuse radiation in the galaxy", Astrophysical Journal 93 (1941), 70,
 * (2): the density per solid angle, over which its integral is 1, of the angle between the directions before and after
 * scattering; its mean cosine is the asymmetry g, -1 < g < 1. Pure; cannot fail. */
#pragma once

#include "base/lanes.h"
#include <math.h>

/* 1/sr. 1 + g^2 - 2 g c = (1 - |g|)^2 + 2 |g| (1 -+ c), without cancellation. */
static inline double henyey_greenstein(double cosine, double g)
{
    const double size = fabs(g), off = g < 0.0 ? 1.0 + cosine : 1.0 - cosine,
                 base = (1.0 - size) * (1.0 - size) + 2.0 * size * greater(off, 0.0), four_pi = 12.566370614359172954;
    return (1.0 - size) * (1.0 + size) / (four_pi * base * sqrt(base));
}

/* The cosine for a uniform random number u in (0, 1): the inverse of the distribution,
 * c = (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g) with s = 2 u - 1, multiplied out, so that g may be 0. */
static inline double henyey_greenstein_cosine(double u, double g)
{
    const double s = 2.0 * u - 1.0, g2 = g * g, below = 1.0 + g * s;
    const double c = (s * (1.0 + g2) + 0.5 * g * (s * s * (1.0 + g2) + 3.0 - g2)) / (below * below);
    return lesser(greater(c, -1.0), 1.0);
}
