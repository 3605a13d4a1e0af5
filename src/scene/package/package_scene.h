/* The contents of a package, for package.c: all but its head and its hash. */
#pragma once

#include "base/pack.h"
#include "scene/model/open.h"

/* text: the scene's. */
status package_put_scene(pack_writer *to, const scene *s, const char *text, diagnostic *why);
status package_get_scene(pack_reader *from, scene **out, diagnostic *why);
