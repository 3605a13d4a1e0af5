/* One split of a large range by all threads together. */
#include "base/cancel.h"
#include "geometry/hierarchy_bvh.h"

#include <stdlib.h>

/* References per task of a large range: twice a range that a single thread builds (TASK_TRIANGLES). */
enum { PIECE = 16384 };

typedef struct piece {
    bvh_bins bins;
    bvh_box centers[2];
    uint32_t lower;
} piece;

typedef struct job {
    bvh_ref *refs; /* the range's own */
    uint32_t count, lower;
    bvh_bins bins;
    bvh_cut cut;
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
    bvh_bins *own = &j->pieces[index].bins;
    *own = j->bins;
    bvh_bins_fill(own, j->refs + index * PIECE, piece_count(j, index));
}

static void part_piece(void *context, size_t index, int member)
{
    (void)member;
    job *j = context;
    piece *p = &j->pieces[index];
    p->lower = bvh_part(j->refs + index * PIECE, piece_count(j, index), &j->bins, j->cut, p->centers);
}

static void add_bins(bvh_bins *sum, const bvh_bins *s)
{
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < sum->count; i++) {
            bvh_box_add(&sum->box[axis][i], s->box[axis][i].low, s->box[axis][i].high);
            sum->members[axis][i] += s->members[axis][i];
        }
}

/* Joins the partitions of the pieces. Each piece holds its lower references, then its upper ones. Upper ones before the
 * end of all lower ones are swapped with the lower ones after it; both have the same number. */
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
        bvh_ref t = j->refs[upper];
        j->refs[upper++] = j->refs[--lower];
        j->refs[lower] = t;
    }
}

status bvh_split_together(thread_team *t, bvh_ref *refs, const bvh_range *range, int depth, bvh_range half[2],
                          diagnostic *why)
{
    size_t pieces = (range->count + (size_t)PIECE - 1) / PIECE;
    if (thread_team_size(t) == 1 || pieces < 2 || !bvh_may_bin(range, depth)) {
        bvh_split(refs, range, depth, half);
        return STATUS_OK;
    }
    job j = {.refs = refs + range->first, .count = range->count};
    j.pieces = aligned_alloc(64, (pieces * sizeof *j.pieces + 63) / 64 * 64);
    if (!j.pieces)
        return out_of_memory(why);
    bvh_bins_begin(&j.bins, range);
    thread_team_run(t, fill_piece, &j, pieces);
    for (size_t i = 0; i < pieces; i++)
        add_bins(&j.bins, &j.pieces[i].bins);
    if (bvh_cheapest(&j.bins, &j.cut)) {
        thread_team_run(t, part_piece, &j, pieces);
        bvh_box centers[2] = {bvh_box_empty(), bvh_box_empty()};
        for (size_t i = 0; i < pieces; i++) {
            j.lower += j.pieces[i].lower;
            for (int k = 0; k < 2; k++)
                bvh_box_add(&centers[k], j.pieces[i].centers[k].low, j.pieces[i].centers[k].high);
        }
        join_partitions(&j, pieces);
        bvh_describe_halves(range, &j.bins, j.cut, j.lower, centers, half);
    } else {
        bvh_split_at_median(refs, range, half);
    }
    free(j.pieces);
    return STATUS_OK;
}
