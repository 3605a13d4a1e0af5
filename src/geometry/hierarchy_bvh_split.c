/* One split of the bvh builder: bins, the cheapest split plane, the partition, and the median split. */
#include "geometry/hierarchy_bvh.h"

/* Just below 1, so that the last centre is in the last bin and not beyond it, whatever the rounding. */
#define BELOW_ONE 0.99999f
#define FLAT 1e-30f /* centres within this distance coincide: the width of a bin could not be inverted */

static bvh_range empty_range(uint32_t first)
{
    bvh_range r = {.box = bvh_box_empty(), .centers = bvh_box_empty(), .first = first};
    return r;
}

/* Uses fewer bins for few references: more bins than references would distinguish nothing. */
void bvh_bins_begin(bvh_bins *s, const bvh_range *range)
{
    uint32_t wanted = 4 + range->count / 8;
    s->count = wanted < BINS_MAX ? (int)wanted : BINS_MAX;
    for (int axis = 0; axis < 3; axis++) {
        float extent = range->centers.high[axis] - range->centers.low[axis];
        s->base[axis] = range->centers.low[axis];
        s->scale[axis] = extent > FLAT ? BELOW_ONE * (float)s->count / extent : 0.0f;
        for (int i = 0; i < s->count; i++) {
            s->box[axis][i] = bvh_box_empty();
            s->members[axis][i] = 0;
        }
    }
    s->base[3] = s->scale[3] = 0.0f;
}

static void bins_of(const bvh_bins *s, const bvh_ref *r, int32_t bin[4])
{
    for (int k = 0; k < 4; k++)
        bin[k] = (int32_t)((r->low[k] + r->high[k] - s->base[k]) * s->scale[k]);
}

void bvh_bins_fill(bvh_bins *s, const bvh_ref *refs, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        int32_t bin[4];
        bins_of(s, &refs[i], bin);
        for (int axis = 0; axis < 3; axis++) {
            bvh_box_add(&s->box[axis][bin[axis]], refs[i].low, refs[i].high);
            s->members[axis][bin[axis]]++;
        }
    }
}

static float blocks_of(uint32_t triangles)
{
    return (float)((triangles + BLOCK - 1) / BLOCK);
}

/* The cheapest split along one axis: sum over the halves of area times blocks (MacDonald and Booth 1990). */
static void best_of_axis(const bvh_bins *s, int axis, bvh_cut *best)
{
    float above[BINS_MAX];
    bvh_box box = bvh_box_empty();
    uint32_t members = 0;
    for (int i = s->count - 1; i > 0; i--) {
        bvh_box_add(&box, s->box[axis][i].low, s->box[axis][i].high);
        members += s->members[axis][i];
        above[i] = members ? bvh_half_area(box.low, box.high) * blocks_of(members) : INFINITY;
    }
    box = bvh_box_empty();
    members = 0;
    for (int i = 1; i < s->count; i++) {
        bvh_box_add(&box, s->box[axis][i - 1].low, s->box[axis][i - 1].high);
        members += s->members[axis][i - 1];
        float cost = members ? bvh_half_area(box.low, box.high) * blocks_of(members) + above[i] : INFINITY;
        if (cost < best->cost)
            *best = (bvh_cut){axis, i, cost};
    }
}

static void exchange(bvh_ref *a, bvh_ref *b)
{
    bvh_ref t = *a;
    *a = *b;
    *b = t;
}

/* Lomuto's partition, which needs no unpredictable branch. */
uint32_t bvh_part(bvh_ref *refs, size_t count, const bvh_bins *s, bvh_cut cut, bvh_box centers[2])
{
    int axis = cut.axis;
    float base = s->base[axis], scale = s->scale[axis];
    bvh_box bounds[2] = {bvh_box_empty(), bvh_box_empty()};
    uint32_t lower = 0;
    for (size_t i = 0; i < count; i++) {
        bvh_ref r = refs[i];
        float center[4];
        for (int k = 0; k < 4; k++)
            center[k] = r.low[k] + r.high[k];
        int32_t upper = (int32_t)((center[axis] - base) * scale) >= cut.bin;
        bvh_box_add(&bounds[upper], center, center);
        refs[i] = refs[lower];
        refs[lower] = r;
        lower += 1u - (uint32_t)upper;
    }
    centers[0] = bounds[0];
    centers[1] = bounds[1];
    return lower;
}

void bvh_describe_halves(const bvh_range *range, const bvh_bins *s, bvh_cut cut, uint32_t lower,
                         const bvh_box centers[2], bvh_range half[2])
{
    half[0] = (bvh_range){bvh_box_empty(), centers[0], range->first, lower};
    half[1] = (bvh_range){bvh_box_empty(), centers[1], range->first + lower, range->count - lower};
    for (int i = 0; i < s->count; i++)
        bvh_box_add(&half[i >= cut.bin].box, s->box[cut.axis][i].low, s->box[cut.axis][i].high);
}

/* A total order: by centre, then by number. */
static bool before(const bvh_ref *a, const bvh_ref *b, int axis)
{
    float x = a->low[axis] + a->high[axis], y = b->low[axis] + b->high[axis];
    return x < y || (x == y && bvh_triangle(a) < bvh_triangle(b));
}

/* Hoare's selection: afterwards refs[0 .. middle-1] come before the others. */
static void select_lower(bvh_ref *refs, size_t count, size_t middle, int axis)
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
        bvh_ref pivot = refs[center];
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

void bvh_split_at_median(bvh_ref *refs, const bvh_range *range, bvh_range half[2])
{
    int axis = 0;
    float widest = -1.0f;
    for (int k = 0; k < 3; k++) {
        float extent = range->centers.high[k] - range->centers.low[k];
        if (extent > widest) {
            widest = extent;
            axis = k;
        }
    }
    uint32_t lower = range->count / 2;
    bvh_ref *own = refs + range->first;
    select_lower(own, range->count, lower, axis);
    half[0] = empty_range(range->first);
    half[1] = empty_range(range->first + lower);
    half[0].count = lower;
    half[1].count = range->count - lower;
    for (uint32_t i = 0; i < range->count; i++)
        bvh_range_add(&half[i >= lower], &own[i]);
}

/* Levels that median splits need down to single triangles. */
static int median_levels(uint32_t count)
{
    return count > 1 ? 32 - __builtin_clz(count - 1) : 0;
}

bool bvh_may_bin(const bvh_range *range, int depth)
{
    return depth + median_levels(range->count) < BRANCH_DEPTH_MAX;
}

bool bvh_cheapest(const bvh_bins *s, bvh_cut *cut)
{
    *cut = (bvh_cut){-1, 0, INFINITY};
    for (int axis = 0; axis < 3; axis++)
        if (s->scale[axis] > 0.0f)
            best_of_axis(s, axis, cut);
    return cut->axis >= 0 && cut->cost > 0.0f; /* with boxes of zero area no split is better than another */
}

void bvh_split(bvh_ref *refs, const bvh_range *range, int depth, bvh_range half[2])
{
    if (bvh_may_bin(range, depth)) {
        bvh_bins s;
        bvh_cut cut;
        bvh_bins_begin(&s, range);
        bvh_bins_fill(&s, refs + range->first, range->count);
        if (bvh_cheapest(&s, &cut)) {
            bvh_box centers[2];
            uint32_t lower = bvh_part(refs + range->first, range->count, &s, cut, centers);
            bvh_describe_halves(range, &s, cut, lower, centers, half);
            return;
        }
    }
    bvh_split_at_median(refs, range, half);
}
