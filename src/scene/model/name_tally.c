/* Counts of names by hash. */
#include "scene/model/name_tally.h"

#include "base/hash.h"
#include <stdlib.h>
#include <string.h>

/* Never 0. */
static uint64_t hash_of(const char *name)
{
    const uint64_t h = hash_finish(hash_bytes(HASH_START, name, strlen(name)));
    return h ? h : 1;
}

/* The place of a hash, or the free place where it belongs. size: a power of two with a free place. */
static size_t place_of(const name_tally *t, uint64_t hash)
{
    size_t at = (size_t)hash & (t->size - 1);
    while (t->hash[at] != 0 && t->hash[at] != hash)
        at = (at + 1) & (t->size - 1);
    return at;
}

static bool grow(name_tally *t)
{
    const size_t size = t->size ? 2 * t->size : 64;
    name_tally larger = {.hash = calloc(size, sizeof *t->hash), .count = calloc(size, sizeof *t->count), .size = size};
    if (!larger.hash || !larger.count) {
        name_tally_clear(&larger);
        return false;
    }
    for (size_t i = 0; i < t->size; i++) {
        if (t->hash[i] == 0 || t->count[i] == 0)
            continue;
        const size_t at = place_of(&larger, t->hash[i]);
        larger.hash[at] = t->hash[i];
        larger.count[at] = t->count[i];
        larger.used++;
    }
    name_tally_clear(t);
    *t = larger;
    return true;
}

void name_tally_add(name_tally *t, const char *name)
{
    if (t->lost || (2 * (t->used + 1) > t->size && !grow(t))) {
        t->lost = true;
        return;
    }
    const uint64_t hash = hash_of(name);
    const size_t at = place_of(t, hash);
    t->used += t->hash[at] == 0;
    t->hash[at] = hash;
    t->count[at]++;
}

void name_tally_remove(name_tally *t, const char *name)
{
    if (t->lost || t->size == 0)
        return;
    const size_t at = place_of(t, hash_of(name));
    if (t->count[at] > 0)
        t->count[at]--;
}

size_t name_tally_most(const name_tally *t, const char *name)
{
    if (t->lost)
        return SIZE_MAX;
    return t->size ? t->count[place_of(t, hash_of(name))] : 0;
}

void name_tally_clear(name_tally *t)
{
    free(t->hash);
    free(t->count);
    *t = (name_tally){.lost = t->lost};
}
