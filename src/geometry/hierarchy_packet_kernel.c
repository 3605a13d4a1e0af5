/* Packet traversal of the hierarchy `bvh` by coherent rays. A whole node is culled for all rays by one test, with
 * interval arithmetic over the packet (Boulos et al., "Packet-based Whitted and distribution ray tracing", GI 2007);
 * boxes and triangles are then tested by eight rays at a time. When few rays of the packet are left, each continues
 * alone.
 *
 * A ray tests at least every box and triangle that it would test alone, and the same triangle test decides on hits. So
 * the hits are bit-identical. */
#include "geometry/hierarchy_boxes.h"

enum { LANES = 8, GROUPS = TOGETHER / LANES };
enum { ALONE = 6 /* at most this many rays continue one by one: they would fill less than one group */ };

typedef double double8 __attribute__((vector_size(64)));
typedef int64_t int8x64 __attribute__((vector_size(64)));

/* A set of rays: a byte per group of eight. */
typedef struct ray_set {
    uint8_t bits[GROUPS];
} ray_set;

typedef struct packet {
    _Alignas(64) float near_origin[3][TOGETHER], far_origin[3][TOGETHER], near_inverse[3][TOGETHER],
        far_inverse[3][TOGETHER];
    _Alignas(64) float t_min[TOGETHER], t_best[TOGETHER];
    _Alignas(64) double origin[3][TOGETHER], shear[3][TOGETHER]; /* along the query's axes x, y, z */
    _Alignas(64) double t_limit[TOGETHER], t_start[TOGETHER];    /* each query's t_best and t_min */
    _Alignas(64) double mesh_origin[3][TOGETHER],
        inverse[3][TOGETHER]; /* origin and inverse direction along the mesh's axes */
    _Alignas(64) int64_t parallel[3][TOGETHER], skip[TOGETHER], wanted[TOGETHER], best[TOGETHER], facing[TOGETHER];
    _Alignas(64) double weight_u[TOGETHER], weight_v[TOGETHER], det[TOGETHER]; /* of the best hits */
    ray_query *ray[TOGETHER];
    int count, groups;
    int near[3], far[3], axis[3];
    box_ray all;      /* bounds of all rays */
    float t_farthest; /* the largest t_best */
    bool changed;     /* some t_best has decreased since t_farthest was computed */
    ray_set alive;
} packet;

typedef struct waiting {
    uint32_t child, node, slot;
    float near;
    ray_set rays;
} waiting;

static void widen(packet *p, const box_ray *b, bool first)
{
    box_ray *all = &p->all;
    if (first) {
        *all = *b;
        return;
    }
    for (int k = 0; k < 3; k++) {
        const bool down = b->near[k] >= WIDTH * 3;
#define LESS(a, c) ((c) < (a) ? (c) : (a))
#define MORE(a, c) ((c) > (a) ? (c) : (a))
        all->near_origin[k] =
            down ? LESS(all->near_origin[k], b->near_origin[k]) : MORE(all->near_origin[k], b->near_origin[k]);
        all->far_origin[k] =
            down ? MORE(all->far_origin[k], b->far_origin[k]) : LESS(all->far_origin[k], b->far_origin[k]);
        all->near_inverse[k] =
            down ? MORE(all->near_inverse[k], b->near_inverse[k]) : LESS(all->near_inverse[k], b->near_inverse[k]);
        all->far_inverse[k] =
            down ? LESS(all->far_inverse[k], b->far_inverse[k]) : MORE(all->far_inverse[k], b->far_inverse[k]);
    }
    all->t_min = LESS(all->t_min, b->t_min);
}

