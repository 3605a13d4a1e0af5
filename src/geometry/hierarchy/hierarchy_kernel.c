/* The entry points of the hierarchy kernels: they prepare the query and choose the traversal, of one ray
 * (traverse_kernel.c) or of packets. */
#include "geometry/hierarchy/packet.h"

/* --- packets ---
 *
 * Packet traversal of the hierarchy `bvh` by coherent rays. A whole node is culled for all rays by one test, with
 * interval arithmetic over the packet (Boulos et al., "Packet-based Whitted and distribution ray tracing", GI 2007);
 * boxes and triangles are then tested by 16 rays at a time. When few rays of the packet are left, they continue one by
 * one.
 *
 * A ray tests at least every box and triangle that it would test by itself, and the same triangle test decides on hits:
 * the hits are bit-identical. */

enum { FEW_RAYS = 6 /* at most this many rays continue one by one: they would fill less than one group */ };

/* A child on the stack, with the rays that entered its node. */
typedef struct pending_child {
    uint32_t node, slot;
    float near;
    ray_set rays;
} pending_child;

/* The rays among sixteen, from slot i on, that enter a box before their best hits. */
ALWAYS_INLINE unsigned enter_box(const packet *p, int i, const float *near_plane, const float *far_plane)
{
    const float *restrict ix = &p->inverse[0][i], *restrict iy = &p->inverse[1][i], *restrict iz = &p->inverse[2][i];
    const float *restrict nox = &p->near_offset[0][i], *restrict noy = &p->near_offset[1][i],
                          *restrict noz = &p->near_offset[2][i];
    const float *restrict fox = &p->far_offset[0][i], *restrict foy = &p->far_offset[1][i],
                          *restrict foz = &p->far_offset[2][i];
    const float *restrict t_min = &p->t_min[i], *restrict t_best = &p->t_best[i];
    const float nx = near_plane[0], ny = near_plane[1], nz = near_plane[2], fx = far_plane[0], fy = far_plane[1],
                fz = far_plane[2];
    _Alignas(64) int32_t in[LANES];
    /* VECTORISE */
    for (int k = 0; k < LANES; k++) {
        const float x = MULTIPLY_ADD(nx, ix[k], nox[k]), y = MULTIPLY_ADD(ny, iy[k], noy[k]),
                    z = MULTIPLY_ADD(nz, iz[k], noz[k]);
        const float u = MULTIPLY_ADD(fx, ix[k], fox[k]), v = MULTIPLY_ADD(fy, iy[k], foy[k]),
                    w = MULTIPLY_ADD(fz, iz[k], foz[k]);
        const float xy = x > y ? x : y, zt = z > t_min[k] ? z : t_min[k], near = xy > zt ? xy : zt;
        const float uv = u < v ? u : v, wt = w < t_best[k] ? w : t_best[k], far = uv < wt ? uv : wt;
        in[k] = near <= far ? -1 : 0;
    }
    return bits_of16(in);
}

/* The rays of a set that enter one box of a node before their best hits. Returns their number. */
static int rays_in_box(const packet *p, const bvh_node *node, uint32_t slot, const ray_set *set, ray_set *in)
{
    float near_plane[3], far_plane[3];
    for (int k = 0; k < 3; k++)
        near_plane[k] = planes_at(node, p->near[k])[slot], far_plane[k] = planes_at(node, p->far[k])[slot];
    int count = 0;
    for (int g = 0; g < p->groups; g++) {
        unsigned bits = set->bits[g];
        if (bits)
            bits &= enter_box(p, g * LANES, near_plane, far_plane);
        in->bits[g] = (uint16_t)bits;
        count += __builtin_popcount(bits);
    }
    return count;
}

/* The query of the ray in a slot, with its best hit so far. */
static ray_query *query_of_slot(packet *p, int slot, enum query_mode mode)
{
    ray_query *q = &p->query[slot];
    const int at = p->number[slot];
    const uint16_t bit = (uint16_t)(1u << slot % LANES);
    if (!(p->prepared.bits[slot / LANES] & bit)) {
        query_start(q, &p->rays[at]);
        p->prepared.bits[slot / LANES] |= bit;
    }
    q->t_best = p->t_limit[slot];
    q->best = mode == QUERY_ANY ? TRIANGLE_NONE : p->hits[at].triangle;
    return q;
}

/* Stores the hit of a ray that continued by itself. */
static void store_hit(packet *p, int slot, const ray_query *q, enum query_mode mode)
{
    const int at = p->number[slot];
    if (mode == QUERY_ANY) {
        if (q->best == TRIANGLE_NONE)
            return;
        p->blocked[at] = true;
        p->t_best[slot] = -1.0f;
        p->alive.bits[slot / LANES] &= (uint16_t) ~(1u << slot % LANES);
    } else if (q->best != p->hits[at].triangle || q->t_best != p->t_limit[slot]) {
        query_finish(q, &p->hits[at]);
        p->t_limit[slot] = q->t_best;
        p->t_best[slot] = float_above(q->t_best);
    }
}

