/* Writers of meshes: a description as text and as JSON, and formats for other programs, so that all of them render the
 * same triangles. Ownership: the JSON is a new reference, NULL when out of memory. Errors of the stream stay in the
 * stream, where the caller checks them. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include <jansson.h>
#include <stdio.h>

/* refusal: why a closed mesh cannot be transparent (hierarchy_operands), or NULL. */
void mesh_rows_text(FILE *stream, const mesh *m, const char *refusal);
json_t *mesh_rows_json(const mesh *m, const char *refusal);

/*   obj  Wavefront: positions, colours of vertices, and triangles
 *   ply  Stanford, binary, little-endian: all data of the mesh (normals nx ny nz, texture coordinates s t,
 *        colours red green blue, slots as material_index)
 *   glb  glTF 2.0, binary (Khronos, "glTF 2.0 Specification", 2021): all data of the mesh, as floats, and of its
 *        materials names, colours, emission, alpha, glass and images: those inside the mesh file are copied, the others
 *        named by their paths. Left out are highlights, cameras and lights
 *
 * OBJ and PLY read back the same: single-precision coordinates are written with 9 significant digits, or as floats,
 * double-precision ones with 17, or as doubles. */
typedef enum mesh_format { MESH_OBJ, MESH_PLY, MESH_GLB, MESH_FORMAT_COUNT } mesh_format;

const char *mesh_format_name(mesh_format format); /* "obj" */

/* mirrored: written with z of the other sign, in the right-handed axes of these formats. looks: the materials by slot,
 * whose image paths start in the working folder, or NULL. path: of the written file, where paths in it start; NULL or
 * "" means a file in the working folder.
 * STATUS_BAD_INPUT: larger than a GLB file can be (4 GiB), or without triangles. */
status mesh_write(const mesh *m, const mesh_import *looks, mesh_format format, bool mirrored, const char *path,
                  FILE *stream, diagnostic *why);
/* The largest change of a coordinate by rounding to floats. */
double mesh_rounding(const mesh *m);
