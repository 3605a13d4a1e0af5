/* A rank of a simulated cluster, without its tracing threads: a queue of tiles, each of which takes its
 * measured cost of the simulated processor. Rank 0 has none (threads 0): it only waits for messages. Under mpirun,
 * tiles cost nothing: what remains is the time of the messages themselves. Ownership: the creator's. */
#pragma once

#include "cost_map.h"
#include "mpi/messenger.h"
#include "render/plan/schedule.h"

/* The frame, the same for all ranks. */
typedef struct frame_costs {
    const cost_map *map;
    const schedule *tiles;
    double scale;       /* a pixel's cost as a multiple of the map's */
    size_t pixel_bytes; /* of a tile */
} frame_costs;

double frame_tile_ns(const frame_costs *f, int64_t tile);
size_t frame_tile_bytes(const frame_costs *f, int64_t tile); /* of its result, without the head */

typedef struct simulated_rank {
    const frame_costs *frame;
    int32_t queue[4 * HANDOUT_MOST]; /* a ring */
    int first, count;
    tile_message *finished;
    bool ended;
    double busy_s;
} simulated_rank;

tracing simulated_tracing(simulated_rank *r, const frame_costs *frame, int threads);

/* Time of the rank's processor. */
void spend_ns(double ns);
