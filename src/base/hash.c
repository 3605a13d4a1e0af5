/* The FNV-1a hash with a final mix. */
#include "base/hash.h"

#include <string.h>

static const uint64_t FNV_PRIME = UINT64_C(1099511628211); /* 64-bit FNV prime, draft-eastlake-fnv */

/* Multiplication carries only upwards: without the shift, changes to the top bits of two words could cancel. */
static uint64_t step(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * FNV_PRIME;
    return hash ^ hash >> 32;
}

uint64_t hash_words(uint64_t hash, const void *words, size_t count)
{
    const unsigned char *at = words;
    for (size_t i = 0; i < count; i++, at += sizeof(uint64_t)) {
        uint64_t word;
        memcpy(&word, at, sizeof word);
        hash = step(hash, word);
    }
    return hash;
}

uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < count; i++)
        hash = step(hash, byte[i]);
    return hash;
}

uint64_t hash_numbers(uint64_t hash, const void *numbers, size_t count, size_t size)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    const unsigned char *number = numbers;
    for (size_t i = 0; i < count; i++, number += size)
        for (size_t k = size; k-- > 0;)
            hash = step(hash, number[k]);
    return hash;
#else
    return hash_bytes(hash, numbers, count * size);
#endif
}

/* Austin Appleby, MurmurHash3, fmix64. */
uint64_t hash_finish(uint64_t hash)
{
    hash ^= hash >> 33;
    hash *= UINT64_C(0xff51afd7ed558ccd);
    hash ^= hash >> 33;
    hash *= UINT64_C(0xc4ceb9fe1a85ec53);
    return hash ^ hash >> 33;
}
