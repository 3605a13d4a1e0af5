/* How many objects of a scene may have a name: an upper bound by the names' hashes, which is nearly always exact. It
 * makes the usual question, whether a name is in use, independent of the number of objects.
 *
 * Ownership: zero-initialised; name_tally_clear frees. Without memory it is `lost`, and gives the largest bound. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct name_tally {
    uint64_t *hash;  /* open addressing; a place with count 0 and hash 0 is free */
    uint32_t *count; /* of names with that hash */
    size_t size, used;
    bool lost;
} name_tally;

void name_tally_add(name_tally *t, const char *name);
void name_tally_remove(name_tally *t, const char *name);
/* At least the number of objects with that name. */
size_t name_tally_most(const name_tally *t, const char *name);
void name_tally_clear(name_tally *t);
