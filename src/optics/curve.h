/* A function of the wavelength by its values at some: a cubic between each two, and constant beyond the first and the
 * last. Its slope at a point is that of the parabola through the point and its neighbours, limited so that the curve
 * is monotone wherever the values are (de Boor and Swartz, Piecewise monotone interpolation, J. Approx. Theory 21, 411
 * (1977)): it never leaves the range of its two values. Pure; identical bits on every platform. */
#pragma once

#include <stddef.h>

/* The value at x. point: count >= 1 pairs x0 y0 x1 y1 ..., ascending in x. */
double curve_at(const double *point, size_t count, double x);
