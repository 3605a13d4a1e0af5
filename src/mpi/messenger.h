/* The messengers of a frame: the loops that exchange tiles for traced pieces, one for rank 0 and one for the others.
 * They know nothing of scenes. What traces is behind an interface, so that the same loops run with threads that trace
 * (mpi/tracing.h) and in a simulated cluster with measured costs (experiments/cluster/simulated). Each rank runs its
 * messenger on one thread; no other thread of the rank calls MPI meanwhile. Errors of MPI end the program: OpenMPI then
 * ends all ranks. */
#pragma once

#include "mpi/handout.h"
#include "mpi/wire.h"

/* What traces the tiles of one rank. No function waits but `wait`. */
typedef struct tracing {
    int threads; /* 0: it traces nothing */
    void *of;
    void (*give)(void *of, const int32_t *tiles, int count);
    piece_message *(*take)(void *of); /* a finished piece, or NULL */
    void (*end)(void *of);            /* no more tiles follow */
    void (*stop)(void *of);           /* the frame is given up */
    bool (*over)(void *of);           /* it traces nothing any more, and all its pieces were taken */
    /* Waits for a finished piece or a message, or a short time. idle: the number of calls since anything happened. */
    void (*wait)(void *of, int idle);
} tracing;

/* What rank 0 does with what arrives. */
typedef struct frame_sink {
    void *of;
    /* Takes a piece's sums and variances; the message is the callee's. */
    void (*piece)(void *of, piece_message *piece);
    /* Takes a rank's report and its workers' reports. */
    void (*report)(void *of, int rank, const rank_report *report, const worker_report *workers);
    /* Called often. */
    void (*progress)(void *of, double share_done);
} frame_sink;

/* Bytes that moved, for the account. */
typedef struct traffic {
    uint64_t pieces, piece_bytes, messages;
} traffic;

/* Rank 0: hands out all tiles, and returns when all pieces and the reports of all other ranks have arrived. Cancelling
 * its thread gives the frame up: then it returns after the reports. */
void messenger_serve(int64_t frame, int ranks, handout *tiles, const tracing *own, const frame_sink *sink,
                     traffic *moved);

/* Another rank: passes tiles and pieces until its tracing is over. */
void messenger_work(int64_t frame, const tracing *own, traffic *moved);
