/* What cuvette-import's readers make: one mesh whose equal vertices are joined. Without assimp, so that a module for
 * browsers can use it too (wasm/mesh). Ownership: the arrays are the caller's. */
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
    const char *root;             /* all files that are opened must be below it (base/file.h); "": anywhere */
    enum { READER_ANY, READER_PLAIN, READER_ASSIMP } reader; /* of OBJ files; plain: obj.h */
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

/* A hash table of the vertices of flat, by the bits of their position, normal and texture coordinates; 0 for what they
 * lack, and never -0. join_vertex finds the vertex with these numbers or adds it. */
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
