/* RGB-to-spectrum upsampling: S(lambda) = sigmoid(c0 t^2 + c1 t + c2) with t the wavelength, -1 at OBSERVER_LOW_NM and
 * 1 at OBSERVER_HIGH_NM, and sigmoid(x) = 1/2 + x / (2 sqrt(1 + x^2)): smooth, and within 0 .. 1 for all coefficients,
 * so that an upsampled reflectance conserves energy. Jakob and Hanika, "A Low-Dimensional Function Space for Efficient
 * Spectral Upsampling", Computer Graphics Forum 38(2), 2019. Each call fits the coefficients so that the spectrum, seen
 * by the observer under D65, has the given colour: 20 microseconds, so upsample once per colour and not once per ray.
 * Greys are exact: a constant spectrum, 0 for black and 1 for white. The round trip of 8-bit colours is within a
 * CIEDE2000 of 3e-4 (at the corners of the gamut, 5e-6), and within 0.006 one step from black, where the curves are
 * steepest. Values, not objects: nothing to free. Pure; cannot fail. */
#pragma once

#include "optics/spectrum.h"
#include <math.h>

typedef struct upsampled_spectrum {
    double c[3];  /* c0, c1, c2 */
    double scale; /* 1 for a reflectance; for an emission, twice its largest component */
} upsampled_spectrum;

/* Linear sRGB; components are clamped to 0 .. 1 first (NaN to 0). */
upsampled_spectrum upsample_reflectance(const double rgb[3]);

/* Linear sRGB of any magnitude; negative components (and NaN) are clamped to 0. The shape is fitted to the colour at
 * half of full brightness, where smooth spectra reach every hue; white is exactly D65. */
upsampled_spectrum upsample_emission(const double rgb[3]);

/* S(lambda), 0 .. 1. */
static inline double upsampled_reflectance(const upsampled_spectrum *l, double lambda_nm)
{
    const double middle = 0.5 * (OBSERVER_LOW_NM + OBSERVER_HIGH_NM),
                 reach = 0.5 * (OBSERVER_HIGH_NM - OBSERVER_LOW_NM);
    double t = (lambda_nm - middle) / reach;
    double x = (l->c[0] * t + l->c[1]) * t + l->c[2];
    return 0.5 + 0.5 * x / sqrt(1.0 + x * x); /* Jakob and Hanika, eq. 4 */
}

/* scale S(lambda) D65(lambda), a radiance in units of observer_d65. */
static inline double upsampled_emission(const upsampled_spectrum *l, double lambda_nm)
{
    return l->scale * upsampled_reflectance(l, lambda_nm) * observer_d65(lambda_nm);
}
