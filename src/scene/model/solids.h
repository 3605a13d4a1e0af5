/* The solids, meshes and textures of a scene. A solid owns its name; the entry of a mesh or a texture owns its strings
 * and one reference to its loaded data. */
#pragma once

#include "base/status.h"
#include "geometry/mesh/mesh.h"
#include "geometry/solid.h"
#include "image/texture.h"
#include "scene/model/material.h"
#include "softbody/softbody.h"
#include <stdbool.h>
#include <stdint.h>

/* --- solids --- */

typedef enum shading_rule { SHADING_FLAT, SHADING_SMOOTH, SHADING_GOURAUD } shading_rule;

/* The largest number of primitives of all solids (shape_primitive_slots), and of solids that are unbounded or have
 * triangles. */
enum { SCENE_PRIMITIVES_MAX = (1 << 21) - 1, SCENE_UNBOUNDED_MAX = 64 };

typedef struct solid {
    char *name;
    solid_shape shape;
    int64_t priority;                 /* the highest has precedence where solids overlap; among equals the first in the
                                      scene */
    int64_t visible;                  /* 0: omitted from the scene */
    char follows[SCENE_NAME_MAX + 1]; /* name of an earlier solid, with which this one moves, turns and is scaled; "":
                                         none */
    vec3 offset;                      /* from that solid's position, in its frame */
    vec3 rotation_deg, scale;         /* its own, in that solid's frame; the shape has those in the world */
    char mesh[SCENE_NAME_MAX + 1];    /* name of the mesh, for shape mesh */
    char points[SCENE_NAME_MAX + 1];  /* name of the mesh at whose vertices the solid is repeated; "" for one solid */
    int64_t shading;                  /* shading_rule, for meshes */
    int material_index;               /* index in scene.materials; -1 for none */
    char ends[3][SCENE_NAME_MAX + 1]; /* names of the materials of its two ends and of the rest of its surface; "" for
                                         the solid's own; see solid_has_ends */
    material surface;                 /* a copy of the material, with the solid's changes */
} solid;

/* Whether the solid's shape has triangles and it refers to this mesh. */
bool solid_shows_mesh(const solid *owner, const char *mesh_name);
/* The same, or the solid is repeated at the vertices of this mesh. */
bool solid_uses_mesh(const solid *owner, const char *mesh_name);

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

/* The axes of a mesh file: the format's own (right-handed, but left-handed for points), or given. */
typedef enum mesh_handedness { HANDEDNESS_FILE, HANDEDNESS_RIGHT, HANDEDNESS_LEFT } mesh_handedness;

/* --- the materials in a mesh file --- */

typedef struct face_material {
    char name[SCENE_NAME_MAX + 1]; /* truncated if longer; "" for none */
    bool given;                    /* the file defines the material; otherwise the solid's own material is used */
    vec3 color;                    /* linear RGB, each at most 1 */
    double diffuse, specular, shininess, opacity;
    double emission;      /* times glow and glow_img is the emitted light */
    vec3 glow;            /* linear RGB, whose largest component is 1 */
    material_alpha alpha; /* with alpha other than opaque, the image's alpha is multiplied by opacity */
    double alpha_cutoff;
    const texture *img, *glow_img; /* one reference each; NULL for none */
} face_material;

/* The materials of a mesh file, by slot. Reference counted like their mesh; retain and release are thread safe. */
typedef struct face_materials face_materials;

/* Copies a list of materials and a note on what the mesh file has or names and was not read ("": nothing; it may be
 * shortened), and takes over the list's references to images; after an error it has released them. STATUS_FAILURE if
 * memory runs out. */
status face_materials_of(const face_material *list, int count, const char *note, const face_materials **out,
                         diagnostic *why);
/* NULL is allowed in these four functions. */
const char *face_materials_note(const face_materials *l);
void face_materials_retain(const face_materials *l);
void face_materials_release(const face_materials *l);
int face_materials_count(const face_materials *l); /* 0 for NULL */
const face_material *face_materials_at(const face_materials *l, int slot);

/* --- meshes and textures --- */

typedef struct mesh_entry {
    char *name;
    int64_t source;              /* mesh_maker */
    char *path;                  /* relative to the scene file; "" for none */
    long path_line, path_column; /* where the scene file names the file or the generator; 0 if it does not */
    int64_t handedness;          /* mesh_handedness, for a file */
    int64_t count;               /* triangles, for sparse, dense and sphere */
    int64_t level;               /* for icosphere and slime */
    double major, minor;         /* for torus */
    int64_t around, tube;        /* segments of torus and lathe; cells of terrain along x and z */
    number_list profile;         /* for lathe: radius, height, radius, height, ... */
    double crease_deg;
    vec3 size;                       /* for box; for terrain with the height of its hills */
    double depth;                    /* for terrain: depth of the solid base below y = 0; 0: an open surface */
    int64_t seed;                    /* for terrain */
    softbody_settings slime;         /* for slime; its level is the field `level` above */
    double time_s;                   /* for slime: the simulated time that is shown */
    char *script_path;               /* for slime: the script of its hands; "" for none; relative to the scene file */
    long script_line, script_column; /* where the scene file names the script; 0 if it does not */
    softbody_quantities account;     /* for a loaded slime: the quantities of its motion */
    double motion_s;                 /* for a loaded slime: the wall time of its steps */
    const mesh *data;                /* a counted reference; NULL until scene_load */
    const face_materials *shading_materials; /* a counted reference; NULL for none */
} mesh_entry;

typedef struct texture_entry {
    char *name;
    char *path; /* relative to the scene file */
    long path_line, path_column;
    int64_t filter, wrap_u, wrap_v, space; /* texture_filter, texture_wrap, texture_space */
    const texture *data;                   /* a counted reference; NULL until scene_load */
} texture_entry;

/* A file of optical data (scene/data/optical_files.h). */
typedef struct data_entry {
    char *name;
    char *path; /* relative to the scene file */
    long path_line, path_column;
    char glass[SCENE_NAME_MAX + 1], column[SCENE_NAME_MAX + 1]; /* "": the only one; the second */
    double scale;
    int64_t relative_to;      /* data_reference: of an index */
    const optical_data *data; /* a counted reference; NULL until scene_load */
} data_entry;
typedef enum data_reference { DATA_IN_AIR, DATA_IN_VACUUM } data_reference;
enum { SCENE_DATA_MAX = 64 };

/* Limits of loading, for scenes from others; copies of a scene have the same limits. */
typedef struct load_limits {
    char *root;       /* folder of all files that may be read (base/file.h); NULL or "": no restriction */
    size_t triangles; /* total of all meshes; 0: only the importer's limit */
} load_limits;

/* Releases the loaded data of an entry whose parameters change. */
void mesh_entry_unload(mesh_entry *m);
void texture_entry_unload(texture_entry *t);
void data_entry_unload(data_entry *d);

/* --- slimes --- */

/* The settings of a slime's body, with the level of the mesh entry. */
softbody_settings slime_settings(const mesh_entry *m);

/* Checks that the settings are valid and need at most SLIME_STEPS_MAX steps to time_s. The diagnostic has no
 * position. */
#define SLIME_STEPS_MAX 1e9
status slime_check(const mesh_entry *m, diagnostic *why);
/* Checks the number of steps to another time, such as the end of an animation. */
status slime_check_end(const mesh_entry *m, double end_s, diagnostic *why);
