/* Single-ray traversal of the hierarchy `bvh`: nearest children first; farther ones wait on a stack with their
 * distances. */
#include "geometry/hierarchy_boxes.h"

ALWAYS_INLINE void walk_down(const hierarchy *h, ray_query *q, const box_ray *ray, enum query_mode mode, bool single,
                             uint32_t at)
{
    const box_ray b = *ray;
    const float8 t_min = float8_all(b.t_min);
    float t_best = float_above(q->t_best);
    float8 t_max = float8_all(t_best);
    uint64_t stack[STACK];
    int top = 0;
    for (;;) {
        while (!(at & CHILD_LEAF)) {
            const bvh_node *node = &h->nodes[at];
            _Alignas(32) float nears[WIDTH], fars[WIDTH];
            slabs(node, &b, nears, fars);
            float8 near, far;
            memcpy(&near, nears, sizeof near);
            memcpy(&far, fars, sizeof far);
            uint64_t set = lanes_of8((near <= far) & (near <= t_max) & (far >= t_min));
            if (!set)
                goto pop;
            const unsigned one = lane_first(set);
            set = LANES_LESS_FIRST(set);
            if (!set) {
                at = node->child[one];
                continue;
            }
            const unsigned two = lane_first(set);
            if (!LANES_LESS_FIRST(set)) {
                const bool first = nears[one] <= nears[two];
                const unsigned nearer = first ? one : two, farther = first ? two : one;
                stack[top++] = pending(nears[farther], node->child[farther]);
                at = node->child[nearer];
                continue;
            }
            stack[top] = pending(nears[one], node->child[one]);
            const int bottom = top++;
            for (; set; set = LANES_LESS_FIRST(set)) {
                const unsigned lane = lane_first(set);
                const uint64_t next = pending(nears[lane], node->child[lane]);
                int place = top++;
                for (; place > bottom && stack[place - 1] < next; place--)
                    stack[place] = stack[place - 1];
                stack[place] = next;
            }
            at = (uint32_t)stack[--top];
        }
        if (query_blocks(q, h, mode, single, child_first_block(at), child_blocks(at)))
            return;
        if (mode == QUERY_NEAREST || mode == QUERY_BOXES) {
            t_best = float_above(q->t_best);
            t_max = float8_all(t_best);
        }
    pop:
        do {
            if (top == 0)
                return;
            top--;
        } while (pending_near(stack[top]) > t_best);
        at = (uint32_t)stack[top];
    }
}

void KERNEL(walk_bvh_from)(const hierarchy *h, ray_query *q, const box_ray *b, enum query_mode mode, uint32_t at)
{
    if (mode == QUERY_NEAREST)
        h->single ? walk_down(h, q, b, QUERY_NEAREST, true, at) : walk_down(h, q, b, QUERY_NEAREST, false, at);
    else if (mode == QUERY_ANY)
        h->single ? walk_down(h, q, b, QUERY_ANY, true, at) : walk_down(h, q, b, QUERY_ANY, false, at);
    else if (mode == QUERY_BOXES)
        walk_down(h, q, b, QUERY_BOXES, true, at);
    else
        h->single ? walk_down(h, q, b, QUERY_ALL, true, at) : walk_down(h, q, b, QUERY_ALL, false, at);
}

void KERNEL(walk_bvh)(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    box_ray b;
    box_ray_start(&b, q);
    KERNEL(walk_bvh_from)(h, q, &b, mode, 0);
}
