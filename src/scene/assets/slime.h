/* The simulation of a slime in a scene: its body and script, from time 0 to the shown time. Ownership: the caller
 * releases a slime with slime_destroy; slime_make's mesh belongs to the entry. Errors: STATUS_BAD_INPUT, located in the
 * script, or at the mesh in the scene file, with its name. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"
#include "softbody/softbody.h"

/* --- script.c --- */

/* Script files: recorded hands that act on a slime. YAML:
 *
 *   title: A tug to the left            # optional
 *   hands:
 *     left:                             # any name; each hand holds one place at a time
 *       - {time_s: 0.5, grab: [0, 1, -6], towards: [0, 0, 1], reach: 0.3}   # where this ray (point, direction) hits
 *       - {time_s: 1.5, move: [-1.2, 0.8, 0]}                               # displacement since the grab, at that time
 *       - {time_s: 2.0, release: on}
 *
 * Points are in the frame of the slime's mesh, which is the world's if its solid is not moved, rotated or scaled. The
 * caller releases a script with hand_script_destroy. */

/* Reads a file below root (base/file.h; NULL: no restriction). */
status script_read_below(const char *path, const char *root, hand_script **out, diagnostic *why);
/* Reads a script from memory; name is used in diagnostics. */
status script_read_text(const char *name, const char *text, size_t size, hand_script **out, diagnostic *why);

/* --- slime.c --- */

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
