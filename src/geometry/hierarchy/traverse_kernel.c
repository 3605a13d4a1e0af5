/* Traversals of one ray. Nearest children first; farther ones wait on a stack with their distances. */

/* The vectors are a node's eight floats and a block's four doubles. While wider ones, which gcc would use to copy, are
 * under way, the processor computes with one port fewer. */
#if defined(__AVX512F__) && !defined(__clang__)
#pragma GCC target("prefer-vector-width=256")
#endif

#include "geometry/hierarchy/query.h"

/* --- bvh --- */

/* The children whose boxes the ray enters before t_best, and the distances, at least t_min, at which it does. */
ALWAYS_INLINE uint64_t enter_children(const bvh_node *node, const box_ray *b, float t_best, float *nears)
{
    _Alignas(32) float fars[WIDTH];
    box_distances(node, b, t_best, nears, fars);
    return lanes_ordered(nears, fars);
}

/* Pushes the children of a set, the nearest on top. */
ALWAYS_INLINE int push_sorted(const bvh_node *node, const float *nears, uint64_t set, uint64_t *stack, int top)
{
    const unsigned one = lane_first(set);
    stack[top] = pending(nears[one], node->child[one]);
    const int bottom = top++;
    for (set = LANES_LESS_FIRST(set); set; set = LANES_LESS_FIRST(set)) {
        const unsigned lane = lane_first(set);
        const uint64_t next = pending(nears[lane], node->child[lane]);
        int place = top++;
        for (; place > bottom && stack[place - 1] < next; place--)
            stack[place] = stack[place - 1];
        stack[place] = next;
    }
    return top;
}

/* Prefetches children on the stack: of a hierarchy that does not fit into the cache, whose rays would wait for them. */
ALWAYS_INLINE void fetch_pending(const hierarchy *h, bool single, const uint64_t *stack, int first, int end)
{
    enum { CACHED_BYTES = 4 << 20 /* twice the second-level cache of a core */ };
    for (int i = first; h->report.bytes > CACHED_BYTES && i < end; i++)
        fetch_child(h, (uint32_t)stack[i], single ? sizeof(block_single) : sizeof(block_double));
}

ALWAYS_INLINE void traverse_from(const hierarchy *h, ray_query *q, const box_ray *ray, enum query_mode mode,
                                 bool single, uint32_t at)
{
    const box_ray b = *ray;
    float t_best = float_above(q->t_best);
    uint64_t stack[STACK];
    int top = 0;
    for (;;) {
        while (!(at & CHILD_LEAF)) {
            const bvh_node *node = &h->nodes[at];
            _Alignas(32) float nears[WIDTH];
            uint64_t set = enter_children(node, &b, t_best, nears);
            if (!set)
                goto pop;
            const unsigned one = lane_first(set);
            const uint64_t others = LANES_LESS_FIRST(set);
            if (!others) {
                at = node->child[one];
                continue;
            }
            const unsigned two = lane_first(others);
            if (!LANES_LESS_FIRST(others)) {
                const uint64_t first = pending(nears[one], node->child[one]),
                               second = pending(nears[two], node->child[two]);
                stack[top++] = first > second ? first : second;
                fetch_pending(h, single, stack, top - 1, top);
                at = (uint32_t)(first > second ? second : first);
                continue;
            }
            const int bottom = top;
            top = push_sorted(node, nears, set, stack, top);
            fetch_pending(h, single, stack, bottom, top - 1);
            at = (uint32_t)stack[--top];
        }
        if (query_blocks(q, h, mode, single, child_first_block(at), child_blocks(at)))
            return;
        if (mode == QUERY_NEAREST || mode == QUERY_BOXES)
            t_best = float_above(q->t_best);
    pop:
        do {
            if (top == 0)
                return;
            top--;
        } while (pending_near(stack[top]) > t_best);
        at = (uint32_t)stack[top];
    }
}

void KERNEL(traverse_bvh_from)(const hierarchy *h, ray_query *q, const box_ray *b, enum query_mode mode, uint32_t at)
{
    if (mode == QUERY_NEAREST)
        h->single ? traverse_from(h, q, b, QUERY_NEAREST, true, at) : traverse_from(h, q, b, QUERY_NEAREST, false, at);
    else if (mode == QUERY_ANY)
        h->single ? traverse_from(h, q, b, QUERY_ANY, true, at) : traverse_from(h, q, b, QUERY_ANY, false, at);
    else if (mode == QUERY_BOXES)
        traverse_from(h, q, b, QUERY_BOXES, true, at);
    else
        h->single ? traverse_from(h, q, b, QUERY_ALL, true, at) : traverse_from(h, q, b, QUERY_ALL, false, at);
}

void KERNEL(traverse_bvh)(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    box_ray b;
    box_ray_start(&b, h, q);
    KERNEL(traverse_bvh_from)(h, q, &b, mode, 0);
}

/* --- sphere and octant --- */

ALWAYS_INLINE void traverse_spheres(const hierarchy *h, ray_query *q, enum query_mode mode, bool single)
{
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += q->direction[k] * q->direction[k];
    const double inverse_square = 1.0 / square;
    sphere_pending stack[SPHERES_PENDING];
    int top = 0;
    stack[top++] = (sphere_pending){sphere_near(q, inverse_square, h->spheres), 0};
    while (top > 0) {
        const sphere_pending at = stack[--top];
        if (at.near > q->t_best || at.near == (double)INFINITY)
            continue;
        const sphere_node *s = &h->spheres[at.node];
        if (query_blocks(q, h, mode, single, s->first_block, s->blocks))
            return;
        const int bottom = top;
        for (uint32_t i = 0; i < s->children; i++) {
            const sphere_pending child = {sphere_near(q, inverse_square, &h->spheres[s->first_child + i]),
                                          s->first_child + i};
            if (child.near == (double)INFINITY)
                continue;
            int place = top++;
            for (; place > bottom && stack[place - 1].near < child.near; place--)
                stack[place] = stack[place - 1];
            stack[place] = child;
        }
    }
}

void KERNEL(traverse_spheres)(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    if (mode == QUERY_NEAREST)
        h->single ? traverse_spheres(h, q, QUERY_NEAREST, true) : traverse_spheres(h, q, QUERY_NEAREST, false);
    else if (mode == QUERY_ANY)
        h->single ? traverse_spheres(h, q, QUERY_ANY, true) : traverse_spheres(h, q, QUERY_ANY, false);
    else
        h->single ? traverse_spheres(h, q, QUERY_ALL, true) : traverse_spheres(h, q, QUERY_ALL, false);
}
