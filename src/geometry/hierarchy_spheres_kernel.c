/* The traversal of sphere trees. A sphere is hit if the ray's line passes within its radius plus a margin wider than
 * the rounding error, and part of its inside is between t_min and the best hit. */
#include "geometry/hierarchy_query.h"

#define SPHERE_MARGIN 0x1p-20 /* relative; wider than the rounding of centre and radius to floats */

/* The spheres on the stack: per level at most all children of one node. */
typedef struct sphere_pending {
    double near;
    uint32_t node;
} sphere_pending;
enum { STACK = SPHERES_DEPTH_MAX * 8 };

/* The ray's distance to its entry into the sphere; +inf for a miss. The centre's distance from the line is computed by
 * components, since a difference of squares would cancel (Haines et al., "Precision improvements for ray/sphere
 * intersection", Ray Tracing Gems, 2019). */
ALWAYS_INLINE double sphere_near(const ray_query *q, double inverse_square, const sphere_node *s)
{
    double center[3], along = 0.0, off = 0.0, reach = 0.0;
    for (int k = 0; k < 3; k++) {
        center[k] = (double)s->center[k] - q->origin[k];
        along += center[k] * q->direction[k];
        reach = greater(reach, magnitude(center[k]));
    }
    along *= inverse_square;
    for (int k = 0; k < 3; k++) {
        const double away = center[k] - along * q->direction[k];
        off += away * away;
    }
    const double radius = (double)s->radius * (1.0 + SPHERE_MARGIN) + reach * BOX_MARGIN;
    if (!(off <= radius * radius))
        return (double)INFINITY;
    /* The direction is at least 1 long, so that the radius bounds half of the chord's length in t. */
    const double near = along - radius, far = along + radius;
    return far < q->t_min || near > q->t_best ? (double)INFINITY : near;
}

ALWAYS_INLINE void walk_spheres(const hierarchy *h, ray_query *q, enum query_mode mode, bool single)
{
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += q->direction[k] * q->direction[k];
    const double inverse_square = 1.0 / square;
    sphere_pending stack[STACK];
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
