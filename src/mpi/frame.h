/* A frame on the ranks of an MPI job. Rank 0 shares the frames of a job with the other ranks (job/job.h). It
 * renders too: the job traces its own part while a thread of its own serves the others (mpi/messenger.h). The other
 * ranks wait for frames and trace the tiles that rank 0 gives them, until it ends. Ownership: lead_create allocates,
 * lead_destroy releases, and ends the other ranks. One job at a time uses it. */
#pragma once

#include "base/status.h"
#include "job/job.h"
#include "mpi/messenger.h"

typedef struct lead lead;

status lead_create(int ranks, lead **out, diagnostic *why);
void lead_destroy(lead *l); /* NULL is allowed */

/* Borrowed from it. */
const job_sharing *lead_sharing(const lead *l);

/* The other ranks; returns when rank 0 ends. Errors of a frame are reported to rank 0; those that prevent any frame are
 * returned. */
status follow(diagnostic *why);
