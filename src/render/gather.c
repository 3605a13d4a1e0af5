#include "render/shade.h"

void group_gather(const ray_queue *q, int first, const hit_batch *hits, const double *ior, const int *list, int count, group *g)
{
    g->count = count;
    g->padded = (count + LANES_MAX - 1) / LANES_MAX * LANES_MAX;
    for (int k = 0; k < g->padded; k++) {
        const int i = list[k < count ? k : count - 1], from = first + i;
        g->ox[k] = q->ox[from], g->oy[k] = q->oy[from], g->oz[k] = q->oz[from];
        g->dx[k] = q->dx[from], g->dy[k] = q->dy[from], g->dz[k] = q->dz[from];
        g->wr[k] = q->wr[from], g->wg[k] = q->wg[from], g->wb[k] = q->wb[from];
        g->start[k] = q->start[from], g->pixel[k] = q->pixel[from];
        g->t[k] = hits->t[i];
        g->n_from[k] = ior[hits->before[i]];
        g->n_to[k] = ior[hits->after[i]];
        g->inside_before[k] = hits->inside_before[i];
        g->inside_after[k] = hits->inside_after[i];
    }
}
