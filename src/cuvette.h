/* Cuvette, the engine: make a scene, turn any of its parameters, render it into your own memory, and send rays of your
 * own through it, and take hold of what is soft in it. This is the only header that a program outside src/ includes;
 * link with `pkg-config --cflags --libs cuvette`.
 *
 * Five handles. A cuvette_scene is a description, as a scene file is. A cuvette_engine is worker threads and their
 * memory; it renders scenes, one at a time. A cuvette_frame is what a render leaves: film, ray counts, times. A
 * cuvette_query is a scene made ready for rays of the caller's, as it was at that moment. A cuvette_motion makes the
 * slimes of a scene move, and has hands. cuvette(1) is the manual of scenes, parameters and models; `cuvette params`
 * lists every parameter with its range, unit and default.
 *
 * Ownership. What a function whose name ends in _create, _read, _clone or _render hands out is the caller's; the
 * function that ends in _destroy releases it, and takes NULL. Arguments are borrowed for the call alone: the library
 * keeps no pointer to the caller's memory, and a frame or a query does not need its scene or its engine any more.
 * Handles need no order of release.
 *
 * Errors. A function that can fail returns a cuvette_status; results come back by pointer and are set only on success
 * (handles to NULL otherwise). `why`, which may be NULL, then says what is wrong and what would be right. A NULL where
 * a handle, a name or a result is needed is CUVETTE_BAD_INPUT like any wrong value. The library never prints, never
 * exits, raises no signal, and reads of the environment only CUVETTE_ISA (cuvette_engine_create) and CUVETTE_IMPORT
 * (the program that reads mesh files).
 *
 * Threads. There is no global state: what belongs to different handles may be used by different threads at the same
 * time. Of one scene any number of functions that take it as const may run at the same time, also renders by several
 * engines, but none beside one that changes it; a change while it is being rendered is refused with CUVETTE_BUSY. A
 * motion counts as its scene here. Of one engine one render runs at a time (CUVETTE_BUSY); cuvette_engine_cancel may be
 * called from any thread. A frame and a query are never changed once they are made: any number of threads may use them.
 * Callbacks come on the thread that called, and never two at once.
 *
 * Geometry. Lengths are scene units (render.unit_m says how long one is), y is up, angles are degrees. Pixels are
 * counted from 0, 0 at the top left; pixel x, y covers the square from x, y to x + 1, y + 1.
 *
 * The film is a function of the scene alone: the same bits for any number of threads, schedule, instruction set or
 * compiler, and with or without pieces, previews and callbacks. Its hash proves it.
 *
 * Floating-point environment. Functions that return a cuvette_status compute in C's default one (to nearest, no
 * traps, subnormal numbers kept), whatever the caller's rounding mode, traps (feenableexcept), FTZ, DAZ or x87
 * precision. On return the caller's is as it was, raised exceptions too; it is in force in the caller's callbacks,
 * and what they change in it stays. */
#ifndef CUVETTE_H
#define CUVETTE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Of this header; cuvette_version tells the library's. A new patch or minor number keeps what is here and may add to
 * it; a new major number may not, and changes the soname. */
#define CUVETTE_VERSION_MAJOR 0
#define CUVETTE_VERSION_MINOR 1
#define CUVETTE_VERSION_PATCH 0

#if defined(__GNUC__)
#define CUVETTE_API __attribute__((visibility("default")))
#else
#define CUVETTE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* "0.1.0": the version of the library that is running. Lasts for ever. */
CUVETTE_API const char *cuvette_version(void);

/* --- errors --- */

typedef enum cuvette_status {
    CUVETTE_OK = 0,
    CUVETTE_FAILURE = 1,    /* the machine failed us: memory, disk, threads */
    CUVETTE_BAD_INPUT = 2,  /* a file, a name or a value is wrong */
    CUVETTE_BUSY = 3,       /* the engine or the scene is in use by a render, or the scene by an advance */
    CUVETTE_CANCELLED = 130 /* stopped on request; what was finished is kept */
} cuvette_status;

