#include "scene/assets/mesh_file.h"

#include "scene/assets/mesh_child.h"
#include "scene/assets/mesh_textures.h"

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    mesh_limits all = mesh_limits_complete(limits);
    mesh_child child;
    diagnostic said = {.what = ""};
    *out = NULL;
    if (!*path)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the name of the mesh file is empty");
    status code = mesh_child_open(&child, path, &all, &said);
    mesh_import *fresh = NULL;
    if (code == STATUS_OK) {
        mesh_source source = {.read = mesh_child_read, .end = mesh_child_end, .context = &child};
        code = mesh_stream_read(&source, &all, &fresh, &said);
        code = mesh_child_close(&child, path, &all, code, &said);
    }
    THEN(code, mesh_textures_find(path, fresh, &said));
    if (code != STATUS_OK) {
        mesh_import_destroy(fresh);
        if (why)
            *why = said;
        return code;
    }
    *out = fresh;
    return STATUS_OK;
}
