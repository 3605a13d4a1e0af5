/* The scene to begin with: a room with a floor, a light and a camera, and nothing in it. Ownership: the scene is the
 * caller's. */
#ifndef CUVETTE_SCENE_MODEL_PLACE_NEW_SCENE_H
#define CUVETTE_SCENE_MODEL_PLACE_NEW_SCENE_H

#include "scene/model/open.h"

status new_scene(scene **out, diagnostic *why);

#endif
