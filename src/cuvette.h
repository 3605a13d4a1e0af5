/* The public interface of Cuvette: build a scene, set any of its parameters, render it into the caller's memory, trace
 * rays through it, compare its optics with theory, simulate and grab its soft bodies, and run studies. This is the only
 * header that a program outside src/ includes; link with `pkg-config --cflags --libs cuvette`.
 *
 * The main handles are five. A cuvette_scene is a scene description, with the content of a scene file. A cuvette_engine
 * owns worker threads and their memory; it renders scenes, one at a time. A cuvette_frame is the result of a render:
 * film, ray counts, times. A cuvette_query is a snapshot of a scene, prepared for the caller's rays. A cuvette_motion
 * advances the slimes of a scene in time and has hands that grab them. Trees, fans, images and studies are results of
 * these, or read from files. cuvette-scene(5) is the manual of scenes and parameters, cuvette-optics(7) describes the
 * models; `cuvette params` lists every parameter with its range, unit and default.
 *
 * Ownership. The caller owns every handle that a function returns through a pointer; the function of its type that ends
 * in _destroy releases it, and accepts NULL. Arguments are borrowed for the call only: the library keeps no pointer to
 * the caller's memory, and a frame or a query no longer needs its scene or its engine. Handles can be released in any
 * order.
 *
 * Errors. A function that can fail returns a cuvette_status; results are returned through pointers and set only on
 * success (on failure handles are set to NULL). `why`, which may be NULL, then describes the problem and its remedy. A
 * NULL where a handle, a name or a result is required is CUVETTE_BAD_INPUT like any wrong value. The library never
 * prints, never exits, raises no signal, and reads only these environment variables: CUVETTE_ISA
 * (cuvette_engine_create), CUVETTE_IMPORT (the program that reads mesh files), CUVETTE_SANDBOX (cuvette(1)), LD_PRELOAD
 * (to recognise valgrind), and for studies CUVETTE_MACHINE, CUVETTE_NODE_TYPE (cuvette-results(5)), CUVETTE_CALLGRIND
 * and SOURCE_DATE_EPOCH. One library that it uses breaks this rule: jansson, with which the functions of studies parse
 * lists of runs, ends the process if memory runs out. A host that must survive this passes allocation functions with a
 * reserve to json_set_alloc_funcs, as the program cuvette does.
 *
 * Threads. There is no global state: different threads may use different handles at the same time. Any number of
 * functions that take a scene as const may run on it at the same time, including renders by several engines, but not
 * while another function changes it; a change during a render is refused with CUVETTE_BUSY. In this respect a motion is
 * a part of its scene. An engine runs one render at a time (else CUVETTE_BUSY). A frame and a query are immutable: any
 * number of threads may use them. Any thread may call cuvette_engine_cancel and cuvette_query_cancel. Callbacks run on
 * the calling thread, never two at once. In a child of fork, handles that no thread of the parent was using remain
 * usable; an engine starts new threads there.
 *
 * Geometry. Lengths are in scene units (render.unit_m is the length of a scene unit in metres), y is up, angles are in
 * degrees. Pixels are counted from 0, with 0 at the top left; pixel x, y covers the square from x, y to x + 1, y + 1.
 * The world is left-handed: x to the right, y up, z away. Positive degrees turn x to y about z, y to z about x, z to x
 * about y, by the rule of the left hand: counter-clockwise for an eye that looks along the axis, here along z:
 *
 *     y
 *     |          .  x after 20 degrees
 *     |     .
 *     | .
 *     o----------- x
 *
 * The film is a function of the scene only: it is bit-identical for any number of threads, schedule, instruction set or
 * compiler, and with or without tiles, previews and callbacks. Compare films by their hashes.
 *
 * Floating-point environment. Functions that return a cuvette_status compute in C's default environment (round to
 * nearest, no traps, subnormal numbers kept), whatever the caller's rounding mode, traps (feenableexcept), FTZ, DAZ or
 * x87 precision. On return the caller's environment is restored, including raised exceptions; it is also in force
 * during the caller's callbacks, and changes that callbacks make to it persist. */
#ifndef CUVETTE_H
#define CUVETTE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The version of this header; cuvette_version returns the library's. A new patch or minor version keeps everything in
 * this header and may add to it; a new major version may remove things and changes the soname. */
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

/* The version of the running library, such as "0.1.0"; valid for the life of the process. */
CUVETTE_API const char *cuvette_version(void);

/* --- errors --- */

typedef enum cuvette_status {
    CUVETTE_OK = 0,
    CUVETTE_FAILURE = 1,    /* the system failed: memory, disk, threads */
    CUVETTE_BAD_INPUT = 2,  /* a file, a name or a value is invalid */
    CUVETTE_BUSY = 3,       /* a render uses the engine or the scene, or an advance uses the scene */
    CUVETTE_CANCELLED = 130 /* stopped on request; finished work is kept */
} cuvette_status;

/* Why a call failed. Each text is one line of UTF-8 that ends in 0, without a full stop. A text is "" and a number 0
 * where it does not apply. */
typedef struct cuvette_diagnostic {
    char file[512];    /* the file or other input */
    long line, column; /* the position in it, counted from 1 */
    char what[512];    /* the problem */
    char remedy[512];  /* how to correct it */
} cuvette_diagnostic;

enum { CUVETTE_DIAGNOSTIC_TEXT_MAX = 1792 }; /* large enough for the text of any diagnostic */

/* Writes "file:line:column: what; remedy", without absent parts, at most size - 1 characters; returns text. */
CUVETTE_API char *cuvette_diagnostic_text(const cuvette_diagnostic *why, char *text, size_t size);

/* --- scenes --- */

typedef struct cuvette_scene cuvette_scene;

/* Creates an empty scene: every parameter at its default, no lights, no materials, no solids. */
CUVETTE_API cuvette_status cuvette_scene_create(cuvette_scene **out, cuvette_diagnostic *why);
/* Reads a scene file (YAML, at most 256 MiB), or a shared scene: a PNG image that carries it, a page or a link. The
 * files that it names are read at their first use. */
CUVETTE_API cuvette_status cuvette_scene_read(const char *path, cuvette_scene **out, cuvette_diagnostic *why);
/* Reads a scene from size bytes of text; diagnostics call the file `name`, and relative paths start in its folder. */
CUVETTE_API cuvette_status cuvette_scene_read_text(const char *name, const char *text, size_t size, cuvette_scene **out,
                                                   cuvette_diagnostic *why);
/* Creates a copy that is independent of the scene. */
CUVETTE_API cuvette_status cuvette_scene_clone(const cuvette_scene *scene, cuvette_scene **out,
                                               cuvette_diagnostic *why);
/* Must not be called during a render of the scene or an advance of its slimes. */
CUVETTE_API void cuvette_scene_destroy(cuvette_scene *scene);

/* Checks constraints between values, as every render does before it begins: for example shapes, conservation of energy,
 * a camera at its own target. */
CUVETTE_API cuvette_status cuvette_scene_check(const cuvette_scene *scene, cuvette_diagnostic *why);

/* Writes the scene as a scene file, with only the values that differ from the defaults; reading the file gives the same
 * film. The file is written completely or not at all; "-" is standard output. */
CUVETTE_API cuvette_status cuvette_scene_write(const cuvette_scene *scene, const char *path, cuvette_diagnostic *why);
/* Writes the same text into memory, with the arguments of cuvette_scene_get; file paths are relative to the working
 * folder. */
