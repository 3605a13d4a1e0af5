/* The files that a scene reads, as they are found from the working folder: its own, its sky, its textures, its meshes
 * and the scripts of its slimes. Not those that a mesh's file names in turn. Ownership: everything is borrowed. */
#ifndef CUVETTE_CLI_SCENE_FILES_H
#define CUVETTE_CLI_SCENE_FILES_H

#include "scene/model/open.h"

/* Is one of them what is looked for? Calls is_it with each until it returns true. */
bool scene_files_any(const scene *s, bool (*is_it)(void *context, const char *path), void *context);

#endif
