/* The program cuvette-import: reads one mesh file with assimp under limits that it sets itself, and writes the
 * triangles on standard output as import/mesh_wire.h says. It is a program of its own so that a file that crashes
 * or fills a reader takes nothing else down. Its parts, one file each. Ownership: what is allocated is never given
 * back; the process ends as soon as the mesh is written, and with it all of it goes. Errors: STATUS_BAD_INPUT and the
 * reason in the diagnostic; memory that is not there is the file's fault, too, because the limit on it is ours. */
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
    file_kind kind;               /* by the ending of its name */
    uint64_t memory_mib, seconds; /* limits on this process */
    uint64_t triangles, vertices; /* limits on the mesh */
    const char *root;             /* all that is opened lies below it (base/below.h); "": anywhere */
} request;

/* ---- files.c ---- */

/* How assimp opens files, here and all that they name: regular ones below the root, for reading, without waiting.
 * Counts the ones that are named and not there. */
typedef struct file_access {
    struct aiFileIO io;
    const char *root;
    char missing[512];  /* the first one that could not be opened; "" */
    const char *reason; /* the system's word on it, or ours */
    bool outside;       /* that it is not below the root */
} file_access;

void files_prepare(file_access *access, const request *asked);
/* The file itself as such a stream, NULL where it cannot be opened any more. */
FILE *files_open(const request *asked);
/* That it is a regular file with something in it, or why not. */
status files_check(const request *asked, diagnostic *why);

/* ---- whole.c ---- */

/* That a PLY or STL file is as long as it says it is. */
status check_whole(const request *asked, diagnostic *why);

/* ---- read.c ---- */

/* The scene of the file, triangulated; every file that it needs was there. */
status read_scene(const request *asked, const struct aiScene **out, diagnostic *why);
status no_memory_for(const request *asked, diagnostic *why);

/* ---- flatten.c ---- */

/* One mesh in world coordinates. Vertices that are equal in every number that they carry are one. */
typedef struct flat_mesh {
    size_t vertex_count, triangle_count;
    vec3 *positions, *normals;
    struct {
        double u, v;
    } * uvs;
    uint32_t (*triangles)[3];
    uint8_t *slots;
    bool with_normals, with_uvs;
    unsigned material_count, materials[256]; /* by slot: index into the scene's */
} flat_mesh;

status flatten(const request *asked, const struct aiScene *scene, flat_mesh *flat, diagnostic *why);

/* ---- join.c ---- */

/* Adds a vertex to flat, or finds the one that equals it. */
typedef struct joiner {
    uint32_t *table;
    size_t size;
    size_t room;
} joiner;
enum joined { JOINED, JOIN_NO_MEMORY, JOIN_TOO_MANY };
enum joined join_vertex(joiner *j, flat_mesh *flat, uint64_t limit, const double numbers[8], uint32_t *index);

/* ---- write.c ---- */

status write_mesh(const request *asked, const struct aiScene *scene, const flat_mesh *flat, FILE *to, diagnostic *why);
