/* The parts of the builder of the hierarchy `bvh`; for src/geometry/hierarchy_bvh*.c alone.
 *
 * Triangles become references, boxes of single precision, and are split in two again and again by the binned
 * surface-area heuristic (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007): a tree of
 * branches. Which of them become leaves and how they are gathered into nodes of eight is then chosen at the least
 * expected cost (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs",
 * 2017, section 3.1).
 *
 * The tree depends on the set of references alone, never on their order: boxes and counts of bins do not, halves are
 * those of a complete order, and a leaf's triangles are sorted. So it is the same for any number of threads. */
#pragma once

#include "geometry/hierarchy_private.h"
#include "base/thread_team.h"

#include <string.h>

/* Binary levels: SAH may use them up to where halving alone stays within. */
enum { BRANCH_DEPTH_MAX = BVH_DEPTH_MAX - 1, LEAF_TRIANGLES_MAX = LEAF_BLOCKS_MAX * BLOCK };

/* The time of a visit to a node (eight boxes), in those of the test of one block. Measured on sets of 50000 triangles:
 * between half and twice this, or with a constant for each leaf, frames take as long or longer. */
#define COST_NODE 1.0f

/* A box of four lanes, of which the first three are axes; the fourth is kept free of slow (denormal) numbers. */
typedef struct bvh_box {
    float low[4] __attribute__((aligned(16))), high[4] __attribute__((aligned(16)));
} bvh_box;

/* A triangle's box; the fourth lane of low holds its number, see bvh_triangle. */
typedef bvh_box bvh_ref;

/* A run of references with its bounds. */
typedef struct bvh_range {
    bvh_box box;
    bvh_box centers; /* of the boxes' centres, doubled: low + high */
    uint32_t first, count;
} bvh_range;

/* A node of the binary tree. */
typedef struct bvh_branch {
    float low[3], high[3];
    uint32_t first, count;
    struct bvh_branch *half[2]; /* NULL where it is not split */
    float cost[WIDTH];          /* [i], i = 1..7: least cost as at most i subtrees */
    uint8_t share[WIDTH + 1];   /* [i], i = 2..8: of i subtrees, the first half's; 0: as for i - 1 */
    bool leaf;                  /* as one subtree */
    uint32_t depth;             /* of the nodes below and at it; with the next two found when the tree is gathered */
    size_t nodes, blocks, leaves;
} bvh_branch;

/* A number that is no denormal as a float. */
static inline float bvh_lane_of(uint32_t triangle)
{
    uint32_t bits = triangle | 0x40000000u;
    float lane;
    memcpy(&lane, &bits, sizeof lane);
    return lane;
}

static inline uint32_t bvh_triangle(const bvh_ref *r)
{
    uint32_t bits;
    memcpy(&bits, &r->low[3], sizeof bits);
    return bits & 0x3fffffffu;
}

/* The largest float that is not above v, and the smallest not below, where |v| is 0 or at least the smallest normal
 * float: bits that a float does not have are cut off, after they were carried over where that is the way outwards. */
#define BVH_CUT_LEAST 0x1p-126
#define BVH_CUT UINT64_C(0x1fffffff)

static inline float bvh_cut_float(double v, uint64_t carried)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    bits = (bits + (carried << 29) - carried) & ~BVH_CUT;
    memcpy(&v, &bits, sizeof v);
    return (float)v;
}

static inline uint64_t bvh_sign(double v)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    return bits >> 63;
}

static inline float bvh_cut_below(double v)
{
    return bvh_cut_float(v, bvh_sign(v));
}
static inline float bvh_cut_above(double v)
{
    return bvh_cut_float(v, 1 - bvh_sign(v));
}

/* The same of any v. */
static inline float bvh_float_below(double v)
{
    if (fabs(v) < BVH_CUT_LEAST)
        return (double)(float)v > v ? nextafterf((float)v, -INFINITY) : (float)v;
    return bvh_cut_below(v);
}

static inline float bvh_float_above(double v)
{
    return -bvh_float_below(-v);
}

static inline bvh_box bvh_box_empty(void)
{
    return (bvh_box){{INFINITY, INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY, -INFINITY}};
}

static inline void bvh_box_add(bvh_box *__restrict b, const float *__restrict low, const float *__restrict high)
{
    for (int k = 0; k < 4; k++)
        b->low[k] = low[k] < b->low[k] ? low[k] : b->low[k];
    for (int k = 0; k < 4; k++)
        b->high[k] = high[k] > b->high[k] ? high[k] : b->high[k];
}

