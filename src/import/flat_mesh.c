/* The hash table of vertices, keyed by their bits: open addressing with linear probing, at most half full. */
#include "import/flat_mesh.h"
#include "base/array.h"

#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 8 };

static void vertex_numbers(const flat_mesh *flat, uint32_t index, double numbers[NUMBERS])
{
    vec3 p = flat->positions[index];
    vec3 n = flat->with_normals ? flat->normals[index] : vec3_make(0, 0, 0);
    double u = flat->with_uvs ? flat->uvs[index].u : 0, v = flat->with_uvs ? flat->uvs[index].v : 0;
    memcpy(numbers, (double[NUMBERS]){p.x, p.y, p.z, n.x, n.y, n.z, u, v}, NUMBERS * sizeof *numbers);
}

uint64_t join_hash(const flat_mesh *flat, const double numbers[NUMBERS])
{
    const int used = flat->with_normals || flat->with_uvs ? NUMBERS : 3;
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < used; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu; /* MurmurHash3's finaliser, Appleby */
        hash ^= hash >> 32;
    }
    return hash;
}

void join_prefetch(const joiner *j, uint64_t hash)
{
    if (j->size)
        __builtin_prefetch(&j->table[hash & (j->size - 1)]);
}

/* The table index of the vertex with these numbers, or of the empty entry for it. Entries are index + 1; 0 is empty. */
static size_t find(const joiner *j, const flat_mesh *flat, const double numbers[NUMBERS], uint64_t hash)
{
    size_t at = hash & (j->size - 1);
    while (j->table[at]) {
        double other[NUMBERS];
        vertex_numbers(flat, j->table[at] - 1, other);
        if (memcmp(other, numbers, sizeof other) == 0)
            break;
        at = (at + 1) & (j->size - 1);
    }
    return at;
}

static bool resize_table(joiner *j, const flat_mesh *flat, size_t size)
{
    joiner larger = {.size = size, .room = j->room};
    larger.table = large_calloc(larger.size, sizeof *larger.table);
    if (!larger.table)
        return false;
    for (size_t i = 0; i < flat->vertex_count; i++) {
        double numbers[NUMBERS];
        vertex_numbers(flat, (uint32_t)i, numbers);
        larger.table[find(&larger, flat, numbers, join_hash(flat, numbers))] = (uint32_t)i + 1;
    }
    free(j->table);
    *j = larger;
    return true;
}

static void *resized(void *array, size_t room, size_t size)
{
    return large_pages(realloc(array, room * size), room * size);
}

static bool resize_arrays(joiner *j, flat_mesh *flat, size_t room)
{
    vec3 *positions = resized(flat->positions, room, sizeof *positions);
    flat->positions = positions ? positions : flat->positions;
    vec3 *normals = flat->with_normals ? resized(flat->normals, room, sizeof *normals) : NULL;
    flat->normals = normals ? normals : flat->normals;
    void *uvs = flat->with_uvs ? resized(flat->uvs, room, sizeof *flat->uvs) : NULL;
    flat->uvs = uvs ? uvs : flat->uvs;
    if (!positions || (flat->with_normals && !normals) || (flat->with_uvs && !uvs))
        return false;
    j->room = room;
    return true;
}

bool join_reserve(joiner *j, flat_mesh *flat, size_t count)
{
    size_t size = 1024;
    while (size < 2 * count)
        size *= 2;
    return resize_table(j, flat, size) && resize_arrays(j, flat, count);
}

enum joined join_vertex(joiner *j, flat_mesh *flat, uint64_t limit, const double numbers[NUMBERS], uint64_t hash,
                        uint32_t *index)
{
    if (flat->vertex_count * 2 >= j->size && !resize_table(j, flat, j->size ? j->size * 2 : 1024))
        return JOIN_NO_MEMORY;
    size_t at = find(j, flat, numbers, hash);
    if (j->table[at]) {
        *index = j->table[at] - 1;
        return JOINED;
    }
    if (flat->vertex_count >= limit)
        return JOIN_TOO_MANY;
    if (flat->vertex_count >= j->room && !resize_arrays(j, flat, j->room + j->room / 2 + 1024))
        return JOIN_NO_MEMORY;
    *index = (uint32_t)flat->vertex_count++;
    j->table[at] = *index + 1;
    flat->positions[*index] = vec3_make(numbers[0], numbers[1], numbers[2]);
    if (flat->with_normals)
        flat->normals[*index] = vec3_make(numbers[3], numbers[4], numbers[5]);
    if (flat->with_uvs) {
        flat->uvs[*index].u = numbers[6];
        flat->uvs[*index].v = numbers[7];
    }
    return JOINED;
}
