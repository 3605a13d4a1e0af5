/* Sets of primitives in 64 bits, for scenes with more primitives than bits. A set of up to three primitives is written
 * out: their numbers plus one, ascending, 21 bits each. A larger set has bit 63, and its number in a table that keeps
 * one copy of each such set.
 *
 * Ownership: set_table_create creates, set_table_destroy frees. Any number of threads may use one table at once.
 * Errors: a set that cannot be stored because memory runs out becomes the empty set, and set_table_failed is true from
 * then on. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { SET_WRITTEN_OUT = 3, SET_FIELD_BITS = 21, SET_PRIMITIVES_MAX = (1 << SET_FIELD_BITS) - 1 };
#define SET_LARGE (UINT64_C(1) << 63)

typedef struct set_table set_table;

set_table *set_table_create(void); /* NULL: out of memory */
void set_table_destroy(set_table *t);
bool set_table_failed(const set_table *t);

/* The primitives of a set: count numbers, ascending. `room` holds those of a set that is written out; those of a larger
 * one are borrowed from the table. */
typedef struct set_members {
    int count;
    const uint32_t *primitive;
    uint32_t room[SET_WRITTEN_OUT];
} set_members;
void set_table_members(const set_table *t, uint64_t set, set_members *out);

/* The set of these primitives: ascending, each once, each at most SET_PRIMITIVES_MAX - 1. */
uint64_t set_table_of(set_table *t, const uint32_t *primitive, int count);

bool set_table_has_large(const set_table *t, uint64_t set, int p);
static inline bool set_table_has(const set_table *t, uint64_t set, int p)
{
    const uint64_t wanted = (uint64_t)p + 1, field = SET_PRIMITIVES_MAX;
    if (set & SET_LARGE)
        return set_table_has_large(t, set, p);
    return (set & field) == wanted || (set >> SET_FIELD_BITS & field) == wanted || set >> 2 * SET_FIELD_BITS == wanted;
}

/* The set with or without one primitive. */
uint64_t set_table_change(set_table *t, uint64_t set, int p, bool in);
static inline uint64_t set_table_put(set_table *t, uint64_t set, int p, bool in)
{
    if (set == 0)
        return in ? (uint64_t)p + 1 : 0;
    return set_table_has(t, set, p) == in ? set : set_table_change(t, set, p, in);
}
/* Whether a set, passed in by a caller, is a set of this table. */
bool set_table_knows(const set_table *t, uint64_t set);
