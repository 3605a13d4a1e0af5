/* The images that a mesh file names, as paths that can be opened: absolute, or relative to the mesh file. Their
 * existence is checked; they are not opened. Errors: STATUS_BAD_INPUT for a missing one. */
#pragma once

#include "scene/assets/mesh_stream.h"

status mesh_textures_find(const char *path, mesh_import *imported, diagnostic *why);