/* Traverses from a child with the few rays of a set, one by one. */
static void traverse_one_by_one(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, uint32_t child)
{
    for (int g = 0; g < p->groups; g++) {
        for (unsigned bits = set->bits[g] & p->alive.bits[g]; bits; bits = LANES_LESS_FIRST(bits)) {
            const int i = g * LANES + __builtin_ctz(bits);
            box_ray b;
            for (int k = 0; k < 3; k++) {
                b.inverse[k] = p->inverse[k][i], b.near_offset[k] = p->near_offset[k][i];
                b.far_offset[k] = p->far_offset[k][i], b.near[k] = p->near[k], b.far[k] = p->far[k];
            }
            b.t_min = p->t_min[i];
            ray_query *q = query_of_slot(p, i, mode);
            KERNEL(traverse_bvh_from)(h, q, &b, mode, child);
            store_hit(p, i, q, mode);
        }
    }
}

/* Bounds of the distances at which the rays of a packet enter and leave a node's boxes. */
ALWAYS_INLINE void bounds_of_distances(const packet *p, const bvh_node *node, float *restrict near, float *restrict far)
{
    const float *restrict nx = planes_at(node, p->near[0]), *restrict ny = planes_at(node, p->near[1]),
                          *restrict nz = planes_at(node, p->near[2]);
    const float *restrict fx = planes_at(node, p->far[0]), *restrict fy = planes_at(node, p->far[1]),
                          *restrict fz = planes_at(node, p->far[2]);
    const packet_bounds *all = &p->all;
    /* VECTORISE */
    for (int i = 0; i < WIDTH; i++) {
        const float x = (nx[i] - all->near_origin[0]) * all->near_inverse[0],
                    y = (ny[i] - all->near_origin[1]) * all->near_inverse[1],
                    z = (nz[i] - all->near_origin[2]) * all->near_inverse[2];
        const float u = (fx[i] - all->far_origin[0]) * all->far_inverse[0],
                    v = (fy[i] - all->far_origin[1]) * all->far_inverse[1],
                    w = (fz[i] - all->far_origin[2]) * all->far_inverse[2];
        const float xy = x > y ? x : y, zt = z > all->t_min ? z : all->t_min;
        const float uv = u < v ? u : v, wt = w < p->t_farthest ? w : p->t_farthest;
        near[i] = xy > zt ? xy : zt;
        far[i] = uv < wt ? uv : wt;
    }
}

/* Pushes a node's children that any ray may hit, the nearest on top. */
static int push_children(const hierarchy *h, const packet *p, uint32_t at, const ray_set *set, pending_child *stack,
                         int top)
{
    const bvh_node *nodes = h->nodes;
    const size_t block_bytes = h->single ? sizeof(block_single) : sizeof(block_double);
    const bvh_node *node = &nodes[at];
    _Alignas(32) float near[WIDTH], far[WIDTH];
    bounds_of_distances(p, node, near, far);
    const int bottom = top;
    for (uint64_t hit = lanes_ordered(near, far); hit; hit = LANES_LESS_FIRST(hit)) {
        const unsigned slot = lane_first(hit);
        fetch_child(h, nodes[at].child[slot], block_bytes);
        int position = top++;
        for (; position > bottom && stack[position - 1].near < near[slot]; position--)
            stack[position] = stack[position - 1];
        stack[position] = (pending_child){at, slot, near[slot], *set};
    }
    return top;
}

static void traverse_packet(const hierarchy *h, packet *p, enum query_mode mode)
{
    pending_child stack[STACK];
    int top = 0;
    if (h->nodes[0].child_count == 0)
        return;
    top = push_children(h, p, 0, &p->alive, stack, top);
    while (top > 0) {
        const pending_child next = stack[--top];
        ray_set rays;
        if (next.near > p->t_farthest)
            continue;
        const bvh_node *node = &h->nodes[next.node];
        const uint32_t child = node->child[next.slot];
        const int count = rays_in_box(p, node, next.slot, &next.rays, &rays);
        if (count == 0)
            continue;
        if (count <= FEW_RAYS)
            traverse_one_by_one(h, p, &rays, mode, child);
        else if (child & CHILD_LEAF)
            KERNEL(packet_leaf)(h, p, &rays, mode, node, next.slot);
        else
            top = push_children(h, p, child, &rays, stack, top);
    }
}