/* Lanes beyond count repeat the last ray and are in no set. */
static void packet_start(packet *p, ray_query *const *rays, int count)
{
    p->count = count;
    p->groups = (count + LANES - 1) / LANES;
    memset(&p->alive, 0, sizeof p->alive);
    p->changed = false;
    p->t_farthest = 0.0f;
    for (int i = 0; i < p->groups * LANES; i++) {
        ray_query *q = rays[i < count ? i : count - 1];
        box_ray b;
        box_ray_start(&b, q);
        p->ray[i] = q;
        for (int k = 0; k < 3; k++) {
            p->near_origin[k][i] = b.near_origin[k], p->far_origin[k][i] = b.far_origin[k];
            p->near_inverse[k][i] = b.near_inverse[k], p->far_inverse[k][i] = b.far_inverse[k];
        }
        p->t_min[i] = b.t_min;
        p->t_best[i] = i < count ? float_above(q->t_best) : 0.0f; /* so that unused lanes never count */
        p->t_farthest = MORE(p->t_farthest, p->t_best[i]);
        p->origin[0][i] = q->origin[q->x], p->origin[1][i] = q->origin[q->y], p->origin[2][i] = q->origin[q->z];
        p->shear[0][i] = q->shear_x, p->shear[1][i] = q->shear_y, p->shear[2][i] = q->shear_z;
        p->t_limit[i] = q->t_best, p->t_start[i] = q->t_min;
        p->weight_u[i] = p->weight_v[i] = p->det[i] = 0.0, p->facing[i] = 0;
        p->skip[i] = q->skip, p->wanted[i] = q->wanted, p->best[i] = q->best;
        for (int k = 0; k < 3; k++) {
            p->mesh_origin[k][i] = q->origin[k], p->inverse[k][i] = q->inverse[k];
            p->parallel[k][i] = mask_less(magnitude(q->direction[k]), PARALLEL);
        }
        p->alive.bits[i / LANES] |= (uint8_t)((i < count) << i % LANES);
        widen(p, &b, i == 0);
    }
    for (int k = 0; k < 3; k++)
        p->near[k] = p->all.near[k], p->far[k] = p->all.far[k];
    p->axis[0] = rays[0]->x, p->axis[1] = rays[0]->y, p->axis[2] = rays[0]->z;
}

#ifdef __AVX512VL__
ALWAYS_INLINE uint8_t bits_of8(int8x32 mask)
{
    return (uint8_t)(lanes_of8(mask) * 0x0102040810204080u >> 56);
}
#else
ALWAYS_INLINE uint8_t bits_of8(int8x32 mask)
{
    return (uint8_t)lanes_of8(mask);
}
#endif

ALWAYS_INLINE float8 floats_at(const float *p)
{
    float8 v;
    memcpy(&v, p, sizeof v);
    return v;
}

/* The distances at which eight rays, from number i on, cross the planes of one box. */
ALWAYS_INLINE void slabs_of_rays(const packet *p, int i, const float *restrict near_plane,
                                 const float *restrict far_plane, float *restrict near, float *restrict far)
{
    const float *restrict nox = &p->near_origin[0][i], *restrict noy = &p->near_origin[1][i],
                          *restrict noz = &p->near_origin[2][i];
    const float *restrict nix = &p->near_inverse[0][i], *restrict niy = &p->near_inverse[1][i],
                          *restrict niz = &p->near_inverse[2][i];
    const float *restrict fox = &p->far_origin[0][i], *restrict foy = &p->far_origin[1][i],
                          *restrict foz = &p->far_origin[2][i];
    const float *restrict fix = &p->far_inverse[0][i], *restrict fiy = &p->far_inverse[1][i],
                          *restrict fiz = &p->far_inverse[2][i];
    const float nx = near_plane[0], ny = near_plane[1], nz = near_plane[2], fx = far_plane[0], fy = far_plane[1],
                fz = far_plane[2];
    /* VECTORISE */
    for (int k = 0; k < LANES; k++) {
        const float x = (nx - nox[k]) * nix[k], y = (ny - noy[k]) * niy[k], z = (nz - noz[k]) * niz[k];
        const float u = (fx - fox[k]) * fix[k], v = (fy - foy[k]) * fiy[k], w = (fz - foz[k]) * fiz[k];
        const float xy = x > y ? x : y, uv = u < v ? u : v;
        near[k] = xy > z ? xy : z;
        far[k] = uv < w ? uv : w;
    }
}

