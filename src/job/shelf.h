/* Meshes of the scenes that were loaded last, so that one which comes again does not make its triangles and
 * hierarchies again. Ownership: a shelf owns copies of scenes, which share their meshes; shelf_clear lets go of them.
 */
#pragma once

#include "scene/model/open.h"

enum { SHELF_SCENES = 64 };
#define SHELF_TRIANGLES \
    16000000u /* of all meshes together; a mesh takes some 200 bytes a triangle with its hierarchies */

typedef struct shelf {
    scene *scenes[SHELF_SCENES];
    size_t count;
} shelf;

/* scene_load_until, with meshes from the shelf where it has them; what had to be made is put there. */
status shelf_load(shelf *s, scene *setting, const load_watch *watch, diagnostic *why);
void shelf_clear(shelf *s);
