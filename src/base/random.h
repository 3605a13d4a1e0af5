/* Random numbers as a function of their purpose and not of the time when they are drawn: the counter-based generator
 * Philox4x32-10 of Random123 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
 * Pure; cannot fail. */
#pragma once

#include <stdint.h>

/* 128 random bits for a key and four counters. */
typedef struct random_words {
    uint32_t word[4];
} random_words;
random_words random_at(uint64_t key, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* Uniform in [0, 1): one of 2^32 values, each the middle of its interval, so never 0. */
static inline double random_unit(uint32_t word)
{
    return ((double)word + 0.5) * 0x1p-32;
}
