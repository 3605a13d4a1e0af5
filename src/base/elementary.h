/* Powers and angles with identical bits on every C library, compiler and processor: libm may differ in the last place
 * between platforms, while the image must depend only on the scene. Only + - * / and sqrt are used, which IEEE 754
 * specifies exactly. Pure; cannot fail. The stated errors are tested against libm in long double. */
#pragma once

/* x^y for 0 <= x; 0^0 = 1. Relative error below 4e-16 (2 + |y log2 x|), so 4e-14 at x^y = 1e-30; results below 2^-1000
 * are 0, above 2^1000 they are 2^1000. A branch-free version for kernels is in base/lanes.h (the one for Phong's
 * highlights raises integer exponents by squaring instead: render/shade/shade_kernel.c states its error). */
double elementary_pow(double x, double y);

/* Sine and cosine of an angle in degrees; exact at multiples of 90. Absolute error below 3e-16, for |degrees| <=
 * 1e6. */
void elementary_sincos_deg(double degrees, double *sine, double *cosine);

/* Angle of the point (x, y) in degrees, -180..180, as atan2(y, x); 0 at the origin. Absolute error below 1e-13. */
double elementary_atan2_deg(double y, double x);
