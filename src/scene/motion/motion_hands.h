/* Picking, grabbing and moving soft bodies with the pointer, for interactive front ends; scripted hands are in
 * softbody/softbody.h.
 *
 * A solid shows the point x of its mesh at p + R (s x + c), with its position p, rotation R, scale s, and the offset c
 * of a copy. Rays and displacements in world coordinates are converted to the mesh's frame; distances along a ray, as
 * multiples of its direction, are the same in both. Ownership: hands are the caller's, SOFTBODY_HANDS_MAX for each
 * slime, by the body's own numbers. Errors as in softbody/softbody.h. */
#pragma once

#include "scene/motion/motion.h"

typedef struct motion_place {
    vec3 where;      /* in world coordinates */
    vec3 on_mesh;    /* the same point in the mesh's frame */
    double distance; /* infinite: missed */
    size_t solid;    /* the solid that was hit */
} motion_place;

/* The first hit of a ray with the current surface of the slime, from outside: on any visible solid that shows it
 * (MOTION_ANY_SOLID), or on the given one, visible or not. The direction is a unit vector. */
enum { MOTION_ANY_SOLID = -1 };
status scene_motion_pick(const scene_motion *m, size_t i, int solid_or_any, vec3 origin, vec3 direction,
                         motion_place *out, diagnostic *why);

/* The solid may be removed while a hand holds. Positions are in the mesh's frame. */
typedef struct motion_hand {
    bool holds;
    mat3 rotation; /* of the solid at the time of the grab: the caller's coordinates are world coordinates */
    vec3 scale;
    vec3 where;    /* point of the grab */
    vec3 from, to; /* displacement from there, now and at the end of the next steps */
} motion_hand;

/* Grabs the masses within reach (world scene units) of a picked point; number is that of the hand. */
status scene_motion_grab(scene_motion *m, size_t i, const motion_place *place, double reach, motion_hand *hands,
                         int *number, diagnostic *why);
void scene_motion_release(scene_motion *m, size_t i, motion_hand *hands, int number);

/* A displacement in world coordinates, in the mesh's frame. */
vec3 motion_hand_offset(const motion_hand *h, vec3 by);

/* All steps of the slime until time_s, with its hands moving linearly from their current positions; none if no hand
 * moves. Surfaces and the scene's account are left to scene_motion_advance. watch as for scene_motion_advance_until:
 * after a stop the hands are where they were then. */
status scene_motion_step_held(scene_motion *m, size_t i, motion_hand *hands, double time_s, const load_watch *watch,
                              diagnostic *why);
