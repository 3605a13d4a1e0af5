/* The result of cuvette-import's readers: one mesh whose equal vertices are joined. It does not need assimp, so that
 * the module for browsers can use it, too (wasm/mesh). Ownership: the caller frees the arrays. */
#pragma once

#include "base/vec3.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum file_kind { FILE_OBJ, FILE_PLY, FILE_STL, FILE_GLTF, FILE_GLB, FILE_UNKNOWN } file_kind;

typedef struct request {
    const char *path;
    file_kind kind;               /* by the file's extension */
    uint64_t memory_mib, seconds; /* limits on this process */
    uint64_t triangles, vertices; /* limits on the mesh */
    const char *root;             /* folder of all files that may be opened (base/file.h); "": no restriction */
    enum { READER_ANY, READER_PLAIN, READER_ASSIMP } reader; /* what reads OBJ files; READER_PLAIN: obj.h */
} request;

/* One mesh in world coordinates. Vertices that are equal in position, normal and texture coordinates are joined. */
typedef struct flat_mesh {
    size_t vertex_count, triangle_count;
    vec3 *positions, *normals;
    struct {
        double u, v;
    } * uvs;
    uint32_t (*triangles)[3];
    uint8_t *slots;
    bool with_normals, with_uvs;
    unsigned material_count, materials[256]; /* by slot: index into the scene's materials */
} flat_mesh;

/* A hash table of the vertices of a flat_mesh. The key is the bits of 8 numbers: position, normal and texture
 * coordinates. Missing ones are 0, and none may be -0. join_vertex finds the vertex with these numbers, or adds it. */
typedef struct joiner {
    uint32_t *table;
    size_t size;
    size_t room;
} joiner;
enum joined { JOINED, JOIN_NO_MEMORY, JOIN_TOO_MANY };
uint64_t join_hash(const flat_mesh *flat, const double numbers[8]);
/* Starts to load what join_vertex will read: tables of large meshes exceed the caches. */
void join_prefetch(const joiner *j, uint64_t hash);
enum joined join_vertex(joiner *j, flat_mesh *flat, uint64_t limit, const double numbers[8], uint64_t hash,
                        uint32_t *index);
/* Makes room for `count` vertices; false: out of memory. */
bool join_reserve(joiner *j, flat_mesh *flat, size_t count);
