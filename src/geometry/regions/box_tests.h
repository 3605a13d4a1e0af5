/* Conservative tests of rays with boxes: of one ray with the eight boxes of a node of a solid tree, and whether a ray
 * misses one box. Pure; cannot fail. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include "base/vec3.h"
#include "geometry/rays.h"
#include "geometry/regions/solid_tree.h"

/* --- one box ---
 *
 * Tests the separating axes of a line and a box, which are the cross products of the ray's direction with the box's
 * edges (Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996), and whether the ray starts beyond a face and moves away.
 * The box is widened far beyond the rounding error of a hit, so that the test only saves time. */

/* -1 if the ray misses the box for certain, otherwise 0; also 0 for a box that is not a number. */
static inline int64_t ray_misses_box(vec3 low, vec3 high, vec3 o, vec3 d)
{
    const vec3 m = vec3_make(o.x - 0.5 * (low.x + high.x), o.y - 0.5 * (low.y + high.y), o.z - 0.5 * (low.z + high.z));
    const double wider = 0x1p-30 * ((magnitude(o.x) + magnitude(o.y) + magnitude(o.z)) +
                                    ((magnitude(low.x) + magnitude(low.y) + magnitude(low.z)) +
                                     (magnitude(high.x) + magnitude(high.y) + magnitude(high.z))));
    const double x = 0.5 * (high.x - low.x) + wider, y = 0.5 * (high.y - low.y) + wider,
                 z = 0.5 * (high.z - low.z) + wider;
    const double dx = magnitude(d.x), dy = magnitude(d.y), dz = magnitude(d.z);
    return mask_less(y * dz + z * dy, magnitude(m.y * d.z - m.z * d.y)) |
           mask_less(z * dx + x * dz, magnitude(m.z * d.x - m.x * d.z)) |
           mask_less(x * dy + y * dx, magnitude(m.x * d.y - m.y * d.x)) |
           (mask_less(x, magnitude(m.x)) & mask_less(0.0, m.x * d.x)) |
           (mask_less(y, magnitude(m.y)) & mask_less(0.0, m.y * d.y)) |
           (mask_less(z, magnitude(m.z)) & mask_less(0.0, m.z * d.z));
}

/* --- the boxes of a node ---
 *
 * No box that the exact ray enters between t_min and t_max is missed: box planes are rounded outwards, and distances
 * are widened by more than the rounding errors (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). For the rounding of
 * the origin the boxes are widened. */

#define BOXES_SLACK 0x1p-20f /* relative; more than the roundings of an origin, an inverse, a difference, a product */
#define BOXES_TINY 1e-30f    /* replaces a smaller component, whose inverse could be infinite */

typedef struct boxes_ray {
    float origin[3], inverse[3];
    float margin; /* of the boxes, for the rounding of the origin */
    float t_min, t_max;
} boxes_ray;

ALWAYS_INLINE float boxes_inverse(double d)
{
    const float f = (float)d, size = __builtin_fabsf(f);
    return 1.0f / (size < BOXES_TINY ? __builtin_copysignf(BOXES_TINY, f) : f);
}

ALWAYS_INLINE float boxes_margin(float reach, double x, double y, double z)
{
    const double far = greater(magnitude(x), greater(magnitude(y), magnitude(z)));
    return 0x1p-22f * (reach + (float)far);
}

/* A distance decreased, or increased, by more than its rounding error. */
ALWAYS_INLINE float boxes_less(float t)
{
    return t - __builtin_fabsf(t) * BOXES_SLACK;
}
ALWAYS_INLINE float boxes_more(float t)
{
    return t + __builtin_fabsf(t) * BOXES_SLACK;
}
ALWAYS_INLINE float boxes_min(float a, float b)
{
    return a < b ? a : b;
}
ALWAYS_INLINE float boxes_max(float a, float b)
{
    return a > b ? a : b;
}

/* Called with each item whose box the ray may enter before t_max. Returns t_max or a smaller bound; a negative one ends
 * the search. */
typedef double boxes_visit(void *context, int item, double t_max);

/* Prefetches the data of an item that will probably be visited soon: in large hierarchies the time goes into waiting
 * for memory. */
typedef void boxes_fetch(void *context, int item);

