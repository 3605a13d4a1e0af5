/* Readers of mesh files for browsers, without assimp: OBJ with MTL, and PLY. Triangles, vertices, normals and materials
 * equal those of the program's importer, so that films have the same hash. Ownership: mesh_parts_release frees what a
 * reader made, even after an error. Errors: STATUS_BAD_INPUT, with the line in the message if one line is at fault;
 * STATUS_FAILURE if memory runs out. */
#pragma once

#include "base/status.h"
#include "import/flat_mesh.h"
#include "import/mesh_wire.h"
#include "scene/assets/mesh_stream.h"

#include <stdbool.h>
#include <stddef.h>

enum { POLYGON_MAX = 4096 /* corners */ };

typedef struct mesh_material {
    mesh_wire_material values; /* without the lengths */
    char *name, *texture;      /* texture may be NULL */
} mesh_material;

/* materials[0] is for triangles without a material. */
typedef struct mesh_parts {
    const mesh_limits *limits;
    flat_mesh flat; /* slots are indices of materials until mesh_parts_import */
    joiner join;
    size_t triangle_room, slot_room;
    mesh_material *materials;
    size_t material_count, material_room;
} mesh_parts;

status mesh_parts_begin(mesh_parts *p, const mesh_limits *limits, diagnostic *why);
void mesh_parts_release(mesh_parts *p);
/* Adds a material with the defaults of OBJ files; *index is its number. */
status mesh_parts_material(mesh_parts *p, const char *name, size_t length, size_t *index, diagnostic *why);
/* Finds or adds the vertex with these numbers: position, normal, texture coordinates; missing ones are 0. */
status mesh_parts_vertex(mesh_parts *p, const double numbers[8], uint32_t *index, diagnostic *why);
status mesh_parts_triangle(mesh_parts *p, const uint32_t corners[3], size_t material, diagnostic *why);
status mesh_parts_import(mesh_parts *p, mesh_import **out, diagnostic *why);

/* Divides a polygon of count > 3 corners, which may be concave, into count - 2 triangles, or fewer if it is not simple;
 * returns the number of triangles, whose corners are indices of places. */
size_t polygon_divide(const float (*places)[3], size_t count, uint32_t (*triangles)[3]);

/* text: size bytes and a final 0. path: of the file, to find material libraries next to it; `why` already has the
 * path. */
status obj_read_text(const char *path, const char *text, size_t size, mesh_parts *p, diagnostic *why);
status ply_read_text(const char *text, size_t size, mesh_parts *p, diagnostic *why);

/* --- lines of words, for readers of text. All functions stop at the end of the text or of the line. --- */

typedef struct lines {
    const char *at, *end; /* the rest of the text; a 0 follows */
    const char *word, *line_end;
    long line;
} lines;

/* Begins the next line; false at the end of the text. A \ at the end of a line joins it with the next line. */
bool lines_next(lines *l);
/* The next word of the line and its length; false: none. */
bool lines_word(lines *l, const char **word, size_t *length);
/* Whether the word equals the text. */
bool lines_is(const char *word, size_t length, const char *text);
/* The rest of the line, without blanks at both ends. */
size_t lines_rest(const lines *l, const char **text);
/* Reads up to `most` further words of the line as numbers, rounded as in the importer (import/obj.h); returns how many;
 * -1: a word is not a number. */
int lines_numbers(lines *l, int most, float *numbers);
