/* The triangles of a scene's mesh: computed from its parameters, or read from its file. Ownership: the entry becomes an
 * owner of what it is given, mesh_entry_unload lets go of it. */
#pragma once

#include "scene/model/mesh_entry.h"

/* Of an entry whose source is no file and that has no data. */
status mesh_make(mesh_entry *m, diagnostic *why);

/* path: from the working folder. No mesh has more triangles than limits allow all together. */
status mesh_make_from_file(mesh_entry *m, const char *path, const load_limits *limits, diagnostic *why);
