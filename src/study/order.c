#include "study/order.h"

/* Random123's headers convert freely. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-prototypes"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

/* 64 random bits: draw number attempt for place i. */
static uint64_t random_bits(uint64_t seed, uint64_t stream, uint32_t place, uint32_t attempt)
{
    philox4x32_key_t key = {{(uint32_t)seed, (uint32_t)(seed >> 32)}};
    philox4x32_ctr_t counter = {{place, attempt, (uint32_t)stream, (uint32_t)(stream >> 32)}};
    philox4x32_ctr_t drawn = philox4x32(counter, key);
    return (uint64_t)drawn.v[1] << 32 | drawn.v[0];
}

/* Even on 0..bound-1: bits of the last, incomplete stretch of bound values are drawn again. */
static uint64_t random_below(uint64_t seed, uint64_t stream, uint32_t place, uint64_t bound)
{
    uint64_t incomplete = -bound % bound; /* 2^64 mod bound */
    uint64_t bits;
    uint32_t attempt = 0;
    do
        bits = random_bits(seed, stream, place, attempt++);
    while (bits < incomplete);
    return bits % bound;
}

void order_shuffle(uint64_t seed, uint64_t stream, size_t *order, size_t count)
{
    for (size_t i = 0; i < count; i++)
        order[i] = i;
    for (size_t i = count; i > 1; i--) {
        size_t j = (size_t)random_below(seed, stream, (uint32_t)i, i);
        size_t moved = order[i - 1];
        order[i - 1] = order[j];
        order[j] = moved;
    }
}
