/* Picking, grabbing and moving soft bodies with the pointer, for interactive front ends; scripted hands are in
 * softbody/softbody.h.
 *
 * A solid shows the point x of its mesh at p + R (s x + c), with its position p, rotation R, scale s, and the offset c
 * of a copy. Rays and displacements in world coordinates are converted to the mesh's frame; distances along a ray, as
 * multiples of its direction, are the same in both. Ownership: the caller has SOFTBODY_HANDS_MAX hands per slime,
 * indexed by the body's hand numbers. Errors as in softbody/softbody.h. */
#pragma once

#include "scene/assets/slime.h"
#include "scene/model/scene.h"
#include "scene/motion/motion.h"

typedef struct motion_place {
    vec3 where;      /* in world coordinates */
    vec3 on_mesh;    /* the same point in the mesh's frame */
    double distance; /* infinite: missed */
    size_t solid;    /* the solid that was hit */
} motion_place;

/* Finds the first hit of a ray with the slime's current surface, from outside: on any visible solid that shows the
 * slime (MOTION_ANY_SOLID), or on the given solid, visible or not. The direction is a unit vector. */
enum { MOTION_ANY_SOLID = -1 };
status scene_motion_pick(const scene_motion *m, size_t i, int solid_or_any, vec3 origin, vec3 direction,
                         motion_place *out, diagnostic *why);

/* Positions are in the mesh's frame. The solid may be removed while the hand holds masses. */
typedef struct motion_hand {
    bool holds;
    mat3 rotation; /* of the solid at the time of the grab, with which displacements in world coordinates are
                      converted */
    vec3 scale;
    vec3 where;    /* point of the grab */
    vec3 from, to; /* displacements from this point, now and at the end of the next steps */
} motion_hand;

/* Grabs the masses within reach (world scene units) of a picked point; *number is the hand's. */
status scene_motion_grab(scene_motion *m, size_t i, const motion_place *place, double reach, motion_hand *hands,
                         int *number, diagnostic *why);
void scene_motion_release(scene_motion *m, size_t i, motion_hand *hands, int number);

/* Converts a displacement from world coordinates to the mesh's frame. */
vec3 motion_hand_offset(const motion_hand *h, vec3 by);

/* Advances the slime to time_s while its hands move linearly from their current positions; does nothing if no hand
 * moves. scene_motion_advance then updates the scene. watch as for scene_motion_advance_until; after a cancellation the
 * hands stay where they are. */
status scene_motion_step_held(scene_motion *m, size_t i, motion_hand *hands, double time_s, const load_watch *watch,
                              diagnostic *why);

/* A simulated scene, shared by motion.c and motion_hands.c. */

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