CUVETTE_API cuvette_status cuvette_scene_write_text(const cuvette_scene *scene, char *text, size_t size, size_t *length,
                                                    cuvette_diagnostic *why);
/* Writes the scene as the code of a link, #scene=CODE, which the laboratory opens, with the same arguments. The scene
 * must not name files or contain arrays. */
CUVETTE_API cuvette_status cuvette_scene_write_link(const cuvette_scene *scene, char *text, size_t size, size_t *length,
                                                    cuvette_diagnostic *why);

/* Reads the files that the scene names, and simulates its slimes until their time_s; otherwise the first render, query
 * or measurement does so. progress, which may be NULL, is called about ten times per second, also while files are read
 * and meshes are generated; it receives the finished fraction of the simulation, and returns false to cancel:
 * CUVETTE_CANCELLED. */
CUVETTE_API cuvette_status cuvette_scene_load(const cuvette_scene *scene,
                                              bool (*progress)(void *context, double fraction), void *context,
                                              cuvette_diagnostic *why);

/* Calls note with one line of text, "PLACE: WHAT; REMEDY", for everything that is valid but looks like a mistake: a
 * black solid, no light, a setting without effect. The text is valid during the call. PLACE is a parameter's path or an
 * object's name. */
CUVETTE_API cuvette_status cuvette_scene_hints(const cuvette_scene *scene,
                                               void (*note)(void *context, const char *text), void *context,
                                               cuvette_diagnostic *why);

/* --- parameters, by name ---
 *
 * A path is group.name, as on the command line: "render.depth", "camera.position", "background.color"; for a light, a
 * material or a solid the group is the object's name: "lamp.intensity", "glass.ior", "ball.radius". One element of a
 * vector is "lamp.position.x" (.x .y .z, for colours .r .g .b). Setting a material's parameter changes all solids with
 * that material; setting it by a solid's name changes that solid only. An invalid name, type or value leaves the scene
 * unchanged. */

