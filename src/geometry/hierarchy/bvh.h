/* The builder of the hierarchy `bvh`; private to bvh*.c and refit_kernel.c.
 *
 * Triangles become primitive references (single-precision boxes), which the binned surface-area heuristic splits into a
 * binary tree of build nodes (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007). Which of
 * them become leaves, and how the tree is collapsed into nodes of eight, is then chosen at the least expected cost
 * (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", 2017, section
 * 3.1).
 *
 * The tree depends on the set of references and not on their order: boxes and bin counts are independent of the order,
 * median halves follow a total order, and the triangles of a leaf are sorted. So any number of threads builds the same
 * tree. */
#pragma once

#include "base/isa.h"
#include "base/worker_pool.h"
#include "geometry/hierarchy/layout.h"
#include <string.h>

/* Levels of the binary tree. SAH splits are allowed as long as median splits alone could still finish within them. */
enum { BUILD_DEPTH_MAX = BVH_DEPTH_MAX - 1, LEAF_TRIANGLES_MAX = LEAF_BLOCKS_MAX * BLOCK };

/* The time of a visit to a node (eight boxes) over that of a block test. Measured on sets of 50000 triangles: with half
 * or twice this value, or with a constant cost per leaf, frames take as long or longer. */
#define COST_NODE 1.0f

/* A box of four lanes: three axes, and a fourth that holds no denormal (slow) number. */
typedef struct bvh_box {
    float low[4] __attribute__((aligned(16))), high[4] __attribute__((aligned(16)));
} bvh_box;

/* A triangle's box; the fourth lane of low holds the triangle's number (see bvh_triangle). */
typedef bvh_box prim_ref;

/* A contiguous range of references with its bounds. */
typedef struct prim_range {
    bvh_box bounds;
    bvh_box centroid_bounds; /* of low + high, twice the centroids, as center2 of Embree */
    uint32_t first, count;
} prim_range;

/* A node of the binary tree. */
typedef struct bvh_build_node {
    float low[3], high[3];
    uint32_t first, count;
    struct bvh_build_node *child[2]; /* NULL for an unsplit node */
    float cost[WIDTH];               /* [i], i = 1..7: least cost as at most i subtrees */
    uint8_t left_trees[WIDTH + 1];   /* [i], i = 2..8: of i subtrees, those below child[0]; 0: as for i - 1 */
    bool leaf;                       /* cheapest as a leaf when it is one subtree */
    uint32_t depth; /* levels of nodes from this one down; set, like the next three, when the tree is collapsed */
    size_t nodes, blocks, leaves;
} bvh_build_node;

/* A triangle's number as a float that is not denormal. */
static inline float bvh_lane_of(uint32_t triangle)
{
    uint32_t bits = triangle | 0x40000000u;
    float lane;
    memcpy(&lane, &bits, sizeof lane);
    return lane;
}

static inline uint32_t bvh_triangle(const prim_ref *r)
{
    uint32_t bits;
    memcpy(&bits, &r->low[3], sizeof bits);
    return bits & 0x3fffffffu;
}

/* The largest float not above v, and the smallest not below v, if |v| is 0 or at least the smallest normal float. The
 * bits that a float lacks are cut off, after a carry if rounding is away from 0. */
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

/* The same for any v, with nextafterf below the smallest normal float. */
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

static inline void bvh_box_extend(bvh_box *__restrict b, const float *__restrict low, const float *__restrict high)
{
    for (int k = 0; k < 4; k++)
        b->low[k] = low[k] < b->low[k] ? low[k] : b->low[k];
    for (int k = 0; k < 4; k++)
        b->high[k] = high[k] > b->high[k] ? high[k] : b->high[k];
}

static inline void prim_range_extend(prim_range *__restrict range, const prim_ref *__restrict r)
{
    float center[4];
    for (int k = 0; k < 4; k++)
        center[k] = r->low[k] + r->high[k];
    bvh_box_extend(&range->bounds, r->low, r->high);
    bvh_box_extend(&range->centroid_bounds, center, center);
}

static inline float bvh_half_area(const float *low, const float *high)
{
    float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
}

/* The box around a node's children along an axis; unused slots hold empty boxes and change nothing. */
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

/* Splits a range of at least two references: reorders them and describes the halves. depth: of the range's node, from
 * 0. */
void bvh_split(prim_ref *refs, const prim_range *range, int depth, prim_range half[2]);
/* bvh_split by a thread team, for large ranges. STATUS_FAILURE: out of memory. */
status bvh_split_parallel(thread_team *t, prim_ref *refs, const prim_range *range, int depth, prim_range half[2],
                          diagnostic *why);

/* Computes the costs of a node from its children's (Ylitie et al., section 3.1). */
void bvh_find_costs(bvh_build_node *b);

/* Ranges and subtrees of at most this size are built by a single thread. */
enum { TASK_TRIANGLES = 8192 };

/* Sets h->reach from the root's boxes. */
void bvh_find_reach(hierarchy *h);

/* The kernels of hierarchy_refit: recompute blocks and boxes. */
typedef void hierarchy_refitter(hierarchy *h);
ISA_DECLARE(hierarchy_refitter, hierarchy_refit_nodes)

/* Collapses the tree into nodes and leaves and writes it to h. root NULL: no triangles. STATUS_FAILURE: out of memory
 * or the tree is too large. */
status bvh_collapse(hierarchy *h, bvh_build_node *root, const prim_ref *refs, thread_team *t, diagnostic *why);
