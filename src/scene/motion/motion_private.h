/* A scene that moves, shared by motion.c (its time), motion_scene.c (which scene it is in) and motion_hands.c (what
 * takes hold of it). */
#pragma once

#include "scene/motion/motion.h"
#include "scene/model/slime.h"
#include "scene/model/scene.h"

/* What the scene has of a slime before it moves, and gets back. */
typedef struct given_slime {
    double time_s;
    const mesh *data; /* one owner of it; NULL for none */
    softbody_account account;
    double motion_s;
} given_slime;

typedef struct moving_slime {
    slime x;
    size_t entry;            /* in scene.meshes */
    uint64_t steps;          /* taken so far */
    double time_s;           /* that of its entry */
    char *name, *parameters; /* of its entry, for other scenes */
    given_slime given;
    const struct mesh *skin; /* while it is in no scene: one owner of it; NULL for none */
} moving_slime;

struct scene_motion {
    scene *s; /* NULL: it has left one */
    moving_slime *slimes;
    size_t count;
    scene_motion_report last;
};

static inline mesh_entry *motion_entry(const scene_motion *m, const moving_slime *one)
{
    return &m->s->meshes[one->entry];
}

size_t motion_count_slimes(const scene *s);

/* Remembers what the entry is and has. STATUS_FAILURE when memory is out. */
status motion_remember(scene_motion *m, moving_slime *one, diagnostic *why);
void motion_forget(moving_slime *one);

/* A skin of its own, in place of what others may look at. */
status motion_give_surface(const scene_motion *m, const moving_slime *one, diagnostic *why);
void motion_take_account(scene_motion *m, moving_slime *one, double time_s);
