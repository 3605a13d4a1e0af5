/* A 64-bit fingerprint of data: FNV-1a over 64-bit words (or bytes), each step folded down by a shift, with a
 * final mix (Fowler, Noll, Vo; Appleby's fmix64). Not for security. The same on every machine. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#define HASH_START UINT64_C(14695981039346656037)

uint64_t hash_words(uint64_t hash, const int64_t *words, size_t count);
uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count);
uint64_t hash_finish(uint64_t hash);
