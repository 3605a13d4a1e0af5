/* A ray prepared for the traversal of a hierarchy, and its tests with triangles, boxes and spheres.
 *
 * Triangles: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, in double precision.
 * Corners are translated so that the ray starts at the origin and sheared so that it runs along an axis; the signs of
 * three edge functions then decide whether it passes inside. An edge function changes its sign exactly when its corners
 * are swapped, and zero counts as inside, so that no ray slips between two triangles that share an edge. Four triangles
 * are tested at a time; the triangles that the edge functions do not reject are then tested one by one.
 *
 * A hit's t is never less than the ray's entry into the triangle's own box (with a margin of 2^-40). So no hierarchy
 * that culls by boxes with a wider margin loses a hit, whatever rounding makes of a triangle seen edge-on. As this
 * clamp only increases t, a triangle beyond the best hit before the clamp is beyond it after the clamp and can be
 * skipped. */
#pragma once

#include "base/lanes.h"
#include "geometry/hierarchy/layout.h"
#include "geometry/hierarchy/simd.h"

/* A direction is scaled so that its largest component is 1..2. A ray with a component smaller than PARALLEL counts as
 * parallel to the plane across that axis: over a length of 1e10, ten times the largest coordinate (MESH_FAR), it moves
 * across the plane by no more than PARALLEL_MARGIN. */
#define PARALLEL 1e-30
#define PARALLEL_MARGIN 1e-20
#define ORIGIN_FAR 1e18    /* rays from beyond it hit nothing; far from overflow in single precision */
#define BOX_MARGIN 0x1p-40 /* relative; far wider than the rounding error of a box distance */

/* t is measured along a direction whose largest component is scaled into 1..2 by a power of two: exact, and far from
 * overflow. */
typedef struct ray_query {
    double origin[3], direction[3], inverse[3];
    double shear_x, shear_y, shear_z;
    int x, y, z; /* axes: z is the direction's largest; x and y keep the winding */
    double t_min, t_best, unscale;
    double weight_u, weight_v, det; /* of the best hit */
    uint32_t skip, best;
    int wanted, best_facing;
    mesh_visit *visit;    /* QUERY_ALL */
    box_visit *visit_box; /* QUERY_BOXES */
    double t_start;       /* t_min as the caller passed it */
    void *context;
} ray_query;

/* False for a ray that cannot hit anything: its direction is zero, a component is not finite, its origin is out of
 * range, or its interval of t is empty. */
ALWAYS_INLINE bool query_start(ray_query *q, const mesh_ray *ray)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    const double mx = magnitude(d[0]), my = magnitude(d[1]), mz = magnitude(d[2]);
    const int z = mx > my ? (mx > mz ? 0 : 2) : (my > mz ? 1 : 2);
    const int64_t exponent = lanes_bits(d[z]) >> 52 & 0x7ff;
    const double sum = o[0] + o[1] + o[2] + d[0] + d[1] + d[2],
                 reach = greater(greater(magnitude(o[0]), magnitude(o[1])), magnitude(o[2]));
    q->best = TRIANGLE_NONE;
    if (exponent < 1 || exponent > 2045 || !(sum - sum == 0.0) || reach > ORIGIN_FAR || !(ray->t_min <= ray->t_max))
        return false;
    const double scale = lanes_double((2046 - exponent) << 52), unscale = lanes_double(exponent << 52);
    for (int k = 0; k < 3; k++) {
        q->origin[k] = o[k];
        q->direction[k] = d[k] * scale;
        q->inverse[k] = 1.0 / q->direction[k];
    }
    const int x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1, turned = d[z] < 0.0;
    q->x = turned ? y : x;
    q->y = turned ? x : y;
    q->z = z;
    q->shear_z = q->inverse[z];
    q->shear_x = q->direction[q->x] * q->shear_z;
    q->shear_y = q->direction[q->y] * q->shear_z;
    q->t_min = greater(ray->t_min, 0.0) * unscale;
    q->t_start = greater(ray->t_min, 0.0);
    q->t_best = ray->t_max * unscale;
    q->unscale = scale;
    q->skip = ray->skip;
    q->wanted = ray->facing;
    return q->t_min < (double)INFINITY;
}

ALWAYS_INLINE void query_hit(const ray_query *q, double t, double v, double w, double det, uint32_t triangle,
                             int facing, mesh_hit *hit)
{
    hit->t = t * q->unscale;
    hit->u = v / det;
    hit->v = w / det;
    hit->triangle = triangle;
    hit->facing = facing;
}

