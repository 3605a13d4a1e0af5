/* One split of the bvh builder: bins, the cheapest split plane, the partition, and the median split. A thread team
 * splits large ranges. Names as in pbrt-v4 (7.3.2) and Embree. */
#include "base/cancel.h"
#include "geometry/hierarchy/bvh.h"
#include <stdlib.h>

enum { BINS_MAX = 16 };

/* Bins of a range's references by their centres, along each axis. */
typedef struct bvh_bins {
    int count;
    float base[4], scale[4]; /* bin = (doubled centroid - base) scale; scale is 0 if all centres coincide */
    bvh_box bounds[3][BINS_MAX];
    uint32_t counts[3][BINS_MAX];
} bvh_bins;

/* A split plane: bins below `bin` are the first half. cost: sum of area times blocks over both halves. */
typedef struct sah_split {
    int axis, bin;
    float cost;
} sah_split;

/* Just below 1, so that the last centre is in the last bin and not beyond it, whatever the rounding. */
#define BELOW_ONE 0.99999f
#define FLAT 1e-30f /* centres within this distance coincide: the width of a bin could not be inverted */

static prim_range empty_range(uint32_t first)
{
    prim_range r = {.bounds = bvh_box_empty(), .centroid_bounds = bvh_box_empty(), .first = first};
    return r;
}

/* Uses fewer bins for few references: more bins than references would distinguish nothing. */
static void bins_begin(bvh_bins *s, const prim_range *range)
{
    uint32_t wanted = 4 + range->count / 8;
    s->count = wanted < BINS_MAX ? (int)wanted : BINS_MAX;
    for (int axis = 0; axis < 3; axis++) {
        float extent = range->centroid_bounds.high[axis] - range->centroid_bounds.low[axis];
        s->base[axis] = range->centroid_bounds.low[axis];
        s->scale[axis] = extent > FLAT ? BELOW_ONE * (float)s->count / extent : 0.0f;
        for (int i = 0; i < s->count; i++) {
            s->bounds[axis][i] = bvh_box_empty();
            s->counts[axis][i] = 0;
        }
    }
    s->base[3] = s->scale[3] = 0.0f;
}

static void bins_of(const bvh_bins *s, const prim_ref *r, int32_t bin[4])
{
    for (int k = 0; k < 4; k++)
        bin[k] = (int32_t)((r->low[k] + r->high[k] - s->base[k]) * s->scale[k]);
}

static void bins_fill(bvh_bins *s, const prim_ref *refs, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        int32_t bin[4];
        bins_of(s, &refs[i], bin);
        for (int axis = 0; axis < 3; axis++) {
            bvh_box_extend(&s->bounds[axis][bin[axis]], refs[i].low, refs[i].high);
            s->counts[axis][bin[axis]]++;
        }
    }
}

static float blocks_of(uint32_t triangles)
{
    return (float)((triangles + BLOCK - 1) / BLOCK);
}

/* The cheapest split along one axis: sum over the halves of area times blocks (MacDonald and Booth 1990). */
static void min_cost_split_of_axis(const bvh_bins *s, int axis, sah_split *best)
{
    float above[BINS_MAX];
    bvh_box box = bvh_box_empty();
    uint32_t counts = 0;
    for (int i = s->count - 1; i > 0; i--) {
        bvh_box_extend(&box, s->bounds[axis][i].low, s->bounds[axis][i].high);
        counts += s->counts[axis][i];
        above[i] = counts ? bvh_half_area(box.low, box.high) * blocks_of(counts) : INFINITY;
    }
    box = bvh_box_empty();
    counts = 0;
    for (int i = 1; i < s->count; i++) {
        bvh_box_extend(&box, s->bounds[axis][i - 1].low, s->bounds[axis][i - 1].high);
        counts += s->counts[axis][i - 1];
        float cost = counts ? bvh_half_area(box.low, box.high) * blocks_of(counts) + above[i] : INFINITY;
        if (cost < best->cost)
            *best = (sah_split){axis, i, cost};
    }
}

static void exchange(prim_ref *a, prim_ref *b)
{
    prim_ref t = *a;
    *a = *b;
    *b = t;
}

/* Moves the references of the first half to the front and returns their number. centroid_bounds: of each half. Lomuto's
 * partition, which needs no unpredictable branch. */
