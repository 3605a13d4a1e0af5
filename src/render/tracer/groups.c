/* Lists the groups of a batch's rays, and gathers the rays of groups. */
#include "render/tracer/groups.h"

#include <string.h>

/* The batch's rays by group, as lists of runs: neighbours in the batch often belong to one group. */
typedef struct linked_groups {
    int count, runs;
    int hit_primitive[BATCH], priority_index[BATCH];
    int16_t head[BATCH], tail[BATCH]; /* runs */
    int16_t next_same[BATCH];         /* another group of the same primitive, on another surface; -1 for none */
    int16_t start[BATCH], length[BATCH], next[BATCH]; /* of each run: its rays, and the next run of its group or -1 */
} linked_groups;

static int new_group(linked_groups *l, int hit_primitive, int priority_index, int run)
{
    const int g = l->count++;
    l->hit_primitive[g] = hit_primitive;
    l->priority_index[g] = priority_index;
    l->head[g] = l->tail[g] = (int16_t)run;
    l->next_same[g] = -1;
    return g;
}

/* Adds a run of rays to its group. */
static void add_run(linked_groups *l, int16_t *marks, int hit_primitive, int priority_index, int start, int length)
{
    const int run = l->runs++;
    l->start[run] = (int16_t)start;
    l->length[run] = (int16_t)length;
    l->next[run] = -1;
    int g = marks[hit_primitive];
    if (g < 0) {
        marks[hit_primitive] = (int16_t)new_group(l, hit_primitive, priority_index, run);
        return;
    }
    while (l->priority_index[g] != priority_index && l->next_same[g] >= 0)
        g = l->next_same[g];
    if (l->priority_index[g] != priority_index) {
        l->next_same[g] = (int16_t)new_group(l, hit_primitive, priority_index, run);
        return;
    }
    l->next[l->tail[g]] = (int16_t)run;
    l->tail[g] = (int16_t)run;
}

static void write_group(const linked_groups *l, int g, hit_groups *out, int *written)
{
    const int first = *written;
    int to = first;
    for (int run = l->head[g]; run >= 0; run = l->next[run])
        for (int k = 0; k < l->length[run]; k++)
            out->list[to++] = l->start[run] + k;
    out->group[out->count++] = (hit_group){l->hit_primitive[g], l->priority_index[g], first, to - first};
    *written = to;
}

/* Writes the groups so that groups of one shading class are neighbours: each group is linked to the next of its
 * class. */
static void write_groups(const linked_groups *l, const int *shading_class, int16_t *class_marks, hit_groups *out)
{
    int16_t next[BATCH], last[BATCH];
    int written = 0;
    out->count = 0;
    for (int g = 0; g < l->count; g++) {
        int16_t *mark = &class_marks[shading_class[l->priority_index[g]]];
        next[g] = -1;
        if (*mark < 0)
            *mark = (int16_t)g;
        else
            next[last[*mark]] = (int16_t)g;
        last[*mark] = (int16_t)g;
    }
    for (int g = 0; g < l->count; g++) {
        int16_t *mark = &class_marks[shading_class[l->priority_index[g]]];
        if (*mark != g)
            continue;
        for (int k = g; k >= 0; k = next[k])
            write_group(l, k, out, &written);
        *mark = -1;
    }
}

void hit_groups_make(const hit_batch *hits, int count, const int *shading_class, int16_t *marks, int16_t *class_marks,
                     hit_groups *out)
{
    linked_groups l;
    l.count = l.runs = 0;
    out->missed = 0;
    for (int i = 0; i < count;) {
        const int64_t p = hits->hit_primitive[i], surface = hits->surface[i];
        const int start = i;
        if (p < 0) {
            out->miss[out->missed++] = i++;
            continue;
        }
        do
            i++;
        while (i < count && hits->hit_primitive[i] == p && hits->surface[i] == surface);
        add_run(&l, marks, (int)p, (int)surface, start, i - start);
    }
    for (int g = 0; g < l.count; g++)
        marks[l.hit_primitive[g]] = -1;
    write_groups(&l, shading_class, class_marks, out);
}

/* --- gathering --- */

/* Gathers a group that is contiguous in the batch, for example if all rays hit the ground. */
static void gather_contiguous(const ray_queue *q, int from, const hit_batch *hits, int i, group *g)
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
    const bool contiguous = ascending && last - before == count - 1;
    if (contiguous)
        gather_contiguous(q, first + before, hits, before, g);
    for (int k = 0; k < count && !contiguous; k++)
        gather_one(q, first + list[k], hits, list[k], g, k);
    for (int k = count; k < g->padded; k++)
        gather_one(q, first + last, hits, last, g, k);
    for (int k = 0; k < g->padded; k++) {
        const int i = list[k < count ? k : count - 1];
        g->n_from[k] = ior[hits->before[i]];
        g->n_to[k] = ior[hits->after[i]];
    }
}
