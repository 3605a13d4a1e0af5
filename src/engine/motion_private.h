/* A motion, shared by motion.c (its life and its time) and motion_hands.c (what takes hold of it). Ownership as
 * cuvette.h says. */
#pragma once

#include "engine/engine_private.h"
#include "scene/motion/motion_hands.h"

struct cuvette_motion {
    cuvette_scene *of;
    scene_motion *bodies;
    uint64_t slimes_changed; /* the scene's when this was made */
    bool failed;             /* an advance did: a body is of no more use */
    double time_s;
    motion_hand *hands; /* SOFTBODY_HANDS_MAX of each slime, by the body's own numbers */
};

/* CUVETTE_OK when it can still be used, and is not under way. */
cuvette_status motion_is_alive(const cuvette_motion *m, cuvette_diagnostic *why);

/* The slime of that mesh, or of the solid's. at: what the name means. */
status motion_find(const cuvette_motion *m, const char *name, size_t *index, int *solid_or_none, diagnostic *why);
