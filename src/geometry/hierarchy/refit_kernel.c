/* The bottom-up refit of a bvh's boxes and blocks after its mesh moved; the tree is kept. Nodes are stored after their
 * parents and blocks in the order of their leaves, so that one pass from the last node to the first has every child
 * ready and accesses both arrays nearly sequentially. Corners are compared while they are in registers: reading a
 * vector just after its parts were written is slow. */
#include "geometry/hierarchy/bvh.h"
#include "geometry/hierarchy/simd.h"

typedef uint64_t bits4 __attribute__((vector_size(32)));

ALWAYS_INLINE double4 choose(int4x64 mask, double4 a, double4 b)
{
    return (double4)((mask & (int4x64)a) | (~mask & (int4x64)b));
}
ALWAYS_INLINE double4 lesser4(double4 a, double4 b)
{
    return choose(a < b, a, b);
}
ALWAYS_INLINE double4 greater4(double4 a, double4 b)
{
    return choose(a > b, a, b);
}

/* The bounds of a leaf's corners, by axis and lane. */
typedef struct corner_bounds {
    double4 low[3], high[3];
} corner_bounds;

ALWAYS_INLINE void store_corner(void *block, bool single, int corner, int axis, double4 at)
{
    if (single) {
        const float4 v = __builtin_convertvector(at, float4);
        memcpy(((block_single *)block)->corner[corner][axis], &v, sizeof v);
    } else {
        memcpy(((block_double *)block)->corner[corner][axis], &at, sizeof at);
    }
}

/* Recomputes the corners of a block's triangles. */
ALWAYS_INLINE corner_bounds move_block(const mesh *m, void *block, bool single)
{
    const uint32_t *numbers = single ? ((block_single *)block)->triangle : ((block_double *)block)->triangle;
    const uint32_t *a = m->triangles[numbers[0]].corner, *b = m->triangles[numbers[1]].corner,
                   *c = m->triangles[numbers[2]].corner, *d = m->triangles[numbers[3]].corner;
    double4 at[3][3]; /* by axis and corner */
    for (int k = 0; k < 3; k++) {
        const vec3 *p = &m->vertices[a[k]], *q = &m->vertices[b[k]], *r = &m->vertices[c[k]], *s = &m->vertices[d[k]];
        at[0][k] = (double4){p->x, q->x, r->x, s->x};
        at[1][k] = (double4){p->y, q->y, r->y, s->y};
        at[2][k] = (double4){p->z, q->z, r->z, s->z};
    }
    corner_bounds r;
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k < 3; k++)
            store_corner(block, single, k, axis, at[axis][k]);
        r.low[axis] = lesser4(lesser4(at[axis][0], at[axis][1]), at[axis][2]);
        r.high[axis] = greater4(greater4(at[axis][0], at[axis][1]), at[axis][2]);
    }
    return r;
}

/* The minimum of each axis' lanes, in the lane of the axis' number. */
ALWAYS_INLINE double4 least_of_lanes(const double4 *v)
{
    const double4 xy =
        lesser4(__builtin_shufflevector(v[0], v[1], 0, 4, 2, 6), __builtin_shufflevector(v[0], v[1], 1, 5, 3, 7));
    const double4 z = lesser4(v[2], __builtin_shufflevector(v[2], v[2], 1, 0, 3, 2));
    return lesser4(__builtin_shufflevector(xy, z, 0, 1, 4, 5), __builtin_shufflevector(xy, z, 2, 3, 6, 7));
}

ALWAYS_INLINE double4 most_of_lanes(const double4 *v)
{
    const double4 xy =
        greater4(__builtin_shufflevector(v[0], v[1], 0, 4, 2, 6), __builtin_shufflevector(v[0], v[1], 1, 5, 3, 7));
    const double4 z = greater4(v[2], __builtin_shufflevector(v[2], v[2], 1, 0, 3, 2));
    return greater4(__builtin_shufflevector(xy, z, 0, 1, 4, 5), __builtin_shufflevector(xy, z, 2, 3, 6, 7));
}

/* bvh_cut_below of four numbers, with a carry for negative ones, or bvh_cut_above, with a carry for the others. */
ALWAYS_INLINE float4 cut(double4 v, bits4 carried)
{
    const bits4 bits = ((bits4)v + (carried << 29) - carried) & ~(bits4){BVH_CUT, BVH_CUT, BVH_CUT, BVH_CUT};
    return __builtin_convertvector((double4)bits, float4);
}

