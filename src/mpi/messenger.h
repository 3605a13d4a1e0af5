/* The messages of a frame between rank 0, which hands out its tiles, and the others, which trace them; and the
 * messengers: the loops that exchange tiles for traced tiles, one for rank 0 and one for the others. They know nothing
 * of scenes. What traces is behind an interface, so that the same loops run with threads that trace (mpi/tracing.h) and
 * in a simulated cluster with measured costs (experiments/cluster/simulated).
 *
 * All ranks are of one build (mpi/main.c checks it), so that structures travel as their bytes. A message starts with
 * the number of its frame: one of an earlier frame, which was given up, is dropped. Each rank runs its messenger on one
 * thread; no other thread of the rank calls MPI meanwhile. Errors of MPI end the program: OpenMPI then ends all
 * ranks. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "mpi/handout.h"
#include "render/frame/renderer.h"

#include <stdint.h>

/* --- messages --- */

enum {
    TAG_FRAME = 1, /* to all: frame_order; then the scene follows by broadcast */
    TAG_READY,     /* to rank 0: ready_note */
    TAG_TILES,     /* from rank 0: wire_head, then the tiles' numbers, int32_t */
    TAG_END,       /* from rank 0: wire_head; no tile is left */
    TAG_STOP,      /* from rank 0: wire_head; the frame is given up */
    TAG_RESULT,    /* to rank 0: wire_head, then sums and, with replicates, variances: 3 values per pixel */
    TAG_REPORT,    /* to rank 0: rank_report, then its workers' reports */
    TAG_QUIT       /* to all: wire_head; the program ends */
};

typedef struct wire_head {
    int64_t frame, value; /* value: of a traced tile, its number; otherwise 0 */
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

/* What a rank did for a frame. */
typedef struct rank_report {
    wire_head head;
    int64_t code; /* status; of any other than STATUS_OK, why */
    diagnostic why;
    ray_counters counters;
    rank_usage account;
    int64_t workers;
} rank_report;

/* A finished tile on its way: the message's bytes, and the tile again. The receiver frees it. */
typedef struct tile_message {
    struct tile_message *next;
    size_t bytes; /* of head and values */
    wire_head head;
    int64_t values[]; /* sums, then variances (doubles) */
} tile_message;

/* --- messengers --- */

/* What traces the tiles of one rank. No function waits but `wait`. */
typedef struct tracing {
    int threads; /* 0: it traces nothing */
    void *of;
    void (*give)(void *of, const int32_t *tiles, int count);
    tile_message *(*take)(void *of); /* a finished tile, or NULL */
    void (*end)(void *of);           /* no more tiles follow */
    void (*stop)(void *of);          /* the frame is given up */
    bool (*over)(void *of);          /* it traces nothing any more, and all its tiles were taken */
    /* Waits for a finished tile or a message, or a short time. idle: the number of calls since anything happened. */
    void (*wait)(void *of, int idle);
} tracing;

/* What rank 0 does with what arrives. */
typedef struct frame_sink {
    void *of;
    /* Takes a tile's sums and variances; the message is the callee's. */
    void (*tile)(void *of, tile_message *tile);
    /* Takes a rank's report and its workers' reports. */
    void (*report)(void *of, int rank, const rank_report *report, const worker_report *workers);
    /* Called often. */
    void (*progress)(void *of, double share_done);
} frame_sink;

/* Tiles and bytes that were sent or received, for the report. */
typedef struct traffic {
    uint64_t tiles, tile_bytes, messages;
} traffic;

/* Rank 0: hands out all tiles, and returns when all tiles and the reports of all other ranks have arrived. Cancelling
 * its thread gives the frame up: then it returns after the reports. */
void messenger_serve(int64_t frame, int ranks, handout *tiles, const tracing *own, const frame_sink *sink,
                     traffic *moved);

/* Another rank: receives tiles and sends traced ones until its tracing is over. */
void messenger_work(int64_t frame, const tracing *own, traffic *moved);
