/* In which order cells are measured. Pure; the caller owns the array. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Streams of one seed that have nothing to do with each other: the rounds of repetitions are 0, 1, ... */
#define ORDER_STREAM_SHARDS UINT64_MAX

/* order[0..count-1] = a permutation of 0..count-1, drawn evenly (Fisher and Yates; Durstenfeld 1964) with the
 * counter-based generator Philox4x32-10 (Salmon et al., SC11): the same for the same (seed, stream) everywhere. */
void order_shuffle(uint64_t seed, uint64_t stream, size_t *order, size_t count);
