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
