/* A scene as a person describes it: render settings, camera, background, lights, materials, solids.
 * Every field that may be turned is a row of the parameter table (scene/model/params.h), which is how files,
 * --set, studies and manuals reach it. Ownership: scene_create, scene_read and scene_clone give a scene to the caller,
 * scene_destroy releases it; the renderer borrows it. */
#ifndef CUVETTE_SCENE_MODEL_SCENE_H
#define CUVETTE_SCENE_MODEL_SCENE_H

#include "base/status.h"
#include "base/vec3.h"
#include "geometry/solid.h"
#include "image/image.h"
#include "image/texture.h"
#include "softbody/softbody.h"
#include "scene/model/integrators.h"
#include "scene/model/layers.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum weights_rule { WEIGHTS_FRESNEL, WEIGHTS_CONSTANT } weights_rule;
typedef enum transmission_rule { TRANSMISSION_REFRACT, TRANSMISSION_SIMPLE } transmission_rule;
typedef enum beyond_rule { BEYOND_SKY, BEYOND_BLACK, BEYOND_MEAN } beyond_rule;
typedef enum radiance_rule { RADIANCE_CLASSIC, RADIANCE_BASIC } radiance_rule;
typedef enum shadow_rule { SHADOWS_OFF, SHADOWS_OPAQUE, SHADOWS_ATTENUATED } shadow_rule;
typedef enum schedule_rule { SCHEDULE_COLUMNS, SCHEDULE_ROWS, SCHEDULE_TILES, SCHEDULE_DYNAMIC } schedule_rule;
typedef enum pin_rule { PIN_RULE_NONE, PIN_RULE_COMPACT, PIN_RULE_SCATTER } pin_rule;
typedef enum lighting_rule { LIGHTING_LAMBERT, LIGHTING_PHONG, LIGHTING_WHITTED } lighting_rule;
typedef enum spectrum_rule { SPECTRUM_RGB, SPECTRUM_SPECTRAL } spectrum_rule;
typedef enum texturing_rule { TEXTURING_PERSPECTIVE, TEXTURING_AFFINE } texturing_rule;
typedef enum shading_rule { SHADING_FLAT, SHADING_SMOOTH, SHADING_GOURAUD } shading_rule;
typedef enum light_kind { LIGHT_POINT, LIGHT_CONE, LIGHT_SOFT_CONE } light_kind;
typedef enum background_kind { BACKGROUND_UNIFORM, BACKGROUND_GRADIENT, BACKGROUND_PICTURE } background_kind;

/* Numbers, as many as one gives. */
enum { NUMBER_LIST_MAX = 32 };
typedef struct number_list {
    int64_t count;
    double value[NUMBER_LIST_MAX];
} number_list;

enum { SCENE_NAME_MAX = 63 };

/* Integer and enum parameters are int64_t, switches (on/off) too: one type a kind of parameter. */
typedef struct render_settings {
    int64_t width, height; /* pixels */
    int64_t depth;         /* recursion depth; 0 = camera rays only */
    int64_t samples;       /* a pixel: a whole square, at most SCENE_SAMPLES_MAX */
    int64_t integrator;    /* integrator_rule */
    int64_t layer;         /* layer_rule: which one the film shows, of an integrator that gives layers */
    int64_t lighting;      /* lighting_rule */
    int64_t weights;       /* weights_rule */
    int64_t transmission;  /* transmission_rule */
    int64_t beyond;        /* beyond_rule */
    int64_t radiance;      /* radiance_rule */
    int64_t shadows;       /* shadow_rule */
    double min_weight;     /* children with a lower throughput in every channel are not traced; 0: all are */
    int64_t paths;         /* of the path tracer, a pixel */
    int64_t roulette;      /* 1: the path tracer ends faint paths by chance */
    int64_t seed;          /* of everything that is drawn by chance */
    int64_t polarisation;  /* 1: a ray carries its Stokes vector */
    int64_t spectrum;      /* spectrum_rule */
    int64_t wavelengths;   /* of the spectral film, a camera ray */
    double lambda_nm;      /* at which indices are taken where there is no spectrum */
    double unit_m;         /* length of one scene unit in metres */
    int64_t threads;       /* 1..1024 */
    int64_t pool;          /* 1: threads started beforehand; 0: fresh ones for every frame */
    int64_t schedule;      /* schedule_rule */
    int64_t tile;          /* tile edge, pixels */
    int64_t pin;           /* pin_rule */
    int64_t accel;         /* hierarchy_kind */
    int64_t build_threads; /* that build hierarchies; 0: one a processing unit */
    int64_t keep;          /* 1: a mesh keeps its hierarchy; 0: every frame builds them anew */
    /* a moving mesh's hierarchy is built anew when its expected cost has grown by more than this factor */
    double rebuild;
    int64_t texturing; /* texturing_rule, of the rasteriser */
} render_settings;

static inline const integrator_traits *integrator_of(const render_settings *r)
{
    return &integrator_table[r->integrator];
}

