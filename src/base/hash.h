/* A 64-bit hash of data: FNV-1a over 64-bit words (or bytes), with a shift folded into each step, and a final mix
 * (Fowler, Noll, Vo; Appleby's fmix64). Not for security. Identical on every platform. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define HASH_START UINT64_C(14695981039346656037)

/* words: their bits, 8 bytes each, of any type. */
uint64_t hash_words(uint64_t hash, const void *words, size_t count);
uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count);
/* Numbers of `size` bytes each, lowest byte first on every machine. */
uint64_t hash_numbers(uint64_t hash, const void *numbers, size_t count, size_t size);
uint64_t hash_finish(uint64_t hash);
