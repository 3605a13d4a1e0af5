/* Studies on the ranks of an MPI job: each rank runs one shard of `cuvette study run`, and rank 0 merges the rows. What
 * a rank has measured stays if another one fails; the same command goes on from there, also with another number of
 * ranks. */
#pragma once

#include "base/status.h"

/* Runs "study run" with those arguments (argv[0] is the program, then the command) on this rank; all ranks call it. The
 * status is that of the whole: on all ranks the same, and the reason on those that have one. */
status shards_run(int argc, char **argv, int rank, int ranks, diagnostic *why);
