/* Distributes the frames of a job (job/job.h) over the ranks of an MPI job. Rank 0 renders a part of each frame while
 * another thread serves the other ranks (mpi/messenger.h). The other ranks wait for frames and render the tiles that
 * rank 0 assigns, until rank 0 ends. Ownership: lead_create allocates; lead_destroy releases, and ends the other ranks.
 * One job at a time may use a lead. */
#pragma once

#include "base/status.h"
#include "job/job.h"
#include "mpi/messenger.h"

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
