/* A simulated scene, shared by motion.c (time), motion_scene.c (attachment to scenes) and motion_hands.c (hands). */
#pragma once

#include "scene/motion/motion.h"
#include "scene/model/slime.h"
#include "scene/model/scene.h"

/* The scene's data of a slime before the simulation, to be restored. */
typedef struct given_slime {
    double time_s;
    const mesh *data; /* one reference; NULL for none */
    softbody_quantities account;
    double motion_s;
} given_slime;

typedef struct moving_slime {
    slime x;
    size_t entry;            /* index in scene.meshes */
    uint64_t steps;          /* steps taken */
    double time_s;           /* the entry's step */
    char *name, *parameters; /* parameters of its entry, for other scenes */
    given_slime given;
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

size_t motion_count_slimes(const scene *s);

/* Stores the entry's parameters and data. STATUS_FAILURE if memory runs out. */
status motion_remember(scene_motion *m, moving_slime *one, diagnostic *why);
void motion_forget(moving_slime *one);

/* Gives the entry a surface of its own, since the current one may be shared. */
status motion_give_surface(const scene_motion *m, const moving_slime *one, diagnostic *why);
void motion_take_account(scene_motion *m, moving_slime *one, double time_s);
