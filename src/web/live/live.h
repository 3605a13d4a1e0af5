/* The slime while it is played with: it moves in the painter's thread, hands reach into it from others. Off, paused or
 * playing; while it is not off, the scene shown is the desk's with the slime as it lies now.
 *
 * Threads: those marked "painter" are called by the painter's thread alone, with the stage (the painter's own copy of
 * the scene) that nobody else looks at meanwhile; the others from any thread. Ownership: live_create gives,
 * live_destroy releases, after live_detach and when no other thread calls any more. Errors: STATUS_BAD_INPUT for what
 * cannot be, among them a body that blew up: it then stands still and says so until it is started again. */
#pragma once

#include "base/vec3.h"
#include "scene/model/open.h"
#include <jansson.h>

typedef struct live live;

typedef enum live_preview { LIVE_TRACED, LIVE_ZBUFFER } live_preview;
typedef enum live_order {
    LIVE_PLAY,
    LIVE_PAUSE,
    LIVE_RESTART,
    LIVE_OFF
} live_order; /* restart: from its beginning on, playing */

/* wake: something was ordered; the painter should look. */
live *live_create(void (*wake)(void *context), void *context); /* NULL when memory is out */
void live_destroy(live *l);                                    /* NULL is allowed */

/* --- from any thread --- */

void live_give(live *l, live_order order);
void live_set_preview(live *l, live_preview preview);

/* Places are world rays and points: the caller knows the camera. A grab waits for the painter, which is woken and
 * answers within a frame; STATUS_INTERRUPTED when it has not after LIVE_WAIT_S, or live_stop was called. The others are
 * heard at its next move and do not wait. STATUS_BAD_INPUT: it is off or blew up, or there is no such hand (any more:
 * it begins anew where its own parameters change). */
#define LIVE_WAIT_S 5.0
enum { LIVE_MISSED = -1, LIVE_ALL = -2 };
/* reach: scene units; 0: three tenths of the slime's radius. hand: its number, never given again, or LIVE_MISSED where
 * the ray meets no slime. */
status live_grab(live *l, vec3 origin, vec3 direction, double reach, int *hand, vec3 *where, diagnostic *why);
status live_move(live *l, int hand, vec3 by, diagnostic *why); /* from where it took hold */
status live_release(live *l, int hand, diagnostic *why);       /* LIVE_ALL: all that there are */
/* Where a hand took hold, in the world. */
status live_where(live *l, int hand, vec3 *where, diagnostic *why);

/* Who waits, and who grabs later, gets STATUS_INTERRUPTED at once: the painter will not answer any more. */
void live_stop(live *l);

/* The state's part; null where it is off and the scene has none. NULL when memory is out. */
json_t *live_tell(live *l);

/* --- painter --- */

bool live_is_on(live *l);     /* not off */
bool live_is_moving(live *l); /* playing, and not at rest with no hand on it */
bool live_is_due(live *l);    /* moving, or something was ordered: live_advance has something to do */
live_preview live_preview_of(live *l);

/* The stage is a fresh copy of what is on the desk: takes its slimes over, from their beginning or as they lie now
 * where the slimes' own parameters are what they were. Call it whenever the stage was replaced, before it is loaded:
 * what is live is not computed up to its time_s. What is not live is left to be loaded. */
status live_attach(live *l, scene *snapshot, diagnostic *why);
/* The stage is about to go, and is not rendered any more: hands and motion are kept for the next one where that is
 * possible. */
void live_detach(live *l);

/* Obeys orders, then moves by the wall time since it was called last, at most about most_s of work. told: live_tell
 * says something else than mere motion would: with each picture it is told anyway. A stage that was live and is off now
 * has to be loaded again. The trouble of a body that blew up is told by live_tell, and is no error here. */
status live_advance(live *l, double most_s, bool *told, diagnostic *why);
/* Does the stage look otherwise than when this was asked last? */
bool live_take_moved(live *l);

/* A stage that is on is not to be lent to the desk: its slimes lie as hands have drawn them, not as their time_s says.
 */
