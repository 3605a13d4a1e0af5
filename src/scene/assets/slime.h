/* The simulation of a slime in a scene: its body and script, from time 0 to the shown time. Ownership: slime_create
 * gives, slime_destroy releases; slime_make's mesh belongs to the entry. Errors: STATUS_BAD_INPUT, located: a script's
 * in its file, others at the mesh in the scene file, with its name. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"
/* Its script; NULL for an entry without a script. The caller destroys it. */
status slime_read_script(const scene *s, const mesh_entry *m, hand_script **out, diagnostic *why);

typedef struct slime {
    softbody *body;
    hand_script *script; /* applied to body; NULL for none */
    double motion_s;     /* wall time of its steps */
    double steps;        /* steps of this simulation */
} slime;

/* A simulation at time 0. */
status slime_create(const scene *s, const mesh_entry *m, slime *out, diagnostic *why);
void slime_destroy(slime *x);

/* Advances to the whole number of steps nearest to time_s; not backwards. watch may be NULL; its fraction refers to
 * this advance. STATUS_INTERRUPTED leaves the simulation between, and it may be continued. */
status slime_advance(slime *x, const scene *s, const mesh_entry *m, double time_s, const load_watch *watch,
                     diagnostic *why);

/* Fills data, account and motion_s of an entry without data; the entry is unchanged on failure or interruption. */
status slime_make(const scene *s, mesh_entry *m, const load_watch *watch, diagnostic *why);
