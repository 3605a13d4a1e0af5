/* Memory and batches of a ray queue. */
#include "render/tracer/queue.h"

#include <stdlib.h>
#include <string.h>

enum { FIELDS = 17, LINE = 64, LANES = LANES_MAX };

/* The length of each field, in values. The additional LANES keep it from being a multiple of 1024 bytes: see ROW. */
static size_t length_of(int capacity)
{
    return ((size_t)capacity + LANES - 1) / LANES * LANES + LANES;
}

size_t queue_bytes(int capacity)
{
    return FIELDS * length_of(capacity) * sizeof(double);
}

bool queue_create(ray_queue *q, int capacity)
{
    memset(q, 0, sizeof *q);
    const size_t length = length_of(capacity);
    char *memory = aligned_alloc(LINE, queue_bytes(capacity));
    if (!memory)
        return false;
    double **reals[] = {&q->ox, &q->oy, &q->oz, &q->dx, &q->dy, &q->dz, &q->wr, &q->wg, &q->wb};
    double *at = (double *)(void *)memory;
    for (size_t i = 0; i < sizeof reals / sizeof *reals; i++, at += length)
        *reals[i] = at;
    q->start = (int64_t *)(void *)at;
    q->sample_key = (int64_t *)(void *)(at + length);
    q->inside = (uint64_t *)(void *)(at + 2 * length);
    q->sq = at + 3 * length, q->su = at + 4 * length, q->sv = at + 5 * length;
    q->passed = at + 6 * length, q->bent = at + 7 * length;
    q->lamp_q = q->passed, q->lamp_u = q->bent;
    q->memory = memory;
    q->capacity = capacity;
    return true;
}

bool queue_add_footprints(ray_queue *q)
{
    return q->footprint || (q->footprint = malloc((size_t)q->capacity * sizeof *q->footprint));
}

void queue_destroy(ray_queue *q)
{
    free(q->memory);
    free(q->footprint);
    memset(q, 0, sizeof *q);
}

ray_batch queue_pop(ray_queue *q, int *first)
{
    int from = q->count > BATCH ? (q->count - BATCH + LANES - 1) / LANES * LANES : 0;
    ray_batch b = {q->count - from, q->ox + from, q->oy + from,    q->oz + from,    q->dx + from,
                   q->dy + from,    q->dz + from, q->start + from, q->inside + from};
    q->count = from;
    *first = from;
    return b;
}
