/* The hand-out of a frame's tiles to the ranks of an MPI job: which tiles a rank is given, and when. Tiles are given in
 * order, on demand. A rank holds as many tiles as it has threads, and a few more, so that it need not wait for the next
 * ones: as many as it traces in HANDOUT_AHEAD_S. Near the end it gets none in advance, unless they take less time than
 * a message: the last tiles are then not queued at one rank while others idle. Pure: no messages, no clock, no threads.
 * Ownership: handout_create allocates, handout_destroy releases. Errors: a tile that is returned by a rank that does
 * not hold it. */
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct handout handout;

#define HANDOUT_AHEAD_S 0.004
enum { HANDOUT_MOST = 256 }; /* tiles given at once */

status handout_create(int64_t tiles, int ranks, handout **out, diagnostic *why);
void handout_destroy(handout *h); /* NULL is allowed */

/* The rank is ready to trace with that many threads. Times are seconds from any fixed point. */
void handout_join(handout *h, int rank, int threads, double now_s);

/* Gives tiles to a rank that has joined: writes their numbers to tiles (HANDOUT_MOST of them at most) and returns how
 * many. */
int handout_assign(handout *h, int rank, int32_t *tiles);

/* The rank has traced the tile. False: it does not hold it. */
bool handout_return(handout *h, int rank, int64_t tile, double now_s);

/* No tile is left to be given. */
bool handout_is_empty(const handout *h);
/* All tiles have been returned. */
bool handout_is_complete(const handout *h);
/* The fraction of the tiles that has been returned. */
double handout_fraction(const handout *h);
/* The tiles that the rank holds. */
int64_t handout_held(const handout *h, int rank);
