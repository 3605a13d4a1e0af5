/* The parts of the program cuvette-import, one file each. It reads one mesh file with assimp under resource limits that
 * it sets itself, and writes the triangles to standard output in the format of import/mesh_wire.h. It is a separate
 * program so that a file that crashes assimp or exhausts its memory affects nothing else. Ownership: results are never
 * freed; the process ends as soon as the mesh is written. Errors: STATUS_BAD_INPUT and the reason in the diagnostic,
 * also when out of memory, because the program sets the memory limit itself; STATUS_FAILURE only if standard output
 * cannot be written. */
#pragma once

#include "base/status.h"
#include "import/flat_mesh.h"
#include "import/mesh_wire.h"
#include <assimp/cfileio.h>
#include <assimp/scene.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* ---- files.c ---- */

/* The file access of assimp, for the mesh file and all files that it names: only regular files below the root, read
 * only, without waiting. Records the first file that cannot be opened. */
typedef struct file_access {
    struct aiFileIO io;
    const char *root;
    const char *path, *text; /* `text` is read in place of the file `path`; NULL: every file is read itself */
    size_t text_length;
    char missing[512];  /* the first file that could not be opened; "": none */
    const char *reason; /* why the missing file could not be opened */
    bool outside;       /* the missing file is not below the root */
} file_access;

status no_memory_for(const request *req, diagnostic *why);
void files_prepare(file_access *access, const request *req);
/* Opens the mesh file itself; NULL if that fails. */
FILE *files_open(const request *req);
/* Checks that the mesh file is a regular file and not empty. */
status files_check(const request *req, diagnostic *why);

/* Checks that a PLY or STL file has the length that its header implies, and that a glTF file has the form (JSON or
 * binary) that its ending names. */
status files_check_complete(const request *req, diagnostic *why);

/* ---- read.c ---- */

/* Reads the file and triangulates it. Fails if a file that it names cannot be opened. */
status read_scene(const request *req, const struct aiScene **out, diagnostic *why);
/* Like read_scene, with `text` in place of the mesh file's contents; NULL on failure. */
const struct aiScene *read_scene_text(const request *req, const char *text, size_t length);

/* Transforms all meshes to world coordinates and joins them in `flat`. */
status flatten(const request *req, const struct aiScene *scene, flat_mesh *flat, diagnostic *why);

/* ---- write.c ---- */

status write_mesh(const request *req, const struct aiScene *scene, const flat_mesh *flat, FILE *to, diagnostic *why);