ALWAYS_INLINE void query_finish(const ray_query *q, mesh_hit *hit)
{
    if (q->best == TRIANGLE_NONE) {
        memset(hit, 0, sizeof *hit);
        hit->triangle = TRIANGLE_NONE;
    } else {
        query_hit(q, q->t_best, q->weight_u, q->weight_v, q->det, q->best, q->best_facing, hit);
    }
}

ALWAYS_INLINE double least_of(const double *p)
{
    return lesser(lesser(p[0], p[1]), p[2]);
}
ALWAYS_INLINE double most_of(const double *p)
{
    return greater(greater(p[0], p[1]), p[2]);
}

/* Raises t to the ray's entry into the box around the corners; false if the ray misses the box or leaves it before
 * t_min. corner[axis][corner] is relative to the ray's origin. */
ALWAYS_INLINE bool query_clamp(const ray_query *q, const double (*corner)[3], double *t)
{
    double near = -(double)INFINITY, far = (double)INFINITY;
    for (int k = 0; k < 3; k++) {
        const double low = least_of(corner[k]), high = most_of(corner[k]);
        if (magnitude(q->direction[k]) < PARALLEL) {
            if (low > PARALLEL_MARGIN || high < -PARALLEL_MARGIN)
                return false;
            continue;
        }
        const double one = low * q->inverse[k], two = high * q->inverse[k];
        const double in = lesser(one, two), out = greater(one, two);
        near = greater(near, in - magnitude(in) * BOX_MARGIN);
        far = lesser(far, out + magnitude(out) * BOX_MARGIN);
    }
    *t = greater(*t, near);
    return near <= far && far >= q->t_min;
}

/* Tests one triangle that the edge functions did not reject. True if the search is over. */
static __attribute__((noinline)) bool query_test_triangle(ray_query *q, enum query_mode mode, const double (*corner)[3],
                                                          uint32_t triangle)
{
    double x[3], y[3], z[3];
    for (int j = 0; j < 3; j++)
        z[j] = q->shear_z * corner[q->z][j];
    /* Entirely behind the ray's start or beyond the best hit: t is between the corners', up to the margin. */
    if (most_of(z) * (1.0 + 2.0 * BOX_MARGIN) < q->t_min || least_of(z) * (1.0 - 2.0 * BOX_MARGIN) > q->t_best ||
        triangle == q->skip)
        return false;
    for (int j = 0; j < 3; j++) {
        x[j] = corner[q->x][j] - q->shear_x * corner[q->z][j];
        y[j] = corner[q->y][j] - q->shear_y * corner[q->z][j];
    }
    /* barycentric weights */
    const double u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0],
                 det = u + v + w;
    const int facing = det > 0.0 ? FACING_FRONT : FACING_BACK;
    if (!(det > 0.0 || det < 0.0) || !(facing & q->wanted))
        return false;
    /* The weights of a sliver seen edge-on are rounding noise: it is hit only within its bounds across the ray. */
    if (!(least_of(x) <= 0.0 && most_of(x) >= 0.0 && least_of(y) <= 0.0 && most_of(y) >= 0.0))
        return false;
    double t = (u * z[0] + v * z[1] + w * z[2]) / det;
    if (!query_clamp(q, corner, &t) || !(t >= q->t_min && t <= q->t_best))
        return false;
    if (mode == QUERY_ALL) {
        mesh_hit hit;
        query_hit(q, t, v, w, det, triangle, facing, &hit);
        q->visit(q->context, &hit);
    } else if (t < q->t_best || triangle < q->best) {
        q->t_best = t;
        q->weight_u = v;
        q->weight_v = w;
        q->det = det;
        q->best = triangle;
        q->best_facing = facing;
    }
    return mode == QUERY_ANY;
}

/* Element by element: gcc 12 makes one conversion of it, and of __builtin_convertvector two and four moves. */
ALWAYS_INLINE double4 block_load(const void *block, bool single, int corner, int axis)
{
    if (single) {
        const float *v = ((const block_single *)block)->corner[corner][axis];
        return (double4){(double)v[0], (double)v[1], (double)v[2], (double)v[3]};
    }
    double4 v;
    memcpy(&v, ((const block_double *)block)->corner[corner][axis], sizeof v);
    return v;
}

