/* Counts the tests of a query by a traversal of one ray that repeats the steps of the kernels: the same order, and the
 * same triangle and sphere tests. The box test of query.h is used with product and sum rounded separately; some
 * instruction sets fuse them. */
#include "geometry/hierarchy/query.h"

/* A query and its counters. */
typedef struct counting {
    const hierarchy *h;
    ray_query query;
    enum query_mode mode;
    query_counts *counts;
} counting;

static void ignore_hit(void *context, const mesh_hit *hit)
{
    (void)context, (void)hit;
}

/* The triangles of a block, without its padding: a block that is not full repeats its last triangle. */
static uint64_t triangles_of(const hierarchy *h, size_t block)
{
    const uint32_t *numbers = h->single ? ((const block_single *)h->blocks)[block].triangle
                                        : ((const block_double *)h->blocks)[block].triangle;
    uint64_t count = 1;
    while (count < BLOCK && numbers[count] != numbers[count - 1])
        count++;
    return count;
}

/* Tests blocks one after the other. True if the search is over. */
static bool test_blocks(counting *c, size_t first, size_t count)
{
    const hierarchy *h = c->h;
    for (size_t i = first; i < first + count; i++) {
        c->counts->triangles += triangles_of(h, i);
        if (h->single ? query_blocks(&c->query, h, c->mode, true, i, 1)
                      : query_blocks(&c->query, h, c->mode, false, i, 1))
            return true;
    }
    return false;
}

/* Whether the ray enters a child's box before t_best; *near is the distance of its entry. */
static bool enters(const bvh_node *node, int child, const box_ray *b, float t_best, float *near)
{
    float in = b->t_min, out = t_best;
    for (int k = 0; k < 3; k++) {
        const float from = planes_at(node, b->near[k])[child] * b->inverse[k] + b->near_offset[k],
                    to = planes_at(node, b->far[k])[child] * b->inverse[k] + b->far_offset[k];
        in = from > in ? from : in;
        out = to < out ? to : out;
    }
    *near = in;
    return in <= out;
}

/* Enters a node of a BVH: pushes the children that the ray hits, the nearest on top. Returns the new top. */
static int enter_node(counting *c, const bvh_node *node, const box_ray *b, float t_best, uint64_t *stack, int top)
{
    const int bottom = top;
    c->counts->nodes++;
    c->counts->boxes += node->child_count;
    for (int i = 0; i < (int)node->child_count; i++) {
        float near;
        if (!enters(node, i, b, t_best, &near))
            continue;
        const uint64_t next = pending(near, node->child[i]);
        int place = top++;
        for (; place > bottom && stack[place - 1] < next; place--)
            stack[place] = stack[place - 1];
        stack[place] = next;
    }
    return top;
}

static void count_bvh(counting *c)
{
    enum { CHILDREN = BVH_DEPTH_MAX * (WIDTH - 1) + WIDTH };
    box_ray b;
    uint64_t stack[CHILDREN];
    box_ray_start(&b, c->h, &c->query);
    float t_best = float_above(c->query.t_best);
    int top = 1;
    for (stack[0] = pending(0.0f, 0); top > 0;) {
        const uint64_t next = stack[--top];
        const uint32_t child = (uint32_t)next;
        if (pending_near(next) > t_best)
            continue;
        if (!(child & CHILD_LEAF)) {
            top = enter_node(c, &c->h->nodes[child], &b, t_best, stack, top);
            continue;
        }
        if (test_blocks(c, child_first_block(child), child_blocks(child)))
            return;
        if (c->mode == QUERY_NEAREST)
            t_best = float_above(c->query.t_best);
    }
}

/* Enters a sphere: tests its own triangles, then pushes the children that the ray hits, the nearest on top. Returns the
 * new top; -1 if the search is over. */
static int enter_sphere(counting *c, const sphere_node *s, double inverse_square, sphere_pending *stack, int top)
{
    const int bottom = top;
    c->counts->nodes++;
    if (test_blocks(c, s->first_block, s->blocks))
        return -1;
    c->counts->boxes += s->children;
    for (uint32_t i = s->first_child; i < s->first_child + s->children; i++) {
        const sphere_pending child = {sphere_near(&c->query, inverse_square, &c->h->spheres[i]), i};
        if (child.near == (double)INFINITY)
            continue;
        int place = top++;
        for (; place > bottom && stack[place - 1].near < child.near; place--)
            stack[place] = stack[place - 1];
        stack[place] = child;
    }
    return top;
}

static void count_spheres(counting *c)
{
    const ray_query *q = &c->query;
    double square = 0.0;
    for (int k = 0; k < 3; k++)
        square += q->direction[k] * q->direction[k];
    const double inverse_square = 1.0 / square;
    sphere_pending stack[SPHERES_PENDING];
    int top = 1;
    stack[0] = (sphere_pending){sphere_near(q, inverse_square, c->h->spheres), 0};
    c->counts->boxes++;
    while (top > 0) {
        const sphere_pending at = stack[--top];
        if (!(at.near > q->t_best || at.near == (double)INFINITY))
            top = enter_sphere(c, &c->h->spheres[at.node], inverse_square, stack, top);
    }
}

void hierarchy_count(const hierarchy *h, const mesh_ray *ray, enum query_mode mode, query_counts *counts)
{
    counting c = {.h = h, .mode = mode, .counts = counts};
    counts->rays++;
    if (!query_start(&c.query, ray) || h->block_count == 0)
        return;
    c.query.visit = ignore_hit;
    switch (h->kind) {
    case HIERARCHY_BVH: count_bvh(&c); break;
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT: count_spheres(&c); break;
    case HIERARCHY_NONE: test_blocks(&c, 0, h->block_count); break;
    case HIERARCHY_KIND_COUNT: break;
    }
}