/* Why something failed. Texts are one line each, UTF-8, end in 0, and have no full stop; "" and 0 where there is
 * nothing to say. */
typedef struct cuvette_diagnostic {
    char file[512];    /* the file, or what else was read */
    long line, column; /* in it, from 1 */
    char what[512];    /* what is wrong */
    char remedy[512];  /* what would be right */
} cuvette_diagnostic;

enum { CUVETTE_DIAGNOSTIC_TEXT_MAX = 1792 }; /* holds the text of any */

/* Writes "file:line:column: what; remedy" (absent parts are left out), at most size - 1 characters; returns text. */
CUVETTE_API char *cuvette_diagnostic_text(const cuvette_diagnostic *why, char *text, size_t size);

/* --- scenes --- */

typedef struct cuvette_scene cuvette_scene;

/* An empty scene: every parameter at its default, no lights, no materials, no solids. */
CUVETTE_API cuvette_status cuvette_scene_create(cuvette_scene **out, cuvette_diagnostic *why);
/* From a scene file; YAML, at most 1 MiB. Pictures that it names are read at their first use. */
CUVETTE_API cuvette_status cuvette_scene_read(const char *path, cuvette_scene **out, cuvette_diagnostic *why);
/* The same from size bytes of text; name stands for the file in diagnostics, and its folder is where relative paths
 * start. */
