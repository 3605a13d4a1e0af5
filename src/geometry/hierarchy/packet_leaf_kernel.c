/* The triangles of a leaf against a packet. Edge functions and distances in single precision reject the rays that
 * certainly miss a triangle, 16 at a time; those that remain are collected and tested in doubles, eight at a time. */
#include "geometry/hierarchy/packet.h"

/* --- rejection in single precision --- */

/* The largest errors in single precision, for rays that enter the box of the triangle's leaf. */
typedef struct leaf_errors {
    float edge;           /* of an edge function */
    float t, t_by_weight; /* of a distance: t + t_by_weight / |sum of the edge functions| */
} leaf_errors;

/* With u = 2^-24, C and R the largest coordinates of the box and of the rays' origins: origin, direction, shear (at
 * most 1 in magnitude) and base come with errors of u R, u, 4.1 u and 9.2 u R, and a sheared coordinate (c_x - s c_z) -
 * base with at most e = 12 u (C + R). If a ray hits a triangle, and so passes through its box, a sheared coordinate is
 * at most M, twice the box's largest edge E; the margin of M covers the rounding of such a ray. Rays that enter only
 * the margin of the box test hit nothing, and may be rejected. Then an edge function x_2 y_1 - y_2 x_1 has an error of
 * at most d = 4 e M + 2 e^2 + 4.1 u M^2.
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

/* The edge functions of sixteen rays: the second and third, and the sum of all three. */
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
        const float x0 = MULTIPLY_ADD(-sx[k], cz0, cx0 - bx[k]), y0 = MULTIPLY_ADD(-sy[k], cz0, cy0 - by[k]);
        const float x1 = MULTIPLY_ADD(-sx[k], cz1, cx1 - bx[k]), y1 = MULTIPLY_ADD(-sy[k], cz1, cy1 - by[k]);
        const float x2 = MULTIPLY_ADD(-sx[k], cz2, cx2 - bx[k]), y2 = MULTIPLY_ADD(-sy[k], cz2, cy2 - by[k]);
        const float u = MULTIPLY_ADD(x2, y1, -(y2 * x1)), v = MULTIPLY_ADD(x0, y2, -(y0 * x2)),
                    w = MULTIPLY_ADD(x1, y0, -(y1 * x0));
        const float uv = u < v ? u : v, vu = u > v ? u : v;
        const float least = uv < w ? uv : w, most = vu > w ? vu : w;
        /* one is certainly below zero and another above: the ray passes outside */
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

/* --- the triangle test in doubles ---
 *
 * The operations of query.h in the same order: the hits are bit-identical. */

/* A triangle's hits by eight rays, as in mesh_hit; the caller compares them with the ray's other limits. */
typedef struct eight_hits {
    _Alignas(64) double t_scaled[EIGHT], t_least[EIGHT], t[EIGHT], u[EIGHT], v[EIGHT];
    _Alignas(64) int64_t facing[EIGHT], accepted[EIGHT];
} eight_hits;

ALWAYS_INLINE double least_of_three(double a, double b, double c)
{
    return lesser(lesser(a, b), c);
}
ALWAYS_INLINE double most_of_three(double a, double b, double c)
{
    return greater(greater(a, b), c);
}

/* One axis of query_clamp: the ray's range within the slab from low to high. Returns 0 if a parallel ray misses it. */
ALWAYS_INLINE int64_t clamp_axis(double origin, double direction, double low, double high, double *near, double *far)
{
    const double inverse = 1.0 / direction, l = low - origin, h = high - origin;
    const int64_t parallel = mask_less(magnitude(direction), PARALLEL);
    const int64_t aside = mask_less(PARALLEL_MARGIN, l) | mask_less(h, -PARALLEL_MARGIN);
    const double a = l * inverse, b = h * inverse, in = lesser(a, b), out = greater(a, b);
    *near = blend(parallel, *near, greater(*near, in - magnitude(in) * BOX_MARGIN));
    *far = blend(parallel, *far, lesser(*far, out + magnitude(out) * BOX_MARGIN));
    return ~(parallel & aside);
}

/* query_blocks and query_test_triangle for eight rays and one triangle, operation by operation. axis: x, y, z of the
 * packet; corner[axis of the mesh][corner]. */
