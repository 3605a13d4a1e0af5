/* Vectors of eight floats and four doubles for the hierarchy kernels, in the vector extensions that gcc and clang
 * share. Pure; cannot fail. */
#pragma once

#include "base/isa.h"
#include <stdint.h>
#include <string.h>

/* Without AVX compilers warn about passing wide vectors to functions; all functions of this file are inlined. */
#pragma GCC diagnostic ignored "-Wpsabi"

typedef float float4 __attribute__((vector_size(16)));
typedef float float8 __attribute__((vector_size(32)));
typedef int32_t int8x32 __attribute__((vector_size(32)));
typedef int32_t int16x32 __attribute__((vector_size(64)));
typedef int32_t int4x32 __attribute__((vector_size(16)));
typedef int64_t int2x64 __attribute__((vector_size(16)));
typedef double double4 __attribute__((vector_size(32)));
typedef double double8 __attribute__((vector_size(64)));
typedef int64_t int8x64 __attribute__((vector_size(64)));
typedef int64_t int4x64 __attribute__((vector_size(32)));
typedef int8_t int8x8 __attribute__((vector_size(8)));
typedef int8_t int4x8 __attribute__((vector_size(4)));
typedef int8_t int16x8 __attribute__((vector_size(16)));

ALWAYS_INLINE double4 double4_all(double v)
{
    return (double4){v, v, v, v};
}

ALWAYS_INLINE float8 floats_at(const float *p)
{
    float8 v;
    memcpy(&v, p, sizeof v);
    return v;
}

/* a b + c, in one instruction if there is one: the last bits differ between instruction sets, so this is only for tests
 * with a margin. */
#if defined(__FMA__) || defined(__AVX512F__)
#define MULTIPLY_ADD(a, b, c) __builtin_fmaf(a, b, c)
#else
#define MULTIPLY_ADD(a, b, c) ((a) * (b) + (c))
#endif

/* The set of lanes whose mask is -1: one bit per lane, with AVX-512 in a byte per lane, which is faster because AVX-512
 * narrows a vector in one instruction. lane_first is the lowest lane of a non-empty set. */
#ifdef __AVX512VL__
ALWAYS_INLINE uint64_t lanes_of8(int8x32 mask)
{
    int8x8 bytes = __builtin_convertvector(mask, int8x8);
    uint64_t set;
    memcpy(&set, &bytes, sizeof set);
    return set & 0x0101010101010101u;
}
ALWAYS_INLINE unsigned lanes_of4(int4x64 mask)
{
    int4x8 bytes = __builtin_convertvector(mask, int4x8);
    uint32_t set;
    memcpy(&set, &bytes, sizeof set);
    return set & 0x01010101u;
}
ALWAYS_INLINE unsigned lane_first(uint64_t set)
{
    return (unsigned)__builtin_ctzll(set) >> 3;
}
/* The same as one bit per lane, from lane 0 in bit 0. */
ALWAYS_INLINE unsigned bits_of8(int8x64 mask)
{
    int8x8 bytes = __builtin_convertvector(mask, int8x8);
    uint64_t set;
    memcpy(&set, &bytes, sizeof set);
    return (unsigned)((set & 0x0101010101010101u) * 0x0102040810204080u >> 56);
}
ALWAYS_INLINE unsigned bits_of16(const int32_t *mask)
{
    int16x32 m;
    memcpy(&m, mask, sizeof m);
    int16x8 bytes = __builtin_convertvector(m, int16x8);
    uint64_t set[2];
    memcpy(set, &bytes, sizeof set);
    const uint64_t ones = 0x0101010101010101u, pack = 0x0102040810204080u;
    return (unsigned)((set[0] & ones) * pack >> 56 | (set[1] & ones) * pack >> 56 << 8);
}
#else
/* The lanes of two vectors, whose elements are single bits. */
ALWAYS_INLINE uint64_t lanes_of_bits(int4x32 low, int4x32 high)
{
    const int2x64 halves = (int2x64)(low | high);
    const uint64_t both = (uint64_t)(halves[0] | halves[1]);
    return (uint32_t)both | (uint32_t)(both >> 32);
}
ALWAYS_INLINE uint64_t lanes_of8(int8x32 mask)
{
    mask &= (int8x32){1, 2, 4, 8, 16, 32, 64, 128};
    return lanes_of_bits(__builtin_shufflevector(mask, mask, 0, 1, 2, 3),
                         __builtin_shufflevector(mask, mask, 4, 5, 6, 7));
}
ALWAYS_INLINE unsigned lanes_of4(int4x64 mask)
{
    mask &= (int4x64){1, 2, 4, 8};
#ifdef __AVX2__
    const int2x64 halves = __builtin_shufflevector(mask, mask, 0, 1) | __builtin_shufflevector(mask, mask, 2, 3);
    return (unsigned)(halves[0] | halves[1]);
#else
    return (unsigned)((mask[0] | mask[2]) | (mask[1] | mask[3]));
#endif
}
ALWAYS_INLINE unsigned lane_first(uint64_t set)
{
    return (unsigned)__builtin_ctzll(set);
}
ALWAYS_INLINE unsigned bits_of8(int8x64 mask)
{
    mask &= (int8x64){1, 2, 4, 8, 16, 32, 64, 128};
    return (unsigned)((mask[0] | mask[1]) | (mask[2] | mask[3]) | (mask[4] | mask[5]) | (mask[6] | mask[7]));
}
ALWAYS_INLINE unsigned bits_of16(const int32_t *mask)
{
    int8x32 low, high;
    memcpy(&low, mask, sizeof low);
    memcpy(&high, mask + 8, sizeof high);
    return (unsigned)(lanes_of8(low) | lanes_of8(high) << 8);
}
#endif
#define LANES_LESS_FIRST(set) ((set) & ((set)-1))

/* The lanes in which a is at most b. Without AVX in halves: gcc 12 compares the elements of wider vectors one by
 * one. */
ALWAYS_INLINE uint64_t lanes_ordered(const float *a, const float *b)
{
#ifdef __AVX__
    return lanes_of8(floats_at(a) <= floats_at(b));
#else
    float4 low[2], high[2];
    memcpy(low, a, sizeof low);
    memcpy(high, b, sizeof high);
    return lanes_of_bits((low[0] <= high[0]) & (int4x32){1, 2, 4, 8}, (low[1] <= high[1]) & (int4x32){16, 32, 64, 128});
#endif
}
