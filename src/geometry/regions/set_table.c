/* Sets of primitives in 64 bits. Large sets are found by their hash in lists that only grow at the front, so that a
 * look-up needs no lock. */
#include "geometry/regions/set_table.h"

#include "base/hash.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { FIELD = SET_PRIMITIVES_MAX, BUCKETS = 4096, CHUNKS = 32, FIRST_CHUNK = 64 };

typedef struct large_set {
    struct large_set *next; /* in its bucket */
    uint64_t hash;
    uint32_t number;
    int count;
    uint32_t primitive[];
} large_set;

/* Chunk c of the sets by number has FIRST_CHUNK << c places. */
struct set_table {
    _Atomic(large_set *) bucket[BUCKETS];
    _Atomic(large_set **) chunk[CHUNKS];
    atomic_uint_fast32_t count;
    atomic_bool failed;
    pthread_mutex_t lock; /* for adding */
};

set_table *set_table_create(void)
{
    set_table *t = calloc(1, sizeof *t);
    if (t && pthread_mutex_init(&t->lock, NULL) != 0) {
        free(t);
        return NULL;
    }
    return t;
}

void set_table_destroy(set_table *t)
{
    if (!t)
        return;
    for (int b = 0; b < BUCKETS; b++) {
        for (large_set *next, *s = atomic_load(&t->bucket[b]); s; s = next) {
            next = s->next;
            free(s);
        }
    }
    for (int c = 0; c < CHUNKS; c++)
        free(atomic_load(&t->chunk[c]));
    pthread_mutex_destroy(&t->lock);
    free(t);
}

bool set_table_failed(const set_table *t)
{
    return atomic_load(&t->failed);
}

/* The place of a number: its chunk, and its index there. */
static uint32_t place_of(uint32_t number, int *chunk)
{
    const uint32_t blocks = number / FIRST_CHUNK + 1;
    *chunk = 31 - __builtin_clz(blocks);
    return number - (uint32_t)FIRST_CHUNK * ((UINT32_C(1) << *chunk) - 1);
}

static const large_set *large_of(const set_table *t, uint64_t set)
{
    int chunk;
    const uint32_t at = place_of((uint32_t)set, &chunk);
    return atomic_load_explicit(&t->chunk[chunk], memory_order_acquire)[at];
}

void set_table_members(const set_table *t, uint64_t set, set_members *out)
{
    if (set & SET_LARGE) {
        const large_set *s = large_of(t, set);
        out->count = s->count;
        out->primitive = s->primitive;
        return;
    }
    out->count = 0;
    out->primitive = out->room;
    for (; set; set >>= SET_FIELD_BITS)
        out->room[out->count++] = (uint32_t)(set & FIELD) - 1;
}

bool set_table_has_large(const set_table *t, uint64_t set, int primitive)
{
    const large_set *s = large_of(t, set);
    int low = 0, high = s->count;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (s->primitive[middle] < (uint32_t)primitive)
            low = middle + 1;
        else
            high = middle;
    }
    return low < s->count && s->primitive[low] == (uint32_t)primitive;
}

static uint64_t hash_of(const uint32_t *primitive, int count)
{
    return hash_finish(hash_bytes(HASH_START, primitive, (size_t)count * sizeof *primitive));
}

static const large_set *find(const large_set *s, uint64_t hash, const uint32_t *primitive, int count)
{
    while (s && !(s->hash == hash && s->count == count &&
                  memcmp(s->primitive, primitive, (size_t)count * sizeof *primitive) == 0))
        s = s->next;
    return s;
}

/* Makes room for one more number; false: out of memory. */
static bool grow(set_table *t, uint32_t number)
{
    int chunk;
    place_of(number, &chunk);
    if (atomic_load(&t->chunk[chunk]))
        return true;
    large_set **created = calloc((size_t)FIRST_CHUNK << chunk, sizeof(large_set *));
    atomic_store_explicit(&t->chunk[chunk], created, memory_order_release);
    return created != NULL;
}

static const large_set *add(set_table *t, uint64_t hash, const uint32_t *primitive, int count)
{
    _Atomic(large_set *) *bucket = &t->bucket[hash % BUCKETS];
    const large_set *there = find(atomic_load(bucket), hash, primitive, count); /* added by another thread? */
    const uint32_t number = (uint32_t)atomic_load(&t->count);
    if (there)
        return there;
    large_set *s = malloc(sizeof *s + (size_t)count * sizeof *primitive);
    if (!s || !grow(t, number)) {
        free(s);
        atomic_store(&t->failed, true);
        return NULL;
    }
    *s = (large_set){.next = atomic_load(bucket), .hash = hash, .number = number, .count = count};
    memcpy(s->primitive, primitive, (size_t)count * sizeof *primitive);
    int chunk;
    const uint32_t at = place_of(number, &chunk);
    atomic_load(&t->chunk[chunk])[at] = s;
    atomic_store_explicit(bucket, s, memory_order_release);
    atomic_store(&t->count, number + 1);
    return s;
}

uint64_t set_table_of(set_table *t, const uint32_t *primitive, int count)
{
    if (count <= SET_WRITTEN_OUT) {
        uint64_t set = 0;
        for (int k = 0; k < count; k++)
            set |= ((uint64_t)primitive[k] + 1) << k * SET_FIELD_BITS;
        return set;
    }
    const uint64_t hash = hash_of(primitive, count);
    const large_set *s =
        find(atomic_load_explicit(&t->bucket[hash % BUCKETS], memory_order_acquire), hash, primitive, count);
    if (!s) {
        pthread_mutex_lock(&t->lock);
        s = add(t, hash, primitive, count);
        pthread_mutex_unlock(&t->lock);
    }
    return s ? SET_LARGE | s->number : 0;
}

uint64_t set_table_change(set_table *t, uint64_t set, int primitive, bool in)
{
    set_members old;
    set_table_members(t, set, &old);
    uint32_t few[SET_WRITTEN_OUT + 1] = {0}, *changed = few;
    if (old.count > SET_WRITTEN_OUT && !(changed = malloc(((size_t)old.count + 1) * sizeof *changed))) {
        atomic_store(&t->failed, true);
        return 0;
    }
    int count = 0;
    bool placed = !in;
    for (int k = 0; k < old.count; k++) {
        if (!placed && old.primitive[k] > (uint32_t)primitive) {
            changed[count++] = (uint32_t)primitive;
            placed = true;
        }
        if (old.primitive[k] != (uint32_t)primitive)
            changed[count++] = old.primitive[k];
    }
    if (!placed)
        changed[count++] = (uint32_t)primitive;
    const uint64_t created = set_table_of(t, changed, count);
    if (changed != few)
        free(changed);
    return created;
}

bool set_table_knows(const set_table *t, uint64_t set)
{
    if (set & SET_LARGE)
        return (set & ~SET_LARGE) < atomic_load(&t->count);
    return true;
}
