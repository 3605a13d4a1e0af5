/* The triangles of a leaf against a packet. Edge functions in single precision reject the rays that certainly pass
 * outside of a triangle, 16 at a time; those that remain are collected and tested in doubles, eight at a time, by the
 * test of hierarchy_query.h, operation by operation. So the hits are bit-identical. */
#include "geometry/hierarchy_packet.h"

/* The largest error of an edge function in single precision, for rays that enter the box of the triangle's leaf.
 *
 * With u = 2^-24, C and R the largest coordinates of the box and of the rays' origins: origin, direction, shear (at
 * most 1 in magnitude) and base come with errors of u R, u, 4.1 u and 9.2 u R, and a sheared coordinate
 * (c_x - s c_z) - base with at most e = 12 u (C + R). As the ray passes through the box, a sheared coordinate is at most
 * M, twice the box's largest edge, and what the box test's margins add. Then x_2 y_1 - y_2 x_1 has an error of at most
 * 4 e M + 2 e^2 + 4.1 u M^2. */
static float edge_error(const packet *p, const bvh_node *node, uint32_t slot)
{
    float reach = 0.0f, edge = 0.0f;
    for (int k = 0; k < 3; k++) {
        const float low = node->low[k][slot], high = node->high[k][slot];
        edge = high - low > edge ? high - low : edge;
        reach = -low > reach ? -low : reach;
        reach = high > reach ? high : reach;
    }
    const float u = 0x1p-24f, far = reach + p->reach, e = 12.5f * u * far, m = 2.01f * edge + 0x1p-17f * far;
    return (4.0f * e * m + 2.0f * e * e + 4.5f * u * m * m) * 1.01f + FLOAT_TINY;
}

/* The rays among sixteen, from slot i on, that single precision does not prove to pass outside of the triangle.
 * corner[axis][corner], along the axes x, y, z of the packet. */
ALWAYS_INLINE unsigned maybe_inside(const packet *p, int i, const float (*corner)[3], float error)
{
    const float *restrict sx = &p->shear_x[i], *restrict sy = &p->shear_y[i], *restrict bx = &p->base_x[i],
                          *restrict by = &p->base_y[i];
    const float ax = corner[0][0], bxx = corner[0][1], cx = corner[0][2], ay = corner[1][0], byy = corner[1][1],
                cy = corner[1][2], az = corner[2][0], bz = corner[2][1], cz = corner[2][2];
    _Alignas(64) int32_t inside[LANES];
    /* VECTORISE */
    for (int k = 0; k < LANES; k++) {
        const float x0 = (ax - sx[k] * az) - bx[k], y0 = (ay - sy[k] * az) - by[k];
        const float x1 = (bxx - sx[k] * bz) - bx[k], y1 = (byy - sy[k] * bz) - by[k];
        const float x2 = (cx - sx[k] * cz) - bx[k], y2 = (cy - sy[k] * cz) - by[k];
        const float u = x2 * y1 - y2 * x1, v = x0 * y2 - y0 * x2, w = x1 * y0 - y1 * x0;
        const float uv = u < v ? u : v, vu = u > v ? u : v;
        const float least = uv < w ? uv : w, most = vu > w ? vu : w;
        /* not both: one below zero, one above */
        const float below = -least, lesser_of_both = below < most ? below : most;
        inside[k] = lesser_of_both > error ? 0 : -1;
    }
    return bits_of16(inside);
}

ALWAYS_INLINE double8 least_of_three(const double8 *v)
{
    return double8_lesser(double8_lesser(v[0], v[1]), v[2]);
}
ALWAYS_INLINE double8 most_of_three(const double8 *v)
{
    return double8_greater(double8_greater(v[0], v[1]), v[2]);
}

