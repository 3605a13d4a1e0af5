/* Internals of a motion, shared by motion.c (creation and time) and motion_hands.c (hands). Ownership as in
 * cuvette.h. */
#pragma once

#include "engine/engine_private.h"
#include "scene/motion/motion_hands.h"

struct cuvette_motion {
    cuvette_scene *of;
    scene_motion *bodies;
    uint64_t slimes_changed; /* the scene's value when this motion was created */
    bool failed;             /* an advance failed: the state of the bodies is invalid */
    double time_s;
    motion_hand *hands; /* SOFTBODY_HANDS_MAX for each slime, indexed by the body's own numbers */
};

/* CUVETTE_OK when the motion is valid and no advance is in progress. */
cuvette_status motion_is_alive(const cuvette_motion *m, cuvette_diagnostic *why);

/* Finds the slime of the mesh, or of the solid, with that name. *solid_or_none is set to the solid's index, or -1 for a
 * mesh. */
status motion_find(const cuvette_motion *m, const char *name, size_t *index, int *solid_or_none, diagnostic *why);
