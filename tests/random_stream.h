/* Random numbers for tests: SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), a fixed stream per seed, so that a failure
 * is reproducible. Ownership: the caller owns the seed. */
#pragma once

#include "base/vec3.h"
#include <math.h>
#include <stdint.h>

static inline uint64_t random_bits(uint64_t *seed)
{
    uint64_t z = (*seed += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in [low, high). */
static inline double random_real(uint64_t *seed, double low, double high)
{
    return low + (high - low) * (double)(random_bits(seed) >> 11) * 0x1p-53;
}

/* 0 .. count - 1 */
static inline int random_below(uint64_t *seed, int count)
{
    return (int)(random_bits(seed) % (uint64_t)count);
}

static inline vec3 random_point(uint64_t *seed, double reach)
{
    double x = random_real(seed, -reach, reach), y = random_real(seed, -reach, reach),
           z = random_real(seed, -reach, reach);
    return vec3_make(x, y, z);
}

/* Uniform on the unit sphere. */
static inline vec3 random_direction(uint64_t *seed)
{
    for (;;) {
        vec3 v = random_point(seed, 1.0);
        double l2 = vec3_dot(v, v);
        if (l2 > 1e-4 && l2 <= 1.0)
            return vec3_normalize(v);
    }
}
