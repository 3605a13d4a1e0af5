/* Complex numbers as pairs of doubles, for kernels: branch-free, only + - * / and sqrt, so that every compiler gives
 * the same bits (C's own complex product calls a function for infinities). Pure; cannot fail. */
#pragma once

#include "base/lanes.h"
#include <math.h>

typedef struct complex_pair {
    double re, im;
} complex_pair;

static inline complex_pair complex_of(double re, double im)
{
    complex_pair z = {re, im};
    return z;
}

static inline complex_pair complex_add(complex_pair a, complex_pair b)
{
    return complex_of(a.re + b.re, a.im + b.im);
}

static inline complex_pair complex_sub(complex_pair a, complex_pair b)
{
    return complex_of(a.re - b.re, a.im - b.im);
}

static inline complex_pair complex_scale(complex_pair a, double times)
{
    return complex_of(a.re * times, a.im * times);
}

static inline complex_pair complex_multiply(complex_pair a, complex_pair b)
{
    return complex_of(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
}

/* -i a */
static inline complex_pair complex_minus_i(complex_pair a)
{
    return complex_of(a.im, -a.re);
}

/* conj(a) b */
static inline complex_pair complex_between(complex_pair a, complex_pair b)
{
    return complex_of(a.re * b.re + a.im * b.im, a.re * b.im - a.im * b.re);
}

static inline double complex_norm2(complex_pair a)
{
    return a.re * a.re + a.im * a.im;
}

/* a / b; b != 0, and its square must not overflow. */
static inline complex_pair complex_divide(complex_pair a, complex_pair b)
{
    return complex_scale(complex_between(b, a), 1.0 / complex_norm2(b));
}

/* The square root with both parts >= 0, of z with z.im >= 0; without cancellation. */
static inline complex_pair complex_sqrt_upper(complex_pair z)
{
    const double length = sqrt(complex_norm2(z)), large = sqrt(0.5 * (length + magnitude(z.re)));
    const int64_t zero = mask_less_equal(large, 0.0), left = mask_less(z.re, 0.0);
    const double small = blend(zero, 0.0, z.im / blend(zero, 1.0, 2.0 * large));
    return complex_of(blend(left, small, large), blend(left, large, small));
}

static inline complex_pair complex_blend(int64_t mask, complex_pair a, complex_pair b)
{
    return complex_of(blend(mask, a.re, b.re), blend(mask, a.im, b.im));
}
