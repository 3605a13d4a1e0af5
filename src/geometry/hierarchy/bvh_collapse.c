/* The collapse of the binary tree into nodes of eight children and leaves of blocks, at the least expected cost. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/hierarchy/bvh.h"

#include <stdlib.h>

static uint32_t blocks_of(uint32_t triangles)
{
    return (triangles + BLOCK - 1) / BLOCK;
}

/* The least cost of dividing `subtrees` (2..8) subtrees between both halves. */
static float distribute(const bvh_build_node *b, int subtrees, uint8_t *left_trees)
{
    const float *first = b->child[0]->cost, *second = b->child[1]->cost;
    float least = INFINITY;
    for (int k = 1; k < subtrees; k++) {
        float cost = first[k] + second[subtrees - k];
        if (cost < least) {
            least = cost;
            *left_trees = (uint8_t)k;
        }
    }
    return least;
}

void bvh_find_costs(bvh_build_node *b)
{
    float area = bvh_half_area(b->low, b->high);
    float as_leaf = b->count <= LEAF_TRIANGLES_MAX ? area * (float)blocks_of(b->count) : INFINITY;
    b->cost[1] = as_leaf;
    b->leaf = true;
    if (!b->child[0]) {
        for (int i = 2; i < WIDTH; i++)
            b->cost[i] = as_leaf;
        return;
    }
    b->left_trees[WIDTH] = 1; /* a valid division, 1 and 7, even if the costs are infinite or NaN */
    float as_node = distribute(b, WIDTH, &b->left_trees[WIDTH]) + area * COST_NODE;
    if (!(as_leaf <= as_node)) {
        b->cost[1] = as_node;
        b->leaf = false;
    }
    for (int i = 2; i < WIDTH; i++) {
        uint8_t left_trees = 0;
        float cost = distribute(b, i, &left_trees);
        b->cost[i] = cost < b->cost[i - 1] ? cost : b->cost[i - 1];
        b->left_trees[i] = cost < b->cost[i - 1] ? left_trees : 0;
    }
}

/* The nodes that represent b as `subtrees` subtrees; returns their number. */
static int subtrees_of(bvh_build_node *b, int subtrees, bvh_build_node **out)
{
    while (subtrees > 1 && subtrees < WIDTH && (!b->child[0] || b->left_trees[subtrees] == 0))
        subtrees--;
    if (subtrees == 1) {
        *out = b;
        return 1;
    }
    int count = subtrees_of(b->child[0], b->left_trees[subtrees], out);
    return count + subtrees_of(b->child[1], subtrees - b->left_trees[subtrees], out + count);
}

static int children_of(bvh_build_node *b, bool root, bvh_build_node **out)
{
    if (root && b->leaf) {
        *out = b;
        return 1;
    }
    return subtrees_of(b, WIDTH, out);
}

/* A subtree that a single thread counts or writes, and its position in the arrays. */
typedef struct subtree {
    bvh_build_node *b;
    size_t node, block;
} subtree;
typedef struct collapse_job {
    hierarchy *h;
    const prim_ref *refs;
    subtree *list;
    size_t count, room;
} collapse_job;

static bool add_subtree(collapse_job *g, bvh_build_node *b, size_t node, size_t block)
{
    if (!GROW(g->list, g->room, g->count + 1))
        return false;
    g->list[g->count++] = (subtree){b, node, block};
    return true;
}

static bool small(const bvh_build_node *b)
{
    return b->leaf || b->count <= TASK_TRIANGLES;
}

/* Lists the small subtrees among b's children and below. A root that is a leaf counts as its own only child. */
static bool find_small(collapse_job *g, bvh_build_node *b, bool root)
{
    bvh_build_node *children[WIDTH];
    int count = children_of(b, root, children);
    for (int i = 0; i < count; i++)
        if (!(small(children[i]) ? add_subtree(g, children[i], 0, 0) : find_small(g, children[i], false)))
            return false;
    return true;
}

/* Counts the nodes, blocks and leaves of b. small_known: small subtrees below it are counted already. */
static void count_tree(bvh_build_node *b, bool root, bool small_known)
{
    if (b->leaf && !root) {
        b->nodes = b->depth = 0;
        b->blocks = blocks_of(b->count);
        b->leaves = 1;
        return;
    }
    bvh_build_node *children[WIDTH];
    int count = children_of(b, root, children);
    size_t nodes = 1, blocks = 0, leaves = 0;
    uint32_t depth = 0;
    for (int i = 0; i < count; i++) {
        const bvh_build_node *c = children[i]; /* b itself if the root is a leaf */
        if (!small_known || !small(c))
            count_tree(children[i], false, small_known);
        nodes += c->nodes;
        blocks += c->blocks;
        leaves += c->leaves;
        depth = c->depth > depth ? c->depth : depth;
    }
    b->nodes = nodes;
    b->blocks = blocks;
    b->leaves = leaves;
    b->depth = depth + 1;
}