static void test_eight(const double (*restrict column)[EIGHT], const int *axis, const double (*corner)[3],
                       eight_hits *restrict out)
{
    const double *restrict ox = column[ORIGIN + axis[0]], *restrict oy = column[ORIGIN + axis[1]],
                           *restrict oz = column[ORIGIN + axis[2]], *restrict dx = column[DIRECTION + axis[0]],
                           *restrict dy = column[DIRECTION + axis[1]], *restrict dz = column[DIRECTION + axis[2]],
                           *restrict t_min = column[T_MIN];
    const double *cx = corner[axis[0]], *cy = corner[axis[1]], *cz = corner[axis[2]];
    const double ax = cx[0], bx = cx[1], ex = cx[2], ay = cy[0], by = cy[1], ey = cy[2], az = cz[0], bz = cz[1],
                 ez = cz[2];
    /* The clamp goes through the axes of the mesh in order, as query_clamp: the order decides the sign of a zero. */
    const double *restrict o0 = column[ORIGIN], *restrict o1 = column[ORIGIN + 1], *restrict o2 = column[ORIGIN + 2],
                           *restrict d0 = column[DIRECTION], *restrict d1 = column[DIRECTION + 1],
                           *restrict d2 = column[DIRECTION + 2];
    const double low0 = least_of(corner[0]), high0 = most_of(corner[0]), low1 = least_of(corner[1]),
                 high1 = most_of(corner[1]), low2 = least_of(corner[2]), high2 = most_of(corner[2]);
    /* VECTORISE */
    for (int k = 0; k < EIGHT; k++) {
        const int64_t exponent = lanes_bits(dz[k]) >> 52 & 0x7ff;
        const double scale = lanes_double((2046 - exponent) << 52), unscale = lanes_double(exponent << 52);
        const double sz = 1.0 / (dz[k] * scale), sx = dx[k] * scale * sz, sy = dy[k] * scale * sz;
        const double start = greater(t_min[k], 0.0) * unscale;
        const double z0 = az - oz[k], x0 = (ax - ox[k]) - sx * z0, y0 = (ay - oy[k]) - sy * z0;
        const double z1 = bz - oz[k], x1 = (bx - ox[k]) - sx * z1, y1 = (by - oy[k]) - sy * z1;
        const double z2 = ez - oz[k], x2 = (ex - ox[k]) - sx * z2, y2 = (ey - oy[k]) - sy * z2;
        const double u = x2 * y1 - y2 * x1, v = x0 * y2 - y0 * x2, w = x1 * y0 - y1 * x0, det = u + v + w;
        const int64_t inside = ~(mask_less(least_of_three(u, v, w), 0.0) & mask_less(0.0, most_of_three(u, v, w)));
        const double t0 = sz * z0, t1 = sz * z1, t2 = sz * z2, plane = (u * t0 + v * t1 + w * t2) / det;
        const int64_t behind = mask_less(most_of_three(t0, t1, t2) * (1.0 + 2.0 * BOX_MARGIN), start);
        const int64_t front = mask_less(0.0, det), back = mask_less(det, 0.0);
        const int64_t facing = (front & FACING_FRONT) | (~front & FACING_BACK);
        const int64_t across =
            mask_less_equal(least_of_three(x0, x1, x2), 0.0) & mask_less_equal(0.0, most_of_three(x0, x1, x2)) &
            mask_less_equal(least_of_three(y0, y1, y2), 0.0) & mask_less_equal(0.0, most_of_three(y0, y1, y2));
        double near = -(double)INFINITY, far = (double)INFINITY;
        int64_t box = clamp_axis(o0[k], d0[k] * scale, low0, high0, &near, &far);
        box &= clamp_axis(o1[k], d1[k] * scale, low1, high1, &near, &far);
        box &= clamp_axis(o2[k], d2[k] * scale, low2, high2, &near, &far);
        box &= mask_less_equal(near, far) & mask_less_equal(start, far);
        const double t = greater(plane, near);
        out->accepted[k] = inside & ~behind & (front | back) & across & box & mask_less_equal(start, t);
        out->t_least[k] = least_of_three(t0, t1, t2) * (1.0 - 2.0 * BOX_MARGIN);
        out->t_scaled[k] = t;
        out->t[k] = t * scale;
        out->u[k] = v / det;
        out->v[k] = w / det;
        out->facing[k] = facing;
    }
}

ALWAYS_INLINE unsigned accepted_bits(const eight_hits *found)
{
    int8x64 mask;
    memcpy(&mask, found->accepted, sizeof mask);
    return bits_of8(mask);
}

/* Whether the ray in a slot accepts the hit, as in query_blocks and query_test_triangle. */
ALWAYS_INLINE bool accepts(const packet *p, int slot, enum query_mode mode, const eight_hits *found, int k,
                           uint32_t triangle)
{
    const int number = p->number[slot];
    const mesh_ray *ray = &p->rays[number];
    const double limit = p->t_limit[slot], t = found->t_scaled[k];
    if (!(t <= limit) || found->t_least[k] > limit || !(found->facing[k] & ray->facing) || ray->skip == triangle)
        return false;
    return mode == QUERY_ANY || t < limit || triangle < p->hits[number].triangle;
}