CUVETTE_API cuvette_status cuvette_scene_read_text(const char *name, const char *text, size_t size, cuvette_scene **out,
                                                   cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_clone(const cuvette_scene *scene, cuvette_scene **out,
                                               cuvette_diagnostic *why);
/* Not while it is being rendered or its slimes advance. */
CUVETTE_API void cuvette_scene_destroy(cuvette_scene *scene);

/* Checks what single values cannot (as every render does before it begins): shapes, energy, a camera at its own target.
 */
CUVETTE_API cuvette_status cuvette_scene_check(const cuvette_scene *scene, cuvette_diagnostic *why);

/* The scene as a scene file, only what differs from the defaults; what is read from it makes the same film. The file
 * appears whole or not at all; "-" is standard output. */
CUVETTE_API cuvette_status cuvette_scene_write(const cuvette_scene *scene, const char *path, cuvette_diagnostic *why);
/* The same into memory, as cuvette_scene_get writes a value; paths of files are relative to the working folder. */
CUVETTE_API cuvette_status cuvette_scene_write_text(const cuvette_scene *scene, char *text, size_t size, size_t *length,
                                                    cuvette_diagnostic *why);

/* Calls note with one line of text, "PLACE: WHAT; REMEDY", which lasts for the call, for each thing that is allowed and
 * still looks wrong: a black solid, no light, what has no effect. PLACE is a parameter's path or an object's name. */
CUVETTE_API cuvette_status cuvette_scene_hints(const cuvette_scene *scene,
                                               void (*note)(void *context, const char *text), void *context,
                                               cuvette_diagnostic *why);

/* --- parameters, by name ---
 *
 * A path is group.name, as on the command line: "render.depth", "camera.position", "background.color"; of a light, a
 * material or a solid the group is its name: "lamp.intensity", "glass.ior", "ball.radius". One element of a vector is
 * "lamp.position.x"
 * (.x .y .z, of colours .r .g .b). A material's parameter reaches all solids that have the material; by a solid's name
 * it is set for that one alone. Setting a value leaves the scene as it was unless it is right: name, type, range. */

/* From text: "8", "1.5", "on", "sky", "0,2.75,-6". */
CUVETTE_API cuvette_status cuvette_scene_set(cuvette_scene *scene, const char *path, const char *value,
                                             cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_set_double(cuvette_scene *scene, const char *path, double value,
                                                    cuvette_diagnostic *why);
/* An integer or a switch (0, 1); a number where one is wanted. */
CUVETTE_API cuvette_status cuvette_scene_set_int(cuvette_scene *scene, const char *path, int64_t value,
                                                 cuvette_diagnostic *why);
/* Three numbers for a vector or a colour (linear RGB), up to 32 for a list. */
CUVETTE_API cuvette_status cuvette_scene_set_vector(cuvette_scene *scene, const char *path, const double *values,
                                                    size_t count, cuvette_diagnostic *why);

/* As text in the form that cuvette_scene_set takes; numbers have the fewest digits that read back the same. *length
 * (may be NULL) is the text's, without the 0 at its end, also when text is too small for it, which is
 * CUVETTE_BAD_INPUT; text may be NULL when size is 0. */
CUVETTE_API cuvette_status cuvette_scene_get(const cuvette_scene *scene, const char *path, char *text, size_t size,
                                             size_t *length, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_get_double(const cuvette_scene *scene, const char *path, double *value,
                                                    cuvette_diagnostic *why);
/* An integer; a switch as 0 or 1. */
CUVETTE_API cuvette_status cuvette_scene_get_int(const cuvette_scene *scene, const char *path, int64_t *value,
                                                 cuvette_diagnostic *why);
/* At most room numbers; *count is how many there are, also when that is more than room, which is CUVETTE_BAD_INPUT. */
CUVETTE_API cuvette_status cuvette_scene_get_vector(const cuvette_scene *scene, const char *path, double *values,
                                                    size_t room, size_t *count, cuvette_diagnostic *why);

/* What is known of a parameter; texts last for the call of visit. */
typedef struct cuvette_parameter {
    const char *path;    /* "ball.radius" */
    const char *value;   /* now, as cuvette_scene_get gives it */
    const char *unit;    /* "px", "deg", "scene units"; "" for ratios and words */
    const char *range;   /* "integer 1..65536", "one of: sky, black" */
    const char *initial; /* its default */
    const char *meaning; /* one line */
} cuvette_parameter;

/* Visits every parameter of the scene, in a fixed order, until visit returns false. Setting all that was visited on a
 * copy of the scene as it was read makes the same scene. */
CUVETTE_API cuvette_status cuvette_scene_each_parameter(const cuvette_scene *scene,
                                                        bool (*visit)(void *context, const cuvette_parameter *one),
                                                        void *context, cuvette_diagnostic *why);

/* --- objects ---
 *
 * Lights, materials, solids, meshes and textures have names: letters, digits, _ and -, a letter or _ first, at most 63
 * of them; no two objects share one. A scene holds 64 lights, 256 materials, 64 meshes, 64 textures, and 64 solids (a
 * cup counts as two). Where solids overlap, the one with the highest `priority` is there, of equal ones the one added
 * first. */

typedef enum cuvette_object {
    CUVETTE_LIGHT,
    CUVETTE_MATERIAL,
    CUVETTE_SOLID,
    CUVETTE_MESH,
    CUVETTE_TEXTURE
} cuvette_object;

CUVETTE_API cuvette_status cuvette_scene_add_light(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_add_material(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
/* shape: "sphere" or another word of cuvette(1), which says what stands where in each. material: the name of one, or
 * NULL for a surface of the solid's own. Everything else is at its default, and is turned by its path. */
CUVETTE_API cuvette_status cuvette_scene_add_solid(cuvette_scene *scene, const char *name, const char *shape,
                                                   const char *material, cuvette_diagnostic *why);

/* A mesh that is read or computed at its first use: set NAME.file to an OBJ, PLY, STL or glTF file, or NAME.generate to
 * "icosphere", "torus" and so on. It is seen as a solid of the shape "mesh" whose parameter `mesh` is its name. */
CUVETTE_API cuvette_status cuvette_scene_add_mesh(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);

/* Triangles of the caller's, which are copied. Of each pair of arrays one is NULL, or both where the mesh has none. A
 * front is where vertices run counterclockwise. Coordinates are finite, at most 1e9. Set size before the call; later
 * versions add fields at the end. */
typedef struct cuvette_triangles {
    size_t size;            /* sizeof(cuvette_triangles) */
    size_t vertex_count;    /* at most 2^29 */
    size_t triangle_count;  /* at most 2^28 */
    const double *vertices; /* x, y, z of each */
    const float *vertices_float;
    const uint32_t *corners; /* three vertices of each triangle, counted from 0 */
    const double *normals;   /* x, y, z of each vertex, any length */
    const float *normals_float;
    const double *uvs; /* u to the right, v upwards, of each vertex; 0, 0 is the texture's lower left corner */
    const float *uvs_float;
    const unsigned char *slots;    /* material slot of each triangle; NULL: all 0 */
    const char *const *slot_names; /* names of slots 0 to slot_count - 1; may be NULL. Where the mesh's solid has no
                                    * material of its own, faces look like the scene's material of their slot's name;
                                    * what they are made of is the solid's alone */
    int slot_count;                /* of slot_names, at most 256 */
} cuvette_triangles;
CUVETTE_API cuvette_status cuvette_scene_add_triangles(cuvette_scene *scene, const char *name,
                                                       const cuvette_triangles *triangles, cuvette_diagnostic *why);

/* A texture: of a PNG, JPEG, PFM or 24-bit BMP file, NAME.file; or of linear RGB floats of the caller's, which are
 * copied, row by row from the top (repeated, trilinear). A material's or a solid's parameter `texture` names it. What
 * was handed over as arrays is in the scene's clones, but in no file that is written; setting a parameter of it lets go
 * of it. */
CUVETTE_API cuvette_status cuvette_scene_add_texture(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_add_pixels(cuvette_scene *scene, const char *name, int width, int height,
                                                    const float *rgb, cuvette_diagnostic *why);

/* A material goes only when no solid has it. */
CUVETTE_API cuvette_status cuvette_scene_remove(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);

/* Adds by, three numbers in scene units, to the position of a solid, a light or "camera" (whose target goes with it,
 * and a cone's); or of many: the name "all" is all solids and lights, "solids" and "lights" are these alone, and such
 * words are joined by '+', as "all+camera", unless an object has that name. */
CUVETTE_API cuvette_status cuvette_scene_move(cuvette_scene *scene, const char *name, const double *by,
                                              cuvette_diagnostic *why);
/* Turns a solid where it stands, or the direction of a cone of light or "camera", about the world's x axis, then y,
 * then z (three angles), on top of the rotation that it has; right-hand rule on the axes' names. Many objects ("all")
 * turn about the origin, the camera with its roll. */
CUVETTE_API cuvette_status cuvette_scene_turn(cuvette_scene *scene, const char *name, const double *degrees,
                                              cuvette_diagnostic *why);
/* Multiplies all lengths of a solid or a light by a factor above 0, where it stands; or of many ("all+camera"), about
 * the origin: with all solids their materials' lengths too, and render.unit_m is divided by the factor, so that lengths
 * in metres, and what media absorb, stay. */
CUVETTE_API cuvette_status cuvette_scene_scale(cuvette_scene *scene, const char *name, double factor,
                                               cuvette_diagnostic *why);
/* Aims the camera at a point. */
CUVETTE_API cuvette_status cuvette_scene_look_at(cuvette_scene *scene, const double *target, cuvette_diagnostic *why);
/* The solid has that material from now on, and what it had for itself alone is gone; NULL takes the material away. */
CUVETTE_API cuvette_status cuvette_scene_give_material(cuvette_scene *scene, const char *solid, const char *material,
                                                       cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_rename(cuvette_scene *scene, const char *name, const char *new_name,
                                                cuvette_diagnostic *why);

/* How many there are of a kind, and their names, in the scene's order; a name lasts until the scene is changed. 0 and
 * NULL for what is not there. */
CUVETTE_API size_t cuvette_scene_count(const cuvette_scene *scene, cuvette_object kind);
CUVETTE_API const char *cuvette_scene_name(const cuvette_scene *scene, cuvette_object kind, size_t index);

/* --- rendering --- */

typedef struct cuvette_engine cuvette_engine;
typedef struct cuvette_frame cuvette_frame;

/* instructions: "sse2", "avx2" or "avx512", at most what the processor has; NULL: what CUVETTE_ISA names, else the
 * best. Results are the same to the bit. Threads are started by the first render, as many as render.threads says, and
 * wait for the next one. */
CUVETTE_API cuvette_status cuvette_engine_create(const char *instructions, cuvette_engine **out,
                                                 cuvette_diagnostic *why);
/* Not while it renders. */
CUVETTE_API void cuvette_engine_destroy(cuvette_engine *engine);

/* Stops the render under way, within about a tenth of a second; forgotten when there is none. From any thread, and from
 * a signal handler. */
CUVETTE_API void cuvette_engine_cancel(cuvette_engine *engine);

/* A rectangle of the picture, x0 <= x < x1, y0 <= y < y1, whose pixels in the caller's buffers are new. */
typedef struct cuvette_piece {
    int x0, y0, x1, y1;
    int coarse; /* 1: the pixels are final; n: one value for each n x n of them, from a preview */
} cuvette_piece;

/* What a render is to do beside making a frame. Begin with CUVETTE_REQUEST, which fills in the size and zeros, and set
 * what is wanted. Later versions add fields at the end. */
typedef struct cuvette_request {
    size_t size; /* sizeof(cuvette_request) */
    int width,
        height; /* of the buffers: the scene's render.width and render.height, to be sure of it; 0 without buffers */
    float *rgb; /* linear RGB, 1.0 is white, row by row from the top; NULL if not wanted. Not negative in an rgb film */
    size_t rgb_stride; /* floats from one row to the next; 0: 3 * width */
    /* the same encoded as sRGB (IEC 61966-2-1), correctly rounded, a byte a channel; NULL if not wanted */
    unsigned char *srgb;
    size_t srgb_stride; /* bytes from one row to the next; 0: 3 * width */
    int preview; /* 2..64: first a picture of 1/preview of the width and height, each of its pixels as a square; 0:
                  * none. Costs 1/preview^2 of the frame, and is in none of the frame's counts and times */
    bool (*progress)(
        void *context,
        double share); /* of the frame, 0..1, never less than before; once at 0 before the first ray, about ten
                        * times a second, and at 1 when all is done; return false to cancel. May be NULL */
    void (*piece)(
        void *context,
        const cuvette_piece *piece); /* pieces of the buffers as they are finished: of a preview one, then each of the
                                      * picture's tiles once (render.schedule, render.tile), about ten times a second.
                                      * Without it the buffers are filled at the end. May be NULL */
    void *context;                   /* handed to both */
} cuvette_request;

#ifdef __cplusplus
#define CUVETTE_REQUEST                                                      \
    cuvette_request                                                          \
    {                                                                        \
        sizeof(cuvette_request), 0, 0, NULL, 0, NULL, 0, 0, NULL, NULL, NULL \
    }
#else
#define CUVETTE_REQUEST ((cuvette_request){.size = sizeof(cuvette_request)})
#endif

/* Renders the scene with as many threads as render.threads says. request and out may be NULL. Cancelled, it returns
 * CUVETTE_CANCELLED and still hands out the frame, film and counts of the rays that were traced (NULL if that was
 * before the first one); the buffers hold what was finished, and with pieces, elsewhere what they held before.
 * CUVETTE_BAD_INPUT also when the picture is brighter than the film holds (262144 in one contribution, 524288 in a
 * pixel). */
CUVETTE_API cuvette_status cuvette_engine_render(cuvette_engine *engine, const cuvette_scene *scene,
                                                 const cuvette_request *request, cuvette_frame **out,
                                                 cuvette_diagnostic *why);

CUVETTE_API void cuvette_frame_destroy(cuvette_frame *frame);

CUVETTE_API int cuvette_frame_width(const cuvette_frame *frame); /* 0 for NULL */
CUVETTE_API int cuvette_frame_height(const cuvette_frame *frame);
/* The fingerprint of the film's size and every sum in it: equal films, equal hashes. The same as `cuvette render`
 * prints. */
CUVETTE_API uint64_t cuvette_frame_hash(const cuvette_frame *frame);

/* Copies a rectangle into the caller's memory, as the buffers of a request; stride from one row to the next, 0: 3 * (x1
 * - x0). */
CUVETTE_API cuvette_status cuvette_frame_rgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1, float *rgb,
                                             size_t stride, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_frame_srgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1,
                                              unsigned char *srgb, size_t stride, cuvette_diagnostic *why);
/* Writes the picture: .png (bits: 8 or 16 a channel), .jpg, .pfm (linear floats) by the ending of path; "-" is a PNG on
 * standard output. The file appears whole or not at all. */
CUVETTE_API cuvette_status cuvette_frame_write(const cuvette_frame *frame, const char *path, int bits,
                                               cuvette_diagnostic *why);

/* What was traced. A ray is a straight piece between two events, and is counted when it is traced. The totals do not
 * depend on the number of threads. Set size before the call; later versions add fields at the end. */
typedef struct cuvette_counters {
    size_t size;                               /* sizeof(cuvette_counters) */
    uint64_t camera, reflect, refract, shadow; /* rays by kind */
    uint64_t total_internal;                   /* total internal reflections */
    uint64_t cut_depth, cut_weight;            /* rays not traced: beyond render.depth; under render.min_weight */
    double cut_depth_throughput[3];            /* the sum of their weights, linear RGB */
    double cut_weight_throughput[3];
    uint64_t by_depth[65]; /* camera (0), reflected and refracted rays by recursion depth */
} cuvette_counters;

/* Of one solid. */
typedef struct cuvette_solid_counters {
    size_t size;         /* sizeof(cuvette_solid_counters) */
    uint64_t tests;      /* rays tested against it */
    uint64_t hits;       /* interfaces met on it, not by shadow rays */
    uint64_t first_hits; /* camera rays whose first interface is on it */
} cuvette_solid_counters;

/* How the render went. */
typedef struct cuvette_statistics {
    size_t size;      /* sizeof(cuvette_statistics) */
    double wall_s;    /* from the release of the workers to the end of the last */
    double cpu_s;     /* of the process over the same stretch */
    double preview_s; /* wall time of the preview, before that; 0 without */
    int threads;
    double noise_rms; /* standard error of a value of the film, where paths are random; NaN else */
} cuvette_statistics;

CUVETTE_API cuvette_status cuvette_frame_counters(const cuvette_frame *frame, cuvette_counters *out,
                                                  cuvette_diagnostic *why);
/* solid: the index that it had in the rendered scene. */
CUVETTE_API cuvette_status cuvette_frame_solid_counters(const cuvette_frame *frame, size_t solid,
                                                        cuvette_solid_counters *out, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_frame_statistics(const cuvette_frame *frame, cuvette_statistics *out,
                                                    cuvette_diagnostic *why);

/* --- rays of one's own --- */

typedef struct cuvette_query cuvette_query;

/* Makes the scene, as it is now, ready for rays. instructions as in cuvette_engine_create. */
CUVETTE_API cuvette_status cuvette_query_create(const cuvette_scene *scene, const char *instructions,
                                                cuvette_query **out, cuvette_diagnostic *why);
CUVETTE_API void cuvette_query_destroy(cuvette_query *query);

enum { CUVETTE_OUTSIDE = -1 }; /* where a solid's index stands: none */

/* Where a ray sets out: zero for anywhere, then its medium is looked up at its origin; or a copy of what a hit says,
 * then it starts exactly on that surface and does not meet it again at distance 0. The contents belong to the query
 * that filled them in. */
typedef struct cuvette_start {
    uint64_t word[4];
} cuvette_start;

typedef struct cuvette_ray {
    double origin[3];    /* within 1e6 scene units of 0, 0, 0 */
    double direction[3]; /* any length but 0 */
    double reach;        /* hits are at most so far away, scene units; 0 or infinite: any distance */
    cuvette_start start;
} cuvette_ray;

/* The nearest interface on a ray: where the medium changes. What a higher priority hides is none, nor, under Fresnel's
 * weights, is a surface between equal indices. Solids are numbered as in the scene; CUVETTE_OUTSIDE is what surrounds
 * all. */
typedef struct cuvette_hit {
    double distance; /* from the origin, scene units; infinite: nothing was met, and what follows but before means
                        nothing */
    double point[3];
    double normal[3]; /* unit vector, towards the ray; of a mesh that of its triangle */
    double error;     /* bound on the point's distance from the exact surface, scene units */
    int32_t solid;    /* whose surface it is; CUVETTE_OUTSIDE for a miss */
    int32_t before;   /* the medium that the ray comes from ... */
    int32_t after;    /* ... and the one behind the surface */
    int32_t face; /* of the solid: cylinder 0 side, 1 bottom, 2 top; cup the same, then 8 inner side, 9 floor; box 0 -x,
                   * 1 +x, 2 -y, 3 +y, 4 -z, 5 +z; else 0 */
    int64_t triangle;                     /* of a mesh, else -1 */
    int32_t copy, slot;                   /* of a mesh: which of its copies, and the triangle's material slot; else 0 */
    double u, v;                          /* weights of the triangle's second and third corner; else 0 */
    double n_before, n_after;             /* refractive indices at render.lambda_nm */
    cuvette_start reflected, transmitted; /* for a ray that goes on from the point, on this side or behind it */
} cuvette_hit;

/* The nearest interface of each of count rays, hits[i] for rays[i]. The same bits whatever rays are asked together.
 * CUVETTE_BAD_INPUT names the ray; hits then mean nothing. */
CUVETTE_API cuvette_status cuvette_query_nearest(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                                 cuvette_hit *hits, cuvette_diagnostic *why);

/* blocked[i] is 1 when there is any interface on rays[i], else 0. */
CUVETTE_API cuvette_status cuvette_query_occluded(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                                  unsigned char *blocked, cuvette_diagnostic *why);

/* The camera's ray through a point of the picture, in pixels: 0.5, 0.5 is the middle of the first one. It may lie
 * outside the picture. */
CUVETTE_API cuvette_status cuvette_query_camera_ray(const cuvette_query *query, double x, double y, cuvette_ray *out,
                                                    cuvette_diagnostic *why);

/* The index of the solid that is at a point (three numbers), by the rule of priorities, or CUVETTE_OUTSIDE. */
CUVETTE_API cuvette_status cuvette_query_medium(const cuvette_query *query, const double *point, int32_t *solid,
                                                cuvette_diagnostic *why);

/* --- slimes that move ---
 *
 * A motion takes all slimes of a scene (meshes of `generate` "slime") from their beginning on, a moment at a time: the
 * scene then is what it would be with their `time_s` set to that moment, to the bit, unless hands of the caller's took
 * hold of them. What is rendered or queried is the body as it lies; clones have it so too, a written file says the
 * moment alone.
 *
 * The motion and its scene may be released in any order: the scene keeps the bodies as they lie, a motion without its
 * scene answers CUVETTE_BAD_INPUT. So does, from then on, one whose slime's parameters were set, whose scene lost a
 * mesh or was given another motion, or whose advance failed. All else of the scene may be changed. While it advances,
 * what uses the motion or changes or renders its scene is CUVETTE_BUSY, as is an advance during a render; hands may act
 * meanwhile. */

typedef struct cuvette_motion cuvette_motion;

/* Puts the scene's slimes back to their beginning, whatever their time_s. CUVETTE_BAD_INPUT when it has none. */
CUVETTE_API cuvette_status cuvette_motion_create(cuvette_scene *scene, cuvette_motion **out, cuvette_diagnostic *why);
/* Not while it advances. */
CUVETTE_API void cuvette_motion_destroy(cuvette_motion *motion);

/* On to time_s, 0 to 86400, of each slime to the nearest whole number of its steps; not backwards. CUVETTE_BAD_INPUT
 * also when a slime blows up, or a hand of its script takes hold of nothing. */
CUVETTE_API cuvette_status cuvette_motion_advance(cuvette_motion *motion, double time_s, cuvette_diagnostic *why);

/* How many slimes move, and the names of their meshes; a name lasts until the scene is changed. 0 and NULL for what is
 * not there. */
CUVETTE_API size_t cuvette_motion_count(const cuvette_motion *motion);
CUVETTE_API const char *cuvette_motion_name(const cuvette_motion *motion, size_t index);

/* What became of a slime: of the mesh of that name, or the mesh that the solid of that name shows. Lengths, also in
 * energies (N scene units, where N is kg scene units / s^2), are in the mesh's frame, which solids scale, turn and
 * move. */
typedef struct cuvette_slime {
    size_t size; /* sizeof(cuvette_slime) */
    double time_s;
    uint64_t steps, substeps; /* substeps: more than steps where `adaptive` has split them */
    uint64_t masses, held;    /* held: in hands, the script's too */
    double kinetic, elastic, compression,
        gravity;                   /* energies: of the springs, of the pressure, in the field from y = 0 */
    double center[3], momentum[3]; /* of mass */
    double volume, volume_at_rest;
    double low, high; /* smallest and largest y */
    double speed_max;
} cuvette_slime;
CUVETTE_API cuvette_status cuvette_motion_state(const cuvette_motion *motion, const char *name, cuvette_slime *out,
                                                cuvette_diagnostic *why);

/* Hands. A ray is one of the world (cuvette_query_camera_ray makes one of a pixel); its start says nothing. The name is
 * that of a solid that shows a slime, or of its mesh: then of whichever visible solid with it the ray meets first.
 * Copies are met too; all of a mesh's move alike. What else stands in the way is not looked at. */

/* Where the ray meets the slime's skin from outside, and how far that is from its origin; infinite where it misses,
 * *where then is as it was. where, three numbers, may be NULL. */
CUVETTE_API cuvette_status cuvette_motion_pick(const cuvette_motion *motion, const char *name, const cuvette_ray *ray,
                                               double *where, double *distance, cuvette_diagnostic *why);

enum { CUVETTE_NO_HAND = -1 };

/* Takes hold of what lies within reach (scene units, above 0; where a solid scales unequally, of its largest scale) of
 * where the ray meets the skin, of the nearest mass at least. *hand is the hand's number, from 0, or CUVETTE_NO_HAND
 * where the ray misses. 16 hands at a time can hold a slime, the script's among them. where as above. */
CUVETTE_API cuvette_status cuvette_motion_grab(cuvette_motion *motion, const char *name, const cuvette_ray *ray,
                                               double reach, int *hand, double *where, cuvette_diagnostic *why);
/* During the next advance the hand goes, in a straight line, to where it took hold plus `by`, three numbers in the
 * world as the solid stood then. */
CUVETTE_API cuvette_status cuvette_motion_move(cuvette_motion *motion, int hand, const double *by,
                                               cuvette_diagnostic *why);
/* Lets go; the number may then be another hand's. */
CUVETTE_API cuvette_status cuvette_motion_release(cuvette_motion *motion, int hand, cuvette_diagnostic *why);

#ifdef __cplusplus
}
#endif

#endif
