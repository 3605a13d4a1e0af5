/* Reads mesh files in a module: OBJ and PLY, by the readers of wasm/mesh, which the browser's sandbox confines. See
 * scene/assets/mesh_file.h. */
#include "scene/assets/mesh_file.h"
#include "base/file.h"
#include "scene/assets/mesh_stream.h"
#include "wasm/mesh/mesh.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BYTES_MAX = 512 << 20 };

static status read_parts(const char *path, const char *ending, mesh_parts *p, mesh_import **out, diagnostic *why)
{
    char *text = NULL;
    size_t size = 0;
    TRY(file_read_below(path, p->limits->root, BYTES_MAX, &text, &size, why));
    status code = size > 0 ? STATUS_OK : diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the file is empty");
    THEN(code, mesh_parts_begin(p, p->limits, why));
    THEN(code,
         strcasecmp(ending, ".obj") == 0 ? obj_read_text(path, text, size, p, why) : ply_read_text(text, size, p, why));
    free(text);
    THEN(code, mesh_parts_import(p, out, why));
    THEN(code, mesh_textures_find(path, *out, why));
    return code;
}

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    const mesh_limits all = mesh_limits_complete(limits);
    const char *ending = strrchr(path, '.');
    mesh_parts parts = {.limits = &all};
    diagnostic inner = {.line = 0};
    *out = NULL;
    if (!*path)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the name of the mesh file is empty");
    if (!ending || (strcasecmp(ending, ".obj") != 0 && strcasecmp(ending, ".ply") != 0))
        return diagnose_at(why, path, STATUS_BAD_INPUT,
                           "convert it to OBJ or PLY, or open the scene with the program cuvette",
                           "a browser reads meshes from .obj and .ply files only");
    diagnostic_locate(&inner, path, 0, 0);
    mesh_import *fresh = NULL;
    const status code = read_parts(path, ending, &parts, &fresh, &inner);
    mesh_parts_release(&parts);
    if (code == STATUS_OK) {
        *out = fresh;
        return code;
    }
    mesh_import_destroy(fresh);
    if (why)
        *why = inner;
    return code;
}
