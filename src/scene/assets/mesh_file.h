/* Triangle meshes from disk: OBJ with its MTL, PLY, STL, glTF 2.0 and glb, told by the ending of the name. A process of
 * its own (cuvette-import, with assimp) reads the file under limits of memory and time, so that no file can take the
 * caller down; what it answers is checked once more. Any thread may call; several may at once. Node hierarchies are
 * flattened, polygons triangulated, equal vertices joined, points and lines dropped. Coordinates are the file's own
 * floats where no node moves them. Normals are the file's or none; an STL file's facet normals are not taken. Every
 * file that the mesh names (MTL, buffers, pictures) must be there. Vertex colours, emission, lights, cameras, animation
 * and the metalness of glTF are not read. Ownership: the import is the caller's (scene/assets/mesh_stream.h). Errors:
 * STATUS_BAD_INPUT with the file, and what is wrong with it. */
#pragma once

#include "scene/assets/mesh_stream.h"

/* limits may be NULL. Textures come back as paths that can be opened: absolute, or beside the mesh file; they are
 * looked for, not opened. */
status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why);
