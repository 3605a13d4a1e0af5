/* Scenes as wholes, for those who do not look inside: made, read, loaded, checked, destroyed. Ownership: scene_create,
 * scene_read and scene_clone give a scene to the caller, scene_destroy releases it. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct scene scene;

/* An empty scene: every parameter at its default, no lights, no solids. NULL when memory is out. */
scene *scene_create(void);
scene *scene_clone(const scene *original);
void scene_destroy(scene *s);

/* Reads a scene file (YAML; grammar in scene/file/read.c's head and cuvette-scene(5)). Pictures, textures and meshes
 * are not loaded yet. */
status scene_read(const char *path, scene **out, diagnostic *why);
/* The same of a file that lies below root (base/below.h), which is the root of its limits, too. */
status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why);
/* The same from memory; name stands for the file in diagnostics, and its folder is where relative paths start. */
status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);

/* What those who do not look inside ask most: the file it came from ("" for none); the folder that all it reads must
 * lie in ("" for anywhere); its settings; and the names of its solids and lights. Borrowed from the scene. */
const char *scene_path(const scene *s);
const char *scene_root(const scene *s);
const struct render_settings *scene_settings(const scene *s);
const struct camera *scene_camera(const scene *s);
const struct background *scene_background(const scene *s);
size_t scene_solid_count(const scene *s);
const char *scene_solid_name(const scene *s, int index);
const char *scene_light_name(const scene *s, int index);

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

/* Gives each mesh of s that is not loaded the triangles of a mesh with the same parameters in another scene, where
 * there is one. Slimes only where s.render.keep is on: each frame is to have its own simulation else. */
void scene_borrow_meshes(scene *s, const scene *from);