static inline void bvh_range_add(bvh_range *__restrict range, const bvh_ref *__restrict r)
{
    float center[4];
    for (int k = 0; k < 4; k++)
        center[k] = r->low[k] + r->high[k];
    bvh_box_add(&range->box, r->low, r->high);
    bvh_box_add(&range->centers, center, center);
}

static inline float bvh_half_area(const float *low, const float *high)
{
    float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
}

/* The box around a node's children along an axis; slots without a child are empty boxes and change nothing. */
static inline void bvh_around(const bvh_node *n, int axis, float *low, float *high)
{
    float l[WIDTH / 2], g[WIDTH / 2];
    for (int i = 0; i < WIDTH / 2; i++) {
        l[i] = n->low[axis][i] < n->low[axis][i + WIDTH / 2] ? n->low[axis][i] : n->low[axis][i + WIDTH / 2];
        g[i] = n->high[axis][i] > n->high[axis][i + WIDTH / 2] ? n->high[axis][i] : n->high[axis][i + WIDTH / 2];
    }
    for (int i = WIDTH / 4; i > 0; i /= 2)
        for (int k = 0; k < i; k++) {
            l[k] = l[k] < l[k + i] ? l[k] : l[k + i];
            g[k] = g[k] > g[k + i] ? g[k] : g[k + i];
        }
    *low = l[0];
    *high = g[0];
}

enum { BINS_MAX = 16 };

/* A range's references by where their centres lie, along each axis. */
typedef struct bvh_bins {
    int count;
    float base[4], scale[4]; /* bin = (doubled centre - base) scale; scale 0 where all centres are in one place */
    bvh_box box[3][BINS_MAX];
    uint32_t members[3][BINS_MAX];
} bvh_bins;

/* Bins below `bin` are the first half. cost: sum over the halves of area times blocks. */
typedef struct bvh_cut {
    int axis, bin;
    float cost;
} bvh_cut;

/* Splits a range of at least two: reorders its references and describes the halves. depth: of the range's branch, from
 * 0. */
void bvh_split(bvh_ref *refs, const bvh_range *range, int depth, bvh_range half[2]);
/* The same by a team; for ranges so large that it pays. STATUS_FAILURE when memory is out. */
status bvh_split_together(thread_team *t, bvh_ref *refs, const bvh_range *range, int depth, bvh_range half[2],
                          diagnostic *why);

/* The steps of a split. */
bool bvh_may_bin(const bvh_range *range, int depth); /* false where the tree would become too deep */
void bvh_bins_begin(bvh_bins *s, const bvh_range *range);
void bvh_bins_fill(bvh_bins *s, const bvh_ref *refs, size_t count);
bool bvh_cheapest(const bvh_bins *s, bvh_cut *cut); /* false where no cut is better than another */
/* Moves the references of the first half to the front and returns their number; centers: bounds of the halves' doubled
 * centres. */
uint32_t bvh_part(bvh_ref *refs, size_t count, const bvh_bins *s, bvh_cut cut, bvh_box centers[2]);
void bvh_median_halves(const bvh_range *range, const bvh_bins *s, bvh_cut cut, uint32_t lower, const bvh_box centers[2],
                       bvh_range half[2]);
/* Halves of equal counts, for where bins do not help. */
void bvh_split_at_median(bvh_ref *refs, const bvh_range *range, bvh_range half[2]);

/* Cost and shares of a branch from its halves', when those are known. */
void bvh_choose(bvh_branch *b);

/* A binary tree, and the memory of its branches, of each member of a team its own. */
typedef struct bvh_store bvh_store;
typedef struct bvh_tree {
    bvh_branch *root; /* NULL: no triangles */
    bvh_store **stores;
    int store_count;
} bvh_tree;

/* Ranges and subtrees of at most so many triangles are one member's work. */
enum { TASK_TRIANGLES = 8192 };

/* Grows a tree over refs, which it reorders. bvh_free releases it, also after STATUS_FAILURE (memory is out). */
status bvh_build_tree(bvh_tree *tree, thread_team *t, bvh_ref *refs, const bvh_range *all, diagnostic *why);
void bvh_free(bvh_tree *tree);

/* The kernels of hierarchy_refit: blocks and boxes anew. */
void hierarchy_refit_nodes_sse2(hierarchy *h);
void hierarchy_refit_nodes_avx2(hierarchy *h);
void hierarchy_refit_nodes_avx512(hierarchy *h);

/* Counts what becomes of a tree, and writes it to h; root NULL: no triangles. STATUS_FAILURE when memory is out or the
 * tree too large. */
status bvh_collapse(hierarchy *h, bvh_branch *root, const bvh_ref *refs, thread_team *t, diagnostic *why);