/* The rays of a set that enter one box of a node before their best hits. Returns their number. */
static int rays_in_box(const packet *p, const bvh_node *node, uint32_t slot, const ray_set *of, ray_set *in)
{
    const float *plane = (const float *)(const void *)node + slot;
    float near_plane[3], far_plane[3];
    for (int k = 0; k < 3; k++)
        near_plane[k] = plane[p->near[k]], far_plane[k] = plane[p->far[k]];
    int count = 0;
    for (int g = 0; g < p->groups; g++) {
        const uint8_t wanted = of->bits[g] & p->alive.bits[g];
        in->bits[g] = 0;
        if (!wanted)
            continue;
        const int i = g * LANES;
        _Alignas(32) float near[LANES], far[LANES];
        slabs_of_rays(p, i, near_plane, far_plane, near, far);
        const float8 n = floats_at(near), f = floats_at(far);
        in->bits[g] = wanted & bits_of8((n <= f) & (n <= floats_at(&p->t_best[i])) & (f >= floats_at(&p->t_min[i])));
        count += __builtin_popcount(in->bits[g]);
    }
    return count;
}

/* Updates t_farthest, the largest distance at which a hit of any ray could still be nearer than its best one; it only
 * decreases. Non-negative floats sort by their bits, and the maximum of integers is independent of the order. */
static void update_farthest(packet *p)
{
    int32_t bits[TOGETHER], farthest = 0;
    memcpy(bits, p->t_best, sizeof bits);
    const int n = p->groups * LANES;
    /* VECTORISE */
    for (int i = 0; i < n; i++)
        farthest = bits[i] > farthest ? bits[i] : farthest;
    memcpy(&p->t_farthest, &farthest, sizeof farthest);
    p->changed = false;
}

ALWAYS_INLINE double8 double8_all(double v)
{
    return (double8){v, v, v, v, v, v, v, v};
}
ALWAYS_INLINE double8 doubles_at(const double *p)
{
    double8 v;
    memcpy(&v, p, sizeof v);
    return v;
}

ALWAYS_INLINE int8x64 ints_at(const int64_t *p)
{
    int8x64 v;
    memcpy(&v, p, sizeof v);
    return v;
}

ALWAYS_INLINE double8 double8_blend(int8x64 mask, double8 a, double8 b)
{
    return (double8)((mask & (int8x64)a) | (~mask & (int8x64)b));
}
ALWAYS_INLINE double8 double8_greater(double8 a, double8 b)
{
    return double8_blend(a > b, a, b);
}
ALWAYS_INLINE double8 double8_lesser(double8 a, double8 b)
{
    return double8_blend(a < b, a, b);
}
ALWAYS_INLINE double8 double8_magnitude(double8 a)
{
    return (double8)((int8x64)a & INT64_MAX);
}
ALWAYS_INLINE int8x64 any_bits(double8 a)
{
    return (int8x64)a;
}

/* A triangle that the edge functions of some of eight rays let through: weights and corners as seen by each ray. */
typedef struct passed {
    double8 u, v, w, x[3], y[3], z[3], t;
} passed;

/* query_clamp for eight rays. */
ALWAYS_INLINE int8x64 clamp_together(const packet *p, int i, const double (*corner)[3], double8 *t)
{
    const double8 zero = double8_all(0.0);
    double8 near = double8_all(-(double)INFINITY), far = double8_all((double)INFINITY);
    int8x64 hit = {-1, -1, -1, -1, -1, -1, -1, -1};
    for (int k = 0; k < 3; k++) {
        const double8 o = doubles_at(&p->mesh_origin[k][i]), inverse = doubles_at(&p->inverse[k][i]);
        const double8 low = double8_all(least_of(corner[k])) - o, high = double8_all(most_of(corner[k])) - o;
        const int8x64 parallel = ints_at(&p->parallel[k][i]);
        const int8x64 aside = (low > zero + PARALLEL_MARGIN) | (high < zero - PARALLEL_MARGIN);
        const double8 one = low * inverse, two = high * inverse, in = double8_lesser(one, two),
                      out = double8_greater(one, two);
        const double8 first = double8_greater(near, in - double8_magnitude(in) * BOX_MARGIN);
        const double8 last = double8_lesser(far, out + double8_magnitude(out) * BOX_MARGIN);
        near = double8_blend(parallel, near, first);
        far = double8_blend(parallel, far, last);
        hit &= ~(parallel & aside);
    }
    *t = double8_greater(*t, near);
    return hit & (near <= far) & (far >= doubles_at(&p->t_start[i]));
}

