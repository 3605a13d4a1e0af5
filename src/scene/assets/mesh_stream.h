/* Decodes the bytes of mesh_wire.h into a mesh and its materials, without trusting them: counts are compared with
 * limits before memory is allocated, indices, numbers and texts are checked, and a truncated or overlong stream is
 * refused. Ownership: the caller releases an import with mesh_import_destroy; mesh_retain keeps its mesh. */
#pragma once

#include "base/status.h"
#include "geometry/mesh/mesh.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Limits for one file. 0 means the default. */
typedef struct mesh_limits {
    size_t triangles, vertices; /* defaults 2^25 and 2^26 */
    uint64_t memory_bytes;      /* memory of the importer process; default: what a limit of the program's leaves, or 4
                         GiB */
    double wall_s;              /* default 60 */
    bool right_handed;          /* of the file's axes: the mesh is mirrored into the left-handed world */
    const char *root;           /* folder of the file and of all files that it refers to (base/file.h); NULL or "": no
                         restriction. Borrowed */
} mesh_limits;

/* The limits with defaults filled in, at most MESH_TRIANGLES_MAX and MESH_VERTICES_MAX; limits may be NULL. */
mesh_limits mesh_limits_complete(const mesh_limits *limits);

/* An image, and how it is laid on: MESH_WIRE_REPEAT and so on (import/mesh_wire.h). */
typedef struct imported_texture {
    char *path; /* NULL: none; mesh_stream_read leaves it as written in the file */
    int image;  /* the image inside the mesh file, from 1, instead of a path; 0: none */
    int wrap_u, wrap_v, filter;
} imported_texture;

static inline bool imported_texture_exists(const imported_texture *t)
{
    return t->path || t->image;
}

/* A material of the file in the file's own conventions, all numbers finite. Colours are linear RGB of at least 0: Kd of
 * MTL is taken as linear, as in POV-Ray and most renderers, and glTF's factors are linear by definition. */
typedef struct imported_material {
    char *name;          /* NULL if it has none */
    bool given;          /* false: the file has no material for these triangles; the other fields are then undefined */
    double color[3];     /* diffuse: MTL Kd, glTF baseColorFactor */
    double ambient[3];   /* Ka */
    double specular[3];  /* Ks */
    double emissive[3];  /* Ke; glTF emissiveFactor */
    double shininess;    /* Phong exponent: Ns */
    double opacity;      /* 0 to 1: d, or 1 - Tr; glTF's alpha where it blends or masks, times
                            1 - transmission unless it masks */
    double ior;          /* at least 1: Ni, KHR_materials_ior */
    double alpha_cutoff; /* with MESH_WIRE_ALPHA_MASK */
    double transmission; /* KHR_materials_transmission, 0 to 1 */
    double attenuation_color[3], attenuation_distance; /* KHR_materials_volume; distance 0: clear */
    double dispersion;                                 /* KHR_materials_dispersion: 20 / Abbe's number; 0: none */
    uint32_t alpha_mode;      /* MESH_WIRE_ALPHA_OPAQUE, _MASK or _BLEND (import/mesh_wire.h) */
    imported_texture texture; /* multiplies the diffuse colour: map_Kd, glTF baseColorTexture */
    imported_texture glow;    /* multiplies the emitted one: map_Ke, emissiveTexture */
} imported_material;

/* An image file inside the mesh file. */
typedef struct imported_image {
    unsigned char *bytes;
    size_t size;
} imported_image;

/* A camera or a light of the file, in the axes of the file or, with right_handed, of the world. */
typedef struct imported_view {
    struct mesh_wire_view *values; /* import/mesh_wire.h, all numbers finite */
    char *name;                    /* NULL if it has none */
} imported_view;

typedef struct mesh_import {
    struct mesh *mesh;  /* finished; triangle t has the material materials[slots[t]] */
    int material_count; /* = mesh->slot_count; the mesh's slots have the names of the materials */
    imported_material *materials;
    int image_count, view_count;
    imported_image *images;
    imported_view *views;
    char *note; /* what the file names or has, and the mesh lacks; NULL: nothing */
} mesh_import;

/* The source of the bytes. read fills all `size` bytes or fails with a diagnostic; end fails if more bytes follow. */
typedef struct mesh_source {
    status (*read)(void *context, void *bytes, size_t size, diagnostic *why);
    status (*end)(void *context, diagnostic *why);
    void *context;
} mesh_source;

/* STATUS_BAD_INPUT for an invalid stream, STATUS_FAILURE if memory runs out, or the error of source->read. */
status mesh_stream_read(const mesh_source *source, const mesh_limits *limits, mesh_import **out, diagnostic *why);
/* The same for a complete stream in memory: of the module for browsers, and of fuzzers. */
status mesh_stream_read_bytes(const void *bytes, size_t size, const mesh_limits *limits, mesh_import **out,
                              diagnostic *why);

/* Points as text: a mesh without triangles and materials. Each line has the three coordinates of a point, separated by
 * blanks or commas; empty lines, and what follows a #, are skipped. text[size] is 0. STATUS_BAD_INPUT with line and
 * column, also for a file without points, and for more points than a scene can have solids. */
#define POINTS_ENDING ".xyz"
bool mesh_is_points(const char *path); /* by the ending of its name */
status mesh_points_read(const char *path, const char *root, bool right_handed, mesh_import **out, diagnostic *why);
status mesh_points_parse(const char *name, const char *text, size_t size, bool right_handed, mesh_import **out,
                         diagnostic *why);

void mesh_import_destroy(mesh_import *imported); /* NULL is allowed */

/* Turns the image names of materials into paths that can be opened: absolute, or relative to the mesh file at `path`.
 * The images are not opened. A material whose image does not exist loses it, with a note. STATUS_BAD_INPUT if one is
 * not a regular file. */
status mesh_textures_find(const char *path, mesh_import *imported, diagnostic *why);

/* Triangle meshes from files: OBJ with MTL, PLY, STL, glTF 2.0 and glb, by file name extension. A separate process
 * (cuvette-import) reads the file with limits on memory and time, so that no file can crash the caller; its output
 * is validated. Thread safe. Node hierarchies are flattened, polygons triangulated, equal vertices merged, points
 * and lines dropped. Coordinates are the file's numbers, as doubles, unless a node or joints transform them. Normals
 * are the file's or none; facet normals of STL are ignored. Material libraries and images that do not exist are a
 * note of the import; buffers must exist. The alpha of vertices, animation and the metalness of glTF are ignored.
 * Ownership: the import is the caller's (see above). Errors: STATUS_BAD_INPUT with the
 * file and the reason; STATUS_FAILURE if the importer cannot be started, or memory runs out. */

/* Reads a mesh file; limits may be NULL. Images of textures are not opened: their paths are absolute, or relative to
 * the mesh file. */
status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why);

/* A first scene out of a mesh file: its mesh as the solid `body`, and from a glTF file its first camera and its lights;
 * a camera that sees all of it, and a sun, where the file has none. If all of the mesh is glass, the solid is of its
 * medium. Lights are scaled by a common factor to a sum of 1 at the middle of the mesh. *notes: what was not read or
 * cannot be said, NULL: nothing; the caller frees it, and destroys the scene, which is not loaded. */
status mesh_first_scene(const char *path, scene **out, char **notes, diagnostic *why);
