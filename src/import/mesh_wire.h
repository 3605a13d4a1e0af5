/* The wire format that cuvette-import writes to standard output for the program that started it; the module for
 * browsers writes and reads it in its memory. Both programs are of the same build and run on the same machine: numbers
 * are in the machine's byte order, without padding. The reader checks everything (scene/assets/mesh_stream.h). In this
 * order:
 *
 * - the header;
 * - positions: vertex_count x 3 doubles; no two vertices are equal in position, normal, texture coordinates and colour.
 *   The reader relies on this: edges between equal vertices would count as open;
 * - normals, if MESH_WIRE_NORMALS is set: vertex_count x 3 doubles; they need not be unit vectors;
 * - uvs, if MESH_WIRE_UVS is set: vertex_count x 2 doubles;
 * - colours, if MESH_WIRE_COLORS is set: vertex_count x 3 floats from 0 to 1, linear RGB, or sRGB with MESH_WIRE_SRGB;
 * - triangles: triangle_count x 3 uint32;
 * - slots: triangle_count x 1 byte, the index of the material;
 * - materials: material_count times a record, a name and two paths of images (not terminated; the record has the
 *   lengths);
 * - images: image_count times a length (uint64) and the bytes of an image file that is inside the mesh file;
 * - views: view_count times a record and a name: the cameras and lights of the file;
 * - the note (not terminated; the header has its length): what was not read, in words; 0: everything was read;
 * - MESH_WIRE_END. */
#pragma once

#include <stdint.h>

#define MESH_WIRE_MAGIC "CUVMESH\n"
#define MESH_WIRE_END "\nMESHEND"
enum { MESH_WIRE_VERSION = 6, MESH_WIRE_TEXT_MAX = 1024, MESH_WIRE_SLOTS_MAX = 256 };
enum { MESH_WIRE_IMAGES_MAX = MESH_WIRE_SLOTS_MAX, MESH_WIRE_VIEWS_MAX = 1024 };
/* The largest magnitude of a coordinate. */
#define MESH_WIRE_FAR 1e9
/* The maximum of a colour component, an exponent or an index; larger values are errors in the file. */
#define MESH_WIRE_COLOR_MAX 1e6

enum { MESH_WIRE_NORMALS = 1, MESH_WIRE_UVS = 2, MESH_WIRE_COLORS = 4, MESH_WIRE_SRGB = 8 }; /* flags of the header */
enum { MESH_WIRE_GIVEN = 1 }; /* flag of a material: the file defines it */
/* What the alpha of a material's image, times its opacity, means (scene/model/material.h): nothing; no surface where it
 * is below alpha_cutoff; the opacity. */
enum { MESH_WIRE_ALPHA_OPAQUE, MESH_WIRE_ALPHA_MASK, MESH_WIRE_ALPHA_BLEND };
enum { MESH_WIRE_REPEAT, MESH_WIRE_MIRROR, MESH_WIRE_CLAMP };
enum { MESH_WIRE_TRILINEAR, MESH_WIRE_BILINEAR, MESH_WIRE_NEAREST };

typedef struct mesh_wire_header {
    char magic[8];
    uint32_t version, flags;
    uint64_t vertex_count, triangle_count;
    uint32_t material_count, note_length; /* 1 to MESH_WIRE_SLOTS_MAX; 0 to MESH_WIRE_TEXT_MAX */
    uint32_t image_count, view_count;     /* up to MESH_WIRE_IMAGES_MAX and MESH_WIRE_VIEWS_MAX */
} mesh_wire_header;

/* An image, and how it is laid on. */
typedef struct mesh_wire_texture {
    uint32_t path_length, image; /* image: from 1, instead of a path; both 0: none */
    uint32_t wrap_u, wrap_v, filter;
} mesh_wire_texture;

/* A material with the values of the file, colours in linear RGB. */
typedef struct mesh_wire_material {
    double diffuse[3], ambient[3], specular[3], emissive[3], shininess, opacity, ior;
    double alpha_cutoff; /* with MESH_WIRE_ALPHA_MASK, at least 0 */
    double transmission; /* of glass: the fraction of the light that is not reflected; its opacity is then that of thin
                            glass */
    double attenuation_color[3], attenuation_distance; /* of a volume: its transmittance after that way; 0: clear */
    double dispersion;                                 /* 20 / Abbe's number; 0: none */
    uint32_t flags, name_length, alpha_mode, unused;
    mesh_wire_texture texture, glow; /* which multiply the diffuse and the emitted colour */
} mesh_wire_material;

/* A camera or a light of the file, in its axes: it looks, or shines, along `forward`, a unit vector like `up`. */
typedef enum mesh_wire_view_kind {
    MESH_WIRE_PERSPECTIVE,
    MESH_WIRE_ORTHOGRAPHIC,
    MESH_WIRE_SUN,
    MESH_WIRE_POINT,
    MESH_WIRE_SPOT,
    MESH_WIRE_VIEW_KINDS
} mesh_wire_view_kind;

typedef struct mesh_wire_view {
    double position[3], forward[3], up[3];
    double height;       /* of a camera's image: an angle in radians, or for MESH_WIRE_ORTHOGRAPHIC a length */
    double aspect;       /* of a camera's image: width / height; 0: free */
    double color[3];     /* of a light, linear RGB */
    double power;        /* of a sun lx, of other lights cd; times 683 lm/W or without: the file's number */
    double inner, outer; /* half angles of a spot in radians: full light, none */
    double range;        /* of a point or spot: no light beyond; 0: unlimited */
    uint32_t kind, name_length;
} mesh_wire_view;
