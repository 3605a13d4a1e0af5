/* A fast reader of plain OBJ files: v, vt, vn, triangles (f), o, g, s, usemtl, mtllib and comments, in their common
 * forms. It accepts only files that assimp reads without an error, and the result equals assimp's bit for bit. All
 * other files (polygons, relative indices, any mistake) are left to assimp, which also explains what is wrong. Format:
 * Wavefront, Advanced Visualizer Manual, appendix B1, "Object Files". Ownership: obj_read frees what a failed reading
 * has allocated. */
#pragma once

#include "import/flat_mesh.h"

enum {
    OBJ_LINE_MAX = 1000, /* bytes; longer lines are left to assimp */
    OBJ_THREADS_MAX = 8,
    OBJ_PARTS_MAX = OBJ_THREADS_MAX + 1 /* the last one: a last line without an end */
};

/* The indices of a triangle's corner, from 1; 0: none. */
typedef struct obj_corner {
    uint32_t place, uv, normal;
} obj_corner;

/* Faces between two statements other than v, vt, vn: assimp sees one of them, as text, so that it decides their mesh,
 * material and order. */
typedef struct obj_run {
    size_t first, count; /* triangles of the part */
    size_t text_end;     /* the statements before it are obj_part.text[.. text_end - 1] */
} obj_run;

/* The statements of a part of the file, a range of whole lines. */
typedef struct obj_part {
    const char *begin, *end;
    bool plain; /* false: something in it is left to assimp, or it is out of memory */
    bool early; /* a face with texture coordinates comes before the part's first vt */
    float (*places)[3], (*uvs)[2], (*normals)[3];
    obj_corner (*triangles)[3];
    obj_corner highest; /* the highest indices */
    obj_run *runs;
    char *text;
    size_t place_count, uv_count, normal_count, triangle_count, run_count, text_length;
    size_t place_room, uv_room, normal_room, triangle_room, run_room, text_room;
} obj_part;

/* A file; the first part has the vertices, texture coordinates and normals of all. */
typedef struct obj_file {
    obj_part parts[OBJ_PARTS_MAX];
    int part_count;
    size_t triangle_count;
    char last_line[OBJ_LINE_MAX + 1];
} obj_file;

/* ---- obj_parse.c ---- */

/* Parses the lines of the part; each must end in \n. */
void obj_parse(obj_part *part);

/* Reads a decimal number and moves *at past it. The float is that of assimp 5's fast_atoreal_move: the integer and the
 * fraction of at most 15 digits are rounded one after the other. For numbers below 1 in magnitude that is the nearest
 * float, up to double rounding; for others it may be the next one. False: another form. */
bool obj_number(const char **at, float *number);
/* Reads an index from 1 to 999999999. */
bool obj_index(const char **at, uint32_t *index);

/* ---- obj.c ---- */

struct aiScene;

/* Reads the file into flat, with the assimp scene of its materials. False: it is left to assimp; nothing changes. */
bool obj_read(const request *req, flat_mesh *flat, const struct aiScene **scene);
