/* The way down the hierarchy `bvh`; see hierarchy_query.h for the triangle test.
 *
 * Boxes are met in single precision, eight at a time, and never missed where a triangle in them is hit: planes are single numbers rounded
 * outwards, the ray's origin is rounded to both sides by more than it needs, and distances to near planes are made smaller, to far ones
 * larger, by more than the rounding of the three operations (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). A box is left out only if it
 * begins beyond the best hit, not at it, so that the lower number of two triangles at one distance is found whichever comes first. */
#include "geometry/hierarchy_query.h"

/* The ray for boxes. Planes of a node stand in a row, low ones before high ones; near and far say which is which for this ray. */
typedef struct box_ray {
    float near_origin[3], far_origin[3], near_inverse[3], far_inverse[3];
    int near[3], far[3];
    float t_min;
} box_ray;

enum { STACK = BVH_DEPTH_MAX * (WIDTH - 1) + WIDTH };
#define BOX_SLACK 0x1p-21f /* of 2^-24 a rounding, of which there are three */
#define FLOAT_STEP 0x1p-22f /* more than from one float to the next but one */
#define FLOAT_TINY 1e-37f

ALWAYS_INLINE float float_above(double v) { const float f = (float)v; return f + (__builtin_fabsf(f) * FLOAT_STEP + FLOAT_TINY); }
ALWAYS_INLINE float float_below(double v) { const float f = (float)v; return f - (__builtin_fabsf(f) * FLOAT_STEP + FLOAT_TINY); }

ALWAYS_INLINE void box_ray_start(box_ray *b, const ray_query *q)
{
    for (int k = 0; k < 3; k++) {
        const bool parallel = magnitude(q->direction[k]) < PARALLEL, down = q->direction[k] < 0.0;
        const double margin = parallel ? 2.0 * PARALLEL_MARGIN : 0.0;
        const float above = float_above(q->origin[k] + margin), below = float_below(q->origin[k] - margin);
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

/* A child on the stack: its distance above its number; where that is not negative it sorts by its bits. */
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

/* Where the ray meets the planes of a node's boxes. */
ALWAYS_INLINE void slabs(const bvh_node *node, const box_ray *b, float *restrict near, float *restrict far)
{
    const float *p = (const float *)(const void *)node;
    const float *restrict nx = p + b->near[0], *restrict ny = p + b->near[1], *restrict nz = p + b->near[2];
    const float *restrict fx = p + b->far[0], *restrict fy = p + b->far[1], *restrict fz = p + b->far[2];
    /* VECTORISE */
    for (int i = 0; i < WIDTH; i++) {
        const float x = (nx[i] - b->near_origin[0]) * b->near_inverse[0], y = (ny[i] - b->near_origin[1]) * b->near_inverse[1],
                    z = (nz[i] - b->near_origin[2]) * b->near_inverse[2];
        const float u = (fx[i] - b->far_origin[0]) * b->far_inverse[0], v = (fy[i] - b->far_origin[1]) * b->far_inverse[1],
                    w = (fz[i] - b->far_origin[2]) * b->far_inverse[2];
        const float xy = x > y ? x : y, uv = u < v ? u : v;
        near[i] = xy > z ? xy : z;
        far[i] = uv < w ? uv : w;
    }
}

ALWAYS_INLINE void walk_bvh(const hierarchy *h, ray_query *q, enum query_mode mode, bool single)
{
    box_ray b;
    box_ray_start(&b, q);
    const float8 t_min = float8_all(b.t_min);
    float t_best = float_above(q->t_best);
    float8 t_max = float8_all(t_best);
    uint64_t stack[STACK];
    int top = 0;
    uint32_t at = 0;
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

void KERNEL(walk_bvh)(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    if (mode == QUERY_NEAREST)
        h->single ? walk_bvh(h, q, QUERY_NEAREST, true) : walk_bvh(h, q, QUERY_NEAREST, false);
    else if (mode == QUERY_ANY)
        h->single ? walk_bvh(h, q, QUERY_ANY, true) : walk_bvh(h, q, QUERY_ANY, false);
    else if (mode == QUERY_BOXES)
        walk_bvh(h, q, QUERY_BOXES, true);
    else
        h->single ? walk_bvh(h, q, QUERY_ALL, true) : walk_bvh(h, q, QUERY_ALL, false);
}
