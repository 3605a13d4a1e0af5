/* The program cuvette-import: reads one mesh file with assimp under resource limits that it sets itself, and writes the
 * triangles to standard output in the format of import/mesh_wire.h. It is a separate program so that a file that
 * crashes the reader or exhausts memory affects nothing else. One file per part. Ownership: memory is never freed; the
 * process exits as soon as the mesh is written. Errors: STATUS_BAD_INPUT with the reason in the diagnostic; running out
 * of memory counts as an error of the file, because the limit is ours. */
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
    file_kind kind;               /* by file name extension */
    uint64_t memory_mib, seconds; /* limits on this process */
    uint64_t triangles, vertices; /* limits on the mesh */
    const char *root;             /* all files are opened below this folder (base/below.h); "": anywhere */
} request;

/* ---- files.c ---- */

/* How assimp opens the file and all files that it refers to: regular files below the root, for reading, without
 * blocking. Missing files are counted. */
typedef struct file_access {
    struct aiFileIO io;
    const char *root;
    char missing[512];  /* the first file that could not be opened; "" */
    const char *reason; /* the system's error message, or our own */
    bool outside;       /* it is not below the root */
} file_access;

void files_prepare(file_access *access, const request *asked);
/* The file itself as such a stream, NULL if it can no longer be opened. */
FILE *files_open(const request *asked);
/* Checks that it is a regular file that is not empty. */
status files_check(const request *asked, diagnostic *why);

/* ---- whole.c ---- */

/* Checks that a PLY or STL file is as long as its header implies. */
status check_whole(const request *asked, diagnostic *why);

/* ---- read.c ---- */

/* The scene of the file, triangulated; all files that it needs existed. */
status read_scene(const request *asked, const struct aiScene **out, diagnostic *why);
status no_memory_for(const request *asked, diagnostic *why);

/* ---- flatten.c ---- */

/* One mesh in world coordinates. Vertices that are equal in all their numbers are merged. */
typedef struct flat_mesh {
    size_t vertex_count, triangle_count;
    vec3 *positions, *normals;
    struct {
        double u, v;
    } * uvs;
    uint32_t (*triangles)[3];
    uint8_t *slots;
    bool with_normals, with_uvs;
    unsigned material_count, materials[256]; /* by slot: index of the scene's material */
} flat_mesh;

status flatten(const request *req, const struct aiScene *scene, flat_mesh *flat, diagnostic *why);

/* ---- join.c ---- */

/* Adds a vertex to flat, or finds an equal one. */
typedef struct joiner {
    uint32_t *table;
    size_t size;
    size_t room;
} joiner;
enum joined { JOINED, JOIN_NO_MEMORY, JOIN_TOO_MANY };
enum joined join_vertex(joiner *j, flat_mesh *flat, uint64_t limit, const double numbers[8], uint32_t *index);

/* ---- write.c ---- */

status write_mesh(const request *req, const struct aiScene *scene, const flat_mesh *flat, FILE *to, diagnostic *why);
