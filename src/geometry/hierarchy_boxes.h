/* The conservative ray-box test of the hierarchies: single precision, eight boxes at a time. It never misses a box that
 * contains a hit triangle: box planes are floats rounded outwards, the ray's origin is rounded to both sides by more
 * than necessary, and distances to near planes are decreased, to far planes increased, by more than the rounding error
 * of the three operations (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). A box is culled only if it begins beyond
 * the best hit, not at it, so that of two triangles at one distance the lower number wins in any order of traversal. */
#pragma once

#include "geometry/hierarchy_query.h"

/* The ray prepared for the box test. A node stores its low planes before its high planes; near and far are the offsets
 * of the planes that this ray enters and leaves by. */
typedef struct box_ray {
    float near_origin[3], far_origin[3], near_inverse[3], far_inverse[3];
    int near[3], far[3];
    float t_min;
} box_ray;

enum { STACK = BVH_DEPTH_MAX * (WIDTH - 1) + WIDTH }; /* children that wait during the traversal */
#define BOX_SLACK 0x1p-21f                            /* more than three roundings of 2^-24 each */
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

ALWAYS_INLINE void box_ray_start(box_ray *b, const ray_query *q)
{
    for (int k = 0; k < 3; k++) {
        const bool parallel = magnitude(q->direction[k]) < PARALLEL, down = q->direction[k] < 0.0;
        const double margin = parallel ? 2.0 * PARALLEL_MARGIN : 0.0;
        const float above = float_above(q->origin[k] + margin), below = float_below(q->origin[k] - margin);
        /* For a parallel component, a finite number near FLT_MAX: an infinite one would make NaN of a distance of 0. */
        const float inverse = parallel ? (down ? -1e38f : 1e38f) : (float)q->inverse[k];
        b->near_origin[k] = down ? below : above;
        b->far_origin[k] = down ? above : below;
        b->near_inverse[k] = inverse * (1.0f - BOX_SLACK);
        b->far_inverse[k] = inverse * (1.0f + BOX_SLACK);
        b->near[k] = WIDTH * (k + (down ? 3 : 0));
        b->far[k] = WIDTH * (k + (down ? 0 : 3));
    }
    const float t_min = float_below(q->t_min);
    b->t_min = t_min > 0.0f ? t_min : 0.0f;
}

/* A child on the stack: its distance in the upper half, its number in the lower. Non-negative floats sort by their
 * bits. */
ALWAYS_INLINE uint64_t pending(float near, uint32_t child)
{
    uint32_t bits;
    near = near > 0.0f ? near : 0.0f;
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

/* The entry and exit distances of a node's boxes. */
ALWAYS_INLINE void slabs(const bvh_node *node, const box_ray *b, float *__restrict near, float *__restrict far)
{
    const float *p = (const float *)(const void *)node;
    const float *__restrict nx = p + b->near[0], *__restrict ny = p + b->near[1], *__restrict nz = p + b->near[2];
    const float *__restrict fx = p + b->far[0], *__restrict fy = p + b->far[1], *__restrict fz = p + b->far[2];
    /* VECTORISE */
    for (int i = 0; i < WIDTH; i++) {
        const float x = (nx[i] - b->near_origin[0]) * b->near_inverse[0],
                    y = (ny[i] - b->near_origin[1]) * b->near_inverse[1],
                    z = (nz[i] - b->near_origin[2]) * b->near_inverse[2];
        const float u = (fx[i] - b->far_origin[0]) * b->far_inverse[0],
                    v = (fy[i] - b->far_origin[1]) * b->far_inverse[1],
                    w = (fz[i] - b->far_origin[2]) * b->far_inverse[2];
        const float xy = x > y ? x : y, uv = u < v ? u : v;
        near[i] = xy > z ? xy : z;
        far[i] = uv < w ? uv : w;
    }
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
