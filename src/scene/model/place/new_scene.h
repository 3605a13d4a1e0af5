/* The scene to begin with: a room with a floor, a light and a camera, and nothing in it. Ownership: the scene is the
 * caller's. */
#pragma once

#include "scene/model/open.h"

status new_scene(scene **out, diagnostic *why);
