/* The triangle test of hierarchy_query.h for rays of a packet, eight at a time, operation by operation: the hits are
 * bit-identical. */
#include "geometry/hierarchy_packet.h"

/* A triangle's hits by eight rays, as in mesh_hit; what depends on the ray's other limits is left to the caller. */
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

/* query_blocks and query_consider for eight rays and one triangle, operation by operation. axis: x, y, z of the packet;
 * corner[axis of the mesh][corner]. */
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

/* Does the ray in a slot accept the hit, as in query_blocks and query_consider? */
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

void KERNEL(packet_test)(packet *p, const uint8_t *slots, int count, enum query_mode mode, const double (*corner)[3],
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
