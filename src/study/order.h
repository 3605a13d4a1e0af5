/* The order in which cells are measured. Pure; the caller owns the array. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Independent streams of one seed: the rounds of repetitions are 0, 1, ... */
#define ORDER_STREAM_SHARDS UINT64_MAX

/* order[0..count-1] = a uniform random permutation of 0..count-1 (Fisher and Yates; Durstenfeld 1964) from the
 * counter-based generator Philox4x32-10 (Salmon et al., SC11): the same everywhere for the same (seed, stream). */
void order_shuffle(uint64_t seed, uint64_t stream, size_t *order, size_t count);
