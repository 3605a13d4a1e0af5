/* Reads mesh files in a module, by the readers of the program's importer, which the browser's sandbox confines. See
 * scene/assets/mesh_stream.h. */
#include "base/text.h"
#include "import/plain.h"
#include "scene/assets/mesh_stream.h"

#include <stdlib.h>

/* Writes the mesh, releases it, and reads what was written, with the checks of the program. */
static status import_flat(flat_mesh *flat, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    text_writer to;
    char *bytes = NULL;
    size_t size = 0;
    TRY(text_writer_open(&to, why));
    status code = flat_write(flat, to.stream, why);
    flat_release(flat);
    code = text_writer_end(&to, code, &bytes, &size, why);
    THEN(code, mesh_stream_read_bytes(bytes, size, limits, out, why));
    free(bytes);
    return code;
}

static status read_plain(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    const request req = {.path = path,
                         .kind = file_kind_of(path),
                         .triangles = limits->triangles,
                         .vertices = limits->vertices,
                         .root = limits->root ? limits->root : ""};
    flat_mesh *flat = calloc(1, sizeof *flat);
    status code = flat ? plain_read(&req, flat, why) : out_of_memory(why);
    const bool wrong = code != STATUS_OK && why;
    diagnostic_locate(why, path, wrong ? why->line : 0, wrong ? why->column : 0);
    THEN(code, import_flat(flat, limits, out, why));
    THEN(code, mesh_textures_find(path, *out, why));
    if (flat)
        flat_release(flat);
    free(flat);
    return code;
}

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    const mesh_limits all = mesh_limits_complete(limits);
    diagnostic inner = {.line = 0};
    *out = NULL;
    if (!*path)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the name of the mesh file is empty");
    mesh_import *fresh = NULL;
    const status code = read_plain(path, &all, &fresh, &inner);
    if (code == STATUS_OK) {
        *out = fresh;
        return code;
    }
    mesh_import_destroy(fresh);
    if (why)
        *why = inner;
    return code;
}
