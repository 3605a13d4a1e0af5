/* The triangles of a leaf against a packet. Edge functions and distances in single precision reject the rays that
 * certainly miss a triangle, 16 at a time; those that remain are collected and tested in doubles
 * (hierarchy_packet_exact_kernel.c). */
#include "geometry/hierarchy_packet.h"

/* The largest errors in single precision, for rays that enter the box of the triangle's leaf. */
typedef struct leaf_errors {
    float edge;           /* of an edge function */
    float t, t_by_weight; /* of a distance: t + t_by_weight / |sum of the edge functions| */
} leaf_errors;

/* With u = 2^-24, C and R the largest coordinates of the box and of the rays' origins: origin, direction, shear (at
 * most 1 in magnitude) and base come with errors of u R, u, 4.1 u and 9.2 u R, and a sheared coordinate
 * (c_x - s c_z) - base with at most e = 12 u (C + R). Of a ray that hits a triangle, and so passes through
 * its box, a sheared coordinate is at most M, twice the box's largest edge E; the margin of M covers the rounding of
 * such a ray. Rays that only the box test's margins let in hit nothing, and may be rejected. Then an edge function
 * x_2 y_1 - y_2 x_1 has an error of at most d = 4 e M + 2 e^2 + 4.1 u M^2.
 *
 * A distance, for weights of one sign, is s_z (z_0 + (v (z_1 - z_0) + w (z_2 - z_0)) / (u + v + w)): the quotient is at
 * most E, and its error 5.1 d E / |u + v + w| and a few u E; the other terms add less than 16 u (C + R). */
static leaf_errors errors_of(const packet *p, const bvh_node *node, uint32_t slot)
{
    float reach = 0.0f, edge = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float low = node->low[k][slot], high = node->high[k][slot];
        edge = high - low > edge ? high - low : edge;
        reach = -low > reach ? -low : reach;
        reach = high > reach ? high : reach;
    }
    const float u = 0x1p-24f, far = reach + p->reach, e = 12.5f * u * far, m = 2.01f * edge + 0x1p-17f * far;
    const float d = (4.0f * e * m + 2.0f * e * e + 4.5f * u * m * m) * 1.01f + FLOAT_TINY;
    return (leaf_errors){d, 20.0f * u * (edge + far) + FLOAT_TINY, 7.0f * d * edge + FLOAT_TINY};
}

/* The edge functions of sixteen rays: two of them, and their sum. */
typedef struct weights {
    _Alignas(64) float v[LANES], w[LANES], det[LANES];
} weights;

/* The rays among sixteen, from slot i on, that single precision does not prove to pass outside of the triangle.
 * corner[axis][corner], along the axes x, y, z of the packet. */
ALWAYS_INLINE unsigned maybe_inside(const packet *p, int i, const float (*corner)[3], float error,
                                    weights *restrict out)
{
    const float *restrict sx = &p->shear_x[i], *restrict sy = &p->shear_y[i], *restrict bx = &p->base_x[i],
                          *restrict by = &p->base_y[i];
    const float cx0 = corner[0][0], cx1 = corner[0][1], cx2 = corner[0][2], cy0 = corner[1][0], cy1 = corner[1][1],
                cy2 = corner[1][2], cz0 = corner[2][0], cz1 = corner[2][1], cz2 = corner[2][2];
    _Alignas(64) int32_t inside[LANES];
    /* VECTORISE */
    for (int k = 0; k < LANES; k++) {
        const float x0 = (cx0 - sx[k] * cz0) - bx[k], y0 = (cy0 - sy[k] * cz0) - by[k];
        const float x1 = (cx1 - sx[k] * cz1) - bx[k], y1 = (cy1 - sy[k] * cz1) - by[k];
        const float x2 = (cx2 - sx[k] * cz2) - bx[k], y2 = (cy2 - sy[k] * cz2) - by[k];
        const float u = x2 * y1 - y2 * x1, v = x0 * y2 - y0 * x2, w = x1 * y0 - y1 * x0;
        const float uv = u < v ? u : v, vu = u > v ? u : v;
        const float least = uv < w ? uv : w, most = vu > w ? vu : w;
        /* not both: one below zero, one above */
        const float below = -least, lesser_of_both = below < most ? below : most;
        inside[k] = lesser_of_both > error ? 0 : -1;
        out->v[k] = v;
        out->w[k] = w;
        out->det[k] = u + v + w;
    }
    return bits_of16(inside);
}