/* query_consider for the rays of `mask` among eight. Returns those that accept the hit. */
ALWAYS_INLINE int8x64 consider_together(packet *p, int i, int8x64 mask, const passed *h, const double (*corner)[3],
                                        uint32_t triangle)
{
    const double8 zero = double8_all(0.0), limit = doubles_at(&p->t_limit[i]), start = doubles_at(&p->t_start[i]),
                  sz = doubles_at(&p->shear[2][i]);
    const double8 z0 = sz * h->z[0], z1 = sz * h->z[1], z2 = sz * h->z[2];
    const double8 farthest = double8_greater(double8_greater(z0, z1), z2),
                  nearest = double8_lesser(double8_lesser(z0, z1), z2);
    mask &= ~((farthest * (1.0 + 2.0 * BOX_MARGIN) < start) | (nearest * (1.0 - 2.0 * BOX_MARGIN) > limit));
    mask &= ints_at(&p->skip[i]) != (int64_t)triangle;
    const double8 det = h->u + h->v + h->w;
    const int8x64 front = det > zero, facing = (front & FACING_FRONT) | (~front & FACING_BACK);
    mask &= (front | (det < zero)) & ((facing & ints_at(&p->wanted[i])) != 0);
    const double8 least_x = double8_lesser(double8_lesser(h->x[0], h->x[1]), h->x[2]);
    const double8 most_x = double8_greater(double8_greater(h->x[0], h->x[1]), h->x[2]);
    const double8 least_y = double8_lesser(double8_lesser(h->y[0], h->y[1]), h->y[2]);
    const double8 most_y = double8_greater(double8_greater(h->y[0], h->y[1]), h->y[2]);
    mask &= (least_x <= zero) & (most_x >= zero) & (least_y <= zero) & (most_y >= zero);
    double8 t = h->t;
    mask &= clamp_together(p, i, corner, &t);
    mask &= (t >= start) & (t <= limit);
    const int8x64 best = ints_at(&p->best[i]), better = mask & ((t < limit) | (best > (int64_t)triangle));
    const double8 new_limit = double8_blend(better, t, limit),
                  u = double8_blend(better, h->v, doubles_at(&p->weight_u[i])),
                  v = double8_blend(better, h->w, doubles_at(&p->weight_v[i])),
                  d = double8_blend(better, det, doubles_at(&p->det[i]));
    const int8x64 number = (better & (int64_t)triangle) | (~better & best),
                  side = (better & facing) | (~better & ints_at(&p->facing[i]));
    memcpy(&p->t_limit[i], &new_limit, sizeof new_limit);
    memcpy(&p->weight_u[i], &u, sizeof u);
    memcpy(&p->weight_v[i], &v, sizeof v);
    memcpy(&p->det[i], &d, sizeof d);
    memcpy(&p->best[i], &number, sizeof number);
    memcpy(&p->facing[i], &side, sizeof side);
    return better;
}

/* Updates the float limits of eight rays from the exact ones; a finished ray gets the limit 0, which no box or triangle
 * is below. */
ALWAYS_INLINE void update_limits(packet *p, int group)
{
    for (int k = 0; k < LANES; k++) {
        const int i = group * LANES + k;
        const bool over = !(p->alive.bits[group] >> k & 1);
        p->t_best[i] = over ? 0.0f : float_above(p->t_limit[i]);
    }
    p->changed = true;
}

