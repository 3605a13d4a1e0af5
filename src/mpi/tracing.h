/* The threads that trace the tiles of one rank, behind the interface of its messenger (mpi/messenger.h): two queues, of
 * tiles to trace and of traced tiles. The renderer takes the tiles as its source (render/frame/renderer.h). Ownership:
 * team_create allocates, team_destroy releases, after the messenger and the renderer have ended. */
#pragma once

#include "base/cancel.h"
#include "mpi/messenger.h"
#include "render/plan/schedule.h"

typedef struct team team;

/* tiles: the frame's tiles, as schedule_start makes them; copied. */
status team_create(const schedule *tiles, int threads, team **out, diagnostic *why);
void team_destroy(team *t); /* NULL is allowed */

/* For the messenger, and for the renderer; borrowed from the team. */
const tracing *team_tracing(const team *t);
const tile_source *team_source(const team *t);

/* The renderer has ended: its threads take no more tiles. */
void team_left(team *t);
/* Set when the frame is given up, or to give it up: for the thread that renders. */
cancel_token *team_token(team *t);
/* The renderer's status, or that the team ran out of memory for tiles: the renderer then only sees its
 * end. */
status team_status(const team *t, status traced, diagnostic *why);
