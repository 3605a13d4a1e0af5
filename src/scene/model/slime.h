/* The body of a slime among a scene's meshes: what its parameters and its script say, from the beginning to a moment.
 * Ownership: slime_create gives, slime_destroy releases; slime_make's mesh is the entry's. Errors: STATUS_BAD_INPUT,
 * located: a script's in its file, others where the scene file says what the mesh is, with its name. */
#pragma once

#include "scene/model/mesh_entry.h"
#include "scene/model/open.h"

/* Those of its body: the level is the entry's. */
softbody_settings slime_settings(const mesh_entry *m);

/* Settings that make a body, and not more than SLIME_STEPS_MAX steps to its time_s. Not located. */
#define SLIME_STEPS_MAX 1e9
status slime_check(const mesh_entry *m, diagnostic *why);
/* Not more of them to another moment, a film's end. */
status slime_check_end(const mesh_entry *m, double end_s, diagnostic *why);

/* What hands do with it; NULL for an entry without a script. The caller destroys it. */
status slime_read_script(const scene *s, const mesh_entry *m, hand_script **out, diagnostic *why);

typedef struct slime {
    softbody *body;
    hand_script *script; /* followed by body; NULL for none */
    double motion_s;     /* wall time of its steps so far */
    double steps;        /* of its own way, so far */
} slime;

/* At time 0. */
status slime_create(const scene *s, const mesh_entry *m, slime *out, diagnostic *why);
void slime_destroy(slime *x);

/* To the whole number of steps nearest to time_s; not backwards. watch may be NULL; its share is of this way.
 * STATUS_INTERRUPTED leaves the body on the way, and it may go on. */
status slime_advance(slime *x, const scene *s, const mesh_entry *m, double time_s, const load_watch *watch,
                     diagnostic *why);

/* How much there is to do to its time_s, for shares of a whole: steps times masses. */
double slime_work(const mesh_entry *m);

/* Fills the data, account and motion_s of an entry that has no data; leaves it as it was where that fails or is
 * stopped. */
status slime_make(const scene *s, mesh_entry *m, const load_watch *watch, diagnostic *why);
