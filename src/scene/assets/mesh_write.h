/* Meshes out: for other renderers, so that all trace the same triangles. Ownership: nothing is kept. Errors of the
 * stream are left in the stream, where a file's commit finds them.
 *
 *   obj      Wavefront: positions and triangles
 *   bin      nine little-endian floats a triangle, nothing else
 *   pov      a scene for POV-Ray 3.7 with the camera and light of the speed study
 *   tachyon  the same for Tachyon
 *   ply      Stanford, binary, little-endian: all that the mesh has (normals nx ny nz, texture coordinates s t, slots
 *            as material_index)
 *
 * Coordinates that are floats are written with 9 significant digits (tachyon: 9 decimals), others with 17, so that they
 * read back the same. */
#ifndef CUVETTE_SCENE_ASSETS_MESH_WRITE_H
#define CUVETTE_SCENE_ASSETS_MESH_WRITE_H

#include "geometry/mesh.h"
#include <stdio.h>

typedef enum mesh_format { MESH_OBJ, MESH_BIN, MESH_POV, MESH_TACHYON, MESH_PLY, MESH_FORMAT_COUNT } mesh_format;

const char *mesh_format_name(mesh_format format); /* "obj" */
void mesh_write(const mesh *m, mesh_format format, FILE *stream);

#endif
