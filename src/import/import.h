/* The parts of the program cuvette-import that need assimp, one file each: they read glTF files. The program reads one
 * mesh file under resource limits that it sets itself, and writes the triangles to standard output in the format of
 * import/mesh_wire.h. It is a separate program so that a file that crashes assimp or exhausts its memory affects
 * nothing else. Ownership: assimp's scene is never freed; the process ends as soon as the mesh is written. Errors:
 * STATUS_BAD_INPUT and the reason in the diagnostic, also when out of memory, because the program sets the memory limit
 * itself. */
#pragma once

#include "base/status.h"
#include "import/plain.h"
#include <assimp/cfileio.h>
#include <assimp/scene.h>
#include <stdbool.h>
#include <stddef.h>

/* ---- gltf_files.c ---- */

/* The file access of assimp, for the mesh file and all files that it names: only regular files below the root, read
 * only, without waiting. Records the first file that cannot be opened. */
typedef struct file_access {
    struct aiFileIO io;
    const char *root;
    char missing[512];  /* the first file that could not be opened; "": none */
    const char *reason; /* why the missing file could not be opened */
    bool outside;       /* the missing file is not below the root */
} file_access;

void files_prepare(file_access *access, const request *req);
/* The error for the missing file. */
status files_needed(const file_access *access, diagnostic *why);

/* Checks that the mesh file is a regular file, not empty, and has the form (JSON or binary) that its ending names. */
status files_check(const request *req, diagnostic *why);

/* ---- read.c ---- */

/* Reads the file and triangulates it. Fails if a file that it names cannot be opened. */
status read_scene(const request *req, const struct aiScene **out, diagnostic *why);

/* Transforms all meshes to world coordinates and joins them in `flat`. */
status flatten(const request *req, const struct aiScene *scene, flat_mesh *flat, diagnostic *why);