static void packet_test(packet *p, const uint8_t *slots, int count, enum query_mode mode, const double (*corner)[3],
                        uint32_t triangle)
{
    for (int first = 0; first < count; first += EIGHT) {
        const int n = count - first < EIGHT ? count - first : EIGHT;
        const mesh_ray *rays[EIGHT];
        _Alignas(64) double column[EIGHT][EIGHT];
        eight_hits found;
        for (int k = 0; k < EIGHT; k++)
            rays[k] = &p->rays[p->number[slots[first + (k < n ? k : 0)]]];
        ray_lanes_read(column[0], EIGHT, rays);
        test_eight((const double(*)[EIGHT])column, p->axis, corner, &found);
        for (unsigned set = accepted_bits(&found) & ((1u << n) - 1); set; set = LANES_LESS_FIRST(set)) {
            const int k = __builtin_ctz(set), slot = slots[first + k], at = p->number[slot];
            if (!accepts(p, slot, mode, &found, k, triangle))
                continue;
            p->changed = true;
            if (mode == QUERY_ANY) {
                p->blocked[at] = true;
                p->t_best[slot] = -1.0f;
                p->alive.bits[slot / LANES] &= (uint16_t) ~(1u << slot % LANES);
            } else {
                p->hits[at] = (mesh_hit){found.t[k], found.u[k], found.v[k], triangle, (int)found.facing[k]};
                p->t_limit[slot] = found.t_scaled[k];
                p->t_best[slot] = float_above(found.t_scaled[k]);
            }
        }
    }
}

/* --- leaves --- */

/* A triangle's corner along an axis of the mesh; lane: of the block. */
ALWAYS_INLINE double corner_of(const void *block, bool single, int corner, int axis, int lane)
{
    return single ? (double)((const block_single *)block)->corner[corner][axis][lane]
                  : ((const block_double *)block)->corner[corner][axis][lane];
}

/* The rays of a set, and the groups that have any. */
typedef struct leaf_groups {
    ray_set rays;
    int count, number[GROUPS];
} leaf_groups;

/* Tests the triangle in a lane of a block. */
ALWAYS_INLINE void test_triangle(packet *p, const leaf_groups *groups, enum query_mode mode, const void *block,
                                 bool single, int lane, const leaf_errors *errors, uint32_t triangle)
{
    float turned[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            turned[k][j] = (float)corner_of(block, single, j, p->axis[k], lane);
    /* First all groups, without a branch that depends on their rays: the processor would often guess it wrong. */
    weights f[GROUPS];
    uint16_t inside[GROUPS];
    for (int i = 0; i < groups->count; i++) {
        const int g = groups->number[i];
        inside[i] = (uint16_t)(maybe_inside(p, g * LANES, (const float(*)[3])turned, errors->edge, &f[i]) &
                               groups->rays.bits[g]);
    }
    uint64_t words[PACKET_MAX / 64] = {0};
    for (int i = 0; i < groups->count; i++) {
        const int g = groups->number[i];
        const unsigned bits = inside[i] & p->alive.bits[g];
        if (bits)
            words[g / 4] |= (uint64_t)(bits & maybe_in_range(p, g * LANES, turned[2], errors, &f[i])) << g % 4 * LANES;
    }
    uint8_t slots[PACKET_MAX];
    int count = 0;
    for (int i = 0; i < PACKET_MAX / 64; i++)
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
    packet_test(p, slots, count, mode, (const double(*)[3])corner, triangle);
}

ALWAYS_INLINE void test_leaf(const hierarchy *h, packet *p, const leaf_groups *groups, enum query_mode mode,
                             uint32_t leaf, const leaf_errors *errors, bool single)
{
    for (uint32_t b = child_first_block(leaf); b < child_first_block(leaf) + child_blocks(leaf); b++) {
        const block_single *floats = (const block_single *)h->blocks + b;
        const block_double *doubles = (const block_double *)h->blocks + b;
        const void *block = single ? (const void *)floats : (const void *)doubles;
        const uint32_t *numbers = single ? floats->triangle : doubles->triangle;
        for (int lane = 0; lane < BLOCK && !(lane > 0 && numbers[lane] == numbers[lane - 1]); lane++)
            test_triangle(p, groups, mode, block, single, lane, errors, numbers[lane]);
    }
}

void KERNEL(packet_leaf)(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, const bvh_node *node,
                         uint32_t slot)
{
    const leaf_errors errors = errors_of(p, node, slot);
    leaf_groups groups = {.rays = *set};
    for (int g = 0; g < p->groups; g++) {
        groups.number[groups.count] = g;
        groups.count += set->bits[g] != 0;
    }
    if (h->single)
        test_leaf(h, p, &groups, mode, node->child[slot], &errors, true);
    else
        test_leaf(h, p, &groups, mode, node->child[slot], &errors, false);
    if (p->changed)
        p->t_farthest = most_of_row(p->t_best, p->groups * LANES);
    p->changed = false;
}