/* Tests one triangle, eight rays at a time. corner[axis][corner], in the mesh's axes. */
static void triangle_together(packet *p, const ray_set *set, enum query_mode mode, const double (*corner)[3],
                              uint32_t triangle)
{
    const double *cx = corner[p->axis[0]], *cy = corner[p->axis[1]], *cz = corner[p->axis[2]];
    const double8 zero = double8_all(0.0);
    const int8x64 lane_bit = {1, 2, 4, 8, 16, 32, 64, 128};
    for (int g = 0; g < p->groups; g++) {
        const uint8_t wanted = set->bits[g] & p->alive.bits[g];
        if (!wanted)
            continue;
        const int i = g * LANES;
        const double8 ox = doubles_at(&p->origin[0][i]), oy = doubles_at(&p->origin[1][i]),
                      oz = doubles_at(&p->origin[2][i]), sx = doubles_at(&p->shear[0][i]),
                      sy = doubles_at(&p->shear[1][i]);
        passed h;
        for (int j = 0; j < 3; j++) {
            h.z[j] = double8_all(cz[j]) - oz;
            h.x[j] = (double8_all(cx[j]) - ox) - sx * h.z[j];
            h.y[j] = (double8_all(cy[j]) - oy) - sy * h.z[j];
        }
        h.u = h.x[2] * h.y[1] - h.y[2] * h.x[1], h.v = h.x[0] * h.y[2] - h.y[0] * h.x[2],
        h.w = h.x[1] * h.y[0] - h.y[1] * h.x[0];
        const int8x64 below = any_bits(h.u + zero) | any_bits(h.v + zero) | any_bits(h.w + zero);
        const int8x64 above = any_bits(zero - h.u) | any_bits(zero - h.v) | any_bits(zero - h.w);
        const int8x64 inside =
            ((below & above) >= 0) &
            (((int8x64){wanted, wanted, wanted, wanted, wanted, wanted, wanted, wanted} & lane_bit) != 0);
        if (!bits_of8(__builtin_convertvector(inside, int8x32)))
            continue;
        /* As in query_blocks: hits that are certainly beyond the best hit. */
        const double8 sz = doubles_at(&p->shear[2][i]);
        h.t = (h.u * (sz * h.z[0]) + h.v * (sz * h.z[1]) + h.w * (sz * h.z[2])) / (h.u + h.v + h.w);
        const int8x64 near = inside & (h.t <= doubles_at(&p->t_limit[i]));
        if (!bits_of8(__builtin_convertvector(near, int8x32)))
            continue;
        const int8x64 found = consider_together(p, i, near, &h, corner, triangle);
        const uint8_t bits = bits_of8(__builtin_convertvector(found, int8x32));
        if (!bits)
            continue;
        p->alive.bits[g] &= (uint8_t)(mode == QUERY_ANY ? ~bits : 255);
        update_limits(p, g);
    }
}

static void leaf_together(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, uint32_t leaf)
{
    for (uint32_t b = child_first_block(leaf); b < child_first_block(leaf) + child_blocks(leaf); b++) {
        const block_single *single = &((const block_single *)h->blocks)[b];
        const block_double *exact = &((const block_double *)h->blocks)[b];
        const uint32_t *numbers = h->single ? single->triangle : exact->triangle;
        for (int lane = 0; lane < BLOCK && !(lane > 0 && numbers[lane] == numbers[lane - 1]); lane++) {
            double corner[3][3];
            for (int k = 0; k < 3; k++)
                for (int j = 0; j < 3; j++)
                    corner[k][j] = h->single ? (double)single->corner[j][k][lane] : exact->corner[j][k][lane];
            triangle_together(p, set, mode, (const double(*)[3])corner, numbers[lane]);
        }
    }
    if (p->changed)
        update_farthest(p);
}

/* Copies a ray's best hit from the packet to its query, and back. */
static void store_hit(const packet *p, int i)
{
    ray_query *q = p->ray[i];
    q->t_best = p->t_limit[i];
    q->weight_u = p->weight_u[i], q->weight_v = p->weight_v[i], q->det = p->det[i];
    q->best = (uint32_t)p->best[i];
    q->best_facing = (int)p->facing[i];
}

static void load_hit(packet *p, int i)
{
    const ray_query *q = p->ray[i];
    p->t_limit[i] = q->t_best;
    p->weight_u[i] = q->weight_u, p->weight_v[i] = q->weight_v, p->det[i] = q->det;
    p->best[i] = q->best;
    p->facing[i] = q->best_facing;
}

