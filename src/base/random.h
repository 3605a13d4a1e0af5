/* Random numbers as a function of their purpose and not of the time when they are drawn: a counter-based generator, and
 * the points of a scrambled low-discrepancy sequence. Pure; cannot fail. */
#pragma once

#include "base/isa.h"
#include <stdint.h>

/* ---- independent numbers ---- */

/* 128 random bits for a key and four counters: the counter-based generator Philox4x32-10 of Random123 (Salmon, Moraes,
 * Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011). */
typedef struct random_words {
    uint32_t word[4];
} random_words;
random_words random_at(uint64_t key, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* Uniform in [0, 1): one of 2^32 values, each the middle of its interval, so never 0. */
static inline double random_unit(uint32_t word)
{
    return ((double)word + 0.5) * 0x1p-32;
}

/* ---- low-discrepancy points ---- */

/* Points of a two-dimensional low-discrepancy sequence with nested uniform (Owen) scrambling by hashing: Burley,
 * "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020. The points are those of Sobol's first two dimensions (Joe
 * and Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30, 2008): van
 * der Corput's sequence and Pascal's triangle mod 2, a (0, 2)-sequence in base 2: of each aligned block of 2^m indices,
 * one point is in every elementary interval of area 2^-m. Each key has its own scrambling of both coordinates and its
 * own order of the points, which keeps aligned blocks; points of different keys can be combined into points of more
 * dimensions. Integer arithmetic only: the same bits everywhere. */

/* Coordinates in units of 2^-32. */
typedef struct sobol_point {
    uint32_t x, y;
} sobol_point;

/* Reverses the order of the 32 bits. */
static inline uint32_t sobol_reverse(uint32_t x)
{
    x = (x & 0x55555555) << 1 | (x >> 1 & 0x55555555);
    x = (x & 0x33333333) << 2 | (x >> 2 & 0x33333333);
    x = (x & 0x0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f);
    return __builtin_bswap32(x);
}

/* Bit j of the result is the sum mod 2 of C(i, j) x_i. C(i, j) is odd where j has no bit that i lacks (Lucas), so that
 * the matrix is a Kronecker power of (1 1; 0 1), and each step applies one factor. */
static inline uint32_t sobol_pascal(uint32_t x)
{
    x ^= x >> 1 & 0x55555555;
    x ^= x >> 2 & 0x33333333;
    x ^= x >> 4 & 0x0f0f0f0f;
    x ^= x >> 8 & 0x00ff00ff;
    return x ^ x >> 16;
}

/* Nested uniform scrambling of a number whose bits are in reverse order: each bit is flipped by a hash of the bits
 * below it. Laine and Karras, "Stratified sampling for stochastic transparency", CGF 30(4), 2011, with the constants of
 * Vegdahl, "Building a better LK hash", 2021. */
static inline uint32_t sobol_scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56U;
    return x ^ x * 0x53a22864U;
}

/* A bijection whose every output bit depends on every input bit: the finalizer of SplitMix64 (Steele, Lea and Flood,
 * "Fast splittable pseudorandom number generators", OOPSLA 2014, variant 13 of Stafford). */
static inline uint64_t sobol_mix(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9U;
    x = (x ^ x >> 27) * 0x94d049bb133111ebU;
    return x ^ x >> 31;
}

/* The seeds that a key determines: for the order of its points, and for the scrambling of each coordinate. Keys need
 * not look random. */
typedef struct sobol_seeds {
    uint32_t order, x, y;
} sobol_seeds;

static inline sobol_seeds sobol_seeds_of(uint64_t key)
{
    const uint64_t first = sobol_mix(key + 0x9e3779b97f4a7c15U), second = sobol_mix(first + 0x9e3779b97f4a7c15U);
    return (sobol_seeds){(uint32_t)first, (uint32_t)(first >> 32), (uint32_t)second};
}

/* Point number `index` of the sequence with these seeds. */
ALWAYS_INLINE sobol_point sobol_scrambled(uint32_t index, sobol_seeds s)
{
    const uint32_t i = sobol_reverse(sobol_scramble_reversed(sobol_reverse(index), s.order));
    return (sobol_point){sobol_reverse(sobol_scramble_reversed(i, s.x)),
                         sobol_reverse(sobol_scramble_reversed(sobol_pascal(i), s.y))};
}

static inline sobol_point sobol_at(uint32_t index, uint64_t key)
{
    return sobol_scrambled(index, sobol_seeds_of(key));
}