/* Reports the triangles of blocks to the `boxes` callback. True if the search is over. */
static __attribute__((noinline)) bool query_report_boxes(ray_query *q, const hierarchy *h, size_t first, size_t count)
{
    for (size_t i = first; i < first + count; i++) {
        const uint32_t *numbers =
            h->single ? ((const block_single *)h->blocks)[i].triangle : ((const block_double *)h->blocks)[i].triangle;
        for (int lane = 0; lane < BLOCK; lane++) {
            if (lane > 0 && numbers[lane] == numbers[lane - 1])
                continue; /* padding: a block repeats its last triangle */
            const double t_max = q->visit_box(q->context, numbers[lane], q->t_best * q->unscale);
            if (t_max < q->t_start)
                return true;
            q->t_best = t_max / q->unscale;
        }
    }
    return false;
}

/* Tests the triangles of blocks first .. first + count - 1. True if the search is over. */
ALWAYS_INLINE bool query_blocks(ray_query *q, const hierarchy *h, enum query_mode mode, bool single, size_t first,
                                size_t count)
{
    if (mode == QUERY_BOXES)
        return query_report_boxes(q, h, first, count);
    const size_t stride = single ? sizeof(block_single) : sizeof(block_double);
    const char *block = (const char *)h->blocks + first * stride, *end = block + count * stride;
    const double4 ox = double4_all(q->origin[q->x]), oy = double4_all(q->origin[q->y]),
                  oz = double4_all(q->origin[q->z]);
    const double4 sx = double4_all(q->shear_x), sy = double4_all(q->shear_y), sz = double4_all(q->shear_z),
                  zero = double4_all(0.0);
    const int kx = q->x, ky = q->y, kz = q->z;
    for (; block < end; block += stride) {
        double4 x[3], y[3], z[3];
        for (int j = 0; j < 3; j++) {
            z[j] = block_load(block, single, j, kz) - oz;
            x[j] = (block_load(block, single, j, kx) - ox) - sx * z[j];
            y[j] = (block_load(block, single, j, ky) - oy) - sy * z[j];
        }
        const double4 u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
        /* Sign bits: any weight below zero, any above? Adding zero turns -0 into +0. */
        const int4x64 below = (int4x64)(u + zero) | (int4x64)(v + zero) | (int4x64)(w + zero);
        const int4x64 above = (int4x64)(zero - u) | (int4x64)(zero - v) | (int4x64)(zero - w);
        unsigned set = lanes_of4((below & above) >= 0);
        if (!set)
            continue;
        const double4 t = (u * (sz * z[0]) + v * (sz * z[1]) + w * (sz * z[2])) / (u + v + w);
        set = lanes_of4(((below & above) >= 0) & (t <= double4_all(q->t_best)));
        for (; set; set = LANES_LESS_FIRST(set)) {
            const unsigned lane = lane_first(set);
            const uint32_t *numbers =
                single ? ((const block_single *)block)->triangle : ((const block_double *)block)->triangle;
            if (mode == QUERY_ALL && ((lane > 0 && numbers[lane] == numbers[lane - 1])))
                continue; /* padding: a block repeats its last triangle */
            double corner[3][3];
            for (int k = 0; k < 3; k++)
                for (int j = 0; j < 3; j++)
                    corner[k][j] = (single ? (double)((const block_single *)block)->corner[j][k][lane]
                                           : ((const block_double *)block)->corner[j][k][lane]) -
                                   q->origin[k];
            if (query_test_triangle(q, mode, (const double(*)[3])corner, numbers[lane]))
                return true;
        }
    }
    return false;
}

/* --- boxes ---
 *
 * Conservative, in single precision, eight boxes at a time. No box that contains a hit triangle is missed: box planes
 * are floats rounded outwards, and distances to near planes are decreased, to far planes increased, by more than the
 * rounding errors (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013). A box is culled only if it begins beyond the best
 * hit, not at it, so that of two triangles at one distance the lower number wins in any order of traversal. */

enum { STACK = BVH_DEPTH_MAX * (WIDTH - 1) + WIDTH }; /* the most children on a traversal's stack */
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

/* Byte offsets of an axis' low and high planes from the node's start. */
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
ALWAYS_INLINE const float *planes_at(const void *node, size_t offset)
{
    return (const float *)(const void *)((const char *)node + offset);
}