/* The children of a node, as bits, that the ray may enter before its t_max; near: the t at which it enters each. */
ALWAYS_INLINE unsigned boxes_entered(const boxes_node *n, const boxes_ray *r, float near[BOXES_WIDE])
{
    int32_t entered[BOXES_WIDE];
    const float *in[3], *out[3];
    float offset_in[3], offset_out[3];
    for (int axis = 0; axis < 3; axis++) {
        const bool down = r->inverse[axis] < 0.0f;
        in[axis] = down ? n->high[axis] : n->low[axis];
        out[axis] = down ? n->low[axis] : n->high[axis];
        offset_in[axis] = down ? r->origin[axis] - r->margin : r->origin[axis] + r->margin;
        offset_out[axis] = down ? r->origin[axis] + r->margin : r->origin[axis] - r->margin;
    }
    /* VECTORISE */
    for (int i = 0; i < BOXES_WIDE; i++) {
        const float x = (in[0][i] - offset_in[0]) * r->inverse[0], y = (in[1][i] - offset_in[1]) * r->inverse[1],
                    z = (in[2][i] - offset_in[2]) * r->inverse[2];
        const float u = (out[0][i] - offset_out[0]) * r->inverse[0], v = (out[1][i] - offset_out[1]) * r->inverse[1],
                    w = (out[2][i] - offset_out[2]) * r->inverse[2];
        const float first = boxes_less(boxes_max(boxes_max(x, y), z)), last = boxes_more(boxes_min(boxes_min(u, v), w));
        near[i] = boxes_max(first, r->t_min);
        entered[i] = -(int32_t)(near[i] <= boxes_min(last, r->t_max));
    }
    unsigned set = 0;
    for (int i = 0; i < BOXES_WIDE; i++)
        set |= (unsigned)(entered[i] & 1) << i;
    return set & ((1u << n->count) - 1);
}

/* A child on the stack, and the t at which the ray enters it. */
typedef struct boxes_pending {
    float near;
    int32_t child;
} boxes_pending;

ALWAYS_INLINE void boxes_fetch_node(const solid_boxes *b, int32_t child)
{
    for (size_t line = 0; line < sizeof(boxes_node); line += 64)
        __builtin_prefetch((const char *)&b->nodes[child] + line);
}

/* Pushes a node's entered children, the nearest last; returns the new size. */
ALWAYS_INLINE int boxes_push(const solid_boxes *b, boxes_pending *stack, int size, const boxes_node *n,
                             unsigned entered, const float *near, boxes_fetch *fetch, void *context)
{
    const int first = size;
    for (; entered; entered &= entered - 1) {
        const int child = __builtin_ctz(entered);
        int at = size++;
        for (; at > first && stack[at - 1].near < near[child]; at--)
            stack[at] = stack[at - 1];
        stack[at] = (boxes_pending){near[child], n->child[child]};
        if (n->child[child] >= 0)
            boxes_fetch_node(b, n->child[child]);
        else
            fetch(context, ~n->child[child]);
    }
    return size;
}

/* Visits the items whose boxes a ray may enter in t_min .. t_max, roughly the nearest first. */
ALWAYS_INLINE void boxes_traverse(const solid_boxes *b, vec3 origin, vec3 direction, double t_min, double t_max,
                                  boxes_visit *visit, boxes_fetch *fetch, void *context)
{
    boxes_pending stack[BOXES_DEPTH_MAX * (BOXES_WIDE - 1) + 1];
    float near[BOXES_WIDE];
    boxes_ray r = {.origin = {(float)origin.x, (float)origin.y, (float)origin.z},
                   .inverse = {boxes_inverse(direction.x), boxes_inverse(direction.y), boxes_inverse(direction.z)},
                   .margin = boxes_margin(b->reach, origin.x, origin.y, origin.z),
                   .t_min = boxes_less((float)t_min),
                   .t_max = boxes_more((float)t_max)};
    int size = boxes_push(b, stack, 0, b->nodes, boxes_entered(b->nodes, &r, near), near, fetch, context);
    while (size > 0) {
        const boxes_pending next = stack[--size];
        if (next.near > r.t_max)
            continue;
        if (next.child >= 0) {
            const boxes_node *n = &b->nodes[next.child];
            size = boxes_push(b, stack, size, n, boxes_entered(n, &r, near), near, fetch, context);
            continue;
        }
        const double bound = visit(context, ~next.child, t_max);
        if (bound < 0.0)
            return;
        if (bound < t_max) {
            t_max = bound;
            r.t_max = boxes_more((float)t_max);
        }
    }
}