static uint32_t partition(prim_ref *refs, size_t count, const bvh_bins *s, sah_split split, bvh_box centroid_bounds[2])
{
    int axis = split.axis;
    float base = s->base[axis], scale = s->scale[axis];
    bvh_box bounds[2] = {bvh_box_empty(), bvh_box_empty()};
    uint32_t lower = 0;
    for (size_t i = 0; i < count; i++) {
        prim_ref r = refs[i];
        float center[4];
        for (int k = 0; k < 4; k++)
            center[k] = r.low[k] + r.high[k];
        int32_t upper = (int32_t)((center[axis] - base) * scale) >= split.bin;
        bvh_box_extend(&bounds[upper], center, center);
        refs[i] = refs[lower];
        refs[lower] = r;
        lower += 1u - (uint32_t)upper;
    }
    centroid_bounds[0] = bounds[0];
    centroid_bounds[1] = bounds[1];
    return lower;
}

static void find_halves(const prim_range *range, const bvh_bins *s, sah_split split, uint32_t lower,
                        const bvh_box centroid_bounds[2], prim_range half[2])
{
    half[0] = (prim_range){bvh_box_empty(), centroid_bounds[0], range->first, lower};
    half[1] = (prim_range){bvh_box_empty(), centroid_bounds[1], range->first + lower, range->count - lower};
    for (int i = 0; i < s->count; i++)
        bvh_box_extend(&half[i >= split.bin].bounds, s->bounds[split.axis][i].low, s->bounds[split.axis][i].high);
}

/* A total order: by centre, then by number. */
static bool before(const prim_ref *a, const prim_ref *b, int axis)
{
    float x = a->low[axis] + a->high[axis], y = b->low[axis] + b->high[axis];
    return x < y || (x == y && bvh_triangle(a) < bvh_triangle(b));
}

/* Hoare's selection: afterwards refs[0 .. middle-1] come before the others. */
static void select_lower(prim_ref *refs, size_t count, size_t middle, int axis)
{
    size_t low = 0, high = count - 1;
    while (low < high) {
        size_t center = low + (high - low) / 2;
        if (before(&refs[center], &refs[low], axis))
            exchange(&refs[center], &refs[low]);
        if (before(&refs[high], &refs[low], axis))
            exchange(&refs[high], &refs[low]);
        if (before(&refs[high], &refs[center], axis))
            exchange(&refs[high], &refs[center]);
        prim_ref pivot = refs[center];
        size_t i = low, j = high;
        for (;;) {
            while (before(&refs[i], &pivot, axis))
                i++;
            while (before(&pivot, &refs[j], axis))
                j--;
            if (i >= j)
                break;
            exchange(&refs[i++], &refs[j--]);
        }
        if (middle <= j)
            high = j;
        else
            low = j + 1;
    }
}

/* Halves of equal counts, for references that bins cannot separate. */
static void split_at_median(prim_ref *refs, const prim_range *range, prim_range half[2])
{
    int axis = 0;
    float widest = -1.0f;
    for (int k = 0; k < 3; k++) {
        float extent = range->centroid_bounds.high[k] - range->centroid_bounds.low[k];
        if (extent > widest) {
            widest = extent;
            axis = k;
        }
    }
    uint32_t lower = range->count / 2;
    prim_ref *part = refs + range->first;
    select_lower(part, range->count, lower, axis);
    half[0] = empty_range(range->first);
    half[1] = empty_range(range->first + lower);
    half[0].count = lower;
    half[1].count = range->count - lower;
    for (uint32_t i = 0; i < range->count; i++)
        prim_range_extend(&half[i >= lower], &part[i]);
}

/* Levels that median splits need down to single triangles. */
static int median_levels(uint32_t count)
{
    return count > 1 ? 32 - __builtin_clz(count - 1) : 0;
}

/* False if the tree could become too deep. */
static bool may_bin(const prim_range *range, int depth)
{
    return depth + median_levels(range->count) < BUILD_DEPTH_MAX;
}

/* False if the centres coincide along every axis, or if all boxes have no area. */
static bool find_min_cost_split(const bvh_bins *s, sah_split *split)
{
    *split = (sah_split){-1, 0, INFINITY};
    for (int axis = 0; axis < 3; axis++)
        if (s->scale[axis] > 0.0f)
            min_cost_split_of_axis(s, axis, split);
    return split->axis >= 0 && split->cost > 0.0f; /* 0 if all boxes have no area */
}

void bvh_split(prim_ref *refs, const prim_range *range, int depth, prim_range half[2])
{
    if (may_bin(range, depth)) {
        bvh_bins s;
        sah_split split;
        bins_begin(&s, range);
        bins_fill(&s, refs + range->first, range->count);
        if (find_min_cost_split(&s, &split)) {
            bvh_box centroid_bounds[2];
            uint32_t lower = partition(refs + range->first, range->count, &s, split, centroid_bounds);
            find_halves(range, &s, split, lower, centroid_bounds, half);
            return;
        }
    }
    split_at_median(refs, range, half);
}

