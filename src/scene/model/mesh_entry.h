/* Meshes and textures of a scene: their sources and the loaded data. An entry owns its strings and one reference to its
 * data. */
#pragma once

#include "geometry/mesh/mesh.h"
#include "image/texture.h"
#include "scene/model/material.h"
#include "softbody/softbody.h"
#include <stdint.h>

enum { SCENE_MESHES_MAX = 64, SCENE_TEXTURES_MAX = 64 };

/* The source of a mesh: a file, or a generator (geometry/mesh/mesh_generators.h). */
typedef enum mesh_maker {
    MESH_FILE,
    MESH_SPARSE,
    MESH_DENSE,
    MESH_SPHERE,
    MESH_ICOSPHERE,
    MESH_TORUS,
    MESH_LATHE,
    MESH_TERRAIN,
    MESH_BOX,
    MESH_SLIME,
    MESH_ARRAYS
} mesh_maker;

typedef struct face_materials face_materials; /* the materials in a file: scene/model/face_materials.h */

typedef struct mesh_entry {
    char *name;
    int64_t source;              /* mesh_maker */
    char *path;                  /* relative to the scene file; "" for none */
    long path_line, path_column; /* location of the file or the generator in the scene file; 0 if it was set otherwise
                                    */
    int64_t count;               /* triangles, for sparse, dense and sphere */
    int64_t level;               /* for icosphere */
    double major, minor;         /* for torus */
    int64_t around, tube;        /* segments of torus and lathe; edges of terrain along x and z */
    number_list profile;         /* for lathe: radius, height, radius, height, ... */
    double crease_deg;
    vec3 size;                       /* for box; for terrain with the height of its hills */
    double depth;                    /* for terrain: the height of its solid base below y = 0; 0: an open surface */
    int64_t seed;                    /* for terrain */
    softbody_settings slime;         /* for slime; its level is the field `level` above */
    double time_s;                   /* for slime: the simulated time that is shown */
    char *script_path;               /* for slime: the script of its hands; "" for none; relative to the scene file */
    long script_line, script_column; /* its location in the scene file; 0 if it was set otherwise */
    softbody_quantities account;     /* for a loaded slime: the account of its motion */
    double motion_s;                 /* for a loaded slime: the wall time of its steps */
    const mesh *data;                /* a counted reference that the entry owns; NULL until scene_load */
    const face_materials *shading_materials; /* a counted reference; NULL for none */
} mesh_entry;

typedef struct texture_entry {
    char *name;
    char *path; /* relative to the scene file */
    long path_line, path_column;
    int64_t filter, wrap_u, wrap_v, space; /* texture_filter, texture_wrap, texture_space */
    const texture *data;                   /* one owner of it; NULL until scene_load */
} texture_entry;

/* Limits of loading, for scenes from others; copies of a scene have the same limits. */
typedef struct load_limits {
    char *root;       /* all files are read below this folder (base/file.h); NULL or "": anywhere */
    size_t triangles; /* of all meshes together; 0: only the importer's limit */
} load_limits;

/* Releases the loaded data of an entry whose parameters change. */
void mesh_entry_unload(mesh_entry *m);
void texture_entry_unload(texture_entry *t);
