/* The search for vertices at equal positions: a hash table of vertex numbers with open addressing. */
#include "base/cancel.h"
#include "base/array.h"
#include "geometry/mesh_parts.h"

#include <stdlib.h>
#include <string.h>

#define NO_MEMORY "out of memory for the vertices of a mesh"

static uint64_t bits_of(double x)
{
    uint64_t bits;
    x += 0.0; /* -0 becomes 0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Coordinates that are floats differ in their high bits only: each step mixes these into the low bits. */
static uint64_t position_hash(vec3 p)
{
    uint64_t h = bits_of(p.x) * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ h >> 32 ^ bits_of(p.y)) * UINT64_C(0xd6e8feb86659fd93);
    h = (h ^ h >> 32 ^ bits_of(p.z)) * UINT64_C(0xd6e8feb86659fd93);
    return h ^ h >> 32;
}

static bool same_place(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static uint32_t *numbers(size_t count)
{
    return large_pages(malloc(count * sizeof(uint32_t)), count * sizeof(uint32_t));
}

/* Every vertex is its own. */
static status weld_distinct(const mesh *m, uint32_t **same, diagnostic *why)
{
    uint32_t *own = *same = numbers(m->vertex_count + 1);
    for (size_t v = 0; own && v < m->vertex_count; v++)
        own[v] = (uint32_t)v;
    return own ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_MEMORY);
}

status mesh_weld(const mesh *m, uint32_t **same, diagnostic *why)
{
    if (m->distinct)
        return weld_distinct(m, same, why);
    enum { AHEAD = 16 }; /* the table exceeds the caches: prefetch its lines */
    size_t size = 16;
    while (size < 2 * m->vertex_count)
        size *= 2;
    uint32_t *table = numbers(size), *found = numbers(m->vertex_count + 1);
    if (!table || !found) {
        free(table);
        free(found);
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_MEMORY);
    }
    for (size_t at = 0; at < size; at++) {
        if (cancel_asked_at(at))
            break;
        table[at] = UINT32_MAX;
    }
    uint64_t hashes[AHEAD];
    for (size_t v = 0; v < m->vertex_count + AHEAD && !cancel_asked_at(v); v++) {
        if (v >= AHEAD) {
            const size_t at = v - AHEAD;
            size_t place = hashes[at % AHEAD] & (size - 1);
            while (table[place] != UINT32_MAX && !same_place(m->vertices[table[place]], m->vertices[at]))
                place = (place + 1) & (size - 1);
            if (table[place] == UINT32_MAX)
                table[place] = (uint32_t)at;
            found[at] = table[place];
        }
        if (v < m->vertex_count) {
            hashes[v % AHEAD] = position_hash(m->vertices[v]);
            __builtin_prefetch(&table[hashes[v % AHEAD] & (size - 1)]);
        }
    }
    free(table);
    *same = found;
    return cancel_check(why);
}