/* Traverses from a child with each of the few rays of a set alone. */
static void traverse_alone(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, uint32_t child)
{
    for (int g = 0; g < p->groups; g++) {
        for (uint8_t bits = set->bits[g]; bits; bits = (uint8_t)LANES_LESS_FIRST(bits)) {
            const int lane = __builtin_ctz(bits), i = g * LANES + lane;
            box_ray b = p->all;
            for (int k = 0; k < 3; k++) {
                b.near_origin[k] = p->near_origin[k][i], b.far_origin[k] = p->far_origin[k][i];
                b.near_inverse[k] = p->near_inverse[k][i], b.far_inverse[k] = p->far_inverse[k][i];
            }
            b.t_min = p->t_min[i];
            const uint32_t before = p->ray[i]->best;
            store_hit(p, i);
            KERNEL(walk_bvh_from)(h, p->ray[i], &b, mode, child);
            load_hit(p, i);
            p->alive.bits[g] &= (uint8_t) ~((mode == QUERY_ANY && p->ray[i]->best != before) << lane);
            p->t_best[i] = p->alive.bits[g] >> lane & 1 ? float_above(p->t_limit[i]) : 0.0f;
        }
    }
    update_farthest(p);
}

/* Pushes a node's children that any ray may hit, the nearest on top. */
static int push_children(const packet *p, const bvh_node *nodes, uint32_t at, const ray_set *set, waiting *stack,
                         int top)
{
    _Alignas(32) float near[WIDTH], far[WIDTH];
    slabs(&nodes[at], &p->all, near, far);
    const float8 n = floats_at(near), f = floats_at(far);
    const int bottom = top;
    for (uint64_t hit = lanes_of8((n <= f) & (n <= float8_all(p->t_farthest)) & (f >= float8_all(p->all.t_min))); hit;
         hit = LANES_LESS_FIRST(hit)) {
        const unsigned slot = lane_first(hit);
        int position = top++;
        for (; position > bottom && stack[position - 1].near < near[slot]; position--)
            stack[position] = stack[position - 1];
        stack[position] = (waiting){nodes[at].child[slot], at, slot, near[slot], *set};
    }
    return top;
}

static void packet_walk(const hierarchy *h, packet *p, enum query_mode mode)
{
    waiting stack[STACK];
    int top = 0;
    if (h->nodes[0].child_count == 0)
        return;
    top = push_children(p, h->nodes, 0, &p->alive, stack, top);
    while (top > 0) {
        const waiting next = stack[--top];
        ray_set rays;
        if (next.near > p->t_farthest)
            continue;
        const int count = rays_in_box(p, &h->nodes[next.node], next.slot, &next.rays, &rays);
        if (count == 0)
            continue;
        if (count <= ALONE)
            traverse_alone(h, p, &rays, mode, next.child);
        else if (next.child & CHILD_LEAF)
            leaf_together(h, p, &rays, mode, next.child);
        else
            top = push_children(p, h->nodes, next.child, &rays, stack, top);
    }
}

/* The class of a ray: rays of one packet have the same direction signs and major axis. */
static int ray_class(const ray_query *q)
{
    return (q->direction[0] < 0.0) | (q->direction[1] < 0.0) << 1 | (q->direction[2] < 0.0) << 2 | q->z << 3;
}

void KERNEL(walk_bvh_together)(const hierarchy *h, ray_query *const *rays, int count, enum query_mode mode)
{
    enum { FEW = 12 /* fewer coherent rays than this are traversed one by one */ };
    packet p;
    ray_query *coherent[TOGETHER];
    bool taken[TOGETHER] = {false};
    for (int first = 0; first < count; first++) {
        if (taken[first])
            continue;
        const int kind = ray_class(rays[first]);
        int n = 0;
        for (int i = first; i < count; i++) {
            if (taken[i] || ray_class(rays[i]) != kind)
                continue;
            taken[i] = true;
            coherent[n++] = rays[i];
        }
        if (n < FEW) {
            for (int i = 0; i < n; i++)
                KERNEL(walk_bvh)(h, coherent[i], mode);
            continue;
        }
        packet_start(&p, coherent, n);
        packet_walk(h, &p, mode);
        for (int i = 0; i < n; i++)
            store_hit(&p, i);
    }
}
