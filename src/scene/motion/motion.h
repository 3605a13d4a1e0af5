/* A scene that moves: the slimes among its meshes, from their beginning on, a moment at a time. At each moment the
 * scene's meshes are the skins as they lie then, the very ones that scene_load makes for the same time_s, and the
 * hierarchies that they keep are fitted to them; so that a film is that of the scene with its slimes' time_s set,
 * whatever came before.
 *
 * Ownership: scene_motion_create gives, scene_motion_destroy releases; the scene is borrowed, must outlive it, and is
 * not rendered while it advances. Errors as softbody/softbody.h; a script's are located in its file. */
#pragma once

#include "softbody/softbody.h"
#include "geometry/hierarchy.h"
#include "scene/model/open.h"

typedef struct scene_motion scene_motion;

/* Is there a slime among its meshes? */
bool scene_moves(const scene *s);

/* All slimes of s at time 0, whatever their time_s and whatever was loaded of them; all else is loaded as by
 * scene_load. STATUS_BAD_INPUT when there is none. */
status scene_motion_create(scene *s, scene_motion **out, diagnostic *why);
void scene_motion_destroy(scene_motion *m); /* NULL is allowed; the scene keeps the skins as they lie */
/* The same, and the scene gets back what it had: its slimes' time_s and what was loaded of them. NULL is allowed. */
void scene_motion_end(scene_motion *m);

/* Into another scene that has the same slimes, by name and by all their parameters but time_s: there they lie and go on
 * as they did here, and the scene that is left gets back what it had. joined: false where that has others, and nothing
 * has changed. What else is there is left to be loaded. */
status scene_motion_join(scene_motion *m, scene *s, bool *joined, diagnostic *why);
/* Out of its scene, which may then go, and into none: until it joins one, scene_motion_count and scene_motion_body
 * alone may be asked. */
void scene_motion_leave(scene_motion *m);

/* To the time nearest to time_s that is a whole number of steps of each slime; not backwards. The slimes' time_s are
 * set to time_s. skins: false leaves the scene's meshes as they were, for frames that are not rendered. */
status scene_motion_advance(scene_motion *m, double time_s, bool skins, diagnostic *why);
/* The same, for one who waits: STATUS_INTERRUPTED leaves the scene as it was, with bodies on the way, and a later
 * advance goes on. The share is of this way; watch may be NULL. */
status scene_motion_advance_until(scene_motion *m, double time_s, bool skins, const load_watch *watch, diagnostic *why);

/* Of the latest advance: what the hierarchies of all slimes came to, and the wall time of steps and of moving skins. */
typedef struct scene_motion_report {
    hierarchy_moves hierarchies;
    uint64_t steps;
    double step_s, skin_s;
} scene_motion_report;
scene_motion_report scene_motion_last(const scene_motion *m);

size_t scene_motion_count(const scene_motion *m);
/* The i-th slime; its mesh's index in the scene. Borrowed. */
softbody *scene_motion_body(const scene_motion *m, size_t i);
size_t scene_motion_mesh(const scene_motion *m, size_t i);

/* When the last hand of a script has done all; 0 without scripts. */
double scene_motion_script_end_s(const scene_motion *m);
/* From now on no script moves a hand; what those hold they let go. false where there was none. */
bool scene_motion_drop_scripts(scene_motion *m);
