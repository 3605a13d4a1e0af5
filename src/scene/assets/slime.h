/* The simulation of a slime in a scene: its body and script, from time 0 to the shown time. Ownership: the caller
 * releases a slime with slime_destroy; slime_make's mesh belongs to the entry. Errors: STATUS_BAD_INPUT, located in the
 * script, or at the mesh in the scene file, with its name. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* Reads the script of a mesh entry; *out is NULL if it has none. The caller destroys the script. */
status slime_read_script(const scene *s, const mesh_entry *m, hand_script **out, diagnostic *why);

typedef struct slime {
    softbody *body;
    hand_script *script; /* applied to body; NULL for none */
    double motion_s;     /* wall time of all steps */
    double steps;        /* number of steps so far */
} slime;

/* Creates a simulation at time 0. */
status slime_create(const scene *s, const mesh_entry *m, slime *out, diagnostic *why);
void slime_destroy(slime *x);

/* Advances to the step nearest to time_s; never backwards. watch may be NULL; its fraction refers to this advance.
 * After STATUS_INTERRUPTED the simulation is at an earlier step and can be continued. */
status slime_advance(slime *x, const scene *s, const mesh_entry *m, double time_s, const load_watch *watch,
                     diagnostic *why);

/* Fills data, account and motion_s of an entry without data; the entry is unchanged on failure or interruption. */
status slime_make(const scene *s, mesh_entry *m, const load_watch *watch, diagnostic *why);
