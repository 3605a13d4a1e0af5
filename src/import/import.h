/* The parts of the program cuvette-import, one file each. It reads one mesh file with assimp under resource limits that
 * it sets itself, and writes the triangles to standard output in the format of import/mesh_wire.h. It is a separate
 * program so that a file that crashes assimp or exhausts its memory affects nothing else. Ownership: memory is never
 * freed; the process ends as soon as the mesh is written. Errors: STATUS_BAD_INPUT and the reason in the diagnostic,
 * also when out of memory, because the program sets the memory limit itself. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "import/mesh_wire.h"
#include <assimp/cfileio.h>
#include <assimp/scene.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef enum file_kind { FILE_OBJ, FILE_PLY, FILE_STL, FILE_GLTF, FILE_GLB, FILE_UNKNOWN } file_kind;

typedef struct request {
    const char *path;
    file_kind kind;               /* by the file's extension */
    uint64_t memory_mib, seconds; /* limits on this process */
    uint64_t triangles, vertices; /* limits on the mesh */
    const char *root;             /* all files that are opened must be below it (base/below.h); "": anywhere */
    enum { READER_ANY, READER_PLAIN, READER_ASSIMP } reader; /* of OBJ files; plain: obj.h */
} request;

/* ---- files.c ---- */

/* The file access of assimp, for the mesh file and all files that it names: only regular files below the root, read
 * only, without waiting. Records the first file that cannot be opened. */
typedef struct file_access {
    struct aiFileIO io;
    const char *root;
    const char *path, *text; /* the text that is read in place of this file, or NULL */
    size_t text_length;
    char missing[512];  /* the first file that could not be opened; "": none */
    const char *reason; /* why it could not be opened */
    bool outside;       /* it is not below the root */
} file_access;

void files_prepare(file_access *access, const request *req);
/* Opens the mesh file itself; NULL if that fails. */
FILE *files_open(const request *req);
/* Checks that the mesh file is a regular file and not empty. */
status files_check(const request *req, diagnostic *why);

/* ---- whole.c ---- */

/* Checks that a PLY or STL file has the length that its header implies, and a glTF file the form of its ending. */
status check_whole(const request *req, diagnostic *why);

/* ---- read.c ---- */

/* Reads the file and triangulates it. Fails if a file that it names cannot be opened. */
status read_scene(const request *req, const struct aiScene **out, diagnostic *why);
/* The same for a text in place of the mesh file's; NULL: it cannot be read. */
const struct aiScene *read_scene_text(const request *req, const char *text, size_t length);
status no_memory_for(const request *req, diagnostic *why);

/* ---- flatten.c ---- */

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

status flatten(const request *req, const struct aiScene *scene, flat_mesh *flat, diagnostic *why);

/* ---- join.c ---- */

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

/* ---- write.c ---- */

status write_mesh(const request *req, const struct aiScene *scene, const flat_mesh *flat, FILE *to, diagnostic *why);
