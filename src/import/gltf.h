/* The parts of the reader of glTF 2.0 files: the file and its JSON, its accessors, its nodes and meshes, its materials,
 * cameras and lights.
 * References in comments are to the sections of the glTF 2.0 specification of the Khronos Group, version 2.0.1. All
 * numbers are doubles; coordinates have the axes of the file: x to the right, y up, z towards the viewer. Ownership: a
 * gltf_file owns what it has read, and the views of it in accessors. Errors: STATUS_BAD_INPUT with the item that is
 * wrong, such as "accessors[3].count"; `why` already has the path. An accessor only views bytes; one without bytes,
 * whose elements are 0, has no more of them than the file and the buffers that were read have bytes. */
#pragma once

#include "import/plain.h"
#include <jansson.h>

#define GLTF_REPAIR "repair the file or export it again"

/* An item of a list of the file's root, and its name in messages. */
typedef struct gltf_item {
    const json_t *json; /* NULL: none */
    const char *list;
    size_t index;
} gltf_item;

typedef struct gltf_buffer {
    const unsigned char *bytes; /* NULL: not read yet */
    size_t size;
    file_text file;         /* of a buffer in a file of its own */
    unsigned char *decoded; /* of a buffer in the JSON */
} gltf_buffer;

typedef struct gltf_file {
    const request *req;
    flat_mesh *flat;
    diagnostic *why;
    json_t *root;
    const unsigned char *chunk;            /* the binary chunk of a .glb file; NULL: none */
    size_t size, chunk_size, buffer_count; /* size: of the file */
    gltf_buffer *buffers;
    uint32_t *image_numbers; /* of the images in the mesh, by image of the file; 0: not there yet */
} gltf_file;

/* A part of a buffer. */
typedef struct gltf_view {
    const unsigned char *bytes;
    size_t size, stride; /* stride: of vertex attributes; 0: they are dense */
} gltf_view;

/* A transform: rows of the matrix that is multiplied with columns x, y, z, 1. */
typedef struct gltf_affine {
    double m[3][4];
} gltf_affine;

/* --- gltf_file.c --- */

/* Opens the text of a .gltf or .glb file: chunks, JSON, version, required extensions. gltf_close also after an
 * error. */
status gltf_open(gltf_file *g, const char *text, size_t size);
void gltf_close(gltf_file *g);

/* The number of items in a list of the root. */
size_t gltf_count(const gltf_file *g, const char *list);
gltf_item gltf_at(const gltf_file *g, const char *list, size_t index);
/* The error "LIST[INDEX].KEY WHAT". */
status gltf_bad(const gltf_file *g, gltf_item of, const char *key, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
/* A whole number from 0 to `most`; `otherwise` if the object has no such member. */
status gltf_whole(const gltf_file *g, gltf_item of, const json_t *object, const char *key, uint64_t most,
                  uint64_t otherwise, uint64_t *out);
/* An index of an item of a list; -1: there is none. */
status gltf_index(const gltf_file *g, gltf_item of, const json_t *object, const char *key, const char *list,
                  int64_t *out);
/* `count` finite numbers: an array, or for count 1 a number. They keep their values if there is no such member. */
status gltf_numbers(const gltf_file *g, gltf_item of, const json_t *object, const char *key, size_t count, double *out);
/* An extension of an object, or NULL. */
const json_t *gltf_extension(const json_t *object, const char *name);
/* A text, or "". */
const char *gltf_text(const json_t *object, const char *key);

status gltf_view_at(gltf_file *g, int64_t index, gltf_view *out);
/* Decodes a data: URI; *bytes is NULL if it is none, and the caller's. */
status gltf_decode(const gltf_file *g, gltf_item of, const char *uri, unsigned char **bytes, size_t *size);

/* The numbers of an accessor, checked against the bytes of its buffers. */
typedef struct gltf_accessor {
    size_t count, stride, sparse_count, sparse_size;
    int components, type;
    bool normalized;
    const unsigned char *base, *sparse_indices, *sparse_values; /* NULL: zeros; none */
    int sparse_type;
} gltf_accessor;

/* Opens an accessor with `components` numbers per element; with 0 in `components`, 3 or 4. `reader`: what refers to
 * it. */
status gltf_accessor_open(gltf_file *g, gltf_item reader, int64_t index, int components, gltf_accessor *out);
/* The components of an element; normalised integers are fractions (3.6.2.2). */
void gltf_accessor_get(const gltf_accessor *a, size_t element, double *out);
/* An element of an accessor of indices. */
uint32_t gltf_accessor_index(const gltf_accessor *a, size_t element);

/* --- gltf_looks.c --- */

/* How the base colour's texture, or without it the emission's, is laid on: which texture coordinates, and u' = m[0] u +
 * m[1] v + m[2], v' = m[3] u + m[4] v + m[5]. */
typedef struct gltf_uv_map {
    uint64_t set;
    double m[6];
    bool textured;   /* there is such a texture, or one of the emission */
    bool glow_apart; /* the emission's has other coordinates */
} gltf_uv_map;

/* Of a material, -1 for none. */
status gltf_material_uv_map(const gltf_file *g, int64_t index, gltf_uv_map *out);
/* Makes the slot of a material, -1 for none, whose colour is multiplied by a tint; with its texture or without it. */
status gltf_material_slot(gltf_file *g, int64_t index, const double tint[3], bool textured, uint8_t *slot);

/* Adds the camera and the light of a node at its place. */
status gltf_views(const gltf_file *g, gltf_item node, const gltf_affine *place);

/* --- gltf_scene.c has gltf_read of plain.h --- */
