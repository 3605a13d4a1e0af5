/* Meshes and textures that a scene names: where they come from, and what was loaded. An entry owns its words and is one
 * owner of its data. */
#pragma once

#include "geometry/mesh.h"
#include "image/texture.h"
#include "scene/model/material.h"
#include "softbody/softbody.h"
#include <stdint.h>

enum { SCENE_MESHES_MAX = 64, SCENE_TEXTURES_MAX = 64 };

/* Where a mesh comes from: its file, or a body that is computed (geometry/mesh_generators.h). */
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

typedef struct face_materials
    face_materials; /* how the faces of a file's materials look: scene/model/face_materials.h */

typedef struct mesh_entry {
    char *name;
    int64_t source;              /* mesh_maker */
    char *path;                  /* relative to the scene file; "" for none */
    long path_line, path_column; /* where the scene file names it, or what generates it; 0 when it was set otherwise */
    int64_t count;               /* triangles, of sparse, dense and sphere */
    int64_t level;               /* of an icosphere */
    double major, minor;         /* of a torus */
    int64_t around, tube;        /* segments of torus and lathe; edges of terrain along x and z */
    number_list profile;         /* of a lathe: radius, height, radius, height .. */
    double crease_deg;
    vec3 size;                       /* of a box; of a terrain, with the height of its hills */
    double depth;                    /* of a terrain, below y = 0; 0 is open */
    int64_t seed;                    /* of a terrain */
    softbody_settings slime;         /* of a slime, level but for its own above, which takes its place */
    double time_s;                   /* of a slime: the moment that is shown */
    char *script_path;               /* of a slime: what hands do with it; "" for none; relative to the scene file */
    long script_line, script_column; /* where the scene file names it; 0 when it was set otherwise */
    softbody_account account;        /* of a slime whose data is there: what became of it */
    double motion_s;                 /* and the wall time of its steps */
    const mesh *data;                /* one owner of it; NULL until scene_load */
    const face_materials *shading_materials; /* one owner of them; NULL for none */
} mesh_entry;

typedef struct texture_entry {
    char *name;
    char *path; /* relative to the scene file */
    long path_line, path_column;
    int64_t filter, wrap_u, wrap_v, space; /* texture_filter, texture_wrap, texture_space */
    const texture *data;                   /* one owner of it; NULL until scene_load */
} texture_entry;

/* What loading is held to, for scenes that others wrote; copies of a scene are held to the same. */
typedef struct load_limits {
    char *root;       /* every file that is read lies below it, whoever names it (base/below.h); NULL or "": anywhere */
    size_t triangles; /* of all meshes together; 0: no limit but the importer's own */
} load_limits;

/* Lets go of what was loaded for an entry whose parameters change. */
void mesh_entry_unload(mesh_entry *m);
void texture_entry_unload(texture_entry *t);
