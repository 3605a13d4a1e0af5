/* The two queues between the messenger of a rank (mpi/messenger.h) and its rendering threads: tiles to render, and
 * rendered tiles. For the renderer they are the source of tiles (render/frame/renderer.h). Ownership:
 * tile_queues_create allocates, tile_queues_destroy releases, after the messenger and the renderer have ended. */
#pragma once

#include "base/cancel.h"
#include "mpi/messenger.h"
#include "render/plan/schedule.h"

typedef struct tile_queues tile_queues;

/* tiles: the frame's tiles, as schedule_start makes them; copied. */
status tile_queues_create(const schedule *tiles, int threads, tile_queues **out, diagnostic *why);
void tile_queues_destroy(tile_queues *t); /* NULL is allowed */

/* The interfaces for the messenger and for the renderer; borrowed from the queues. */
const tracing *tile_queues_tracing(const tile_queues *t);
const tile_source *tile_queues_source(const tile_queues *t);

/* Called when the renderer has ended: its threads request no more tiles. */
void tile_queues_close(tile_queues *t);
/* The token for the thread that renders. The queues set it when rank 0 cancels the frame or memory runs out; the caller
 * may set it to cancel the frame. */
cancel_token *tile_queues_token(tile_queues *t);
/* The renderer's status, or out of memory if a queue could not grow, which the renderer sees as the end of the
 * tiles. */
status tile_queues_status(const tile_queues *t, status rendered, diagnostic *why);
