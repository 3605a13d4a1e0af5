/* The conservative ray-box test of the hierarchies: single precision, eight boxes at a time. It never misses a box that
 * contains a hit triangle: box planes are floats rounded outwards, and distances to near planes are decreased, to far
 * planes increased, by more than the rounding errors (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). A box is
 * culled only if it begins beyond the best hit, not at it, so that of two triangles at one distance the lower number
 * wins in any order of traversal. */
#pragma once

#include "geometry/hierarchy_query.h"

enum { STACK = BVH_DEPTH_MAX * (WIDTH - 1) + WIDTH }; /* children that wait during the traversal */
#define FLOAT_STEP 0x1p-22f                           /* relative; more than two steps between floats */
#define FLOAT_TINY 1e-37f /* absolute, for values near 0: several times the smallest normal float */

ALWAYS_INLINE float float_above(double v)
{
    const float f = (float)v;
    return f + (__builtin_fabsf(f) * FLOAT_STEP + FLOAT_TINY);
}
ALWAYS_INLINE float float_below(double v)
{
    const float f = (float)v;
    return f - (__builtin_fabsf(f) * FLOAT_STEP + FLOAT_TINY);
}

/* The ray prepared for the box test: the distance to a plane p across an axis is p inverse + near_offset, or
 * far_offset. A node stores its low planes before its high planes; near and far are the offsets in bytes of the planes
 * that this ray enters and leaves by. */
typedef struct box_ray {
    float inverse[3], near_offset[3], far_offset[3];
    size_t near[3], far[3];
    float t_min;
} box_ray;

/* With u = 2^-24, a plane within the reach B and an origin o: inverse is 1 / d with an error of at most 2 u, so that
 * p inverse errs by 3 u, o inverse by 4 u, and the two sums by 2 u of (B + |o|) / |d|: together less than half of
 * BOX_SLACK.
 *
 * For |d| below 1 / STEEPEST the inverse is limited, which brings planes nearer: that is conservative for the near
 * distance. The far distance is BEYOND every t: in the frame of a mesh that is scaled to a thin sheet, a hit's t can be
 * 1e12 times the reach along the sheet. It is finite, so that the planes of unused children, which are infinite, do not
 * give NaN. */
#define BOX_SLACK 0x1p-20f
#define STEEPEST 0x1p30f
#define BEYOND 0x1p126f
#define REACH_LEAST 1e-30f /* keeps the margin a normal number */

ALWAYS_INLINE float box_margin(float reach, float origin)
{
    return (reach + __builtin_fabsf(origin) + REACH_LEAST) * BOX_SLACK;
}

/* The low planes of an axis, and the high planes, in bytes from the node's start. */
ALWAYS_INLINE size_t low_planes(int axis)
{
    return (size_t)axis * WIDTH * sizeof(float);
}
ALWAYS_INLINE size_t high_planes(int axis)
{
    return low_planes(axis + 3);
}

ALWAYS_INLINE void box_ray_start(box_ray *b, const hierarchy *h, const ray_query *q)
{
    for (int k = 0; k < 3; k++) {
        const bool down = q->direction[k] < 0.0;
        const float origin = (float)q->origin[k], limit = down ? -STEEPEST : STEEPEST;
        const bool steep = !(magnitude(q->inverse[k]) < (double)STEEPEST);
        const float inverse = steep ? limit : (float)q->inverse[k];
        const float margin = box_margin(h->reach[k], origin) * __builtin_fabsf(inverse);
        b->inverse[k] = inverse;
        b->near_offset[k] = -origin * inverse - margin;
        b->far_offset[k] = steep ? BEYOND : -origin * inverse + margin;
        b->near[k] = down ? high_planes(k) : low_planes(k);
        b->far[k] = down ? low_planes(k) : high_planes(k);
    }
    const float t_min = float_below(q->t_min);
    b->t_min = t_min > 0.0f ? t_min : 0.0f;
}

/* A child on the stack: its distance, which is not negative, in the upper half, its number in the lower. Non-negative
 * floats sort by their bits. */
ALWAYS_INLINE uint64_t pending(float near, uint32_t child)
{
    uint32_t bits;
    memcpy(&bits, &near, sizeof bits);
    return (uint64_t)bits << 32 | child;
}

ALWAYS_INLINE float pending_near(uint64_t p)
{
    const uint32_t bits = (uint32_t)(p >> 32);
    float near;
    memcpy(&near, &bits, sizeof near);
    return near;
}

/* The planes of a node's boxes at an offset. */
ALWAYS_INLINE const float *planes_at(const bvh_node *node, size_t offset)
{
    return (const float *)(const void *)((const char *)node + offset);
}

/* Fetches what a child refers to, for which the traversal would wait in a large mesh. */
ALWAYS_INLINE void fetch_child(const hierarchy *h, uint32_t child, size_t block_bytes)
{
    const char *at = child & CHILD_LEAF ? (const char *)h->blocks + child_first_block(child) * block_bytes
                                        : (const char *)&h->nodes[child];
    for (int line = 0; line < 4; line++)
        __builtin_prefetch(at + line * 64);
}

/* Traverses from a child that a group of rays has already reached. */
void KERNEL(walk_bvh_from)(const hierarchy *h, ray_query *q, const box_ray *b, enum query_mode mode, uint32_t at);
