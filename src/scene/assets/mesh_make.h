/* The triangles of a scene's mesh, from a generator or a file. Ownership: the entry gets a reference to its data, which
 * mesh_entry_unload releases. */
#pragma once

#include "scene/model/mesh_entry.h"

/* The triangles of a generator's mesh before it is made; 0 for other sources, and for box and lathe, which are
 * small. */
size_t mesh_make_triangles(const mesh_entry *m);

/* For an entry without data whose source is a generator. */
status mesh_make(mesh_entry *m, diagnostic *why);

/* path: relative to the working folder. No mesh may exceed the limits of all meshes together. */
status mesh_make_from_file(mesh_entry *m, const char *path, const load_limits *limits, diagnostic *why);
