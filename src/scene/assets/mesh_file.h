/* Triangle meshes from files: OBJ with MTL, PLY, STL, glTF 2.0 and glb, by file name extension. A separate process
 * (cuvette-import) reads the file with limits on memory and time, so that no file can crash the caller; its output
 * is validated. Thread safe. Node hierarchies are flattened, polygons triangulated, equal vertices merged, points
 * and lines dropped. Coordinates are the file's numbers, as doubles, unless a node or joints transform them. Normals
 * are the file's or none; facet normals of STL are ignored. Material libraries and images that do not exist are a
 * note of the import; buffers must exist. The alpha of vertices, animation and the metalness of glTF are ignored.
 * Ownership: the import is the caller's (scene/assets/mesh_stream.h). Errors: STATUS_BAD_INPUT with the
 * file and the reason; STATUS_FAILURE if the importer cannot be started, or memory runs out. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include "scene/model/open.h"

/* Reads a mesh file; limits may be NULL. Images of textures are not opened: their paths are absolute, or relative to
 * the mesh file. */
status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why);

/* A first scene out of a mesh file: its mesh as the solid `body`, and from a glTF file its first camera and its lights;
 * a camera that sees all of it, and a sun, where the file has none. If all of the mesh is glass, the solid is of its
 * medium. Lights are scaled by a common factor to a sum of 1 at the middle of the mesh. *notes: what was not read or
 * cannot be said, NULL: nothing; the caller frees it, and destroys the scene, which is not loaded. */
status mesh_first_scene(const char *path, scene **out, char **notes, diagnostic *why);
