/* A simulated scene, shared by motion.c and motion_hands.c. */
#pragma once

#include "scene/assets/slime.h"
#include "scene/model/scene.h"
#include "scene/motion/motion.h"

/* The scene's data of a slime before the simulation, to be restored. */
typedef struct original_slime {
    double time_s;
    const mesh *data; /* one reference; NULL for none */
    softbody_quantities account;
    double motion_s;
} original_slime;

typedef struct moving_slime {
    slime x;
    size_t entry;            /* index in scene.meshes */
    uint64_t steps;          /* steps that scene_motion_report has counted */
    double time_s;           /* time_s of the entry */
    char *name, *parameters; /* of the entry, to find an equal slime in another scene */
    original_slime original;
    const struct mesh *surface; /* while detached: one reference; NULL for none */
} moving_slime;

struct scene_motion {
    scene *s; /* NULL: detached */
    moving_slime *slimes;
    size_t count;
    scene_motion_report last;
};

static inline mesh_entry *motion_entry(const scene_motion *m, const moving_slime *one)
{
    return &m->s->meshes[one->entry];
}