/* query_clamp for eight rays. */
ALWAYS_INLINE int8x64 clamp_eight(const ray_lanes *r, const double (*corner)[3], double8 t_start, double8 *t)
{
    const double8 zero = double8_all(0.0), one = double8_all(1.0);
    double8 near = double8_all(-(double)INFINITY), far = double8_all((double)INFINITY);
    int8x64 hit = {-1, -1, -1, -1, -1, -1, -1, -1};
    for (int k = 0; k < 3; k++) {
        const double8 o = r->origin[k], inverse = one / r->direction[k];
        const double8 low = double8_all(least_of(corner[k])) - o, high = double8_all(most_of(corner[k])) - o;
        const int8x64 parallel = double8_magnitude(r->direction[k]) < zero + PARALLEL;
        const int8x64 aside = (low > zero + PARALLEL_MARGIN) | (high < zero - PARALLEL_MARGIN);
        const double8 a = low * inverse, b = high * inverse, in = double8_lesser(a, b), out = double8_greater(a, b);
        const double8 first = double8_greater(near, in - double8_magnitude(in) * BOX_MARGIN);
        const double8 last = double8_lesser(far, out + double8_magnitude(out) * BOX_MARGIN);
        near = double8_blend(parallel, near, first);
        far = double8_blend(parallel, far, last);
        hit &= ~(parallel & aside);
    }
    *t = double8_greater(*t, near);
    return hit & (near <= far) & (far >= t_start);
}

/* A triangle's hits by eight rays, as in mesh_hit. */
typedef struct eight_hits {
    double t_scaled[8], t[8], u[8], v[8];
    int64_t facing[8];
} eight_hits;

/* What a ray's record holds besides coordinates. */
typedef struct eight_limits {
    double t_limit[8];
    int64_t skip[8], wanted[8], best[8];
} eight_limits;

/* query_blocks and query_consider for eight rays and one triangle: the rays whose best hit it is so far. axis: x, y, z
 * of the packet; corner[axis of the mesh][corner]. */
static unsigned test_eight(const mesh_ray *const *rays, const eight_limits *limits, const int *axis,
                           const double (*corner)[3], uint32_t triangle, eight_hits *out)
{
    ray_lanes r;
    ray_lanes_read(&r, rays);
    const double8 zero = double8_all(0.0), one = double8_all(1.0);
    const int8x64 exponent = double8_exponent(r.direction[axis[2]]);
    const double8 scale = double8_power(2046 - exponent), unscale = double8_power(exponent);
    for (int k = 0; k < 3; k++)
        r.direction[k] *= scale;
    const double8 sz = one / r.direction[axis[2]], sx = r.direction[axis[0]] * sz, sy = r.direction[axis[1]] * sz;
    const double8 start = double8_greater(r.t_min, zero) * unscale;
    double8 limit, x[3], y[3], z[3];
    int8x64 skip, wanted, best;
    memcpy(&limit, limits->t_limit, sizeof limit);
    memcpy(&skip, limits->skip, sizeof skip);
    memcpy(&wanted, limits->wanted, sizeof wanted);
    memcpy(&best, limits->best, sizeof best);
    for (int j = 0; j < 3; j++) {
        z[j] = double8_all(corner[axis[2]][j]) - r.origin[axis[2]];
        x[j] = (double8_all(corner[axis[0]][j]) - r.origin[axis[0]]) - sx * z[j];
        y[j] = (double8_all(corner[axis[1]][j]) - r.origin[axis[1]]) - sy * z[j];
    }
    const double8 u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
    int8x64 mask = ~(((u < zero) | (v < zero) | (w < zero)) & ((u > zero) | (v > zero) | (w > zero)));
    for (int j = 0; j < 3; j++)
        z[j] = sz * z[j];
    const double8 det = u + v + w;
    double8 t = (u * z[0] + v * z[1] + w * z[2]) / det;
    mask &= t <= limit;
    if (!bits_of8(mask))
        return 0;
    mask &= ~((most_of_three(z) * (1.0 + 2.0 * BOX_MARGIN) < start) |
              (least_of_three(z) * (1.0 - 2.0 * BOX_MARGIN) > limit));
    mask &= skip != (int64_t)triangle;
    const int8x64 front = det > zero, facing = (front & FACING_FRONT) | (~front & FACING_BACK);
    mask &= (front | (det < zero)) & ((facing & wanted) != 0);
    mask &= (least_of_three(x) <= zero) & (most_of_three(x) >= zero) & (least_of_three(y) <= zero) &
            (most_of_three(y) >= zero);
    mask &= clamp_eight(&r, corner, start, &t);
    mask &= (t >= start) & (t <= limit);
    mask &= (t < limit) | (best > (int64_t)triangle);
    const double8 distance = t * scale, second = v / det, third = w / det;
    memcpy(out->t_scaled, &t, sizeof t);
    memcpy(out->t, &distance, sizeof distance);
    memcpy(out->u, &second, sizeof second);
    memcpy(out->v, &third, sizeof third);
    memcpy(out->facing, &facing, sizeof facing);
    return bits_of8(mask);
}

