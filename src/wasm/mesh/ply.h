/* A PLY file, while it is read: the header (ply_header.c), the elements (ply_body.c), the triangles (ply_text.c).
 * Ownership: ply_read_text frees the arrays. */
#pragma once

#include "wasm/mesh/lines.h"
#include "wasm/mesh/mesh.h"

enum { PLY_ELEMENTS_MAX = 16, PLY_PROPERTIES_MAX = 64, PLY_NUMBERS = 8 };

typedef enum ply_type { PLY_NONE, PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64 } ply_type;

typedef struct ply_property {
    ply_type count, type; /* count: of a list, else PLY_NONE */
    int number;           /* of the vertex: the index in its numbers; -1: ignored */
    bool corners;         /* of a face */
} ply_property;

typedef struct ply_element {
    enum { PLY_OTHER, PLY_VERTEX, PLY_FACE } kind;
    uint64_t count;
    ply_property properties[PLY_PROPERTIES_MAX];
    int property_count;
} ply_element;

typedef struct ply {
    lines text;     /* the header; then the rest, as text */
    const char *at; /* the rest, as bytes */
    bool ascii, big;
    ply_element elements[PLY_ELEMENTS_MAX];
    int element_count;
    mesh_parts *parts;
    double (*vertices)[PLY_NUMBERS];
    uint32_t *joined; /* the vertex of the mesh; UINT32_MAX: not used yet */
    size_t vertex_count, vertex_room;
    size_t *starts;    /* of the faces in corners, and of the end */
    uint32_t *corners; /* indices of vertices */
    size_t face_count, start_room, corner_count, corner_room;
    diagnostic *why;
} ply;

/* Reads from the first line to end_header. */
status ply_header(ply *p);
/* Reads vertices and faces. */
status ply_body(ply *p);
