/* Readers of OBJ (with MTL), PLY, STL and glTF files: for the program cuvette-import and for the module for
 * browsers. Numbers are doubles, rounded once from the text of the file. Triangles are in the order of the file. A
 * text may have any line ends and begin with a byte order mark. Ownership: flat_release frees what a reader made,
 * even after an error. Errors: STATUS_BAD_INPUT with the file and the line, in binary files the byte, that is wrong;
 * no_memory_for if memory runs out. */
#pragma once

#include "import/flat_mesh.h"

enum { POLYGON_MAX = 65536 /* corners */ };

/* ---- plain.c ---- */

/* Reads the file of the request into an empty mesh. STATUS_BAD_INPUT if its ending is unknown. */
status plain_read(const request *req, flat_mesh *flat, diagnostic *why);

/* ---- files.c ---- */

/* The format by the ending of the name, or by the one before .gz; upper and lower case are the same. */
file_kind file_kind_of(const char *path);

/* Opens a regular file below the root (base/file.h), without waiting. -1, with errno and the reason, on failure; EXDEV:
 * the file is outside the root. The caller owns the descriptor. */
int files_open(const char *path, const char *root, const char **reason);

/* The same for a name in the mesh file, relative to its folder. */
int files_open_beside(const request *req, const char *name, const char **reason);

/* Opens the mesh file of the request, and sets the path of further errors. */
status files_open_mesh(const request *req, int *fd, diagnostic *why);

/* The contents of a file: size bytes, then \n and 0. */
typedef struct file_text {
    char *bytes;
    size_t size, mapped; /* mapped: bytes of the mapping; 0: it is allocated */
} file_text;

/* Reads an open file, or maps it, and closes it; one that gzip compressed, but no FILE_BUFFER, is decompressed, to at
 * most a quarter of the limit of memory. files_release frees the text. STATUS_BAD_INPUT also if the check of the
 * request refuses it. */
status files_read(const request *req, int fd, file_kind kind, file_text *text, diagnostic *why);
void files_release(file_text *text);

/* Whether these are the contents of a file that gzip compressed. */
bool files_compressed(const char *bytes, size_t size);

/* Lines and words of a text, after whose end \n follows. */
typedef struct lines {
    const char *at, *end; /* the rest of the text */
    long line;            /* from 1 */
} lines;

/* The size of a byte order mark at the beginning of the text; 0: none. */
size_t text_begin(const char *text, size_t size);
lines lines_of(const char *text, size_t size);
/* Goes to the next line; false at the end of the text. Line ends are \n, \r\n and \r. */
bool lines_next(lines *l);
/* The next word of this line; false: none. */
bool lines_word(lines *l, const char **word, size_t *length);
/* The next word of this line or of a following one; false at the end of the text. */
bool lines_any_word(lines *l, const char **word, size_t *length);
/* The rest of this line, without blanks at both ends. */
size_t lines_rest(const lines *l, const char **text);
/* Whether the word equals the text, in upper or lower case. */
bool lines_is(const char *word, size_t length, const char *text);
/* Whether the word is a decimal number, finite as a double. */
bool lines_number(const char *word, size_t length, double *number);

/* ---- the readers. text: size bytes, then \n and 0. `why` already has the path. ---- */

/* Format: Wavefront, Advanced Visualizer Manual, appendix B1, "Object Files". v, vt, vn, f, usemtl, mtllib; groups,
 * smoothing, lines, points and free-form surfaces are ignored. Faces may come before their vertices. */
status obj_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why);
/* Format: Greg Turk, "The PLY Polygon File Format", 1994. Vertices with positions, normals, texture coordinates and
 * colours, faces and triangle strips, in any order; other elements and properties are ignored. */
status ply_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why);
/* Binary: 80 bytes, a count, and 50 bytes per facet. Text: facets from 'solid' to 'endsolid', once or more often. The
 * normals are ignored. */
status stl_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why);
/* Whether a binary file of this size agrees with the count in its header. */
bool stl_agrees(const char *bytes, size_t size);
/* STATUS_BAD_INPUT if more facets follow than the header of a binary file counts. `whole` as of content_check. */
status stl_check(const char *bytes, size_t size, bool whole, diagnostic *why);

/* Format: Khronos Group, glTF 2.0 specification; .gltf and .glb by the kind of the request. The triangles of the scene,
 * in the pose that the file begins with; its materials, images, cameras and lights. */
status gltf_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why);

/* ---- mtl.c ---- */

/* The materials of all libraries of an OBJ file, in the order of the files. */
typedef struct mtl_library {
    mesh_material *list;
    size_t count, room;
} mtl_library;

/* Reads the libraries that an mtllib statement names: one file, or several divided by blanks. A file that does not
 * exist is a note of the mesh. */
status mtl_read(const request *req, const char *names, size_t length, mtl_library *into, flat_mesh *flat,
                diagnostic *why);
void mtl_release(mtl_library *m);
/* The first material with this name, or the default of OBJ files, without a name. */
mesh_material mtl_find(const mtl_library *m, const char *name, size_t length);

/* ---- polygon.c ---- */

/* Memory for polygons of up to `room` corners. */
typedef struct polygon {
    size_t room;
    struct polygon_corner *corners;
    uint32_t *reflex;
    uint32_t (*triangles)[3];
} polygon;

/* Appends a polygon of 3 to POLYGON_MAX corners, which may be concave, to the mesh as count - 2 triangles, which use
 * every edge. indices: of the corners' vertices, which are joined already. flat_reserve has made room. */
status polygon_append(const request *req, polygon *p, const uint32_t *indices, size_t count, uint8_t slot,
                      flat_mesh *flat, diagnostic *why);
void polygon_release(polygon *p);
