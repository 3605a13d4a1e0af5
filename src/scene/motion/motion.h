/* Simulates a scene's slimes from time 0 onwards. At each time the scene's meshes are the current surfaces, identical
 * to those that scene_load makes for the same time_s, with their hierarchies refitted: a film depends only on the time,
 * not on the history.
 *
 * Ownership: the caller releases a motion with scene_motion_destroy; the scene is borrowed, must outlive the motion,
 * and must not be rendered while the motion advances. Errors as in softbody/softbody.h; a script's are located in
 * it. */
#pragma once

#include "geometry/hierarchy/hierarchy.h"
#include "scene/model/open.h"
#include "softbody/softbody.h"
#include <stdint.h>

typedef struct scene_motion scene_motion;

/* Whether a mesh of the scene is a slime. */
bool scene_moves(const scene *s);

/* Starts all slimes of s at time 0, whatever their time_s and loaded data; everything else is loaded as by scene_load.
 * STATUS_BAD_INPUT if there is no slime. */
status scene_motion_create(scene *s, scene_motion **out, diagnostic *why);
void scene_motion_destroy(scene_motion *m); /* NULL is allowed; the scene keeps the current surfaces */
/* Destroys the motion, and restores the slimes' original time_s and data. NULL is allowed. */
void scene_motion_end(scene_motion *m);

/* Moves the simulation to another scene whose slimes have the same names and parameters, except time_s: they continue
 * there from their current state, and the previous scene is restored. *joined is false, and nothing has changed, if the
 * slimes differ. Other data of the new scene is not loaded. */
status scene_motion_join(scene_motion *m, scene *s, bool *joined, diagnostic *why);
/* Detaches the simulation from its scene, which may then be destroyed: until it joins another one, only
 * scene_motion_count and scene_motion_body are valid. */
void scene_motion_leave(scene_motion *m);

/* Advances each slime to its step nearest to time_s, never backwards, and sets its time_s. surfaces: false leaves the
 * scene's meshes unchanged, for frames that are not rendered. */
status scene_motion_advance(scene_motion *m, double time_s, bool surfaces, diagnostic *why);
/* scene_motion_advance with progress. After a cancellation (STATUS_INTERRUPTED) the scene is unchanged, and a later
 * advance continues from the steps done so far. Fractions refer to this advance; watch may be NULL. */
status scene_motion_advance_until(scene_motion *m, double time_s, bool surfaces, const load_watch *watch,
                                  diagnostic *why);

/* For the last advance: changes of all slimes' hierarchies, steps, and the wall time of steps and of surfaces. */
typedef struct scene_motion_report {
    hierarchy_update_counts hierarchies;
    uint64_t steps;
    double step_s, surface_s;
} scene_motion_report;
scene_motion_report scene_motion_last(const scene_motion *m);

size_t scene_motion_count(const scene_motion *m);
/* The body of the i-th slime, borrowed; the index of its mesh in the scene. */
softbody *scene_motion_body(const scene_motion *m, size_t i);
size_t scene_motion_mesh(const scene_motion *m, size_t i);

/* The time of the last script entry; 0 without scripts. */
double scene_motion_script_end_s(const scene_motion *m);
/* Detaches all scripts, whose hands release their masses. False if there was no script. */
bool scene_motion_drop_scripts(scene_motion *m);

/* The times of the frames of an animation: frame k, counted from 0, shows the time start_s + k fps_den / fps_num.
 * Errors are STATUS_BAD_INPUT, not located, except those of scripts. */
typedef struct frame_times {
    double start_s, duration_s; /* duration_s < 0: not given */
    int64_t fps_num, fps_den;   /* in lowest terms */
} frame_times;

/* Number of frames: duration_s times the frame rate, rounded, at least 1. */
int64_t frame_times_count(const frame_times *t);
double frame_times_at(const frame_times *t, int64_t frame);

/* Chooses a duration that is not given: until two seconds after the end of the scripts, in which the slimes come to
 * rest; 4 s without a script. */
status frame_times_choose(frame_times *t, const scene *s, diagnostic *why);
/* Checks that the slimes need at most SLIME_STEPS_MAX steps up to the end. */
status frame_times_check_end(const frame_times *t, const scene *s, diagnostic *why);
