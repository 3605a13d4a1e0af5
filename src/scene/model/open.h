/* Scenes as opaque values: create, read, load, check, destroy. The folders of src/scene, each of which includes only
 * those before it: model (the scene in memory, its parameters and edits), lens (lens prescriptions, and their solids),
 * file (scene files and shared scenes), assets (the files that a scene names: meshes, textures, scripts of slimes),
 * motion (slimes in time), package (a loaded scene as bytes). Ownership: the caller releases a scene with
 * scene_destroy. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct scene scene;

/* --- defined in model/scene.c --- */

/* An empty scene: all parameters at their defaults, no lights, no solids. NULL if memory runs out. */
scene *scene_create(void);
scene *scene_clone(const scene *original);
void scene_destroy(scene *s);

/* Properties for callers that treat scenes as opaque: the file that was read ("": none); the folder of its limits ("":
 * no restriction); settings; the names of solids and lights. Borrowed from the scene. */
const char *scene_path(const scene *s);
const char *scene_root(const scene *s);
const struct render_settings *scene_settings(const scene *s);
const struct camera *scene_camera(const scene *s);
const struct background *scene_background(const scene *s);
size_t scene_solid_count(const scene *s);
const char *scene_solid_name(const scene *s, int index);
const char *scene_light_name(const scene *s, int index);

/* Limits what the scene loads from now on (load_limits, scene/model/solids.h); data that is already loaded stays. root
 * is copied. */
status scene_limit(scene *s, const char *root, size_t triangles, diagnostic *why);

/* A path of the scene relative to the working folder. Newly allocated; NULL if memory runs out. */
char *scene_file_path(const scene *s, const char *path);
/* Reports the error `bad` of a file to which the scene refers as `what`, at line and column of the scene file; if line
 * is 0, at the position of `bad`. Returns code. */
status scene_file_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                        diagnostic *why);

/* --- defined in model/check.c --- */

/* Checks beyond the range of single values: shapes, energy (under constant weights or simple transmission: reflectivity
 * + transparency <= 1), names, limits, a camera or light at its own target, a background image without a file. Called
 * when a scene is read or changed, so that the error has a position and nothing invalid is loaded, and by the renderer,
 * because triangles were loaded since. */
status scene_check(const scene *s, diagnostic *why);

/* --- defined in file/shared_read.c and file/read.c --- */

/* Reads a scene file (YAML; grammar at the top of file/read.c and in cuvette-scene(5)), or a shared scene
 * (file/shared.h). Images, textures and meshes are not loaded yet. */
status scene_read(const char *path, scene **out, diagnostic *why);
/* Like scene_read, for a file below root (base/file.h), which becomes the root of the scene's limits. */
status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why);
/* Reads the text of a scene file; name is used in diagnostics, and paths are relative to its folder. */
status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);
/* The initial scene of an editor: a floor, a light and a camera. bench: of an optical bench, in centimetres. */
status new_scene(bool bench, scene **out, diagnostic *why);

/* --- defined in assets/load.c --- */

/* Loads everything to which the scene refers and which is not loaded yet: the background image, textures, and meshes,
 * from files or generators. A diagnostic about a file is located where the scene file names it. Values of the
 * background must be from 0 to SCENE_SKY_MAX. STATUS_BAD_INPUT above the limits; the mesh that exceeds the limit is
 * discarded. */
status scene_load(scene *s, diagnostic *why);

/* Watches moving slimes: progress is called about every 10 ms, with the completed fraction of all motion. */
typedef struct load_watch {
    void (*progress)(void *context, double fraction);
    void *context;
} load_watch;

/* scene_load with progress. After a cancellation it returns STATUS_INTERRUPTED: completely loaded data is kept, and a
 * later load continues. watch is borrowed; NULL: none. */
status scene_load_until(scene *s, const load_watch *watch, diagnostic *why);

/* Like scene_load, without generated meshes. Scripts of slimes are parsed and discarded. */
status scene_load_files(scene *s, diagnostic *why);

/* Retains the loaded meshes of another scene for meshes of s with equal parameters that are not loaded; for slimes only
 * if s.render.keep is on, because otherwise each frame simulates anew. */
void scene_retain_meshes(scene *s, const scene *from);
