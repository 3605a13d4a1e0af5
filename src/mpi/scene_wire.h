/* Sends a loaded scene from rank 0 to all other ranks, which read no file and build no hierarchy: its package is
 * broadcast in parts (scene/package/package.h). Each part follows its length, so that the sender needs no complete
 * copy, and an error on either side leaves all ranks synchronised. Ownership: the receiver's scene is the caller's. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"

#include <stdint.h>

/* Called by rank 0, with the hierarchies built (scene_build_hierarchies). *sent: bytes per rank. After an error the
 * other ranks have no scene. */
status scene_wire_send(const scene *s, uint64_t *sent, diagnostic *why);

/* Called by the other ranks. *failed: rank 0 failed; there is no frame. */
status scene_wire_receive(scene **out, bool *failed, diagnostic *why);
