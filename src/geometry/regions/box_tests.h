/* Conservative tests of rays with boxes: whether a ray misses one box; which boxes of a node of a solid tree it enters;
 * and traversals of the tree, by one ray or by the rays of a batch. Pure; cannot fail. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include "base/vec3.h"
#include "geometry/hierarchy/query.h"
#include "geometry/rays.h"
#include "geometry/regions/solid_tree.h"
#include <stddef.h>

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
 * are widened by more than the rounding errors (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). */

#define BOXES_SLACK 0x1p-20f /* relative; more than the roundings of an origin, an inverse, a difference, a product */
#define BOXES_TINY 1e-30f    /* replaces a smaller component, whose inverse could be infinite */

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

/* A ray prepared for the test, as for a mesh (query.h), whose margin bounds the same errors. */
typedef struct boxes_ray {
    box_ray box;
    float t_max;
} boxes_ray;

/* A component below 2^-40 of the largest is replaced by it. Up to its exit from a box, the ray moves at most the reach
 * plus the origin's largest coordinate along its largest component, and so less than the margin across these planes. */
#define BOXES_PARALLEL 0x1p-40f

ALWAYS_INLINE boxes_ray boxes_ray_start(const solid_boxes *b, vec3 origin, vec3 direction, double t_min, double t_max)
{
    const float o[3] = {(float)origin.x, (float)origin.y, (float)origin.z};
    const float d[3] = {(float)direction.x, (float)direction.y, (float)direction.z};
    const float largest = boxes_max(__builtin_fabsf(d[0]), boxes_max(__builtin_fabsf(d[1]), __builtin_fabsf(d[2])));
    const float least = largest * BOXES_PARALLEL;
    const float far = boxes_max(__builtin_fabsf(o[0]), boxes_max(__builtin_fabsf(o[1]), __builtin_fabsf(o[2])));
    const float margin = box_margin(b->reach, far);
    boxes_ray r = {.box = {.t_min = float_below(t_min)}, .t_max = float_above(t_max)};
    for (int k = 0; k < 3; k++) {
        const float inverse = 1.0f / (__builtin_fabsf(d[k]) < least ? __builtin_copysignf(least, d[k]) : d[k]);
        const bool down = inverse < 0.0f; /* also for a component of -0.0 */
        r.box.inverse[k] = inverse;
        r.box.near_offset[k] = -o[k] * inverse - margin * __builtin_fabsf(inverse);
        r.box.far_offset[k] = -o[k] * inverse + margin * __builtin_fabsf(inverse);
        r.box.near[k] = down ? high_planes(k) : low_planes(k);
        r.box.far[k] = down ? low_planes(k) : high_planes(k);
    }
    return r;
}

/* The children of a node, as lanes, that the ray may enter before its t_max; near: the t at which it enters each. */
ALWAYS_INLINE uint64_t boxes_entered(const boxes_node *n, const boxes_ray *r, float *near)
{
    _Alignas(32) float far[BOXES_WIDE];
    int8x32 used;
    memcpy(&used, n->used, sizeof used);
    box_distances(n, &r->box, r->t_max, near, far);
    return lanes_of8((floats_at(near) <= floats_at(far)) & used);
}

_Static_assert((int)BOXES_WIDE == (int)WIDTH && offsetof(boxes_node, high) == 3 * sizeof(float[WIDTH]),
               "box_distances reads a node as it reads that of a mesh");

/* Called with each item whose box the ray may enter before t_max. Returns t_max or a smaller bound; a negative one ends
 * the search. */
typedef double boxes_visit(void *context, int item, double t_max);

/* Prefetches the data of an item that will probably be visited soon: in large hierarchies the time goes into waiting
 * for memory. */
typedef void boxes_fetch(void *context, int item);

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
                             uint64_t entered, const float *near, boxes_fetch *fetch, void *context)
{
    const int first = size;
    for (; entered; entered = LANES_LESS_FIRST(entered)) {
        const unsigned child = lane_first(entered);
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
    _Alignas(32) float near[BOXES_WIDE];
    boxes_ray r = boxes_ray_start(b, origin, direction, t_min, t_max);
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
            r.t_max = float_above(t_max);
        }
    }
}

/* --- the rays of a batch ---
 *
 * They walk the tree once: each visited node is tested with all rays that enter its box (Barringer and Akenine-Moller,
 * "Dynamic ray stream traversal", ACM TOG 33(4), 2014). So a node is read once for them, and while its other rays are
 * tested, its children arrive from memory. */

/* Called with an item and the numbers of the rays that may enter its box. */
typedef void boxes_visit_rays(void *context, int item, const uint16_t *rays, int count);

/* A child on the stack, and its rays: `count` numbers in the list, from `first` on. */
typedef struct boxes_listed {
    int32_t child;
    int first, count;
} boxes_listed;

enum { BOXES_LIST = (BOXES_DEPTH_MAX * BOXES_WIDE + 1) * BATCH };

/* Lists the unsettled rays of `next` by the child that they enter, and pushes these children; returns the new size. */
ALWAYS_INLINE int boxes_push_listed(const solid_boxes *b, const boxes_ray *rays, const int64_t *settled,
                                    boxes_listed next, uint16_t *list, boxes_listed *stack, int size,
                                    boxes_fetch *fetch, void *context)
{
    const boxes_node *n = &b->nodes[next.child];
    const int room = next.first + next.count;
    int counts[BOXES_WIDE] = {0};
    for (int k = next.first; k < room; k++) {
        const uint16_t ray = list[k];
        _Alignas(32) float near[BOXES_WIDE];
        if (settled[ray])
            continue;
        for (uint64_t set = boxes_entered(n, &rays[ray], near); set; set = LANES_LESS_FIRST(set)) {
            const unsigned child = lane_first(set);
            list[room + (int)child * next.count + counts[child]++] = ray;
        }
    }
    for (int i = 0; i < BOXES_WIDE; i++) {
        if (counts[i] == 0)
            continue;
        stack[size++] = (boxes_listed){n->child[i], room + i * next.count, counts[i]};
        if (n->child[i] >= 0)
            boxes_fetch_node(b, n->child[i]);
        else
            fetch(context, ~n->child[i]);
    }
    return size;
}

/* Visits the items whose boxes the rays may enter, in any order. A ray may be settled by any visit; it is then not
 * reported again. */
ALWAYS_INLINE void boxes_traverse_rays(const solid_boxes *b, const boxes_ray *rays, int count, const int64_t *settled,
                                       boxes_visit_rays *visit, boxes_fetch *fetch, void *context)
{
    uint16_t list[BOXES_LIST];
    boxes_listed stack[BOXES_DEPTH_MAX * (BOXES_WIDE - 1) + 1] = {{0, 0, count}};
    for (int i = 0; i < count; i++)
        list[i] = (uint16_t)i;
    for (int size = 1; size > 0;) {
        const boxes_listed next = stack[--size];
        if (next.child >= 0)
            size = boxes_push_listed(b, rays, settled, next, list, stack, size, fetch, context);
        else
            visit(context, ~next.child, list + next.first, next.count);
    }
}
