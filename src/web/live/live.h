/* The live slime: it moves in the render worker's thread, while hands drag it from other threads. It is off, paused or
 * playing; while it is on, the displayed scene is the scene document with the slime in its live state.
 *
 * Threads: functions marked "render worker" are called only by the render worker's thread, with the snapshot (the
 * render worker's own copy of the scene), which no other thread reads meanwhile; all others are thread-safe. Ownership:
 * live_create creates, live_destroy releases, after live_detach and once no other thread uses the slime. Errors:
 * STATUS_BAD_INPUT for invalid requests, and for a body whose simulation diverged: it stops and reports the error until
 * it is restarted. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"

#include <jansson.h>

typedef struct live live;

typedef enum live_preview { LIVE_TRACED, LIVE_ZBUFFER } live_preview;
typedef enum live_command {
    LIVE_PLAY,
    LIVE_PAUSE,
    LIVE_RESTART,
    LIVE_OFF
} live_command; /* restart: plays from the beginning */

/* wake: called after each command, so that the render worker runs it. */
live *live_create(void (*wake)(void *context), void *context); /* NULL when out of memory */
void live_destroy(live *l);                                    /* NULL is allowed */

/* --- thread-safe --- */

void live_send(live *l, live_command order);
void live_set_preview(live *l, live_preview preview);

/* Rays and points are in world space: the caller knows the camera. A grab wakes the render worker and waits for it,
 * usually less than a frame; STATUS_INTERRUPTED after LIVE_WAIT_S or live_stop. The other functions do not wait; the
 * next step applies them. STATUS_BAD_INPUT: the slime is off or diverged, or no such hand exists (hands end when the
 * slime restarts, by a command or because its parameters changed). */
#define LIVE_WAIT_S 5.0
enum { LIVE_MISSED = -1, LIVE_ALL = -2 };
/* reach: scene units; 0: 0.3 of the radius of the slime as scaled in the scene. *hand: a number that is never reused,
 * or LIVE_MISSED if the ray misses the slime. *where: the grab point. */
status live_grab(live *l, vec3 origin, vec3 direction, double reach, int *hand, vec3 *where, diagnostic *why);
status live_move(live *l, int hand, vec3 by, diagnostic *why); /* by: offset from the grab point */
status live_release(live *l, int hand, diagnostic *why);       /* LIVE_ALL: all hands */
/* The grab point of a hand, in world space. */
status live_where(live *l, int hand, vec3 *where, diagnostic *why);

/* Makes waiting and later grabs return STATUS_INTERRUPTED: the render worker is ending. */
void live_stop(live *l);

/* The slime in the state JSON; null if the scene has none. NULL when out of memory. */
json_t *live_json(live *l);

/* --- render worker --- */

bool live_is_on(live *l);       /* playing or paused */
bool live_is_moving(live *l);   /* playing, and not at rest */
bool live_has_request(live *l); /* a command or a grab is pending */
bool live_is_due(live *l);      /* moving, or a request is pending: live_advance has work */
live_preview live_preview_of(live *l);

/* Attaches to the slimes of a new snapshot: from their beginning, or in their live state if the slimes' own
 * parameters are unchanged. Call it after each new snapshot, before it is loaded: live slimes are not simulated up
 * to their time_s. Slimes that are not live are left to the loader. */
status live_attach(live *l, scene *snapshot, diagnostic *why);
/* Detaches from a snapshot that will not be rendered any more; hands and motion are kept for the next one if
 * possible. */
void live_detach(live *l);

/* Runs pending commands, then simulates the wall time since the last call, with at most about most_s of computation.
 * state_changed: live_json differs by more than the motion, which is sent with every image anyway. A snapshot whose
 * slime was switched off must be loaded again. STATUS_OK for a diverged body, whose error live_json reports. */
status live_advance(live *l, double most_s, bool *state_changed, diagnostic *why);
/* Whether the snapshot's appearance changed since the last call. */
bool live_fetch_moved(live *l);

/* A snapshot with a live slime must not be passed to scene_document_reuse_loaded: its slimes are shaped by hands, not
 * by their time_s. */