/* Tests the rays in those slots, in doubles. */
static void test_slots(packet *p, const uint8_t *slots, int count, enum query_mode mode, const double (*corner)[3],
                       uint32_t triangle)
{
    for (int first = 0; first < count; first += 8) {
        const int n = count - first < 8 ? count - first : 8;
        const mesh_ray *rays[8];
        eight_limits limits;
        eight_hits found;
        for (int k = 0; k < 8; k++) {
            const int at = p->number[slots[first + (k < n ? k : 0)]];
            rays[k] = &p->rays[at];
            limits.t_limit[k] = p->t_limit[at];
            limits.skip[k] = p->rays[at].skip;
            limits.wanted[k] = p->rays[at].facing;
            limits.best[k] = mode == QUERY_ANY ? TRIANGLE_NONE : p->hits[at].triangle;
        }
        for (unsigned set = test_eight(rays, &limits, p->axis, corner, triangle, &found) & ((1u << n) - 1); set;
             set = LANES_LESS_FIRST(set)) {
            const int k = __builtin_ctz(set), slot = slots[first + k], at = p->number[slot];
            p->changed = true;
            if (mode == QUERY_ANY) {
                p->blocked[at] = true;
                p->t_best[slot] = -1.0f;
                p->alive.bits[slot / LANES] &= (uint16_t) ~(1u << slot % LANES);
            } else {
                p->hits[at] = (mesh_hit){found.t[k], found.u[k], found.v[k], triangle, (int)found.facing[k]};
                p->t_limit[at] = found.t_scaled[k];
                p->t_best[slot] = float_above(found.t_scaled[k]);
            }
        }
    }
}

static void test_triangle(packet *p, const ray_set *set, enum query_mode mode, const double (*corner)[3], float error,
                          uint32_t triangle)
{
    float turned[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            turned[k][j] = (float)corner[p->axis[k]][j];
    uint8_t slots[TOGETHER];
    int count = 0;
    for (int g = 0; g < p->groups; g++) {
        unsigned bits = set->bits[g] & p->alive.bits[g];
        if (!bits)
            continue;
        for (bits &= maybe_inside(p, g * LANES, (const float(*)[3])turned, error); bits; bits = LANES_LESS_FIRST(bits))
            slots[count++] = (uint8_t)(g * LANES + __builtin_ctz(bits));
    }
    if (count > 0)
        test_slots(p, slots, count, mode, corner, triangle);
}

/* Updates t_farthest, which only decreases: the largest distance at which a hit of any ray could still be nearer than
 * its best one. The maximum of floats is independent of the order. */
static void update_farthest(packet *p)
{
    _Alignas(64) float most[LANES];
    memcpy(most, p->t_best, sizeof most);
    for (int g = 1; g < p->groups; g++)
        /* VECTORISE */
        for (int k = 0; k < LANES; k++)
            most[k] = p->t_best[g * LANES + k] > most[k] ? p->t_best[g * LANES + k] : most[k];
    for (int half = LANES / 2; half > 0; half /= 2)
        for (int k = 0; k < half; k++)
            most[k] = most[k + half] > most[k] ? most[k + half] : most[k];
    p->t_farthest = most[0];
    p->changed = false;
}

void KERNEL(packet_leaf)(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, const bvh_node *node,
                         uint32_t slot)
{
    const uint32_t leaf = node->child[slot];
    const float error = edge_error(p, node, slot);
    for (uint32_t b = child_first_block(leaf); b < child_first_block(leaf) + child_blocks(leaf); b++) {
        const block_single *single = &((const block_single *)h->blocks)[b];
        const block_double *exact = &((const block_double *)h->blocks)[b];
        const uint32_t *numbers = h->single ? single->triangle : exact->triangle;
        for (int lane = 0; lane < BLOCK && !(lane > 0 && numbers[lane] == numbers[lane - 1]); lane++) {
            double corner[3][3];
            for (int k = 0; k < 3; k++)
                for (int j = 0; j < 3; j++)
                    corner[k][j] = h->single ? (double)single->corner[j][k][lane] : exact->corner[j][k][lane];
            test_triangle(p, set, mode, (const double(*)[3])corner, error, numbers[lane]);
        }
    }
    if (p->changed)
        update_farthest(p);
}
