/* Meshes out: for other renderers, so that all trace the same triangles. Ownership: nothing is kept. Errors of the
 * stream are left in the stream, where a file's commit finds them.
 *
 *   obj  Wavefront: positions and triangles
 *   bin  nine little-endian floats a triangle, nothing else
 *   ply  Stanford, binary, little-endian: all that the mesh has (normals nx ny nz, texture coordinates s t, slots
 *        as material_index)
 *
 * Coordinates that are floats are written with 9 significant digits, others with 17, so that they read back the
 * same. */
#pragma once

#include "geometry/mesh.h"
#include <stdio.h>

typedef enum mesh_format { MESH_OBJ, MESH_BIN, MESH_PLY, MESH_FORMAT_COUNT } mesh_format;

const char *mesh_format_name(mesh_format format); /* "obj" */
void mesh_write(const mesh *m, mesh_format format, FILE *stream);
