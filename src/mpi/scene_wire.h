/* A loaded scene on its way from rank 0 to all others, by one broadcast in parts (scene/package/package.h): they read
 * no file and build no hierarchy. Each part has its length first, so that the sender needs no copy of the whole, and an
 * error of either side leaves all ranks in step. Ownership: the receiver's scene is the caller's. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"

#include <stdint.h>

/* Rank 0, with the hierarchies built (scene_build_hierarchies). *sent: bytes that each rank got. After an error the
 * others have no scene. */
status scene_wire_send(const scene *s, uint64_t *sent, diagnostic *why);

/* The others. *given_up: the sender failed; there is no frame. */
status scene_wire_receive(scene **out, bool *given_up, diagnostic *why);
