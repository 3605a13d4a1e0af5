/* The mesh cache: meshes of recently loaded scenes, so that a scene that is loaded again need not rebuild its triangles
 * and hierarchies. Ownership: the cache owns copies of scenes, which share their meshes; shelf_clear releases them. */
#pragma once

#include "scene/model/open.h"

enum { SHELF_SCENES = 64 };
#define SHELF_TRIANGLES 16000000u /* over all meshes; a mesh takes about 200 bytes per triangle with its hierarchies */

typedef struct shelf {
    scene *scenes[SHELF_SCENES];
    size_t count;
} shelf;

/* scene_load_until that uses the meshes of the cache and adds newly built ones to it. */
status shelf_load(shelf *s, scene *setting, const load_watch *watch, diagnostic *why);
void shelf_clear(shelf *s);
