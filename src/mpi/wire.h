/* The messages between rank 0, which hands out the tiles of a frame, and the others, which trace them. All ranks are of
 * one build (mpi/main.c checks it), so that structures travel as their bytes. A message starts with the number of its
 * frame: one of an earlier frame, which was given up, is dropped. */
#pragma once

#include "base/counters.h"
#include "base/status.h"
#include "render/frame/renderer.h"
#include <stdint.h>

enum {
    TAG_FRAME = 1, /* to all: frame_order; then the scene follows by broadcast */
    TAG_READY,     /* to rank 0: ready_note */
    TAG_TILES,     /* from rank 0: wire_head, then the tiles' numbers, int32_t */
    TAG_END,       /* from rank 0: wire_head; no tile is left */
    TAG_STOP,      /* from rank 0: wire_head; the frame is given up */
    TAG_PIECE,  /* to rank 0: wire_head, then sums and, with shares, variances: 3 values for each pixel of the tile */
    TAG_REPORT, /* to rank 0: rank_report, then its workers' reports */
    TAG_QUIT    /* to all: wire_head; the program ends */
};

typedef struct wire_head {
    int64_t frame, value; /* value: of a piece, its tile; otherwise 0 */
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
typedef struct piece_message {
    struct piece_message *next;
    size_t bytes; /* of head and values */
    wire_head head;
    int64_t values[]; /* sums, then variances (doubles) */
} piece_message;
