/* A loaded scene on its way from rank 0 to the others. Ownership: bytes and scenes are the caller's. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"
#include <stddef.h>

status scene_wire_pack(const scene *s, char **bytes, size_t *size, diagnostic *why);
status scene_wire_unpack(const char *bytes, size_t size, scene **out, diagnostic *why);
