#include "geometry/hierarchy_bvh.h"

#include <stdlib.h>

/* Times of a step, in those of the test of one block: a visit to a node (eight boxes), and to a leaf whatever is in it. */
#define COST_NODE 1.0f
#define COST_LEAF 0.5f

static uint32_t blocks_of(uint32_t triangles)
{
    return (triangles + BLOCK - 1) / BLOCK;
}

/* The least cost of `subtrees` of them out of both halves, 2..8. */
static float best_share(const bvh_branch *b, int subtrees, uint8_t *share)
{
    const float *first = b->half[0]->cost, *second = b->half[1]->cost;
    float least = INFINITY;
    for (int k = 1; k < subtrees; k++) {
        float cost = first[k] + second[subtrees - k];
        if (cost < least) {
            least = cost;
            *share = (uint8_t)k;
        }
    }
    return least;
}

void bvh_choose(bvh_branch *b)
{
    float area = bvh_half_area(b->low, b->high);
    float as_leaf = b->count <= LEAF_TRIANGLES_MAX ? area * (COST_LEAF + (float)blocks_of(b->count)) : INFINITY;
    b->cost[1] = as_leaf;
    b->leaf = true;
    if (!b->half[0]) {
        for (int i = 2; i < WIDTH; i++)
            b->cost[i] = as_leaf;
        return;
    }
    uint8_t all = 1; /* shares of 1 and 7 can be had whatever the costs are (they may be infinite, or no numbers) */
    b->share[WIDTH] = all;
    float as_node = best_share(b, WIDTH, &b->share[WIDTH]) + area * COST_NODE;
    if (!(as_leaf <= as_node)) {
        b->cost[1] = as_node;
        b->leaf = false;
    }
    for (int i = 2; i < WIDTH; i++) {
        uint8_t share = 0;
        float cost = best_share(b, i, &share);
        b->cost[i] = cost < b->cost[i - 1] ? cost : b->cost[i - 1];
        b->share[i] = cost < b->cost[i - 1] ? share : 0;
    }
}

/* The branches that stand for b as `subtrees` subtrees; returns how many there are. */
static int forest(bvh_branch *b, int subtrees, bvh_branch **out)
{
    while (subtrees > 1 && subtrees < WIDTH && (!b->half[0] || b->share[subtrees] == 0))
        subtrees--;
    if (subtrees == 1) {
        *out = b;
        return 1;
    }
    int count = forest(b->half[0], b->share[subtrees], out);
    return count + forest(b->half[1], subtrees - b->share[subtrees], out + count);
}

static int children_of(bvh_branch *b, bool root, bvh_branch **out)
{
    if (root && b->leaf) {
        *out = b;
        return 1;
    }
    return forest(b, WIDTH, out);
}

static void count_tree(bvh_branch *b, bool root)
{
    b->nodes = b->blocks = b->leaves = b->depth = 0;
    if (b->leaf && !root) {
        b->blocks = blocks_of(b->count);
        b->leaves = 1;
        return;
    }
    bvh_branch *children[WIDTH];
    int count = children_of(b, root, children);
    size_t nodes = 1, blocks = 0, leaves = 0;
    uint32_t depth = 0;
    for (int i = 0; i < count; i++) {
        count_tree(children[i], false);
        nodes += children[i]->nodes;
        blocks += children[i]->blocks;
        leaves += children[i]->leaves;
        depth = children[i]->depth > depth ? children[i]->depth : depth;
    }
    b->nodes = nodes;
    b->blocks = blocks;
    b->leaves = leaves;
    b->depth = depth + 1;
}

static void write_leaf(hierarchy *h, const bvh_branch *b, const bvh_ref *refs, size_t first_block)
{
    uint32_t order[LEAF_TRIANGLES_MAX];
    for (uint32_t i = 0; i < b->count; i++) {
        uint32_t triangle = bvh_triangle(&refs[b->first + i]), k = i;
        for (; k > 0 && order[k - 1] > triangle; k--)
            order[k] = order[k - 1];
        order[k] = triangle;
    }
    hierarchy_fill_blocks(h, order, b->count, first_block);
}

static void write_boxes(bvh_node *n, bvh_branch *const *children, int count)
{
    for (int i = 0; i < WIDTH; i++)
        for (int axis = 0; axis < 3; axis++) {
            n->low[axis][i] = i < count ? children[i]->low[axis] : INFINITY;
            n->high[axis][i] = i < count ? children[i]->high[axis] : -INFINITY;
        }
    n->child_count = (uint32_t)count;
}

/* Depth first: a node, then each child's subtree; blocks in the order of their leaves. */
static void write_tree(hierarchy *h, bvh_branch *b, const bvh_ref *refs, bool root, size_t node, size_t block)
{
    bvh_branch *children[WIDTH];
    int count = children_of(b, root, children);
    bvh_node *n = &h->nodes[node++];
    memset(n, 0, sizeof *n);
    write_boxes(n, children, count);
    for (int i = 0; i < count; i++) {
        bool leaf = children[i]->leaf;
        size_t blocks = leaf ? blocks_of(children[i]->count) : children[i]->blocks;
        n->child[i] = leaf ? child_leaf((uint32_t)block, (uint32_t)blocks) : (uint32_t)node;
        if (leaf)
            write_leaf(h, children[i], refs, block);
        else
            write_tree(h, children[i], refs, false, node, block);
        node += leaf ? 0 : children[i]->nodes;
        block += blocks;
    }
}

static status make_room(hierarchy *h, size_t nodes, size_t blocks, diagnostic *why)
{
    if (blocks > child_first_block(UINT32_MAX) || nodes >= CHILD_LEAF)
        return diagnose(why, STATUS_FAILURE, "a mesh of fewer triangles", "the hierarchy would have too many leaves");
    h->nodes = aligned_alloc(64, nodes * sizeof *h->nodes);
    h->node_count = nodes;
    if (!h->nodes || !hierarchy_make_blocks(h, blocks))
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    return STATUS_OK;
}

status bvh_gather(hierarchy *h, bvh_branch *root, const bvh_ref *refs, int threads, diagnostic *why)
{
    (void)threads;
    if (!root) {
        status code = make_room(h, 1, 0, why);
        if (code == STATUS_OK) {
            memset(h->nodes, 0, sizeof *h->nodes);
            write_boxes(h->nodes, NULL, 0);
            h->report.nodes = 1;
            h->report.depth = 1;
        }
        return code;
    }
    count_tree(root, true);
    status code = make_room(h, root->nodes, root->blocks, why);
    if (code != STATUS_OK)
        return code;
    h->report.nodes = root->nodes;
    h->report.leaves = root->leaves;
    h->report.depth = (int)root->depth;
    write_tree(h, root, refs, true, 0, 0);
    return STATUS_OK;
}
