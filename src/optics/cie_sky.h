/* The CIE standard general sky: luminance of the sky relative to its zenith, for 15 types from overcast to cloudless.
 * ISO 15469:2004 / CIE S 011/E:2003, "Spatial distribution of daylight"; the parameters as in Darula and Kittler, "CIE
 * general sky standard defining luminance distributions", Proceedings of eSim 2002. Types 1 and 12 are near the older
 * overcast sky of Moon and Spencer and the clear sky of Kittler (CIE 22, 1973). Plain values; pure; cannot fail. */
#pragma once

#include "base/vec3.h"

enum { CIE_SKY_TYPES = 15, CIE_SKY_OVERCAST = 1, CIE_SKY_UNIFORM = 5, CIE_SKY_CLEAR = 12 };

/* Gradation phi(Z) = 1 + a exp(b / cos Z) by the zenith angle Z, and indicatrix
 * f(x) = 1 + c (exp(d x) - exp(d pi / 2)) + e cos^2 x by the angle x from the sun, in radians. */
typedef struct cie_sky_type {
    double a, b, c, d, e;
} cie_sky_type;

/* The parameters of a type, 1 .. CIE_SKY_TYPES. */
cie_sky_type cie_sky_type_of(int type);

typedef struct cie_sky {
    cie_sky_type of;
    vec3 to_sun;   /* unit vector */
    double zenith; /* f(Z_s) phi(0) */
    double mean;   /* cie_sky_mean, if the caller has stored it; else 0 */
} cie_sky;

/* The sky of a type with the sun in direction to_sun, a unit vector; y is up. */
cie_sky cie_sky_make(int type, vec3 to_sun);

/* The luminance in a direction (a unit vector above the horizon) over the luminance at the zenith: f(x) phi(Z) /
 * (f(Z_s) phi(0)). */
double cie_sky_relative(const cie_sky *sky, vec3 direction);

/* The mean of cie_sky_relative over the upper hemisphere, by solid angle; relative error below 1e-4 for a sun above the
 * horizon. */
double cie_sky_mean(const cie_sky *sky);
