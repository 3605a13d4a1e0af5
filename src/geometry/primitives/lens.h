/* Formulas of a lens that its shape and its kernel share. A side is a conic of revolution about local y: its sag, the
 * height above its vertex at a distance rho from the axis, is c rho^2 / (1 + sqrt(1 - (1 + k) c^2 rho^2)), with the
 * curvature c = 1 / R and the conic constant k (ISO 10110-12). Pure; cannot fail. */
#pragma once

#include <math.h>

/* rho2 is rho^2; past the conic's end, the sag there. */
static inline double lens_sag(double curvature, double conic, double rho2)
{
    const double under = 1.0 - (1.0 + conic) * curvature * curvature * rho2;
    return curvature * rho2 / (1.0 + sqrt(under > 0.0 ? under : 0.0));
}