static void count_subtree(void *context, size_t index, int member)
{
    (void)member;
    collapse_job *g = context;
    if (!cancel_asked())
        count_tree(g->list[index].b, false, false);
}

static void write_leaf(hierarchy *h, const bvh_build_node *b, const prim_ref *refs, size_t first_block)
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

static void write_boxes(bvh_node *n, bvh_build_node *const *children, int count)
{
    for (int i = 0; i < WIDTH; i++)
        for (int axis = 0; axis < 3; axis++) {
            n->low[axis][i] = i < count ? children[i]->low[axis] : INFINITY;
            n->high[axis][i] = i < count ? children[i]->high[axis] : -INFINITY;
        }
    n->child_count = (uint32_t)count;
}

/* Writes in depth-first order: a node, then each child's subtree; blocks in the order of their leaves. If `later` is
 * given, small subtrees are only listed there. false: out of memory. */
static bool write_tree(collapse_job *g, bvh_build_node *b, bool root, size_t node, size_t block, collapse_job *later)
{
    bvh_build_node *children[WIDTH];
    int count = children_of(b, root, children);
    bvh_node *n = &g->h->nodes[node++];
    memset(n, 0, sizeof *n);
    write_boxes(n, children, count);
    for (int i = 0; i < count; i++) {
        bvh_build_node *c = children[i];
        n->child[i] = c->leaf ? child_leaf((uint32_t)block, blocks_of(c->count)) : (uint32_t)node;
        if (c->leaf)
            write_leaf(g->h, c, g->refs, block);
        else if (!(later && small(c) ? add_subtree(later, c, node, block)
                                     : write_tree(g, c, false, node, block, later)))
            return false;
        node += c->leaf ? 0 : c->nodes;
        block += c->leaf ? blocks_of(c->count) : c->blocks;
    }
    return true;
}

static void write_subtree(void *context, size_t index, int member)
{
    (void)member;
    collapse_job *g = context;
    const subtree *p = &g->list[index];
    if (cancel_asked())
        return;
    write_tree(g, p->b, false, p->node, p->block, NULL);
}

static status make_room(hierarchy *h, size_t nodes, size_t blocks, diagnostic *why)
{
    if (blocks > child_first_block(UINT32_MAX) || nodes >= CHILD_LEAF)
        return diagnose(why, STATUS_FAILURE, "use a mesh with fewer triangles",
                        "the hierarchy would have too many leaves");
    h->nodes = hierarchy_allocate(nodes * sizeof *h->nodes);
    h->node_count = nodes;
    if (!h->nodes || !hierarchy_make_blocks(h, blocks))
        return out_of_memory(why);
    return STATUS_OK;
}

static status no_triangles(hierarchy *h, diagnostic *why)
{
    TRY(make_room(h, 1, 0, why));
    memset(h->nodes, 0, sizeof *h->nodes);
    write_boxes(h->nodes, NULL, 0);
    h->report.nodes = 1;
    h->report.depth = 1;
    return STATUS_OK;
}

static status collapse(collapse_job *g, bvh_build_node *root, thread_team *t, diagnostic *why)
{
    if (!find_small(g, root, true))
        return out_of_memory(why);
    thread_team_run(t, count_subtree, g, g->count);
    TRY(cancel_check(why)); /* counts are missing after a cancellation */
    count_tree(root, true, true);
    TRY(make_room(g->h, root->nodes, root->blocks, why));
    g->count = 0;
    if (!write_tree(g, root, true, 0, 0, g))
        return out_of_memory(why);
    thread_team_run(t, write_subtree, g, g->count);
    TRY(cancel_check(why));
    g->h->report.nodes = root->nodes;
    g->h->report.leaves = root->leaves;
    g->h->report.depth = (int)root->depth;
    return STATUS_OK;
}

status bvh_collapse(hierarchy *h, bvh_build_node *root, const prim_ref *refs, thread_team *t, diagnostic *why)
{
    if (!root)
        return no_triangles(h, why);
    collapse_job g = {.h = h, .refs = refs};
    status code = collapse(&g, root, t, why);
    free(g.list);
    return code;
}