/* Traverses with the rays of one kind. */
static void traverse_kind(const hierarchy *h, packet *p, const batch_floats *b, const uint8_t *positions, int count,
                          enum query_mode mode)
{
    enum { FEW = 12 /* fewer coherent rays than this are traversed one by one */ };
    if (count >= FEW) {
        KERNEL(packet_start)(p, h, b, positions, count);
        traverse_packet(h, p, mode);
        return;
    }
    for (int i = 0; i < count; i++) {
        ray_query q;
        const int at = b->number[positions[i]];
        query_start(&q, &p->rays[at]);
        KERNEL(traverse_bvh)(h, &q, mode);
        if (mode == QUERY_ANY)
            p->blocked[at] = q.best != TRIANGLE_NONE;
        else
            query_finish(&q, &p->hits[at]);
    }
}

/* nearest_batch (hits) or any_batch (blocked) of at most PACKET_MAX rays through the hierarchy `bvh`: rays traverse it
 * together as far as they are coherent. */
static void traverse_bvh_batch(const hierarchy *h, const mesh_ray *rays, int count, enum query_mode mode,
                               mesh_hit *hits, bool *blocked)
{
    batch_floats b;
    packet p;
    bool grouped[PACKET_MAX] = {false};
    p.rays = rays, p.hits = hits, p.blocked = blocked;
    for (int i = 0; mode == QUERY_NEAREST && i < count; i++)
        hits[i] = (mesh_hit){.triangle = TRIANGLE_NONE};
    for (int i = 0; mode == QUERY_ANY && i < count; i++)
        blocked[i] = false;
    if (count == 0 || h->block_count == 0)
        return;
    KERNEL(batch_read)(&b, rays, count);
    uint8_t positions[PACKET_MAX];
    for (int i = 0; b.coherent && i < count; i++)
        positions[i] = (uint8_t)i;
    if (b.coherent && b.kind[0] >= 0)
        traverse_kind(h, &p, &b, positions, count, mode);
    for (int first = 0; !b.coherent && first < count; first++) {
        if (grouped[first] || b.kind[first] < 0)
            continue;
        int n = 0;
        for (int i = first; i < count; i++) {
            if (b.kind[i] != b.kind[first])
                continue;
            grouped[i] = true;
            positions[n++] = (uint8_t)i;
        }
        traverse_kind(h, &p, &b, positions, n, mode);
    }
}

/* --- entry points --- */

/* Tests all triangles in order. */
static void traverse_blocks(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    if (h->single)
        query_blocks(q, h, mode, true, 0, h->block_count);
    else
        query_blocks(q, h, mode, false, 0, h->block_count);
}

static void traverse(const hierarchy *h, ray_query *q, enum query_mode mode)
{
    switch (h->kind) {
    case HIERARCHY_BVH: KERNEL(traverse_bvh)(h, q, mode); break;
    case HIERARCHY_SPHERE:
    case HIERARCHY_OCTANT: KERNEL(traverse_spheres)(h, q, mode); break;
    case HIERARCHY_NONE: traverse_blocks(h, q, mode); break;
    case HIERARCHY_KIND_COUNT: break;
    }
}

static void nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count)
        traverse(h, &q, QUERY_NEAREST);
    query_finish(&q, hit);
}

static bool any(const hierarchy *h, const mesh_ray *ray)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count)
        traverse(h, &q, QUERY_ANY);
    return q.best != TRIANGLE_NONE;
}

static void all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context)
{
    ray_query q;
    if (query_start(&q, ray) && h->block_count) {
        q.visit = visit;
        q.context = context;
        traverse(h, &q, QUERY_ALL);
    }
}

static void boxes(const hierarchy *h, const mesh_ray *ray, box_visit *visit, void *context)
{
    ray_query q;
    if (query_start(&q, ray) && h->kind == HIERARCHY_BVH && h->block_count) {
        q.visit_box = visit;
        q.context = context;
        traverse(h, &q, QUERY_BOXES);
    }
}

static void nearest_batch(const hierarchy *h, const mesh_ray *rays, int count, mesh_hit *hits)
{
    if (h->kind != HIERARCHY_BVH)
        for (int i = 0; i < count; i++)
            nearest(h, &rays[i], &hits[i]);
    for (int first = 0; h->kind == HIERARCHY_BVH && first < count; first += PACKET_MAX)
        traverse_bvh_batch(h, rays + first, count - first < PACKET_MAX ? count - first : PACKET_MAX, QUERY_NEAREST,
                           hits + first, NULL);
}

static void any_batch(const hierarchy *h, const mesh_ray *rays, int count, bool *hit)
{
    if (h->kind != HIERARCHY_BVH)
        for (int i = 0; i < count; i++)
            hit[i] = any(h, &rays[i]);
    for (int first = 0; h->kind == HIERARCHY_BVH && first < count; first += PACKET_MAX)
        traverse_bvh_batch(h, rays + first, count - first < PACKET_MAX ? count - first : PACKET_MAX, QUERY_ANY, NULL,
                           hit + first);
}

const hierarchy_kernels KERNEL(hierarchy_kernels) = {nearest, any, all, boxes, nearest_batch, any_batch};
