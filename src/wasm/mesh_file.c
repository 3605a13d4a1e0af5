/* Meshes from files in a browser. See scene/assets/mesh_file.h. */
#include "scene/assets/mesh_file.h"

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    (void)limits;
    *out = NULL;
    return diagnose_at(why, path, STATUS_BAD_INPUT, "open the scene with the program cuvette",
                       "mesh files cannot be read in a browser");
}
