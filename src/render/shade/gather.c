/* Gathering the rays that hit one surface into a group. */
#include "render/shade/shade.h"

#include <string.h>

/* A group that is contiguous in the batch, as when a whole batch hits the ground. */
static void gather_segment(const ray_queue *q, int from, const hit_batch *hits, int i, group *g)
{
    const size_t bytes = (size_t)g->count * sizeof(double);
    memcpy(g->ox, q->ox + from, bytes), memcpy(g->oy, q->oy + from, bytes), memcpy(g->oz, q->oz + from, bytes);
    memcpy(g->dx, q->dx + from, bytes), memcpy(g->dy, q->dy + from, bytes), memcpy(g->dz, q->dz + from, bytes);
    memcpy(g->wr, q->wr + from, bytes), memcpy(g->wg, q->wg + from, bytes), memcpy(g->wb, q->wb + from, bytes);
    memcpy(g->start, q->start + from, bytes), memcpy(g->sample_key, q->sample_key + from, bytes);
    memcpy(g->t, hits->t + i, bytes);
    memcpy(g->inside_before, hits->inside_before + i, bytes), memcpy(g->inside_after, hits->inside_after + i, bytes);
}

static void gather_one(const ray_queue *q, int from, const hit_batch *hits, int i, group *g, int k)
{
    g->ox[k] = q->ox[from], g->oy[k] = q->oy[from], g->oz[k] = q->oz[from];
    g->dx[k] = q->dx[from], g->dy[k] = q->dy[from], g->dz[k] = q->dz[from];
    g->wr[k] = q->wr[from], g->wg[k] = q->wg[from], g->wb[k] = q->wb[from];
    g->start[k] = q->start[from], g->sample_key[k] = q->sample_key[from];
    g->t[k] = hits->t[i];
    g->inside_before[k] = hits->inside_before[i];
    g->inside_after[k] = hits->inside_after[i];
}

void group_gather(const ray_queue *q, int first, const hit_batch *hits, const double *ior, const int *list, int count,
                  bool ascending, group *g)
{
    const int last = list[count - 1], before = list[0];
    g->count = count;
    g->padded = (count + LANES_MAX - 1) / LANES_MAX * LANES_MAX;
    const bool whole = ascending && last - before == count - 1;
    if (whole)
        gather_segment(q, first + before, hits, before, g);
    for (int k = 0; k < count && !whole; k++)
        gather_one(q, first + list[k], hits, list[k], g, k);
    for (int k = count; k < g->padded; k++)
        gather_one(q, first + last, hits, last, g, k);
    for (int k = 0; k < g->padded; k++) {
        const int i = list[k < count ? k : count - 1];
        g->n_from[k] = ior[hits->before[i]];
        g->n_to[k] = ior[hits->after[i]];
    }
}
