/* Reads the bytes of mesh_wire.h into a mesh and its materials, and believes nothing that they say: counts are held
 * against limits before memory is asked for, indices, numbers and texts are checked, and a stream that ends early or
 * goes on is refused. Ownership: an import is the caller's, mesh_import_destroy releases it; its mesh may be kept with
 * mesh_retain. */
#pragma once

#include "base/status.h"
#include "geometry/mesh.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a file may cost. A field that is 0 stands for its default. */
typedef struct mesh_limits {
    size_t triangles, vertices; /* 2^25 and 2^26 */
    uint64_t memory_bytes;      /* of the process that reads the file; 4 GiB */
    double wall_s;              /* 60 */
    const char *root; /* the file, and all that it names, lie below it (base/below.h); NULL or "": anywhere. Borrowed */
} mesh_limits;

/* The same with the defaults filled in, and nothing over MESH_TRIANGLES_MAX and MESH_VERTICES_MAX; limits may be NULL.
 */
mesh_limits mesh_limits_complete(const mesh_limits *limits);

/* A material as the file has it: numbers of its convention, all finite. Colours are linear RGB, 0 or more: an MTL
 * file's Kd is taken as linear, as POV-Ray and most renderers do, and glTF's factors are linear by definition. */
typedef struct imported_material {
    char *name;         /* NULL when it has none, or none is given */
    bool given;         /* false: the file says nothing of these triangles' material; the rest is then meaningless */
    double color[3];    /* diffuse: MTL Kd, glTF baseColorFactor */
    double ambient[3];  /* Ka */
    double specular[3]; /* Ks */
    double emissive[3]; /* Ke; glTF emissiveFactor */
    double shininess;   /* Phong's exponent: Ns */
    double opacity;     /* 0 to 1: d, or 1 - Tr; glTF's alpha */
    double ior;         /* 1 or more: Ni */
    char *texture; /* path of the diffuse picture, map_Kd; from mesh_stream_read as the file writes it; NULL: none */
    bool texture_inside; /* the picture is inside the mesh file, and cannot be had; texture is NULL */
} imported_material;

typedef struct mesh_import {
    struct mesh *mesh;  /* finished; triangle t has the material materials[slots[t]] */
    int material_count; /* = mesh->slot_count; the mesh's slots have the materials' names */
    imported_material *materials;
} mesh_import;

/* Where the bytes come from. read fills all of bytes or fails and says why; end is STATUS_OK when nothing follows. */
typedef struct mesh_source {
    status (*read)(void *context, void *bytes, size_t size, diagnostic *why);
    status (*end)(void *context, diagnostic *why);
    void *context;
} mesh_source;

/* STATUS_BAD_INPUT for a stream that is wrong, STATUS_FAILURE without memory, or what source->read returned. */
status mesh_stream_read(const mesh_source *source, const mesh_limits *limits, mesh_import **out, diagnostic *why);

void mesh_import_destroy(mesh_import *imported); /* NULL is allowed */
