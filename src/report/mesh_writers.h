/* Writers of meshes: a description as text and as JSON, and formats for other renderers, so that all of them render the
 * same triangles. Ownership: the JSON is a new reference, NULL when out of memory. Errors of the stream stay in the
 * stream, where the caller checks them. */
#pragma once

#include "geometry/mesh/mesh.h"
#include <jansson.h>
#include <stdio.h>

void mesh_rows_text(FILE *stream, const mesh *m);
json_t *mesh_rows_json(const mesh *m);

/*   obj  Wavefront: positions and triangles
 *   bin  nine little-endian numbers per triangle, nothing else: floats if the mesh is in single precision, else doubles
 *   ply  Stanford, binary, little-endian: all data of the mesh (normals nx ny nz, texture coordinates s t, slots
 *        as material_index)
 *
 * Single-precision coordinates are written with 9 significant digits, double-precision ones with 17, so that they read
 * back the same. mirrored: obj and ply are written in right-handed axes (z changes its sign), as readers of these
 * formats expect; bin is in the mesh's own. */
typedef enum mesh_format { MESH_OBJ, MESH_BIN, MESH_PLY, MESH_FORMAT_COUNT } mesh_format;

const char *mesh_format_name(mesh_format format); /* "obj" */
void mesh_write(const mesh *m, mesh_format format, bool mirrored, FILE *stream);
