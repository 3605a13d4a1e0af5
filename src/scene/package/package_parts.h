/* Functions that the files scene/package/package*.c share. */
#pragma once

#include "base/pack.h"
#include "scene/model/face_materials.h"

/* All of a package but its head and its hash. text: the scene's. */
status package_put_scene(pack_writer *to, const scene *s, const char *text, diagnostic *why);
status package_get_scene(pack_reader *from, scene **out, diagnostic *why);

/* Materials in a mesh file; NULL is allowed. */
status package_put_face_materials(pack_writer *to, const face_materials *l, diagnostic *why);
status package_get_face_materials(pack_reader *from, const face_materials **out, diagnostic *why);
