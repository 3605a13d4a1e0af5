/* Branch-free selection, for loops that the compiler should vectorise. A mask is 0 or -1 in 64 bits, as wide as a
 * double: gcc and clang both vectorise blends of bits, while `?:` in a large loop becomes control flow. Pure; cannot
 * fail. */
#pragma once

#include <stdint.h>
#include <string.h>

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

static inline int64_t mask_of(int condition)
{
    return -(int64_t)condition;
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