/* The rays among sixteen for which single precision does not prove that the triangle is out of the ray's range. A sum
 * of weights of zero makes the error infinite or NaN, and the ray is kept. */
ALWAYS_INLINE unsigned maybe_in_range(const packet *p, int i, const float *z, const leaf_errors *errors,
                                      const weights *restrict f)
{
    const float *restrict oz = &p->origin_z[i], *restrict sz = &p->shear_z[i], *restrict t_min = &p->t_min[i],
                          *restrict t_best = &p->t_best[i];
    const float z0 = z[0], z1 = z[1] - z[0], z2 = z[2] - z[0], least = errors->t, by_weight = errors->t_by_weight;
    _Alignas(64) int32_t in[LANES];
    /* VECTORISE */
    for (int k = 0; k < LANES; k++) {
        const float inverse = 1.0f / f->det[k], error = least + by_weight * __builtin_fabsf(inverse);
        const float t = (z0 - oz[k] + (f->v[k] * z1 + f->w[k] * z2) * inverse) * sz[k];
        const float beyond = (t - error) - t_best[k], before = t_min[k] - (t + error);
        const float out = beyond > before ? beyond : before;
        in[k] = out > 0.0f ? 0 : -1;
    }
    return bits_of16(in);
}

/* A triangle's corner along an axis of the mesh; lane: of the block. */
ALWAYS_INLINE double corner_of(const void *block, bool single, int corner, int axis, int lane)
{
    return single ? (double)((const block_single *)block)->corner[corner][axis][lane]
                  : ((const block_double *)block)->corner[corner][axis][lane];
}

/* Tests the triangle in a lane of a block. */
ALWAYS_INLINE void test_triangle(packet *p, const ray_set *set, enum query_mode mode, const void *block, bool single,
                                 int lane, const leaf_errors *errors, uint32_t triangle)
{
    float turned[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            turned[k][j] = (float)corner_of(block, single, j, p->axis[k], lane);
    uint64_t words[TOGETHER / 64] = {0};
    for (int g = 0; g < p->groups; g++) {
        unsigned bits = set->bits[g] & p->alive.bits[g];
        weights f;
        if (bits)
            bits &= maybe_inside(p, g * LANES, (const float(*)[3])turned, errors->edge, &f);
        if (bits)
            words[g / 4] |= (uint64_t)(bits & maybe_in_range(p, g * LANES, turned[2], errors, &f)) << g % 4 * LANES;
    }
    uint8_t slots[TOGETHER];
    int count = 0;
    for (int i = 0; i < TOGETHER / 64; i++)
        for (uint64_t word = words[i]; word; word = LANES_LESS_FIRST(word)) {
            const int slot = i * 64 + __builtin_ctzll(word);
            slots[count] = (uint8_t)slot;
            count += p->rays[p->number[slot]].skip != triangle;
        }
    if (count == 0)
        return;
    double corner[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            corner[k][j] = corner_of(block, single, j, k, lane);
    KERNEL(packet_test)(p, slots, count, mode, (const double(*)[3])corner, triangle);
}

ALWAYS_INLINE void test_leaf(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, uint32_t leaf,
                             const leaf_errors *errors, bool single)
{
    for (uint32_t b = child_first_block(leaf); b < child_first_block(leaf) + child_blocks(leaf); b++) {
        const block_single *floats = (const block_single *)h->blocks + b;
        const block_double *doubles = (const block_double *)h->blocks + b;
        const void *block = single ? (const void *)floats : (const void *)doubles;
        const uint32_t *numbers = single ? floats->triangle : doubles->triangle;
        for (int lane = 0; lane < BLOCK && !(lane > 0 && numbers[lane] == numbers[lane - 1]); lane++)
            test_triangle(p, set, mode, block, single, lane, errors, numbers[lane]);
    }
}

void KERNEL(packet_leaf)(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, const bvh_node *node,
                         uint32_t slot)
{
    const leaf_errors errors = errors_of(p, node, slot);
    if (h->single)
        test_leaf(h, p, set, mode, node->child[slot], &errors, true);
    else
        test_leaf(h, p, set, mode, node->child[slot], &errors, false);
    if (p->changed)
        p->t_farthest = most_of_row(p->t_best, p->groups * LANES);
    p->changed = false;
}
