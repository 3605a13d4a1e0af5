/* The initial scene: a floor, a light and a camera. Ownership: the scene is the caller's. */
#pragma once

#include "scene/model/open.h"

status new_scene(scene **out, diagnostic *why);
