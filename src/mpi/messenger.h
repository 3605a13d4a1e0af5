/* The messages of a frame, and the messengers, the loops that exchange them: rank 0 assigns tiles, and the other ranks
 * send rendered tiles back. Messengers know nothing of scenes. They reach the renderer through an interface, so that
 * the same loops run with real threads (mpi/tracing.h) and in a simulated cluster with measured costs
 * (experiments/cluster/simulated).
 *
 * All ranks run the same build (mpi/main.c checks this); therefore structures are sent as bytes. A message starts with
 * the number of its frame; messages of an earlier frame, which was cancelled, are dropped. Each rank runs its messenger
 * on one thread; no other thread of the rank calls MPI meanwhile. Errors of MPI end the program: OpenMPI then ends all
 * ranks. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "render/frame/renderer.h"
#include <stdbool.h>
#include <stdint.h>

/* Assigns a frame's tiles to the ranks of an MPI job, in order and on demand. A rank holds a tile per thread, and in
 * advance the tiles that it renders in HANDOUT_AHEAD_S, at least one, so that it need not wait for the next message.
 * Near the end, tiles that take longer than HANDOUT_AHEAD_S are not assigned in advance, so that the last tiles do not
 * queue at one rank while others idle. Pure: no messages, no clock, no threads. Ownership: handout_create allocates,
 * handout_destroy releases. */

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

/* --- messages --- */

enum {
    TAG_FRAME = 1, /* to all: frame_order; then the scene follows by broadcast */
    TAG_READY,     /* to rank 0: ready_note */
    TAG_TILES,     /* from rank 0: wire_head, then the tiles' numbers, int32_t */
    TAG_END,       /* from rank 0: wire_head; no tile is left */
    TAG_STOP,      /* from rank 0: wire_head; the frame is cancelled */
    TAG_RESULT,    /* to rank 0: wire_head, then sums and, with replicates, variances: 3 values per pixel */
    TAG_REPORT,    /* to rank 0: rank_report, then its workers' reports */
    TAG_QUIT       /* to all: wire_head; the program ends */
};

typedef struct wire_head {
    int64_t frame, value; /* value: the number of a rendered tile; otherwise 0 */
} wire_head;

typedef struct frame_order {
    wire_head head;
    int32_t tile; /* side of the tiles */
    int32_t usage;
} frame_order;

typedef struct ready_note {
    wire_head head;
    int64_t threads;
} ready_note;

/* The result of a rank's work for a frame. */
typedef struct rank_report {
    wire_head head;
    int64_t code; /* a status; why is set unless it is STATUS_OK */
    diagnostic why;
    ray_counters counters;
    rank_usage account;
    int64_t workers;
} rank_report;

/* A finished tile as a message. The receiver frees it. */
typedef struct tile_message {
    struct tile_message *next;
    size_t bytes; /* of head and values */
    wire_head head;
    int64_t values[]; /* sums, then variances (doubles) */
} tile_message;

/* --- messengers --- */

/* The interface to the renderer of a rank's tiles. Only `wait` blocks. */
typedef struct tracing {
    int threads; /* 0: this rank renders nothing */
    void *of;
    void (*assign)(void *of, const int32_t *tiles, int count);
    tile_message *(*pop)(void *of); /* a finished tile, or NULL */
    void (*end)(void *of);          /* no more tiles follow */
    void (*stop)(void *of);         /* the frame is cancelled */
    bool (*is_done)(void *of);      /* rendering has ended, and all finished tiles were popped */
    /* Waits for a finished tile or a message, or a short time. idle: the number of calls since anything happened. */
    void (*wait)(void *of, int idle);
} tracing;

/* How rank 0 handles what arrives. */
typedef struct frame_sink {
    void *of;
    /* A finished tile; the callee frees it. */
    void (*tile)(void *of, tile_message *tile);
    /* A rank's report, and the reports of its workers. */
    void (*report)(void *of, int rank, const rank_report *report, const worker_report *workers);
    /* Called often. */
    void (*progress)(void *of, double fraction);
} frame_sink;

/* Tiles, their bytes, and messages that were sent or received. */
typedef struct traffic {
    uint64_t tiles, tile_bytes, messages;
} traffic;

/* Rank 0: hands out all tiles, and returns when all tiles and the reports of all other ranks have arrived. Cancelling
 * the calling thread cancels the frame: then it returns after the reports. */
void messenger_serve(int64_t frame, int ranks, handout *tiles, const tracing *tile_renderer, const frame_sink *sink,
                     traffic *moved);

/* Another rank: receives tiles and sends them back rendered, until the renderer is done. */
void messenger_work(int64_t frame, const tracing *tile_renderer, traffic *moved);
