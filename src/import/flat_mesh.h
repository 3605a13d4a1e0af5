/* The result of the readers of mesh files: one mesh whose equal vertices are joined, its materials, and what a file has
 * besides: images, cameras, lights. Ownership: flat_release frees all of it. Errors: STATUS_BAD_INPUT with the reason,
 * also when out of memory if the request limits it; STATUS_FAILURE if the machine is out of memory. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "import/mesh_wire.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Mesh files by their endings, then the files that they name: MTL files, and buffers of glTF files. */
typedef enum file_kind {
    FILE_OBJ,
    FILE_PLY,
    FILE_STL,
    FILE_GLTF,
    FILE_GLB,
    FILE_UNKNOWN,
    FILE_MTL,
    FILE_BUFFER
} file_kind;

/* STATUS_BAD_INPUT if a file of this kind cannot begin so. size: of the whole file, or of what has been expanded of it,
 * at least 64 KiB. An empty file passes. */
typedef status content_check(file_kind kind, const char *bytes, size_t size, bool whole, diagnostic *why);

typedef struct request {
    const char *path;
    file_kind kind;               /* by the file's extension */
    uint64_t memory_mib, seconds; /* limits on this process; 0: none */
    uint64_t triangles, vertices; /* limits on the mesh */
    const char *root;             /* folder of all files that may be opened (base/file.h); "": no restriction */
    content_check *check;         /* of each file that is read; set by plain_read */
} request;

/* STATUS_BAD_INPUT for a request with a limit of memory, because the file needs more; else STATUS_FAILURE. */
status no_memory_for(const request *req, diagnostic *why);

/* A material; its texts may be NULL. They are owned. */
typedef struct mesh_material {
    mesh_wire_material values;   /* without the lengths */
    char *name, *texture, *glow; /* the paths of images */
    char *cover;                 /* the image of an MTL file's map_d; NULL once it is read */
} mesh_material;

/* An image file inside the mesh file; owned. */
typedef struct mesh_image {
    unsigned char *bytes;
    size_t size;
} mesh_image;

/* A camera or a light; the name, which may be NULL, is owned. */
typedef struct mesh_view {
    mesh_wire_view values; /* without the length */
    char *name;
} mesh_view;

/* One mesh in world coordinates. Vertices that are equal in position, normal, texture coordinates and colour are
 * joined. */
typedef struct flat_mesh {
    size_t vertex_count, triangle_count;
    vec3 *positions, *normals;
    struct {
        double u, v;
    } * uvs;
    float (*colors)[3]; /* 0 to 1 */
    uint32_t (*triangles)[3];
    uint8_t *slots; /* by triangle: index of its material */
    bool with_normals, with_uvs, with_colors;
    bool clamped; /* a colour was not within 0 to 1 */
    bool srgb;    /* colours are sRGB, as in OBJ and PLY files; otherwise linear */
    unsigned material_count;
    mesh_material materials[MESH_WIRE_SLOTS_MAX];
    unsigned image_count, view_count;
    mesh_image images[MESH_WIRE_IMAGES_MAX];
    mesh_view *views; /* room for MESH_WIRE_VIEWS_MAX; NULL: none */
    char *note;       /* what the file names or has, and the mesh lacks; NULL: nothing */
} flat_mesh;

void flat_release(flat_mesh *flat);
/* Makes the arrays for `count` triangles, and refuses more than the limit. */
status flat_reserve(const request *req, flat_mesh *flat, uint64_t count, diagnostic *why);
/* Adds a material for further triangles; *slot is its index. Its texts are copied, control characters of the name
 * as ?. */
status flat_material(const request *req, flat_mesh *flat, const mesh_material *like, uint8_t *slot, diagnostic *why);
/* Adds an image, whose bytes it takes over; *number is its number from 1, or 0 if there are too many. */
void flat_image(flat_mesh *flat, unsigned char *bytes, size_t size, uint32_t *number);
/* Adds a camera or a light, unless there are too many; the name is copied, NULL: none. */
status flat_view(const request *req, flat_mesh *flat, const mesh_wire_view *values, const char *name, diagnostic *why);
#define FLAT_FEW_CORNERS "faces with fewer than three corners are left out"
#define VERTEX_ALPHA_NOTE "the alpha of vertices is ignored"
/* Adds a sentence to the note, unless it is there already. */
void flat_note(flat_mesh *flat, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Writes the wire format (mesh_wire.h). STATUS_FAILURE if `to` cannot be written. */
status flat_write(const flat_mesh *flat, FILE *to, diagnostic *why);

/* --- joining vertices --- */

enum { JOIN_BLOCK = 64, JOIN_NUMBERS = 11, JOIN_COLOR = 8 };

/* A hash table of the vertices of a flat_mesh. The key is the bits of JOIN_NUMBERS numbers: position, normal, texture
 * coordinates, and from JOIN_COLOR on the colour, of join_color. Missing ones are 0, and none may be -0. The owner
 * frees the table. */
typedef struct joiner {
    uint32_t *table;
    size_t size;
    size_t room;
} joiner;

/* Makes room for `count` vertices; false: out of memory. */
bool join_reserve(joiner *j, flat_mesh *flat, size_t count);
uint64_t join_hash(const flat_mesh *flat, const double numbers[JOIN_NUMBERS]);
/* Sets the colour of a vertex: as floats, within 0 to 1, with a note if it is not. */
void join_color(flat_mesh *flat, const double color[3], double numbers[JOIN_NUMBERS]);
/* Starts to load what join_vertex will read: tables of large meshes exceed the caches. */
void join_prefetch(const joiner *j, uint64_t hash);
/* Finds the vertex with these numbers, or adds it. */
status join_vertex(const request *req, joiner *j, flat_mesh *flat, const double numbers[JOIN_NUMBERS], uint64_t hash,
                   uint32_t *index, diagnostic *why);
/* The same for up to JOIN_BLOCK vertices, whose -0 become 0. */
status join_vertices(const request *req, joiner *j, flat_mesh *flat, double (*numbers)[JOIN_NUMBERS], size_t count,
                     uint32_t *indices, diagnostic *why);