/* Both branches of each ray are followed. */
static inline bool follows_trees(const render_settings *r)
{
    return integrator_of(r)->tree && r->lighting == LIGHTING_WHITTED;
}

/* All branches of each ray, for what looks into a scene; or a preview of triangles. */
static inline void trace_trees(render_settings *r)
{
    r->integrator = INTEGRATOR_WHITTED;
}

static inline void draw_triangles(render_settings *r)
{
    r->integrator = INTEGRATOR_ZBUFFER;
}

/* y is up; yaw 0 looks along +z, positive yaw turns towards +x, positive pitch looks up; x is to the right at yaw 0. */
typedef struct camera {
    vec3 position;
    vec3 target;               /* used when aimed */
    double yaw_deg, pitch_deg; /* used when not aimed */
    int64_t aimed;             /* 1: looks at target; 0: along yaw and pitch. Set by whichever was written last */
    double roll_deg;           /* about the direction of view, right side down: the image turns counter-clockwise */
    double fov_deg;            /* vertical */
} camera;

typedef struct background {
    int64_t kind;                      /* background_kind */
    vec3 color;                        /* linear RGB in x, y, z; uniform, and the zenith of a gradient */
    vec3 horizon;                      /* gradient: colour at and below the horizon */
    char *picture_path;                /* equirectangular sky; "" for none; relative to the scene file */
    long picture_line, picture_column; /* where the scene file names it; 0 when it was set otherwise */
    image *picture;                    /* owned; NULL until loaded by scene_load */
    vec3 ambient;                      /* I_a of Phong's sum, linear RGB */
    double ior;                        /* of what surrounds all solids, where medium is MEDIUM_IOR */
    int64_t medium;                    /* see scene/model/medium.h */
    vec3 absorb_per_m; /* of what surrounds all solids, by channel, along ways that end at a surface or a light */
} background;

/* Fields mean what Phong's sum I = k_e C + k_a I_a C + k_d I_L C max(0, N.L) + k_s I_L max(0, R.V)^n and the weights
 * rule say. */
typedef struct material {
    vec3 color; /* C, linear RGB; of a clear solid also the share of light left after tint_distance inside */
    double ambient, diffuse, specular, shininess; /* k_a, k_d, k_s, n */
    double emission;                              /* k_e: the surface sends out k_e C by itself, to all sides */
    double reflectivity; /* constant weights, simple transmission, and opaque materials; a clear one's coating under
                            fresnel weights */
    double transparency; /* 0 = opaque; else share of the refracted light that passes an interface */
    double ior;          /* relative to vacuum, where medium is MEDIUM_IOR */
    int64_t medium;      /* see scene/model/medium.h */
    number_list coefficients;    /* of the medium's own law of dispersion */
    vec3 absorb_per_m;           /* Beer and Lambert's coefficient by channel */
    number_list absorb_spectrum; /* the same by wavelength: nm, 1/m, nm, 1/m ...; takes the place of absorb_per_m unless
                                    empty */
    double tint_distance;        /* scene units; tint and absorption add up */
    char texture[SCENE_NAME_MAX + 1]; /* its colour is times color; "" for none */
    double texture_size;              /* scene units of one repetition on solids that are no meshes; 0: one a face */
    double checker;                   /* edge of the checker cells in the solid's own frame; 0 = none */
    vec3 checker_color;               /* colour of the other cells */
} material;

/* Where a mesh comes from: its file, or a body that is computed (geometry/bodies.h). */
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

typedef struct face_looks face_looks; /* how the faces of a file's materials look: scene/model/looks.h */

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
    const face_looks *looks;         /* one owner of them; NULL for none */
} mesh_entry;

typedef struct texture_entry {
    char *name;
    char *path; /* relative to the scene file */
    long path_line, path_column;
    int64_t filter, wrap_u, wrap_v, space; /* texture_filter, texture_wrap, texture_space */
    const texture *data;                   /* one owner of it; NULL until scene_load */
} texture_entry;

typedef struct named_material {
    char *name;
    material value;
} named_material;
typedef struct light {
    char *name;
    int64_t kind;          /* light_kind */
    vec3 position, target; /* target: the point that a cone is aimed at */
    double half_angle_deg; /* of a cone, from its axis */
    vec3 color;
    double intensity;
    double radius; /* of the sphere that shines, for the path tracer; 0 = a point */
    double reach;  /* distance at which intensity holds, falling off with the square; 0 = the same everywhere */
} light;
typedef struct solid {
    char *name;
    solid_shape shape;
    int64_t priority;              /* the higher one wins where solids overlap; of equals the one listed first */
    int64_t visible;               /* 0: left out of the picture altogether */
    char mesh[SCENE_NAME_MAX + 1]; /* of a mesh: which one */
    int64_t shading;               /* shading_rule, of a mesh */
    int material_index;            /* into scene.materials; -1 when it has none */
    material surface;              /* its own copy, with its own changes */
} solid;

