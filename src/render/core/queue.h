/* Rays that wait to be traced, as a structure of arrays; last in, first out, so that what waits stays small.
 * Ownership: queue_create gives, queue_destroy releases; one worker's own. */
#pragma once

#include "geometry/rays.h"
#include <stdbool.h>

typedef struct ray_queue {
    int count, capacity;
    double *ox, *oy, *oz, *dx, *dy, *dz;
    double *wr, *wg, *wb;        /* throughput; of a shadow ray the radiance that it brings if nothing is in the way */
    int64_t *start, *sample_key; /* face it starts on; render/core/sample_key.h */
    uint64_t *inside;
    double *sq, *su, *sv; /* with polarisation: the analyser's Stokes vector relative to its first element */
    void *memory;
} ray_queue;

bool queue_create(ray_queue *q, int capacity);
void queue_destroy(ray_queue *q);

/* Takes a batch off the end: at most BATCH rays, as many as leave the rest a multiple of the widest vector long. The
 * view holds until rays are added. */
ray_batch queue_take(ray_queue *q, int *first);

/* Moves record from into record to. */
static inline void queue_move(ray_queue *q, int to, int from)
{
    q->ox[to] = q->ox[from], q->oy[to] = q->oy[from], q->oz[to] = q->oz[from];
    q->dx[to] = q->dx[from], q->dy[to] = q->dy[from], q->dz[to] = q->dz[from];
    q->wr[to] = q->wr[from], q->wg[to] = q->wg[from], q->wb[to] = q->wb[from];
    q->start[to] = q->start[from], q->sample_key[to] = q->sample_key[from], q->inside[to] = q->inside[from];
}

/* And its Stokes vector. */
static inline void queue_move_polarised(ray_queue *q, int to, int from)
{
    queue_move(q, to, from);
    q->sq[to] = q->sq[from], q->su[to] = q->su[from], q->sv[to] = q->sv[from];
}
