/* Rank 0: shares the frames of a job with the other ranks (job/job.h). It renders too: the job traces its own part
 * while a thread of its own serves the others (mpi/messenger.h). Ownership: lead_create allocates, lead_destroy
 * releases, and ends the other ranks. One job at a time uses it. */
#pragma once

#include "job/job.h"
#include "mpi/messenger.h"

typedef struct lead lead;

status lead_create(int ranks, lead **out, diagnostic *why);
void lead_destroy(lead *l); /* NULL is allowed */

/* Borrowed from it. */
const job_sharing *lead_sharing(const lead *l);