ALWAYS_INLINE bool any_tiny(double4 low, double4 high)
{
    const double4 zero = double4_all(0.0), least = double4_all(BVH_CUT_LEAST), most = double4_all(-BVH_CUT_LEAST);
    const int4x64 tiny =
        ((low < least) & (low > most) & (low != zero)) | ((high < least) & (high > most) & (high != zero));
    return lanes_of4(tiny) != 0;
}

ALWAYS_INLINE void write_box(bvh_node *n, int slot, double4 low, double4 high)
{
    const float4 below = cut(low, (bits4)low >> 63), above = cut(high, ~(bits4)high >> 63);
    for (int axis = 0; axis < 3; axis++) {
        n->low[axis][slot] = below[axis];
        n->high[axis][slot] = above[axis];
    }
    if (__builtin_expect(any_tiny(low, high), false))
        for (int axis = 0; axis < 3; axis++) {
            n->low[axis][slot] = bvh_float_below(low[axis]);
            n->high[axis][slot] = bvh_float_above(high[axis]);
        }
}

ALWAYS_INLINE void refit_leaf(hierarchy *h, bvh_node *n, int slot, bool single)
{
    const size_t stride = single ? sizeof(block_single) : sizeof(block_double);
    char *block = (char *)h->blocks + child_first_block(n->child[slot]) * stride;
    corner_bounds r = move_block(h->of, block, single);
    for (uint32_t left = child_blocks(n->child[slot]) - 1; left > 0; left--) {
        block += stride;
        const corner_bounds next = move_block(h->of, block, single);
        for (int axis = 0; axis < 3; axis++) {
            r.low[axis] = lesser4(next.low[axis], r.low[axis]);
            r.high[axis] = greater4(next.high[axis], r.high[axis]);
        }
    }
    write_box(n, slot, least_of_lanes(r.low), most_of_lanes(r.high));
}

/* Prefetch distances in nodes, for blocks and for the triangles in them: in a large mesh each access goes to main
 * memory. Vertices are not prefetched; that costs as much as it saves. */
enum { BLOCKS_AHEAD = 8, TRIANGLES_AHEAD = 4 };

ALWAYS_INLINE void fetch_blocks(const hierarchy *h, const bvh_node *n, size_t stride)
{
    for (uint32_t slot = 0; slot < n->child_count; slot++) {
        if (!(n->child[slot] & CHILD_LEAF))
            continue;
        const char *block = (const char *)h->blocks + child_first_block(n->child[slot]) * stride;
        for (size_t byte = 0; byte < child_blocks(n->child[slot]) * stride; byte += 64)
            __builtin_prefetch(block + byte, 1);
    }
}

ALWAYS_INLINE void fetch_triangles(const hierarchy *h, const bvh_node *n, bool single)
{
    for (uint32_t slot = 0; slot < n->child_count; slot++) {
        if (!(n->child[slot] & CHILD_LEAF))
            continue;
        const size_t first = child_first_block(n->child[slot]);
        const uint32_t *numbers = single ? ((const block_single *)h->blocks)[first].triangle
                                         : ((const block_double *)h->blocks)[first].triangle;
        for (int lane = 0; lane < BLOCK; lane++)
            __builtin_prefetch(&h->of->triangles[numbers[lane]]);
    }
}

ALWAYS_INLINE void refit_nodes(hierarchy *h, bool single)
{
    for (size_t i = h->node_count; i-- > 0;) {
        bvh_node *n = &h->nodes[i];
        if (i >= BLOCKS_AHEAD)
            fetch_blocks(h, n - BLOCKS_AHEAD, single ? sizeof(block_single) : sizeof(block_double));
        if (i >= TRIANGLES_AHEAD)
            fetch_triangles(h, n - TRIANGLES_AHEAD, single);
        for (int slot = (int)n->child_count; slot-- > 0;) {
            if (n->child[slot] & CHILD_LEAF)
                refit_leaf(h, n, slot, single);
            else
                for (int axis = 0; axis < 3; axis++)
                    bvh_around(&h->nodes[n->child[slot]], axis, &n->low[axis][slot], &n->high[axis][slot]);
        }
    }
}

void KERNEL(hierarchy_refit_nodes)(hierarchy *h)
{
    h->single ? refit_nodes(h, true) : refit_nodes(h, false);
}
