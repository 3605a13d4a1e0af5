/* Hands that reach out of the world into a scene that moves: what a ray meets, what takes hold there, and where it is
 * drawn to. For whoever plays with a slime; what a script does is softbody/hand.h.
 *
 * A solid shows x of its mesh at p + R (s x + c), with its position p, rotation R and scale s, and c where a copy
 * begins. Rays and ways of the world are taken into the mesh's frame by that; distances along a ray, as multiples of
 * its direction, are the same in both. Ownership: hands are the caller's, SOFTBODY_HANDS_MAX for each slime, by the
 * body's own numbers. Errors as softbody/softbody.h. */
#pragma once

#include "scene/motion/motion.h"

typedef struct motion_place {
    vec3 where;      /* of the world */
    vec3 on_mesh;    /* the same place in the mesh's frame */
    double distance; /* infinite: missed */
    size_t solid;    /* under which it was met */
} motion_place;

/* Where a ray first meets the slime as it is shown, from outside: under any visible solid that shows it
 * (MOTION_ANY_SOLID), or under that one, visible or not. The direction is a unit vector. */
enum { MOTION_ANY_SOLID = -1 };
status scene_motion_pick(const scene_motion *m, size_t i, int solid_or_any, vec3 origin, vec3 direction,
                         motion_place *out, diagnostic *why);

/* The solid may go while a hand holds. Places are in the mesh's frame. */
typedef struct motion_hand {
    bool holds;
    mat3 rotation; /* of the solid as it stood then: what the caller says is of the world */
    vec3 scale;
    vec3 where;    /* it took hold */
    vec3 from, to; /* how far from there it is, and is to be at the end of the next steps */
} motion_hand;

/* Takes hold of what lies within reach (scene units of the world) of a place that was picked; number: which hand it is.
 */
status scene_motion_grab(scene_motion *m, size_t i, const motion_place *place, double reach, motion_hand *hands,
                         int *number, diagnostic *why);
void scene_motion_release(scene_motion *m, size_t i, motion_hand *hands, int number);

/* A way of the world in the mesh's frame. */
vec3 motion_hand_offset(const motion_hand *h, vec3 by);

/* All steps of the slime until time_s, with its hands on their straight ways from where they are; none where no hand
 * moves. Skins and the scene's account are left to scene_motion_advance. */
status scene_motion_step_held(scene_motion *m, size_t i, motion_hand *hands, double time_s, diagnostic *why);
