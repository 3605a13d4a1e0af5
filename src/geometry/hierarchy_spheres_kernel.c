/* The traversal of sphere trees. */
#include "geometry/hierarchy_spheres.h"

ALWAYS_INLINE void walk_spheres(const hierarchy *h, ray_query *q, enum query_mode mode, bool single)
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

void KERNEL(walk_spheres)(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    if (mode == QUERY_NEAREST)
        h->single ? walk_spheres(h, q, QUERY_NEAREST, true) : walk_spheres(h, q, QUERY_NEAREST, false);
    else if (mode == QUERY_ANY)
        h->single ? walk_spheres(h, q, QUERY_ANY, true) : walk_spheres(h, q, QUERY_ANY, false);
    else
        h->single ? walk_spheres(h, q, QUERY_ALL, true) : walk_spheres(h, q, QUERY_ALL, false);
}
