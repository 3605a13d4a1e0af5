/* A fast reader of plain OBJ files: v, vt, vn, triangles (f), o, g, s, usemtl, mtllib and comments, in their common
 * forms. It accepts only files that assimp reads without an error, and the result equals assimp's bit for bit. All
 * other files (polygons, relative indices, any mistake) are left to assimp, which also explains what is wrong. Format:
 * Wavefront, Advanced Visualizer Manual, appendix B1, "Object Files". Ownership: if obj_read fails, it frees what it
 * has allocated. */
#pragma once

#include "import/flat_mesh.h"

enum {
    OBJ_LINE_MAX = 1000, /* bytes; longer lines are left to assimp */
    OBJ_THREADS_MAX = 8,
    OBJ_PARTS_MAX = OBJ_THREADS_MAX + 1 /* one more for a last line that lacks its \n */
};

/* The indices of a triangle's corner, from 1; 0: none. */
typedef struct obj_corner {
    uint32_t place, uv, normal;
} obj_corner;

/* Consecutive faces with at most v, vt and vn statements between them. assimp reads one triangle per run, and so
 * decides the run's mesh, material and order. */
typedef struct obj_run {
    size_t first, count; /* triangles of the part */
    size_t text_end;     /* the statements before the run are obj_part.text[0 .. text_end - 1] */
} obj_run;

/* The statements of a part of the file, which ends at a line end. */
typedef struct obj_part {
    const char *begin, *end;
    bool plain; /* false: assimp must read the file, or memory ran out */
    bool early; /* a face with texture coordinates comes before the part's first vt */
    float (*places)[3], (*uvs)[2], (*normals)[3];
    obj_corner (*triangles)[3];
    obj_corner highest; /* the highest indices */
    obj_run *runs;
    char *text;
    size_t place_count, uv_count, normal_count, triangle_count, run_count, text_length;
    size_t place_room, uv_room, normal_room, triangle_room, run_room, text_room;
} obj_part;

/* A file; once parsed, its first part has the vertices, texture coordinates and normals of all parts. */
typedef struct obj_file {
    obj_part parts[OBJ_PARTS_MAX];
    int part_count;
    size_t triangle_count;
    char last_line[OBJ_LINE_MAX + 1];
} obj_file;

/* ---- obj_parse.c ---- */

/* Parses the lines of the part; each must end in \n. */
void obj_parse(obj_part *part);

/* Reads a decimal number and moves *at past it. It rounds like assimp 5's fast_atoreal_move: first the integer, then
 * the fraction of at most 15 digits. The result is the nearest float (up to double rounding) for numbers below 1 in
 * magnitude, and may be the next one for others. False: the text has another form. */
bool obj_number(const char **at, float *number);
/* Reads an index from 1 to 999999999. */
bool obj_index(const char **at, uint32_t *index);

/* ---- obj.c ---- */

struct aiScene;

/* Reads the file into `flat`; *scene has its materials. False: assimp must read the file; `flat` is empty. */
bool obj_read(const request *req, flat_mesh *flat, const struct aiScene **scene);
