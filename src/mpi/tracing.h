/* The two queues between the messenger of a rank (mpi/messenger.h) and its rendering threads: tiles to render, and
 * rendered tiles. For the renderer they are the source of tiles (render/frame/renderer.h). Ownership:
 * tile_queues_create allocates, tile_queues_destroy releases, after the messenger and the renderer have ended. */
#pragma once

#include "base/cancel.h"
#include "base/status.h"
#include "job/job.h"
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

/* Distributes the frames of a job (job/job.h) over the ranks of an MPI job. Rank 0 renders a part of each frame while
 * another thread serves the other ranks (mpi/messenger.h). The other ranks wait for frames and render the tiles that
 * rank 0 assigns, until rank 0 ends. Ownership: lead_create allocates; lead_destroy releases, and ends the other ranks.
 * One job at a time may use a lead. */

typedef struct lead lead;

status lead_create(int ranks, lead **out, diagnostic *why);
void lead_destroy(lead *l); /* NULL is allowed */

/* The interface for the job; borrowed from the lead. */
const job_distribution *lead_distribution(const lead *l);

/* The loop of the other ranks; returns when rank 0 ends. Errors of a frame are reported to rank 0; those that prevent
 * any frame are returned. */
status follow(diagnostic *why);

/* --- scene_wire.c ---
 *
 * Sends a loaded scene from rank 0 to all other ranks, which read no file and build no hierarchy: its package is
 * broadcast in parts (scene/package/package.h). Each part follows its length, so that the sender needs no complete
 * copy, and an error on either side leaves all ranks synchronised. Ownership: the receiver's scene is the caller's. */

/* Called by rank 0, with the hierarchies built (scene_build_hierarchies). *sent: bytes per rank. After an error the
 * other ranks have no scene. */
status scene_wire_send(const scene *s, uint64_t *sent, diagnostic *why);

/* Called by the other ranks. *failed: rank 0 failed; there is no frame. */
status scene_wire_receive(scene **out, bool *failed, diagnostic *why);