/* What loading is held to, for scenes that others wrote; copies of a scene are held to the same. */
typedef struct load_limits {
    char *root;       /* every file that is read lies below it, whoever names it (base/below.h); NULL or "": anywhere */
    size_t triangles; /* of all meshes together; 0: no limit but the importer's own */
} load_limits;

typedef struct scene {
    char *path; /* file it came from, "" if none */
    char *title;
    render_settings render;
    struct camera camera;
    struct background background;
    mesh_entry *meshes;
    size_t mesh_count;
    texture_entry *textures;
    size_t texture_count;
    named_material *materials;
    size_t material_count;
    light *lights;
    size_t light_count;
    solid *solids;
    size_t solid_count;
    load_limits limits; /* none by itself; set by scene_limit */
} scene;

/* Limits of a scene. Primitives are the convex pieces that solids are made of: a cup is two, the others are one. */
enum {
    SCENE_LIGHTS_MAX = 64,
    SCENE_MATERIALS_MAX = 256,
    SCENE_PRIMITIVES_MAX = 64,
    SCENE_MESHES_MAX = 64,
    SCENE_TEXTURES_MAX = 64
};
enum { SCENE_SAMPLES_MAX = 64 };
#define SCENE_SKY_MAX                                                                              \
    65536.0F /* of a sky picture's values: under the film's limit, and all that a half float holds \
              */
#define SCENE_PIXELS_MAX 268435456 /* 2^28 */

/* An empty scene: every parameter at its default, no lights, no solids. NULL when memory is out. */
scene *scene_create(void);
scene *scene_clone(const scene *original);
void scene_destroy(scene *s);

/* Reads a scene file (YAML; grammar in scene/file/read.c's head and the manual). Pictures, textures and meshes are not
 * loaded yet. */
status scene_read(const char *path, scene **out, diagnostic *why);
/* The same of a file that lies below root (base/below.h), which is the root of its limits, too. */
status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why);
/* The same from memory; name stands for the file in diagnostics, and its folder is where relative paths start. */
status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);

/* Sets its limits; root is copied. What was loaded stays. */
status scene_limit(scene *s, const char *root, size_t triangles, diagnostic *why);

/* Loads what the scene names and does not have yet: the sky picture, textures, and meshes, from files or computed. A
 * diagnostic about a file that the scene file names is located there. A sky's values must be from 0 to SCENE_SKY_MAX.
 * STATUS_BAD_INPUT over the limits; of meshes that are too large together the one that was too much is not kept. */
status scene_load(scene *s, diagnostic *why);

/* Who waits for slimes that move: go_on is asked about every 10 ms, from 0 to 1 of all their motion being done; false
 * ends it. */
typedef struct load_watch {
    bool (*go_on)(void *context, double share_done);
    void *context;
} load_watch;

/* scene_load that can be stopped: STATUS_INTERRUPTED then. What was loaded whole is kept, and a later load goes on from
 * there; nothing else of the scene has changed. watch is borrowed; NULL: nobody waits. */
status scene_load_until(scene *s, const load_watch *watch, diagnostic *why);

/* The same as scene_load, but for bodies that are computed: what lies in files alone. Scripts of slimes are read, and
 * nothing is kept of them. */
status scene_load_files(scene *s, diagnostic *why);

/* A path that the scene names, as it reads from the working folder; fresh memory, NULL when that is out. */
char *scene_file_path(const scene *s, const char *path);

/* Checks what single ranges cannot: shapes, energy (under constant weights or simple transmission: reflectivity +
 * transparency <= 1), names, limits, camera not at its own target, a picture sky that names its picture. Run by
 * scene_read and before every render. */
status scene_check(const scene *s, diagnostic *why);

/* Threads that build hierarchies: render.build_threads, or one a processing unit. */
int scene_build_threads(const render_settings *r);

/* Are the shares of a clear surface the material's own constants, whatever its index? */
static inline bool scene_has_constant_shares(const render_settings *r)
{
    return r->weights == WEIGHTS_CONSTANT || r->transmission == TRANSMISSION_SIMPLE;
}

/* Do rays carry basic radiance, L / n^2? Only light that is bent changes its solid angle: under simple transmission
 * nothing is, nor in what is drawn with a depth buffer. */
static inline bool scene_has_basic_radiance(const render_settings *r)
{
    return r->radiance == RADIANCE_BASIC && r->transmission == TRANSMISSION_REFRACT && !integrator_of(r)->drawn;
}

/* Index of the solid of that name, or -1. */
int scene_find_solid(const scene *s, const char *name);

/* The mesh or texture of that name; NULL if there is none. */
const mesh_entry *scene_find_mesh(const scene *s, const char *name);
const texture_entry *scene_find_texture(const scene *s, const char *name);

/* Gives each mesh of s that is not loaded the triangles of a mesh with the same parameters in another scene, where
 * there is one. Slimes only where s.render.keep is on: each frame is to have its own simulation else. */
void scene_borrow_meshes(scene *s, const scene *from);

/* Lets go of what was loaded for an entry whose parameters change. */
void mesh_entry_unload(mesh_entry *m);
void texture_entry_unload(texture_entry *t);

#endif