/* --- by a thread team --- */

/* References per task of a large range: twice a range that a single thread builds (TASK_TRIANGLES). */
enum { PIECE = 16384 };

typedef struct piece {
    bvh_bins bins;
    bvh_box centroid_bounds[2];
    uint32_t lower;
} piece;

typedef struct job {
    prim_ref *refs; /* references of the range */
    uint32_t count, lower;
    bvh_bins bins;
    sah_split split;
    piece *pieces;
} job;

static uint32_t piece_count(const job *j, size_t index)
{
    uint32_t first = (uint32_t)index * PIECE;
    return j->count - first < PIECE ? j->count - first : PIECE;
}

static void fill_piece(void *context, size_t index, int member)
{
    (void)member;
    job *j = context;
    bvh_bins *part = &j->pieces[index].bins;
    *part = j->bins;
    bins_fill(part, j->refs + index * PIECE, piece_count(j, index));
}

static void partition_piece(void *context, size_t index, int member)
{
    (void)member;
    job *j = context;
    piece *p = &j->pieces[index];
    p->lower = partition(j->refs + index * PIECE, piece_count(j, index), &j->bins, j->split, p->centroid_bounds);
}

static void add_bins(bvh_bins *sum, const bvh_bins *s)
{
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < sum->count; i++) {
            bvh_box_extend(&sum->bounds[axis][i], s->bounds[axis][i].low, s->bounds[axis][i].high);
            sum->counts[axis][i] += s->counts[axis][i];
        }
}

/* Joins the partitions of the pieces. Each piece holds its lower references, then its upper ones. Upper ones before
 * j->lower, where the first half ends, are swapped with the lower ones after it; there are as many of both. */
static void join_partitions(const job *j, size_t pieces)
{
    uint32_t upper = 0, lower = j->count, upper_end = 0, lower_begin = j->count; /* empty ranges of both kinds */
    size_t from_front = 0, from_back = pieces;
    for (;;) {
        while (upper == upper_end) {
            if (from_front == pieces)
                return;
            upper = (uint32_t)from_front * PIECE + j->pieces[from_front].lower;
            upper_end = (uint32_t)from_front * PIECE + piece_count(j, from_front);
            from_front++;
        }
        while (lower == lower_begin) {
            if (from_back == 0)
                return;
            from_back--;
            lower_begin = (uint32_t)from_back * PIECE;
            lower = lower_begin + j->pieces[from_back].lower;
        }
        if (upper >= j->lower || lower <= j->lower)
            return;
        prim_ref t = j->refs[upper];
        j->refs[upper++] = j->refs[--lower];
        j->refs[lower] = t;
    }
}

status bvh_split_parallel(thread_team *t, prim_ref *refs, const prim_range *range, int depth, prim_range half[2],
                          diagnostic *why)
{
    size_t pieces = (range->count + (size_t)PIECE - 1) / PIECE;
    if (thread_team_size(t) == 1 || pieces < 2 || !may_bin(range, depth)) {
        bvh_split(refs, range, depth, half);
        return STATUS_OK;
    }
    job j = {.refs = refs + range->first, .count = range->count};
    j.pieces = aligned_alloc(64, (pieces * sizeof *j.pieces + 63) / 64 * 64);
    if (!j.pieces)
        return out_of_memory(why);
    bins_begin(&j.bins, range);
    thread_team_run(t, fill_piece, &j, pieces);
    for (size_t i = 0; i < pieces; i++)
        add_bins(&j.bins, &j.pieces[i].bins);
    if (find_min_cost_split(&j.bins, &j.split)) {
        thread_team_run(t, partition_piece, &j, pieces);
        bvh_box centroid_bounds[2] = {bvh_box_empty(), bvh_box_empty()};
        for (size_t i = 0; i < pieces; i++) {
            j.lower += j.pieces[i].lower;
            for (int k = 0; k < 2; k++)
                bvh_box_extend(&centroid_bounds[k], j.pieces[i].centroid_bounds[k].low,
                               j.pieces[i].centroid_bounds[k].high);
        }
        join_partitions(&j, pieces);
        find_halves(range, &j.bins, j.split, j.lower, centroid_bounds, half);
    } else {
        split_at_median(refs, range, half);
    }
    free(j.pieces);
    return STATUS_OK;
}
