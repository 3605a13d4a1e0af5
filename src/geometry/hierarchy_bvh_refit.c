/* The refit of a bvh after its mesh moved, and the cost of a bvh. */
#include "base/isa.h"
#include "geometry/hierarchy_bvh.h"

bool hierarchy_refit(hierarchy *h)
{
    static hierarchy_refitter *const refit[ISA_COUNT] = ISA_ARRAY(hierarchy_refit_nodes);
    if (h->kind != HIERARCHY_BVH || h->referred != h->of->triangle_count || (h->single && !h->of->single))
        return false;
    refit[isa_best()](h); /* all kernels give identical bits */
    bvh_find_reach(h);
    return true;
}

void bvh_find_reach(hierarchy *h)
{
    for (int axis = 0; axis < 3; axis++) {
        float low, high;
        bvh_around(&h->nodes[0], axis, &low, &high);
        const float reach = -low > high ? -low : high;
        h->reach[axis] = reach > 0.0f ? reach : 0.0f; /* without triangles it is -inf */
    }
}

static double half_area(const bvh_node *n, int slot)
{
    const double x = (double)n->high[0][slot] - (double)n->low[0][slot],
                 y = (double)n->high[1][slot] - (double)n->low[1][slot],
                 z = (double)n->high[2][slot] - (double)n->low[2][slot];
    return x * y + y * z + z * x;
}

double hierarchy_cost(const hierarchy *h)
{
    if (h->kind != HIERARCHY_BVH || h->block_count == 0)
        return 0.0;
    bvh_node root;
    for (int axis = 0; axis < 3; axis++)
        bvh_around(&h->nodes[0], axis, &root.low[axis][0], &root.high[axis][0]);
    const double whole = half_area(&root, 0);
    double sum = whole * (double)COST_NODE;
    for (size_t i = 0; i < h->node_count; i++) {
        const bvh_node *n = &h->nodes[i];
        for (int slot = 0; slot < (int)n->child_count; slot++) {
            const uint32_t child = n->child[slot];
            sum += half_area(n, slot) * (child & CHILD_LEAF ? (double)child_blocks(child) : (double)COST_NODE);
        }
    }
    return whole > 0.0 ? sum / whole : 0.0;
}
