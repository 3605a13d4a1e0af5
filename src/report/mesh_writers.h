/* Writers of meshes: a description as text and as JSON, and formats for other programs, so that all of them render the
 * same triangles. Ownership: the JSON is a new reference, NULL when out of memory. Errors of the stream stay in the
 * stream, where the caller checks them. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include <jansson.h>
#include <stdio.h>
#include <string.h>

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

/* --- glTF files of several meshes (glb.c) ---
 *
 * Writer of glTF 2.0 files (Khronos, "glTF 2.0 Specification", 2021): meshes and their materials, with the numbers
 * in one buffer; the caller adds the nodes. Binary (GLB), or JSON with the buffer in base64. Ownership: glb_create
 * allocates, glb_destroy frees; meshes and looks are borrowed until glb_write. Out of memory is remembered, and
 * reported by glb_write. */

typedef struct glb glb;

/* What an imported material does not have: roughness and metalness, 0 to 1; the factor of the reflectance at normal
 * incidence of a surface that is no metal, 0 to 1, as KHR_materials_specular has it. */
typedef struct glb_finish {
    double roughness, metallic, specular;
} glb_finish;

/* path: of the written file, where paths in it start; "": in the working folder. images: the import whose image files
 * materials name by number; NULL: none. NULL when out of memory. */
glb *glb_create(const char *path, const mesh_import *images);
void glb_destroy(glb *g); /* NULL is allowed */

/* Adds a material; finish NULL: matt, without a word on reflection. Returns its number. */
json_int_t glb_add_material(glb *g, const imported_material *m, const char *name, const glb_finish *finish);
/* Adds a mesh with triangles; mirrored: with z of the other sign. materials: the material by slot, -1 for none; NULL:
 * none for all. smooth, colored: with its normals and colours, if it has any. Returns its number. */
json_int_t glb_add_mesh(glb *g, const mesh *m, bool mirrored, bool smooth, bool colored, const json_int_t *materials);
/* Names an extension as used. */
void glb_use(glb *g, const char *extension);

/* Writes the file. nodes: a list, of which the scene shows all; more: further members of the document, NULL: none;
 * extras: of the asset, NULL: none. Takes all three; NULL nodes are out of memory. STATUS_BAD_INPUT: larger than a GLB
 * file can be (4 GiB). */
status glb_write(glb *g, json_t *nodes, json_t *more, json_t *extras, bool binary, FILE *stream, diagnostic *why);

/* mesh_write for this format (mesh_writers.h). */
status glb_write_mesh(const mesh *m, const mesh_import *looks, bool mirrored, const char *path, FILE *stream,
                      diagnostic *why);

/* --- also for other formats of meshes --- */

static inline vec3 mirrored_if(bool mirrored, vec3 v)
{
    return mirrored ? vec3_make(v.x, v.y, 0.0 - v.z) : v;
}

/* The corner of a triangle that is written as number k: a mirror exchanges the last two (mesh_mirror). */
static inline uint32_t corner_if(bool mirrored, const mesh_triangle *t, int k)
{
    return t->corner[mirrored && k > 0 ? 3 - k : k];
}

/* Little-endian on every machine. */
static inline void put_bits(uint64_t bits, int size, FILE *stream)
{
    for (int k = 0; k < size; k++)
        putc((int)(bits >> 8 * k & 0xff), stream);
}

static inline void put_real(double x, bool single, FILE *stream)
{
    const float narrow = (float)x;
    uint32_t bits32;
    uint64_t bits64;
    memcpy(&bits32, &narrow, sizeof bits32);
    memcpy(&bits64, &x, sizeof bits64);
    put_bits(single ? bits32 : bits64, single ? 4 : 8, stream);
}

static inline void put_real_vector(vec3 v, bool single, FILE *stream)
{
    put_real(v.x, single, stream);
    put_real(v.y, single, stream);
    put_real(v.z, single, stream);
}
