/* The contents of a package, without its head and its hash; for package.c. */
#pragma once

#include "base/pack.h"
#include "scene/model/open.h"

/* text: the scene as scene_write_text writes it. */
status package_put_scene(pack_writer *to, const scene *s, const char *text, diagnostic *why);
status package_get_scene(pack_reader *from, scene **out, diagnostic *why);
