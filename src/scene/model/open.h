/* Scenes as opaque values: create, read, load, check, destroy. The folders of src/scene, each of which includes only
 * those before it: model (the scene in memory, its parameters and edits), file (scene files and shared scenes), assets
 * (the files that a scene names: meshes, textures, scripts of slimes), motion (slimes in time), package. Ownership:
 * scene_create, scene_read and scene_clone give a scene to the caller, scene_destroy releases it. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct scene scene;

/* An empty scene: all parameters at their defaults, no lights, no solids. NULL if memory runs out. */
scene *scene_create(void);
scene *scene_clone(const scene *original);
void scene_destroy(scene *s);

/* Reads a scene file (YAML; grammar at the top of scene/file/read.c and in cuvette-scene(5)). Images, textures and
 * meshes are not loaded yet. */
status scene_read(const char *path, scene **out, diagnostic *why);
/* The same for a file below root (base/file.h), which becomes the root of its limits. */
status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why);
/* The same from memory; name is used in diagnostics, and paths are relative to its folder. */
status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);
/* The initial scene of an editor: a floor, a light and a camera. */
status new_scene(scene **out, diagnostic *why);

/* Properties for callers that treat scenes as opaque: the file it came from ("" for none); the folder of its limits (""
 * for anywhere); its settings; the names of its solids and lights. Borrowed from the scene. */
const char *scene_path(const scene *s);
const char *scene_root(const scene *s);
const struct render_settings *scene_settings(const scene *s);
const struct camera *scene_camera(const scene *s);
const struct background *scene_background(const scene *s);
size_t scene_solid_count(const scene *s);
const char *scene_solid_name(const scene *s, int index);
const char *scene_light_name(const scene *s, int index);

/* Sets its limits; root is copied. Loaded data stays. */
status scene_limit(scene *s, const char *root, size_t triangles, diagnostic *why);

/* Loads everything that the scene refers to and does not have yet: the background image, textures, and meshes, from
 * files or generators. A diagnostic about a file is located where the scene file refers to it. Values of the background
 * must be from 0 to SCENE_SKY_MAX. STATUS_BAD_INPUT above the limits; of meshes that are too large together, the one
 * that exceeded the limit is discarded. */
status scene_load(scene *s, diagnostic *why);

/* Watches moving slimes: progress is called about every 10 ms, with the completed fraction of all motion. */
typedef struct load_watch {
    void (*progress)(void *context, double fraction);
    void *context;
} load_watch;

/* scene_load with progress. Cancelled, it returns STATUS_INTERRUPTED: completely loaded data is kept, and a later load
 * continues; nothing else of the scene has changed. watch is borrowed; NULL: none. */
status scene_load_until(scene *s, const load_watch *watch, diagnostic *why);

/* As scene_load, but only for files, not for generators. Scripts of slimes are parsed and discarded. */
status scene_load_files(scene *s, diagnostic *why);

/* A path of the scene relative to the working folder; fresh memory, NULL if that runs out. */
char *scene_file_path(const scene *s, const char *path);
/* Passes on an error of a file that the scene refers to as what: located in the scene file at line and column, or, if
 * line is 0, at bad. Returns code. */
status scene_file_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                        diagnostic *why);

/* Checks beyond single ranges: shapes, energy (under constant weights or simple transmission: reflectivity +
 * transparency <= 1), names, limits, camera not at its own target, a background image has a file. Called where a
 * scene is read or changed, so that the error has its place and nothing invalid is loaded, and by the renderer, which
 * also knows the triangles that were loaded since; nowhere between. */
status scene_check(const scene *s, diagnostic *why);

/* Shares the triangles of meshes with equal parameters in another scene, for each mesh of s that is not loaded. Slimes
 * only if s.render.keep is on: otherwise each frame has its own simulation. */
void scene_borrow_meshes(scene *s, const scene *from);