/* The distances at which a ray enters a node's eight boxes, and at which it leaves them or reaches t_max. */
ALWAYS_INLINE void box_distances(const void *node, const box_ray *b, float t_max, float *restrict nears,
                                 float *restrict fars)
{
    const float *restrict nx = planes_at(node, b->near[0]), *restrict ny = planes_at(node, b->near[1]),
                          *restrict nz = planes_at(node, b->near[2]);
    const float *restrict fx = planes_at(node, b->far[0]), *restrict fy = planes_at(node, b->far[1]),
                          *restrict fz = planes_at(node, b->far[2]);
    const float ix = b->inverse[0], iy = b->inverse[1], iz = b->inverse[2];
    /* VECTORISE */
    for (int i = 0; i < WIDTH; i++) {
        const float x = MULTIPLY_ADD(nx[i], ix, b->near_offset[0]), y = MULTIPLY_ADD(ny[i], iy, b->near_offset[1]),
                    z = MULTIPLY_ADD(nz[i], iz, b->near_offset[2]);
        const float u = MULTIPLY_ADD(fx[i], ix, b->far_offset[0]), v = MULTIPLY_ADD(fy[i], iy, b->far_offset[1]),
                    w = MULTIPLY_ADD(fz[i], iz, b->far_offset[2]);
        const float xy = x > y ? x : y, zt = z > b->t_min ? z : b->t_min;
        const float uv = u < v ? u : v, wt = w < t_max ? w : t_max;
        nears[i] = xy > zt ? xy : zt;
        fars[i] = uv < wt ? uv : wt;
    }
}

/* Prefetches the node or the blocks of a child, for which the traversal would wait in a large mesh. */
ALWAYS_INLINE void fetch_child(const hierarchy *h, uint32_t child, size_t block_bytes)
{
    const char *at = child & CHILD_LEAF ? (const char *)h->blocks + child_first_block(child) * block_bytes
                                        : (const char *)&h->nodes[child];
    for (int line = 0; line < 4; line++)
        __builtin_prefetch(at + line * 64);
}

/* --- spheres ---
 *
 * A sphere is hit if the ray's line passes within its radius plus a margin wider than the rounding error, and part of
 * its inside is between t_min and the best hit. */

/* The spheres on the stack of a traversal: per level at most all children of one node. */
typedef struct sphere_pending {
    double near;
    uint32_t node;
} sphere_pending;
enum { SPHERES_PENDING = SPHERES_DEPTH_MAX * 8 };

#define SPHERE_MARGIN 0x1p-20 /* relative; wider than the rounding of centre and radius to floats */

/* The ray's distance to its entry into the sphere; +inf for a miss. The centre's distance from the line is computed by
 * components, since a difference of squares would cancel (Haines et al., "Precision improvements for ray/sphere
 * intersection", Ray Tracing Gems, 2019). */
ALWAYS_INLINE double sphere_near(const ray_query *q, double inverse_square, const sphere_node *s)
{
    double center[3], along = 0.0, off = 0.0, reach = 0.0;
    for (int k = 0; k < 3; k++) {
        center[k] = (double)s->center[k] - q->origin[k];
        along += center[k] * q->direction[k];
        reach = greater(reach, magnitude(center[k]));
    }
    along *= inverse_square;
    for (int k = 0; k < 3; k++) {
        const double away = center[k] - along * q->direction[k];
        off += away * away;
    }
    const double radius = (double)s->radius * (1.0 + SPHERE_MARGIN) + reach * BOX_MARGIN;
    if (!(off <= radius * radius))
        return (double)INFINITY;
    /* The direction is at least 1 long, so that the radius bounds half of the chord's length in t. */
    const double near = along - radius, far = along + radius;
    return far < q->t_min || near > q->t_best ? (double)INFINITY : near;
}

/* --- traversals --- */

/* The traversals, by instruction set. The result is in *q. */
void KERNEL(traverse_bvh)(const hierarchy *h, ray_query *q, enum query_mode mode);
void KERNEL(traverse_spheres)(const hierarchy *h, ray_query *q, enum query_mode mode);

/* Traverses from a child that a group of rays has already reached. */
void KERNEL(traverse_bvh_from)(const hierarchy *h, ray_query *q, const box_ray *b, enum query_mode mode, uint32_t at);

/* Rays that traverse the hierarchy `bvh` at once: a batch, BATCH in rays.h. */
enum { PACKET_MAX = 128 };