/* Sets a value from text: "8", "1.5", "on", "sky", "0,2.75,-6". */
CUVETTE_API cuvette_status cuvette_scene_set(cuvette_scene *scene, const char *path, const char *value,
                                             cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_set_double(cuvette_scene *scene, const char *path, double value,
                                                    cuvette_diagnostic *why);
/* Sets an integer or a switch (0, 1), or a real parameter to a whole number; 0 sets render.threads to auto. */
CUVETTE_API cuvette_status cuvette_scene_set_int(cuvette_scene *scene, const char *path, int64_t value,
                                                 cuvette_diagnostic *why);
/* Sets three numbers for a vector or a colour (linear RGB), up to 32 for a list. */
CUVETTE_API cuvette_status cuvette_scene_set_vector(cuvette_scene *scene, const char *path, const double *values,
                                                    size_t count, cuvette_diagnostic *why);

/* Gets a value as text in the form that cuvette_scene_set reads; numbers have the fewest digits that read back the
 * same. *length (may be NULL) is set to the length of the text without the terminating 0, even if text is too small for
 * it, which is CUVETTE_BAD_INPUT; text may be NULL when size is 0. */
CUVETTE_API cuvette_status cuvette_scene_get(const cuvette_scene *scene, const char *path, char *text, size_t size,
                                             size_t *length, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_get_double(const cuvette_scene *scene, const char *path, double *value,
                                                    cuvette_diagnostic *why);
/* Gets an integer, or a switch as 0 or 1; 0 for render.threads = auto. */
CUVETTE_API cuvette_status cuvette_scene_get_int(const cuvette_scene *scene, const char *path, int64_t *value,
                                                 cuvette_diagnostic *why);
/* Writes at most room numbers and sets *count to the number that exists, even if that exceeds room, which is
 * CUVETTE_BAD_INPUT. */
CUVETTE_API cuvette_status cuvette_scene_get_vector(const cuvette_scene *scene, const char *path, double *values,
                                                    size_t room, size_t *count, cuvette_diagnostic *why);

/* A parameter's description; the texts are valid during the call of visit. */
typedef struct cuvette_parameter {
    const char *path;    /* "ball.radius" */
    const char *value;   /* current, in the form of cuvette_scene_get */
    const char *unit;    /* "px", "deg", "scene units"; "" for ratios and words */
    const char *range;   /* "integer 1..65536", "one of: sky, black" */
    const char *initial; /* its default */
    const char *meaning; /* one line */
} cuvette_parameter;

/* Visits every parameter of the scene, in a fixed order, until visit returns false. Setting all visited values on a
 * copy of the scene as it was read reproduces the scene. */
CUVETTE_API cuvette_status cuvette_scene_each_parameter(const cuvette_scene *scene,
                                                        bool (*visit)(void *context, const cuvette_parameter *one),
                                                        void *context, cuvette_diagnostic *why);

/* --- objects ---
 *
 * Lights, materials, solids, meshes, textures and data have names: letters of any script, digits, _ and -, at most
 * 63 bytes of UTF-8, the first a letter or _; names are unique within a scene. A scene holds at most 1024 lights, 256
 * materials, 64 meshes, 64 textures, 64 planes and solids of meshes together, and 2 million other solids. Where solids
 * overlap, the medium is that of the solid with the highest `priority`, or of the one added first if priorities are
 * equal. */

typedef enum cuvette_object {
    CUVETTE_LIGHT,
    CUVETTE_MATERIAL,
    CUVETTE_SOLID,
    CUVETTE_MESH,
    CUVETTE_TEXTURE,
    CUVETTE_DATA
} cuvette_object;

CUVETTE_API cuvette_status cuvette_scene_add_light(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_add_material(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
/* shape: "sphere" or another shape of cuvette-scene(5), which describes the position of each. material: the name of a
 * material; NULL: the solid has its own surface parameters. All other parameters have their defaults; set them by
 * path. */
CUVETTE_API cuvette_status cuvette_scene_add_solid(cuvette_scene *scene, const char *name, const char *shape,
                                                   const char *material, cuvette_diagnostic *why);

/* Adds a mesh that is read or generated at its first use: set NAME.file to an OBJ, PLY, STL or glTF file, or
 * NAME.generate to "icosphere", "torus" and so on. Files have right-handed axes, whose z changes its sign, unless
 * NAME.handedness is "left". To show it, add a solid of the shape "mesh" and set its parameter `mesh` to this name. */
CUVETTE_API cuvette_status cuvette_scene_add_mesh(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);

/* The caller's triangles, which are copied. At most one array of each pair of double and float is set; neither if the
 * mesh has no such data. (b - a) x (c - a) points to the front of a triangle a, b, c; seen from there, the corners run
 * clockwise, because the world is left-handed. Coordinates are finite, at most 1e9. Set size before the call; later
 * versions add fields at the end. */
typedef struct cuvette_triangles {
    size_t size;            /* sizeof(cuvette_triangles) */
    size_t vertex_count;    /* at most 2^29 */
    size_t triangle_count;  /* at most 2^28 */
    const double *vertices; /* x, y, z of each vertex */
    const float *vertices_float;
    const uint32_t *corners; /* three vertex indices of each triangle, from 0 */
    const double *normals;   /* x, y, z of each vertex, any length */
    const float *normals_float;
    const double *uvs; /* u to the right, v upwards, of each vertex; 0, 0 is the texture's lower left corner */
    const float *uvs_float;
    const unsigned char *slots; /* material slot of each triangle; NULL: all 0 */
    /* names of slots 0 to slot_count - 1; may be NULL. If no material is assigned to the mesh's solid, faces are shaded
     * with the scene's material that has their slot's name; the medium inside is always the solid's */
    const char *const *slot_names;
    int slot_count; /* length of slot_names, at most 256 */
} cuvette_triangles;
CUVETTE_API cuvette_status cuvette_scene_add_triangles(cuvette_scene *scene, const char *name,
                                                       const cuvette_triangles *triangles, cuvette_diagnostic *why);

/* Adds a texture: from a PNG, JPEG, BMP, PFM, Radiance HDR or OpenEXR file (set NAME.file), or from the caller's linear
 * RGB floats, which are copied, row by row from the top (repeated, trilinear). A material or a solid uses it by its
 * parameter `texture`. Clones share a texture from an array, but written files do not contain it; setting one of its
 * parameters discards the array. */
CUVETTE_API cuvette_status cuvette_scene_add_texture(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_add_pixels(cuvette_scene *scene, const char *name, int width, int height,
                                                    const float *rgb, cuvette_diagnostic *why);

/* Adds optical data: from a file (set NAME.file), or from the caller's arrays, which are copied: count wavelengths in
 * nm, above 0 and ascending; the values there, which are refractive indices, reflectances, powers, or coefficients in
 * 1/m; and extinction indices of a medium, or NULL. A material uses them by its parameters `medium_data`, `color_data`,
 * `absorb_data` and `scatter_data`, a light by `spectrum_data`. As with textures, clones share the arrays, written
 * files do not contain them, and setting a parameter of the data discards them. */
CUVETTE_API cuvette_status cuvette_scene_add_data(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_scene_add_values(cuvette_scene *scene, const char *name, const double *lambda_nm,
                                                    const double *values, const double *extinction, size_t count,
                                                    cuvette_diagnostic *why);

/* A material can be removed only when no solid uses it. */
CUVETTE_API cuvette_status cuvette_scene_remove(cuvette_scene *scene, const char *name, cuvette_diagnostic *why);

/* Translates a solid, a light or "camera" by three numbers in scene units. The target of the camera, and of a light
 * other than a point, moves too. Names of several objects: "all" is all solids, lights and beams, "solids" and "lights"
 * are only these, and '+' joins such words, as in "all+camera"; an object with such a name has precedence. */
CUVETTE_API cuvette_status cuvette_scene_move(cuvette_scene *scene, const char *name, const double *by,
                                              cuvette_diagnostic *why);
/* Rotates a solid in place, or the direction of "camera" or of a light other than a point, about the world's x axis,
 * then y, then z (three angles), after its present rotation: counter-clockwise for an eye that looks along the axis.
 * Several objects ("all") rotate about the origin, the camera including its roll. */
CUVETTE_API cuvette_status cuvette_scene_turn(cuvette_scene *scene, const char *name, const double *degrees,
                                              cuvette_diagnostic *why);
/* Multiplies all lengths of a solid or a light by a factor above 0, in place; or of several objects ("all+camera"),
 * about the origin. Scaling all solids also scales the lengths of their materials and divides render.unit_m by the
 * factor, so that lengths in metres and absorption by media stay the same. */
CUVETTE_API cuvette_status cuvette_scene_scale(cuvette_scene *scene, const char *name, double factor,
                                               cuvette_diagnostic *why);
/* Aims the camera at a point. */
CUVETTE_API cuvette_status cuvette_scene_look_at(cuvette_scene *scene, const double *target, cuvette_diagnostic *why);
/* Assigns the material to the solid and discards surface parameters set for that solid only; NULL removes the
 * material. */
CUVETTE_API cuvette_status cuvette_scene_give_material(cuvette_scene *scene, const char *solid, const char *material,
                                                       cuvette_diagnostic *why);
/* Renames an object, and updates the references to it. */
CUVETTE_API cuvette_status cuvette_scene_rename(cuvette_scene *scene, const char *name, const char *new_name,
                                                cuvette_diagnostic *why);

/* The number of objects of a kind, and their names in the scene's order; a name is valid until the scene is changed. 0
 * and NULL for an object that does not exist. */
CUVETTE_API size_t cuvette_scene_count(const cuvette_scene *scene, cuvette_object kind);
CUVETTE_API const char *cuvette_scene_name(const cuvette_scene *scene, cuvette_object kind, size_t index);

/* --- rendering --- */

typedef struct cuvette_engine cuvette_engine;
typedef struct cuvette_frame cuvette_frame;

/* instructions: "sse2", "avx2" or "avx512", which the processor must support; NULL: the set that CUVETTE_ISA names,
 * else the best one. Results are bit-identical. The first render starts render.threads threads, which are kept for the
 * next one. */
CUVETTE_API cuvette_status cuvette_engine_create(const char *instructions, cuvette_engine **out,
                                                 cuvette_diagnostic *why);
/* Must not be called during a render. */
CUVETTE_API void cuvette_engine_destroy(cuvette_engine *engine);

/* Stops the current render within about a tenth of a second, also while it loads the scene and builds hierarchies;
 * without a render it has no effect. May be called from any thread and from a signal handler. */
CUVETTE_API void cuvette_engine_cancel(cuvette_engine *engine);

/* A rectangle of the image, x0 <= x < x1, y0 <= y < y1, whose pixels in the caller's buffers are new. */
typedef struct cuvette_tile {
    int x0, y0, x1, y1;
    int coarse; /* 1: the pixels are final; n: one value for each n x n pixels, from a preview */
} cuvette_tile;

/* Options of a render. Begin with CUVETTE_REQUEST, which sets the size and zeros, then set the options you need. Later
 * versions add fields at the end. */
typedef struct cuvette_request {
    size_t size;       /* sizeof(cuvette_request) */
    int width, height; /* size of the buffers, equal to the scene's render.width and render.height; 0 without buffers */
    float *rgb;        /* linear RGB, 1.0 is white, row by row from the top; NULL: none. Not negative for an rgb film */
    size_t rgb_stride; /* floats from one row to the next, at least 3 * width; 0: 3 * width */
    /* the image encoded as sRGB (IEC 61966-2-1), correctly rounded, one byte per channel; NULL: none */
    unsigned char *srgb;
    size_t srgb_stride; /* bytes from one row to the next; 0: 3 * width */
    /* 2..64: render first an image of 1/preview of the width and height, shown with one square per pixel; 0: none.
     * Costs 1/preview^2 of the frame, which the frame's counts and times do not include */
    int preview;
    /* called about ten times per second with the finished fraction of the frame, 0..1, never decreasing: 0 before the
     * first ray and while slimes are simulated, 1 at the end; return false to cancel. May be NULL */
    bool (*progress)(void *context, double fraction);
    /* called about ten times per second with finished tiles of the buffers: one for a preview, then each tile of the
     * image once (render.schedule, render.tile). Without it the buffers are filled at the end. May be NULL */
    void (*tile)(void *context, const cuvette_tile *tile);
    void *context; /* passed to both callbacks */
    /* keep further values of each pixel, which cost memory and time: the named layers of render.integrator aov; the
     * number of its rays; the nanoseconds spent on it; the fraction of its light that was cut */
    bool layers, pixel_rays, pixel_time, pixel_cut;
} cuvette_request;

#ifdef __cplusplus
#define CUVETTE_REQUEST                                                                                  \
    cuvette_request                                                                                      \
    {                                                                                                    \
        sizeof(cuvette_request), 0, 0, NULL, 0, NULL, 0, 0, NULL, NULL, NULL, false, false, false, false \
    }
#else
#define CUVETTE_REQUEST ((cuvette_request){.size = sizeof(cuvette_request)})
#endif

/* Renders the scene with render.threads threads. request and out may be NULL. A cancelled render returns
 * CUVETTE_CANCELLED and still creates the frame, with the film and counts of the rays that were traced (NULL if it was
 * cancelled before the first ray); the buffers then contain the finished part; with the callback `tile`, all other
 * pixels are unchanged. Returns CUVETTE_BAD_INPUT also when the radiance exceeds the film's range (262144 in one
 * contribution, 524288 in a pixel). */
CUVETTE_API cuvette_status cuvette_engine_render(cuvette_engine *engine, const cuvette_scene *scene,
                                                 const cuvette_request *request, cuvette_frame **out,
                                                 cuvette_diagnostic *why);

CUVETTE_API void cuvette_frame_destroy(cuvette_frame *frame);

CUVETTE_API int cuvette_frame_width(const cuvette_frame *frame); /* 0 for NULL */
CUVETTE_API int cuvette_frame_height(const cuvette_frame *frame);
/* A hash of the film's size and every sum in it: equal films have equal hashes. `cuvette render` prints the same
 * hash. */
CUVETTE_API uint64_t cuvette_frame_hash(const cuvette_frame *frame);

/* Copies a rectangle into the caller's memory, in the format of a request's buffers; stride: elements from one row to
 * the next, 0: 3 * (x1 - x0). */
CUVETTE_API cuvette_status cuvette_frame_rgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1, float *rgb,
                                             size_t stride, cuvette_diagnostic *why);
CUVETTE_API cuvette_status cuvette_frame_srgb(const cuvette_frame *frame, int x0, int y0, int x1, int y1,
                                              unsigned char *srgb, size_t stride, cuvette_diagnostic *why);
/* Writes the image in the format of the path's ending: .png (bits: 8 or 16 per channel), .jpg, .pfm, .exr (linear
 * floats); "-" is a PNG on standard output. The file is written completely or not at all. PNG and OpenEXR carry the
 * scene as it was rendered, so that cuvette_scene_read and the program open it, unless the scene names files, is too
 * large (cuvette-scene(5)) or has slimes that hands grabbed. */
CUVETTE_API cuvette_status cuvette_frame_write(const cuvette_frame *frame, const char *path, int bits,
                                               cuvette_diagnostic *why);

/* The values of a named layer, row by row from the top, *channels for each pixel (1 or 3), 0 where rays hit nothing:
 * "normal", "albedo", "depth", "solid", "material", "position". They belong to the frame and are valid until it is
 * destroyed. The request must have had layers set. */
CUVETTE_API cuvette_status cuvette_frame_layer(const cuvette_frame *frame, const char *name, const float **values,
                                               int *channels, cuvette_diagnostic *why);
/* Writes one number for each pixel, width * height in all: "rays", "time" (ns) or "cut", if the request had pixel_rays,
 * pixel_time or pixel_cut set; "noise", the standard error under random paths, root mean square over the channels.
 * "cut" is the fraction of the pixel's light, by weight, in rays that render.depth or render.min_weight cut: the
 * pixel's error is at most that fraction of the brightest light that such a ray could have added. */
CUVETTE_API cuvette_status cuvette_frame_map(const cuvette_frame *frame, const char *name, double *values,
                                             cuvette_diagnostic *why);

/* Ray counts. A ray is a straight segment between two interactions and is counted when it is traced. The totals do not
 * depend on the number of threads. Set size before the call; later versions add fields at the end. */
typedef struct cuvette_counters {
    size_t size;                               /* sizeof(cuvette_counters) */
    uint64_t camera, reflect, refract, shadow; /* rays by kind */
    uint64_t total_internal;                   /* total internal reflections */
    uint64_t cut_depth, cut_weight;            /* rays not traced: beyond render.depth; below render.min_weight */
    double cut_depth_throughput[3];            /* sum of the weights of these rays, linear RGB */
    double cut_weight_throughput[3];
    uint64_t by_depth[65]; /* camera (0), reflected and refracted rays by depth; [64]: 64 and more */
    uint64_t photon;       /* rays of photons (render.caustics) */
} cuvette_counters;

/* Counts of one solid; only the first 64 solids of a scene are counted. */
typedef struct cuvette_solid_counters {
    size_t size;         /* sizeof(cuvette_solid_counters) */
    uint64_t tests;      /* rays tested against it; 0 for a solid in a hierarchy */
    uint64_t hits;       /* hits on its interfaces, without shadow rays and photons */
    uint64_t first_hits; /* camera rays whose first interface is on it */
} cuvette_solid_counters;

/* Times of a render. */
typedef struct cuvette_statistics {
    size_t size;      /* sizeof(cuvette_statistics) */
    double wall_s;    /* from the start of the workers to the end of the last one */
    double cpu_s;     /* CPU time of the process over the same interval */
    double preview_s; /* wall time of the preview; 0 without one */
    int threads;
    double noise_rms; /* standard error of the film's values, root mean square; NaN without random paths */
} cuvette_statistics;

CUVETTE_API cuvette_status cuvette_frame_counters(const cuvette_frame *frame, cuvette_counters *out,
                                                  cuvette_diagnostic *why);
/* solid: its index in the rendered scene. */
CUVETTE_API cuvette_status cuvette_frame_solid_counters(const cuvette_frame *frame, size_t solid,
                                                        cuvette_solid_counters *out, cuvette_diagnostic *why);

CUVETTE_API cuvette_status cuvette_frame_statistics(const cuvette_frame *frame, cuvette_statistics *out,
                                                    cuvette_diagnostic *why);

/* --- ray queries --- */

typedef struct cuvette_query cuvette_query;

/* Prepares a snapshot of the scene for ray queries. instructions as in cuvette_engine_create. */
CUVETTE_API cuvette_status cuvette_query_create(const cuvette_scene *scene, const char *instructions,
                                                cuvette_query **out, cuvette_diagnostic *why);
/* The same at one wavelength in nm, like `cuvette trace --lambda`: it replaces render.lambda_nm, and trees and fans use
 * the media's absorption at this wavelength in all channels. */
CUVETTE_API cuvette_status cuvette_query_wavelength_create(const cuvette_scene *scene, double lambda_nm,
                                                           const char *instructions, cuvette_query **out,
                                                           cuvette_diagnostic *why);
CUVETTE_API void cuvette_query_destroy(cuvette_query *query);

/* Stops every call of the query that is in progress, in all threads, within about a tenth of a second: rays, trees,
 * fans, beams, and the writing of trees and fans, whose files then do not appear. Each returns CUVETTE_CANCELLED and no
 * result; the arrays of hits and of blocked rays are undefined then. Later calls run as usual; without calls in
 * progress it has no effect. May be called from any thread and from a signal handler, before cuvette_query_destroy. */
CUVETTE_API void cuvette_query_cancel(cuvette_query *query);

enum { CUVETTE_OUTSIDE = -1 }; /* in place of a solid's index: no solid */

/* The start of a ray. Zero: a free point, whose medium is looked up. A copy of a hit's start: the ray starts exactly on
 * that surface and does not hit it again at distance 0. It is valid only for the query that returned the hit. */
typedef struct cuvette_start {
    uint64_t word[4];
} cuvette_start;

typedef struct cuvette_ray {
    double origin[3];    /* within 1e6 scene units of 0, 0, 0 */
    double direction[3]; /* any length but 0 */
    double reach;        /* largest distance of a hit, scene units; 0 or infinite: no limit */
    cuvette_start start;
} cuvette_ray;

/* The nearest interface on a ray: the surface where the medium changes. A surface inside a solid of higher priority is
 * no interface; nor, under Fresnel weights, is one between equal refractive indices. Solids have their index in the
 * scene; CUVETTE_OUTSIDE is the surrounding medium. */
typedef struct cuvette_hit {
    /* from the origin, scene units; infinite: no hit, and the fields below are undefined, except before */
    double distance;
    double point[3];
    double normal[3]; /* unit vector, towards the ray; on a mesh, of its triangle */
    double error;     /* bound on the point's distance from the exact surface, scene units */
    int32_t solid;    /* the solid that was hit; CUVETTE_OUTSIDE for a miss */
    int32_t before;   /* the medium on the ray's side ... */
    int32_t after;    /* ... and the one behind the surface */
    /* part of the solid's surface: cylinder 0 side, 1 bottom, 2 top; cup the same, then 8 inner side, 9 floor; box 0
     * -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z; lens 0 rim, 1 and 2 its sides; else 0 */
    int32_t face;
    int64_t triangle;                     /* index of the mesh's triangle; else -1 */
    int32_t copy, slot;                   /* the mesh's instance, and the triangle's material slot; else 0 */
    double u, v;                          /* weights of the triangle's second and third corner; else 0 */
    double n_before, n_after;             /* refractive indices at render.lambda_nm */
    cuvette_start reflected, transmitted; /* starts of rays from the point, on this side or behind it */
} cuvette_hit;

/* Finds the nearest interface of each of count rays, hits[i] for rays[i]. A result does not depend on the other rays of
 * the call. CUVETTE_BAD_INPUT names the invalid ray; hits are then undefined. */
CUVETTE_API cuvette_status cuvette_query_nearest(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                                 cuvette_hit *hits, cuvette_diagnostic *why);

/* Sets blocked[i] to 1 if there is any interface on rays[i], else to 0. A surface with alpha is an interface where its
 * alpha is at least 1/2, with `mask` at least its cutoff; so it is for cuvette_query_nearest. */
CUVETTE_API cuvette_status cuvette_query_occluded(const cuvette_query *query, const cuvette_ray *rays, size_t count,
                                                  unsigned char *blocked, cuvette_diagnostic *why);

/* The camera ray through a point of the image, in pixels: 0.5, 0.5 is the centre of the first pixel. The point may be
 * outside the image. */
CUVETTE_API cuvette_status cuvette_query_camera_ray(const cuvette_query *query, double x, double y, cuvette_ray *out,
                                                    cuvette_diagnostic *why);

/* The index of the solid that contains a point (three numbers), by the rule of priorities, or CUVETTE_OUTSIDE. */
CUVETTE_API cuvette_status cuvette_query_medium(const cuvette_query *query, const double *point, int32_t *solid,
                                                cuvette_diagnostic *why);

/* --- ray trees and fans ---
 *
 * A tree is one ray with all rays that follow from it, as the renderer traces them: the radiance of a pixel's tree is
 * the film's value, bit for bit (for a scene with random paths, a spectral film or a depth buffer, the tree is traced
 * with render.integrator whitted at render.lambda_nm). A fan is many rays in one plane, each followed along its
 * refracted path, with their caustic and focus. Both are immutable; arrays and texts that are read from them are valid
 * until they are destroyed, and they no longer need their query. Calls on one query run one after another. */

typedef struct cuvette_tree cuvette_tree;
typedef struct cuvette_fan cuvette_fan;

typedef enum cuvette_ray_kind {
    CUVETTE_RAY_CAMERA,
    CUVETTE_RAY_REFLECT,
    CUVETTE_RAY_REFRACT,
    CUVETTE_RAY_SHADOW
} cuvette_ray_kind;

/* How a ray ends: at an interface; in the background; not traced because of render.depth or render.min_weight; for a
 * shadow ray, whether (part of) its light arrives. */
typedef enum cuvette_ray_end {
    CUVETTE_END_HIT,
    CUVETTE_END_SKY,
    CUVETTE_END_CUT_DEPTH,
    CUVETTE_END_CUT_WEIGHT,
    CUVETTE_END_LIT,
    CUVETTE_END_BLOCKED
} cuvette_ray_end;

/* One ray of a tree. Fields from distance on describe its hit; they are 0 unless it ends with one. */
typedef struct cuvette_node {
    int32_t kind, end; /* cuvette_ray_kind, cuvette_ray_end */
    int32_t depth;     /* 0: the first ray; a shadow ray has the depth of the ray at whose hit it starts */
    int32_t parent, first_child, next;  /* indices in the tree, or -1; next: the parent's next child */
    double origin[3], direction[3];     /* unit vector; a shadow ray's is towards the light */
    double weight[3];                   /* RGB, at its start; for a shadow ray the radiance that it adds if unblocked */
    double stokes[4];                   /* under render.polarisation: the analyser's Stokes vector; else 1, 0, 0, 0 */
    double added[3];                    /* radiance that this ray itself adds to the film, without its children */
    double n;                           /* refractive index of the medium in which it starts */
    const char *medium_name;            /* "water", or the solid's name */
    int32_t medium;                     /* the solid's index, or CUVETTE_OUTSIDE */
    int32_t light;                      /* index of a shadow ray's light; else -1 */
    double light_distance;              /* distance of a shadow ray's light, scene units; else 0 */
    double light_transmittance;         /* transmittance of the surfaces on a shadow ray's path; else 1 */
    double distance;                    /* scene units */
    double point[3], normal[3];         /* normal: unit vector, towards the ray */
    double error;                       /* bound on the point's distance from the exact surface, scene units */
    int32_t solid, before, after;       /* the solid that was hit, the media on the ray's side and behind */
    int32_t opaque, total_internal;     /* 0 or 1: no ray continues behind it; total internal reflection */
    const char *solid_name, *face_name; /* "vessel", "outer side"; NULL without a hit */
    double n_before, n_after;
    double cos_in, cos_out;  /* cosines of the angles of incidence and refraction; cos_out is 0 if there is none */
    double R_s, R_p, R;      /* power reflectances, with reflectivity */
    double T;                /* power transmittance of the surface, with reflectivity and transparency */
    double gain_classic;     /* factor of the radiance from behind: T, for either value of render.radiance ... */
    double gain_basic;       /* ... and T (n_before / n_after)^2 */
    double length_m;         /* length of the ray, metres */
    double transmittance[3]; /* of the medium over length_m (Beer and Lambert), RGB */
    double angle_in_deg, angle_out_deg; /* of incidence and refraction; angle_out_deg is 0 if there is none */
} cuvette_node;

/* Traces the ray and all rays that follow from it; ignores its reach and start. */
CUVETTE_API cuvette_status cuvette_query_trace(const cuvette_query *query, const cuvette_ray *ray, cuvette_tree **out,
                                               cuvette_diagnostic *why);
/* Traces the camera rays of a pixel; with several samples the tree has as many first rays, linked by next. */
CUVETTE_API cuvette_status cuvette_query_trace_pixel(const cuvette_query *query, int x, int y, cuvette_tree **out,
                                                     cuvette_diagnostic *why);
CUVETTE_API void cuvette_tree_destroy(cuvette_tree *tree);

/* The rays, the first one first; sets *count. NULL for no tree. */
CUVETTE_API const cuvette_node *cuvette_tree_nodes(const cuvette_tree *tree, size_t *count);
/* Writes the radiance that the tree adds to its pixel, three numbers. */
CUVETTE_API cuvette_status cuvette_tree_radiance(const cuvette_tree *tree, double *rgb, cuvette_diagnostic *why);
/* Writes what `cuvette trace` writes, in the format of the path's ending: .txt, .json, .csv, .svg. */
CUVETTE_API cuvette_status cuvette_tree_write(const cuvette_tree *tree, const char *path, cuvette_diagnostic *why);

/* A ray of one of the scene's beams; beam_name is valid until its tree is destroyed. */
typedef struct cuvette_beam_ray {
    const char *beam_name;
    int32_t beam;         /* index of the beam in the scene */
    int32_t number, rays; /* the ray's number in its beam, from 0, and how many there are at each wavelength */
    double lambda_nm;
    double power;  /* at its start: the beam's power divided by its rays, wavelengths and field points */
    int32_t field; /* number of its field point, from 0 */
} cuvette_beam_ray;

/* Traces the rays of the scene's visible beams as `cuvette trace --beams` does: without shadow rays, each with the
 * depth and the wavelengths of its beam. visit owns the tree, and returns false to stop. CUVETTE_BAD_INPUT for a
 * tree of more than two million rays. */
CUVETTE_API cuvette_status cuvette_query_each_beam_ray(const cuvette_query *query,
                                                       bool (*visit)(void *context, const cuvette_beam_ray *ray,
                                                                     cuvette_tree *tree),
                                                       void *context, cuvette_diagnostic *why);

/* The rays of a fan. Zero-initialise it and set size; later versions add fields at the end. */
typedef struct cuvette_fan_rule {
    size_t size;           /* sizeof(cuvette_fan_rule) */
    double from[3], to[3]; /* the axis; the rays start around `from` */
    double normal[3];      /* normal of the rays' plane; 0, 0, 0: up for a horizontal axis, else horizontal */
    int rays;              /* 1..100000 */
    double width;          /* width of a parallel beam, scene units */
    double
        spread_deg; /* above 0: not parallel, but from one point, with this angle between the first and the last ray */
} cuvette_fan_rule;

typedef struct cuvette_fan_ray {
    double offset;        /* distance from the axis, scene units; degrees if the fan spreads */
    size_t first, count;  /* its nodes */
    int32_t leaves;       /* 1: it was followed to its end, in the background or at an opaque surface */
    int32_t crosses_axis; /* 1: its last segment crosses the axis, seen along the plane's normal */
    const char *end_name; /* "sky", "cut", or the opaque solid that it hit */
    double exit_point[3], exit_direction[3]; /* start and direction of the last segment */
    double reach;                            /* length of the last segment; infinite into the background */
    double deviation_deg;                    /* between the first direction and the last */
    double weight;                           /* weight of the last segment, mean of RGB */
    double axis_at;                          /* distance of the crossing from `from`, along the axis */
    double axis_point[3];
} cuvette_fan_ray;

/* The crossing of the last segments of rays number ray and ray + 1. All crossings form the caustic. */
typedef struct cuvette_crossing {
    int64_t ray;
    double at[3];
} cuvette_crossing;

/* The point nearest to all deflected rays. */
typedef struct cuvette_focus {
    size_t size;        /* sizeof(cuvette_focus) */
    int32_t exists;     /* 0: the deflected rays are parallel, or fewer than two */
    int32_t is_virtual; /* 1: the focus is behind the rays */
    double point[3];
    double rms; /* root mean square of the distances of the rays from the focus, scene units */
} cuvette_focus;

CUVETTE_API cuvette_status cuvette_query_fan(const cuvette_query *query, const cuvette_fan_rule *rule,
                                             cuvette_fan **out, cuvette_diagnostic *why);
CUVETTE_API void cuvette_fan_destroy(cuvette_fan *fan);
CUVETTE_API const cuvette_fan_ray *cuvette_fan_rays(const cuvette_fan *fan, size_t *count);
CUVETTE_API const cuvette_node *cuvette_fan_nodes(const cuvette_fan *fan, size_t *count);
CUVETTE_API const cuvette_crossing *cuvette_fan_crossings(const cuvette_fan *fan, size_t *count);
CUVETTE_API cuvette_status cuvette_fan_focus(const cuvette_fan *fan, cuvette_focus *out, cuvette_diagnostic *why);
/* Writes what `cuvette fan` writes: .svg, a drawing, or .csv, one row per ray. */
CUVETTE_API cuvette_status cuvette_fan_write(const cuvette_fan *fan, const char *path, cuvette_diagnostic *why);

/* --- sections ---
 *
 * A plane cut through the scene: what is in it, by the rule of priorities. */

typedef enum cuvette_section_view { CUVETTE_FRONT, CUVETTE_TOP, CUVETTE_SIDE } cuvette_section_view;

/* Zero-initialise it and set size; later versions add fields at the end. */
typedef struct cuvette_section_rule {
    size_t size;         /* sizeof(cuvette_section_rule) */
    int32_t view;        /* cuvette_section_view: x to the right and y up; x and z; z and y */
    int32_t cells;       /* of the grid along the longer side, 2..4096; 0: 400 */
    const char *through; /* the plane contains the axis of this solid; NULL: view */
    const double *at;    /* a point of the plane, three numbers; NULL: the first beam's start */
    double extent[4];    /* u0, u1, v0, v1, scene units; all 0: the solids that the plane cuts, and the beams */
} cuvette_section_rule;

/* Writes what `cuvette section` writes: .svg, a drawing with the beams' rays, or .json, the outlines of the solids. */
CUVETTE_API cuvette_status cuvette_query_write_section(const cuvette_query *query, const cuvette_section_rule *rule,
                                                       const char *path, cuvette_diagnostic *why);

/* --- optics against theory --- */

/* A quantity measured with traced rays, and a textbook's closed form. The texts are valid during the call of visit. */
typedef struct cuvette_metric {
    const char *name;    /* "lens.power" */
    const char *meaning; /* one line; for an undefined metric, why this scene has none */
    const char *unit;    /* "" for ratios */
    const char *verdict; /* "pass", "FAIL", or "none": undefined, and the numbers are NaN */
    double measured, theory, error, tolerance;
} cuvette_metric;

/* Visits the metrics of `cuvette realism`, until visit returns false. CUVETTE_BAD_INPUT describes the solids that they
 * need and the scene lacks. */
CUVETTE_API cuvette_status cuvette_scene_each_metric(const cuvette_scene *scene,
                                                     bool (*visit)(void *context, const cuvette_metric *one),
                                                     void *context, cuvette_diagnostic *why);

/* A curve, such as "fresnel" by angle; x and y are labels with units. */
typedef struct cuvette_curve {
    const char *name, *x, *y;
} cuvette_curve;
/* Visits the curves that the scene has. */
CUVETTE_API cuvette_status cuvette_scene_each_curve(const cuvette_scene *scene,
                                                    bool (*visit)(void *context, const cuvette_curve *one),
                                                    void *context, cuvette_diagnostic *why);
/* Measures a curve: x, measured, theory of each point. Writes at most room points (1024 is enough for any curve), and
 * sets *count to their number, even if that exceeds room, which is CUVETTE_BAD_INPUT. */
CUVETTE_API cuvette_status cuvette_scene_curve(const cuvette_scene *scene, const char *name, double (*points)[3],
                                               size_t room, size_t *count, cuvette_diagnostic *why);

/* --- the report of a lens --- */

/* A number of `cuvette lens report`: cuvette-lens-report(1) has the sections and quantities. Lengths are mm. The texts
 * are constants. */
typedef struct cuvette_lens_number {
    const char *section;  /* "first-order" */
    const char *quantity; /* "efl" */
    const char *unit;     /* "mm"; "" for ratios */
    int surface, field;   /* from 1; 0: the number has none */
    double lambda_nm;     /* 0: all wavelengths */
    double x;             /* the abscissa; NaN: none */
    double value;         /* NaN where no ray arrives */
} cuvette_lens_number;

/* Visits the numbers of the report on the scene's lens, until visit returns false. system: the word with which the
 * names of its solids begin; NULL: all lenses of the scene. CUVETTE_BAD_INPUT if they are not one lens that has a
 * focus. Not in the browser. */
CUVETTE_API cuvette_status cuvette_scene_each_lens_number(const cuvette_scene *scene, const char *system,
                                                          bool (*visit)(void *context, const cuvette_lens_number *one),
                                                          void *context, cuvette_diagnostic *why);

/* --- images and their differences --- */

typedef struct cuvette_image cuvette_image;

/* Reads a PNG, JPEG, BMP, PFM, Radiance HDR or OpenEXR file. */
CUVETTE_API cuvette_status cuvette_image_read(const char *path, cuvette_image **out, cuvette_diagnostic *why);
CUVETTE_API void cuvette_image_destroy(cuvette_image *image);
/* Linear RGB, row by row from the top, valid until the image is destroyed; sets width and height. NULL for no image. */
CUVETTE_API const float *cuvette_image_rgb(const cuvette_image *image, int *width, int *height);

/* The difference of two images as a display shows them: clamped to 0..1 and sRGB-encoded. */
typedef struct cuvette_comparison {
    size_t size;               /* sizeof(cuvette_comparison) */
    double mse;                /* mean squared difference of the encoded channels */
    double psnr_db;            /* 10 log10(1 / mse), infinite if mse is 0 */
    double ssim;               /* mean structural similarity of the luma, 1 for equal images */
    double flip;               /* mean FLIP error at 67 pixels per degree, 0 for equal images */
    double largest;            /* largest difference of an encoded channel */
    double differing_fraction; /* fraction of the pixels whose 8-bit encodings differ */
    int largest_x, largest_y;
} cuvette_comparison;

/* Compares two images of linear RGB values, 3 * width * height each. map, of the same size, becomes the FLIP error of
 * each pixel in false colour; NULL: none. */
CUVETTE_API cuvette_status cuvette_compare(int width, int height, const float *a, const float *b, float *map,
                                           cuvette_comparison *out, cuvette_diagnostic *why);

/* --- slimes in motion ---
 *
 * A motion advances all slimes of a scene (meshes of `generate` "slime") in time from their initial state: the scene is
 * then bit-identical to one whose `time_s` is set to that time, unless the caller's hands grabbed the slimes. Renders
 * and queries use the current shapes of the bodies; so do clones, but a written file records only the time.
 *
 * The motion and its scene may be released in any order: the scene keeps the current shapes, and functions of a motion
 * without its scene return CUVETTE_BAD_INPUT. They also do after a slime's parameters were set, a mesh was removed,
 * another motion was created, or an advance failed. Everything else in the scene may be changed. During an advance,
 * calls that use the motion or that change or render its scene return CUVETTE_BUSY, as does an advance during a render.
 * */

typedef struct cuvette_motion cuvette_motion;

/* Resets the scene's slimes to their initial state, whatever their time_s. CUVETTE_BAD_INPUT when the scene has
 * none. */
CUVETTE_API cuvette_status cuvette_motion_create(cuvette_scene *scene, cuvette_motion **out, cuvette_diagnostic *why);
/* Must not be called during an advance. */
CUVETTE_API void cuvette_motion_destroy(cuvette_motion *motion);

/* Advances to time_s, 0 to 86400, rounded for each slime to the nearest whole number of its steps; not backwards.
 * CUVETTE_BAD_INPUT also when a slime becomes unstable, or a hand of its script grabs nothing. */
CUVETTE_API cuvette_status cuvette_motion_advance(cuvette_motion *motion, double time_s, cuvette_diagnostic *why);
/* The same with a progress function like that of cuvette_scene_load. After CUVETTE_CANCELLED the scene still has the
 * shapes of the previous time; a later advance continues, to a time not before the one that the bodies have reached
 * (cuvette_motion_state). */
CUVETTE_API cuvette_status cuvette_motion_advance_watched(cuvette_motion *motion, double time_s,
                                                          bool (*progress)(void *context, double fraction),
                                                          void *context, cuvette_diagnostic *why);

/* The number of slimes, and the names of their meshes; a name is valid until the scene is changed. 0 and NULL for a
 * slime that does not exist. */
CUVETTE_API size_t cuvette_motion_count(const cuvette_motion *motion);
CUVETTE_API const char *cuvette_motion_name(const cuvette_motion *motion, size_t index);

/* The state of a slime, named by its mesh or by a solid that shows the mesh. Lengths are in scene units of
 * the mesh's frame, before a solid's scale, rotation and translation; energies are in kg (scene unit)^2 / s^2. */
typedef struct cuvette_slime {
    size_t size; /* sizeof(cuvette_slime) */
    double time_s;
    uint64_t steps, substeps;                      /* more substeps than steps if `adaptive` split some */
    uint64_t masses, held;                         /* held: masses in hands, including the script's */
    double kinetic, elastic, compression, gravity; /* energies: motion, springs, pressure, height above y = 0 */
    double center[3], momentum[3];                 /* centre of mass, momentum */
    double volume, volume_at_rest;
    double low, high; /* smallest and largest y */
    double speed_max;
} cuvette_slime;
CUVETTE_API cuvette_status cuvette_motion_state(const cuvette_motion *motion, const char *name, cuvette_slime *out,
                                                cuvette_diagnostic *why);

/* Hands. Rays are in world space (cuvette_query_camera_ray makes one for a pixel); their start is ignored. name is a
 * solid that shows a slime, or the slime's mesh; the mesh stands for its first visible solid on the ray. Rays also hit
 * instances; all instances of a mesh move alike. Other objects do not block the ray. */

/* Finds where the ray hits the slime's surface from outside, and the distance from its origin; on a miss the distance
 * is infinite and *where is unchanged. where, three numbers, may be NULL. */
CUVETTE_API cuvette_status cuvette_motion_pick(const cuvette_motion *motion, const char *name, const cuvette_ray *ray,
                                               double *where, double *distance, cuvette_diagnostic *why);

enum { CUVETTE_NO_HAND = -1 };

/* Grabs the masses within reach (scene units, above 0; for a solid with unequal scale, relative to its largest scale)
 * of the point where the ray hits the surface, at least the nearest mass. *hand is set to the hand's number, from 0, or
 * to CUVETTE_NO_HAND on a miss. At most 16 hands, including the script's, can hold a slime at a time. where: as in
 * cuvette_motion_pick. */
CUVETTE_API cuvette_status cuvette_motion_grab(cuvette_motion *motion, const char *name, const cuvette_ray *ray,
                                               double reach, int *hand, double *where, cuvette_diagnostic *why);
/* Moves the hand during the next advance, in a straight line, to the point where it grabbed plus `by`, three numbers in
 * world space, with the solid's placement at the time of the grab. */
CUVETTE_API cuvette_status cuvette_motion_move(cuvette_motion *motion, int hand, const double *by,
                                               cuvette_diagnostic *why);
/* Releases the hand; its number may then be used for another hand. */
CUVETTE_API cuvette_status cuvette_motion_release(cuvette_motion *motion, int hand, cuvette_diagnostic *why);

/* --- studies ---
 *
 * A study varies parameters of a scene and measures each combination, a cell, several times: one row per repetition in
 * RESULTS/NAME/rows.csv, never changed afterwards. cuvette-study(5) describes the file, cuvette-results(5) the rows.
 * Rows of unlike environments (machine, limits, build) are never pooled. A study is immutable. Functions that take
 * `results`, a folder, use "results" for NULL. Texts returned through char ** are the caller's: release them with
 * cuvette_text_destroy. */

typedef struct cuvette_study cuvette_study;

CUVETTE_API void cuvette_text_destroy(char *text);

/* Reads a study file and its scene. */
CUVETTE_API cuvette_status cuvette_study_read(const char *path, cuvette_study **out, cuvette_diagnostic *why);
CUVETTE_API void cuvette_study_destroy(cuvette_study *study);
/* Valid until the study is destroyed; NULL for no study. title may be "". */
CUVETTE_API const char *cuvette_study_name(const cuvette_study *study);
CUVETTE_API const char *cuvette_study_title(const cuvette_study *study);
CUVETTE_API size_t cuvette_study_cells(const cuvette_study *study);
/* The scene of a cell, counted from 0. */
CUVETTE_API cuvette_status cuvette_study_scene(const cuvette_study *study, size_t cell, cuvette_scene **out,
                                               cuvette_diagnostic *why);
/* Visits the parameters of the grid with the values of a cell, until visit returns false. */
CUVETTE_API cuvette_status cuvette_study_each_value(const cuvette_study *study, size_t cell,
                                                    bool (*visit)(void *context, const char *path, const char *value),
                                                    void *context, cuvette_diagnostic *why);

/* The rows on disk, of the present environment unless stated otherwise. */
typedef struct cuvette_study_progress {
    size_t size; /* sizeof(cuvette_study_progress) */
    size_t cells, cells_done;
    size_t rows, warmups, marked, disturbed; /* marked: another film than expected; disturbed: by the study's rule */
    size_t rows_elsewhere;                   /* rows of other environments */
    size_t rows_other_cells;                 /* rows of cells that the study does not have, or no longer has */
    size_t faults;                           /* rows that fail a check or are missing, and marked ones */
    char environment[16];                    /* key of the present environment, 8 hex digits */
    char fault[512];                         /* the first fault, "" for none */
} cuvette_study_progress;
CUVETTE_API cuvette_status cuvette_study_state(const cuvette_study *study, const char *results,
                                               cuvette_study_progress *out, cuvette_diagnostic *why);

/* Options of a run. Zero-initialise it and set size; later versions add fields at the end. */
typedef struct cuvette_run {
    size_t size;          /* sizeof(cuvette_run) */
    const char *results;  /* folder */
    bool any_environment; /* count rows of other environments too */
    double wait_quiet_s;  /* before each repetition, wait at most this long until other programs are quiet; 0: never */
    /* for a study with `processes` in its file: the number of this process, from 1, which measures only its part. Each
     * number needs its own program, as `cuvette study run` starts them. 0: measures all repetitions */
    long process;
    /* called about ten times per second with the finished fraction of the frames, 0..1, and the seconds that are left
     * (NaN: unknown); return false to stop. May be NULL */
    bool (*progress)(void *context, double fraction, double left_s);
    void (*news)(void *context, const char *text); /* what disturbs the measurement. May be NULL */
    void *context;
} cuvette_run;

/* Measures the missing rows and writes the kept files; sets *rows, which may be NULL, to the number of new rows.
 * CUVETTE_CANCELLED after a stop: rows so far are kept, and the next run resumes. */
CUVETTE_API cuvette_status cuvette_study_run(const cuvette_study *study, const cuvette_run *run, size_t *rows,
                                             cuvette_diagnostic *why);
/* The number of processes that divide the repetitions; 1: the repetitions are not divided. */
CUVETTE_API long cuvette_study_processes(const cuvette_study *study);

/* Returns the rows as CSV with two more columns: environment, the key of the row's environment, and left_out, why the
 * summary omits the row (warm-up, marked, excluded; else empty). Damaged rows and rows of cells that the study does not
 * have are omitted. study may be NULL: results is then the folder of the rows, RESULTS/NAME, and no cell is omitted.
 * environment: a key; "main": the one with most rows; "all"; NULL: the only one; if there are several,
 * CUVETTE_BAD_INPUT names them. *fault as in cuvette_study_summary. */
CUVETTE_API cuvette_status cuvette_study_rows(const cuvette_study *study, const char *results, const char *environment,
                                              char **out, char **fault, cuvette_diagnostic *why);

/* The summary of `cuvette study summary`, as a table with tabs: medians and 95 % intervals, a line for each cell and
 * environment. environment: a key; "main": the one with most rows; NULL: all. *fault, which may be NULL, is set to the
 * first fault of the rows, or NULL. */
CUVETTE_API cuvette_status cuvette_study_summary(const cuvette_study *study, const char *results,
                                                 const char *environment, char **out, char **fault,
                                                 cuvette_diagnostic *why);
/* The comparison of `cuvette study compare --json`, as JSON: the ratio b / a of a column (NULL: wall_s), its
 * interval and a verdict for each cell. A side is a results folder, PATH=VALUE, cell=N, environment=KEY or run=ID. */
CUVETTE_API cuvette_status cuvette_study_compare(const cuvette_study *study, const char *results, const char *a,
                                                 const char *b, const char *column, char **out, char **fault,
                                                 cuvette_diagnostic *why);

/* Options of a figure, like those of `cuvette study plot`; an option that is zero is chosen from the grid. Set size;
 * later versions add fields at the end. */
typedef struct cuvette_plot {
    size_t size; /* sizeof(cuvette_plot) */
    const char *results, *x, *y, *by;
    const char *const *where; /* where_count texts, PATH=VALUE */
    size_t where_count;
    const char *log;       /* "x", "y", "xy" or "none" */
    const char *published; /* a CSV file */
    bool images;           /* draw the sheet of kept images instead */
} cuvette_plot;
/* Draws a figure with gnuplot: its script BASE.gp, its data BASE.tsv, and BASE.format (png, svg or pdf). */
CUVETTE_API cuvette_status cuvette_study_plot(const cuvette_study *study, const cuvette_plot *plot, const char *base,
                                              const char *format, cuvette_diagnostic *why);

/* A column of rows.csv; a name with <axis> or <solid> stands for a column per axis or solid. */
typedef struct cuvette_column {
    const char *name, *unit, *meaning;
} cuvette_column;
/* Visits all columns until visit returns false. */
CUVETTE_API cuvette_status cuvette_each_column(bool (*visit)(void *context, const cuvette_column *one), void *context,
                                               cuvette_diagnostic *why);

#ifdef __cplusplus
}
#endif

#endif
