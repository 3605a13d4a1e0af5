/* Assigns a frame's tiles to the ranks of an MPI job, in order and on demand. A rank holds a tile per thread, and in
 * advance the tiles that it renders in HANDOUT_AHEAD_S, at least one, so that it need not wait for the next message.
 * Near the end, tiles that take longer than HANDOUT_AHEAD_S are not assigned in advance, so that the last tiles do not
 * queue at one rank while others idle. Pure: no messages, no clock, no threads. Ownership: handout_create allocates,
 * handout_destroy releases. */
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct handout handout;

#define HANDOUT_AHEAD_S 0.004
enum { HANDOUT_MOST = 256 }; /* tiles per assignment */

status handout_create(int64_t tiles, int ranks, handout **out, diagnostic *why);
void handout_destroy(handout *h); /* NULL is allowed */

/* Records that the rank is ready to render with that many threads. Times are seconds from any fixed point. */
void handout_join(handout *h, int rank, int threads, double now_s);

/* Assigns tiles to a rank that has joined: writes their numbers to tiles (at most HANDOUT_MOST) and returns how
 * many. */
int handout_assign(handout *h, int rank, int32_t *tiles);

/* Records that the rank has rendered the tile. False if the rank does not hold it. */
bool handout_return(handout *h, int rank, int64_t tile, double now_s);

/* Whether no tile is left to assign. */
bool handout_is_empty(const handout *h);
/* Whether all tiles have been returned. */
bool handout_is_complete(const handout *h);
/* The fraction of the tiles that has been returned. */
double handout_fraction(const handout *h);
/* The number of tiles that the rank holds. */
int64_t handout_held(const handout *h, int rank);
