/* Branch-free arithmetic, for loops that the compiler should vectorise: selection, rounding, and elementary functions.
 * Pure; cannot fail. */
#pragma once

#include <stdint.h>
#include <string.h>

/* ---- selection ---- */

/* A mask is 0 or -1 in 64 bits, as wide as a double: gcc and clang both vectorise blends of bits, while `?:` in a large
 * loop becomes control flow. */

static inline int64_t lanes_bits(double v)
{
    int64_t b;
    memcpy(&b, &v, sizeof b);
    return b;
}
static inline double lanes_double(int64_t b)
{
    double v;
    memcpy(&v, &b, sizeof v);
    return v;
}

static inline int64_t mask_of(int is_true)
{
    return -(int64_t)is_true;
}
static inline int64_t mask_less(double a, double b)
{
    return -(int64_t)(a < b);
}
static inline int64_t mask_less_equal(double a, double b)
{
    return -(int64_t)(a <= b);
}
static inline int64_t mask_same(int64_t a, int64_t b)
{
    return -(int64_t)(a == b);
}

/* mask ? a : b */
static inline int64_t blend_int(int64_t mask, int64_t a, int64_t b)
{
    return (a & mask) | (b & ~mask);
}
static inline double blend(int64_t mask, double a, double b)
{
    return lanes_double(blend_int(mask, lanes_bits(a), lanes_bits(b)));
}
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}
static inline double greater(double a, double b)
{
    return a > b ? a : b;
}
static inline double magnitude(double a)
{
    return lanes_double(lanes_bits(a) & INT64_MAX);
}

/* ---- single precision ---- */

/* The nearest float, as a double; |x| at most FLT_MAX. Not written as (double)(float)x: gcc 12 drops both conversions
 * when it vectorises straight-line code (-O2 and above). */
static inline double single_round(double x)
{
    volatile float single = (float)x;
    return (double)single;
}

/* ---- elementary functions: see base/elementary.h ---- */

/* Powers: x = 2^e m with m in [1/sqrt 2, sqrt 2); log2 m = 2 atanh((m-1)/(m+1)) / ln 2, by its Taylor series to the
 * 21st power (the 23rd is below 1e-18); 2^t by its nearest integer power and the Taylor series of e^(r ln 2) to the
 * 13th power (the 14th is below 1e-17). */
static inline double elementary_log2_inline(double x)
{
    const int64_t exponent_bias = 1023, mantissa = 0x000fffffffffffff, one = 0x3ff0000000000000;
    int64_t bits = lanes_bits(x);
    double m = lanes_double((bits & mantissa) | one);
    int64_t high = mask_less(1.4142135623730951, m);
    m = blend(high, 0.5 * m, m);
    int64_t e = (int64_t)((uint64_t)bits >> 52) - exponent_bias - high;
    /* e as a double by the bits of 1.5 2^52 + e: a conversion that every instruction set supports */
    double e_real = lanes_double(e + 0x4338000000000000) - 6755399441055744.0;
    double f = (m - 1.0) / (m + 1.0), s = f * f;
    double p = 1.0 / 21.0;
    p = p * s + 1.0 / 19.0;
    p = p * s + 1.0 / 17.0;
    p = p * s + 1.0 / 15.0;
    p = p * s + 1.0 / 13.0;
    p = p * s + 1.0 / 11.0;
    p = p * s + 1.0 / 9.0;
    p = p * s + 1.0 / 7.0;
    p = p * s + 1.0 / 5.0;
    p = p * s + 1.0 / 3.0;
    p = p * s;
    const double two_log2_e = 2.8853900817779268;
    return e_real + two_log2_e * (f + f * p);
}

static inline double elementary_exp2_inline(double t)
{
    double clamped = greater(lesser(t, 1000.0), -1001.0);
    double shifted = clamped + 6755399441055744.0; /* 1.5 2^52: rounds to the nearest integer */
    double n = shifted - 6755399441055744.0;
    double r = (clamped - n) * 0.69314718055994530942;
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    p = p * r + 1.0;
    p = p * r + 1.0;
    int64_t scale = (lanes_bits(shifted) - 0x4338000000000000 + 1023) << 52;
    return blend(mask_less(clamped, -1000.0), 0.0, p * lanes_double(scale));
}

static inline double elementary_pow_inline(double x, double y)
{
    const double smallest_normal = 2.2250738585072014e-308;
    int64_t zero = mask_less(x, smallest_normal);
    double log2_x = blend(zero, -1e300, elementary_log2_inline(blend(zero, 1.0, x)));
    return elementary_exp2_inline(y * log2_x);
}

/* Taylor series on |x| <= pi/4; the omitted terms are below 1e-17. */
static inline double elementary_sine_series(double x)
{
    double s = x * x, p = -1.0 / 1307674368000.0;
    p = p * s + 1.0 / 6227020800.0;
    p = p * s - 1.0 / 39916800.0;
    p = p * s + 1.0 / 362880.0;
    p = p * s - 1.0 / 5040.0;
    p = p * s + 1.0 / 120.0;
    p = p * s - 1.0 / 6.0;
    return x + x * (s * p);
}

static inline double elementary_cosine_series(double x)
{
    double s = x * x, p = 1.0 / 20922789888000.0;
    p = p * s - 1.0 / 87178291200.0;
    p = p * s + 1.0 / 479001600.0;
    p = p * s - 1.0 / 3628800.0;
    p = p * s + 1.0 / 40320.0;
    p = p * s - 1.0 / 720.0;
    p = p * s + 1.0 / 24.0;
    return 1.0 - 0.5 * s + s * s * p;
}

/* elementary_sincos_deg(360 turn) for 0 <= turn <= 1, except at the odd eighths of a turn, where two quarters are
 * equally near, and the even one is used. */
static inline void elementary_sincos_turn_inline(double turn, double *sine, double *cosine)
{
    const double degrees = 360.0 * turn, shifted = degrees / 90.0 + 6755399441055744.0, /* 1.5 2^52 */
        quarter = shifted - 6755399441055744.0, x = (degrees - 90.0 * quarter) * 0.017453292519943295769;
    const double s = elementary_sine_series(x), c = elementary_cosine_series(x);
    const int64_t odd = -(lanes_bits(shifted) & 1), negative = -(lanes_bits(shifted) >> 1 & 1);
    const double first = blend(odd, c, s), second = blend(odd, -s, c);
    *sine = blend(negative, -first, first);
    *cosine = blend(negative, -second, second);
}
