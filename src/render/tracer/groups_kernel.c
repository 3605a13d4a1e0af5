/* Lists the groups of a batch's rays, gathers the rays of groups, and sends out new rays from their points. Compiled
 * once for each instruction set. */
#include "render/tracer/groups.h"

#include "base/lanes.h"
#include "geometry/hierarchy/simd.h"

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

static void list_groups(const hit_batch *hits, int count, const int *shading_class, int16_t *marks,
                        int16_t *class_marks, hit_groups *out)
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

/* --- gathering and sending out --- */

/* Rays are copied four at a time; what is copied past the end of a run, the next run or the padding overwrites, or it
 * lies past the end of the queue. */
enum { COPIED = 4 };

/* The lanes of a vector of doubles. */
#if defined __AVX512F__
enum { LANES = 8 };
#elif defined __AVX2__
enum { LANES = 4 };
#else
enum { LANES = 2 };
#endif

/* The number of neighbours from the start of the list. */
ALWAYS_INLINE int run_length(const int *list, int count, bool ascending)
{
    int length = 1;
    if (ascending && list[count - 1] == list[0] + count - 1)
        return count;
    while (length < count && list[length] == list[0] + length)
        length++;
    return length;
}

ALWAYS_INLINE void copy_four(void *to, const void *from)
{
    double4 four;
    memcpy(&four, from, sizeof four);
    memcpy(to, &four, sizeof four);
}

ALWAYS_INLINE void gather_run(const ray_queue *q, const hit_batch *hits, int from, int i, int count, group *g, int to)
{
    for (int end = to + count; to < end; from += COPIED, i += COPIED, to += COPIED) {
        copy_four(g->ox + to, q->ox + from), copy_four(g->oy + to, q->oy + from), copy_four(g->oz + to, q->oz + from);
        copy_four(g->dx + to, q->dx + from), copy_four(g->dy + to, q->dy + from), copy_four(g->dz + to, q->dz + from);
        copy_four(g->wr + to, q->wr + from), copy_four(g->wg + to, q->wg + from), copy_four(g->wb + to, q->wb + from);
        copy_four(g->start + to, q->start + from), copy_four(g->sample_key + to, q->sample_key + from);
        copy_four(g->t + to, hits->t + i);
        copy_four(g->inside_before + to, hits->inside_before + i);
        copy_four(g->inside_after + to, hits->inside_after + i);
    }
}

/* Repeats a row's last value in a vector after it. */
ALWAYS_INLINE void pad(double *row, int count)
{
    const double last = row[count - 1];
    for (int k = 0; k < LANES; k++)
        row[count + k] = last;
}

ALWAYS_INLINE void pad_whole(int64_t *row, int count)
{
    const int64_t last = row[count - 1];
    for (int k = 0; k < LANES; k++)
        row[count + k] = last;
}

static void pad_group(group *g)
{
    const int count = g->count;
    pad(g->ox, count), pad(g->oy, count), pad(g->oz, count), pad(g->dx, count), pad(g->dy, count), pad(g->dz, count);
    pad(g->wr, count), pad(g->wg, count), pad(g->wb, count), pad(g->t, count);
    pad(g->n_from, count), pad(g->n_to, count);
    pad_whole(g->start, count), pad_whole(g->sample_key, count);
    pad_whole((int64_t *)g->inside_before, count), pad_whole((int64_t *)g->inside_after, count);
}

static void gather(const ray_queue *queue, int first, const hit_batch *hits, const double *ior, const int *list,
                   int count, bool ascending, group *g)
{
    const ray_queue q = *queue;
    for (int k = 0, run; k < count; k += run) {
        run = run_length(list + k, count - k, ascending);
        gather_run(&q, hits, first + list[k], list[k], run, g, k);
        for (int i = 0; i < run; i++) {
            g->n_from[k + i] = ior[hits->before[list[k] + i]];
            g->n_to[k + i] = ior[hits->after[list[k] + i]];
        }
    }
    g->count = count;
    g->padded = (count + LANES - 1) / LANES * LANES;
    if (g->padded > count)
        pad_group(g);
}

ALWAYS_INLINE void append_four(const group *g, const new_rays *n, bool weighted, int i, ray_queue *q, int at)
{
    const surface_batch *p = &g->points;
    copy_four(q->ox + at, p->px + i), copy_four(q->oy + at, p->py + i), copy_four(q->oz + at, p->pz + i);
    copy_four(q->dx + at, n->dx + i), copy_four(q->dy + at, n->dy + i), copy_four(q->dz + at, n->dz + i);
    copy_four(q->start + at, p->face + i), copy_four(q->sample_key + at, n->sample_key + i);
    copy_four(q->inside + at, n->inside + i);
    if (!weighted) {
        copy_four(q->wr + at, n->r + i), copy_four(q->wg + at, n->g + i), copy_four(q->wb + at, n->b + i);
        return;
    }
    double r[COPIED], gr[COPIED], b[COPIED];
    for (int k = 0; k < COPIED; k++) {
        r[k] = n->r[i + k] * n->weight[i + k];
        gr[k] = n->g[i + k] * n->weight[i + k];
        b[k] = n->b[i + k] * n->weight[i + k];
    }
    copy_four(q->wr + at, r), copy_four(q->wg + at, gr), copy_four(q->wb + at, b);
}

/* Lists the lanes whose mask is not 0; returns their number. */
ALWAYS_INLINE int list_lanes(const int64_t *mask, int lanes, int *restrict list)
{
    int64_t all = -1;
    int count = 0;
    /* VECTORISE */
    for (int i = 0; i < lanes; i++)
        all &= mask[i];
    if (all)
        for (; count < lanes; count++)
            list[count] = count;
    else
        for (int i = 0; i < lanes; i++) {
            list[count] = i;
            count -= (int)mask[i];
        }
    return count;
}

/* In runs of neighbours. */
ALWAYS_INLINE void append_listed(const group *g, const new_rays *rays, bool weighted, const int *list, int count,
                                 const ray_queue *queue)
{
    ray_queue q = *queue;
    const new_rays n = *rays;
    for (int k = 0, run; k < count; k += run) {
        run = run_length(list + k, count - k, true);
        for (int done = 0; done < run; done += COPIED)
            append_four(g, &n, weighted, list[k] + done, &q, q.count + k + done);
    }
}

static int append(const group *g, const new_rays *n, int *restrict list, ray_queue *q)
{
    const int lanes = g->count;
    const double *weight = n->weight;
    int64_t exists[ROW];
    if (!n->exists)
        /* VECTORISE */
        for (int i = 0; i < lanes; i++)
            exists[i] = -(int64_t)(weight[i] != 0.0);
    const int count = list_lanes(n->exists ? n->exists : exists, lanes, list);
    if (n->weight)
        append_listed(g, n, true, list, count, q);
    else
        append_listed(g, n, false, list, count, q);
    q->count += count;
    return count;
}

const group_kernels KERNEL(group_kernels) = {list_groups, gather, append};
