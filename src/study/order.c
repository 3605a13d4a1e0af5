#include "study/order.h"

#include "base/random.h"

/* 64 random bits: attempt number `attempt` for position i. */
static uint64_t random_bits(uint64_t seed, uint64_t stream, uint32_t place, uint32_t attempt)
{
    random_words drawn = random_at(seed, place, attempt, (uint32_t)stream, (uint32_t)(stream >> 32));
    return (uint64_t)drawn.word[1] << 32 | drawn.word[0];
}

/* Uniform on 0..bound-1: values in the incomplete last range of length bound are rejected. */
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
