/* The wire format that cuvette-import writes to standard output for the program that started it; the module for
 * browsers writes and reads it in its memory. Both programs are of the same build and run on the same machine: numbers
 * are in the machine's byte order, without padding. The reader checks everything (scene/assets/mesh_stream.h). In this
 * order:
 *
 * - the header;
 * - positions: vertex_count x 3 doubles; no two vertices are equal in position, normal and texture coordinates. The
 *   reader relies on this: edges between equal vertices would count as open;
 * - normals, if MESH_WIRE_NORMALS is set: vertex_count x 3 doubles; they need not be unit vectors;
 * - uvs, if MESH_WIRE_UVS is set: vertex_count x 2 doubles;
 * - triangles: triangle_count x 3 uint32;
 * - slots: triangle_count x 1 byte, the index of the material;
 * - materials: material_count times a record, a name and a texture path (not terminated; the record has the lengths);
 * - the note (not terminated; the header has its length): what was not read, in words; 0: everything was read;
 * - MESH_WIRE_END. */
#pragma once

#include <stdint.h>

#define MESH_WIRE_MAGIC "CUVMESH\n"
#define MESH_WIRE_END "\nMESHEND"
enum { MESH_WIRE_VERSION = 3, MESH_WIRE_TEXT_MAX = 1024, MESH_WIRE_SLOTS_MAX = 256 };
/* The largest magnitude of a coordinate. */
#define MESH_WIRE_FAR 1e9

enum { MESH_WIRE_NORMALS = 1, MESH_WIRE_UVS = 2 }; /* flags of the header */
/* Flags of a material: the file defines it; its image is embedded in the mesh file. */
enum { MESH_WIRE_GIVEN = 1, MESH_WIRE_TEXTURE_INSIDE = 2 };

typedef struct mesh_wire_header {
    char magic[8];
    uint32_t version, flags;
    uint64_t vertex_count, triangle_count;
    uint32_t material_count, note_length; /* 1 to MESH_WIRE_SLOTS_MAX; 0 to MESH_WIRE_TEXT_MAX */
} mesh_wire_header;

/* A material with the values of the file, colours in linear RGB. */
typedef struct mesh_wire_material {
    double diffuse[3], ambient[3], specular[3], emissive[3], shininess, opacity, ior;
    uint32_t flags, name_length, texture_length, reserved;
} mesh_wire_material;
