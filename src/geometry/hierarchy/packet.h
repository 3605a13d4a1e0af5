/* A packet: up to 128 coherent rays that traverse the hierarchy `bvh` together; private to packet*_kernel.c.
 *
 * The rays stay where the caller stored them. A packet holds single-precision copies, 16 rays at a time, which only
 * reject: boxes (query.h) and triangles (packet_leaf_kernel.c). What they do not reject is tested in doubles, from the
 * caller's rays. */
#pragma once

#include "geometry/hierarchy/query.h"

#define ALIGNED __attribute__((aligned(64)))
enum { LANES = 16, GROUPS = PACKET_MAX / LANES };

/* A set of rays: a bit per slot of the packet, 16 per group. */
typedef struct ray_set {
    uint16_t bits[GROUPS];
} ray_set;

/* The rays of a batch in single precision, by their position: in a full batch, whose rays come in rows of 16, squares
 * of 4 x 4 rays follow each other; otherwise the caller's order. */
typedef struct batch_floats {
    int count;
    uint8_t number[PACKET_MAX];                                    /* the caller's number of a ray */
    bool coherent;                                                 /* all rays are of one kind */
    ALIGNED float origin[3][PACKET_MAX], direction[3][PACKET_MAX]; /* the direction's largest component is 1..2 */
    ALIGNED float t_min[PACKET_MAX], t_max[PACKET_MAX];            /* rounded outwards, in the direction's units */
    ALIGNED double t_limit[PACKET_MAX]; /* t_max, then the best hit's t, in the direction's units */
    /* Signs of the direction (three bits) plus 8 times the axis of its largest component; -1 for a ray that cannot hit
     * anything. The rays of a packet are of one kind. */
    ALIGNED int32_t kind[PACKET_MAX];
} batch_floats;

/* Bounds of all rays of a packet, by which a node is culled for the whole packet: the distance to a plane p across an
 * axis is at least (p - near_origin) near_inverse, and at most (p - far_origin) far_inverse. */
typedef struct packet_bounds {
    float near_origin[3], far_origin[3], near_inverse[3], far_inverse[3], t_min;
} packet_bounds;

typedef struct packet {
    /* as in box_ray */
    ALIGNED float inverse[3][PACKET_MAX], near_offset[3][PACKET_MAX], far_offset[3][PACKET_MAX];
    ALIGNED float t_min[PACKET_MAX], t_best[PACKET_MAX]; /* t_best is -1 for a finished ray and an unused slot */
    /* Along the axes x, y, z of ray_query: the shears, the ray's position at z = 0, and its origin's z. */
    ALIGNED float shear_x[PACKET_MAX], shear_y[PACKET_MAX], shear_z[PACKET_MAX];
    ALIGNED float base_x[PACKET_MAX], base_y[PACKET_MAX], origin_z[PACKET_MAX];
    size_t near[3], far[3];
    int axis[3];
    int count, groups;
    packet_bounds all;
    float reach;      /* the largest coordinate of an origin */
    float t_farthest; /* the largest t_best */
    bool changed;     /* some t_best has decreased since t_farthest was computed */
    ray_set alive;    /* rays that are not finished */
    ray_set prepared; /* rays whose query is started */

    const mesh_ray *rays; /* the caller's rays and results, by the ray's number in the batch */
    mesh_hit *hits;       /* QUERY_NEAREST */
    bool *blocked;        /* QUERY_ANY */
    double t_limit[PACKET_MAX];
    uint8_t number[PACKET_MAX];
    ray_query query[PACKET_MAX]; /* for rays that leave the packet */
} packet;

/* The first eight doubles of a ray. */
enum { EIGHT = 8, ORIGIN = 0, DIRECTION = 3, T_MIN = 6, T_MAX = 7 };

/* Transposes the first eight doubles of eight rays: number k goes to to[k * stride], ray after ray. */
ALWAYS_INLINE void ray_lanes_read(double *__restrict to, size_t stride, const mesh_ray *const *rays)
{
#ifdef __AVX512F__
    double8 r[8], s[8], t[8];
    for (int i = 0; i < 8; i++)
        memcpy(&r[i], rays[i], sizeof r[i]);
    for (int i = 0; i < 8; i += 2) {
        s[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        s[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; k++) {
            t[i + k] = __builtin_shufflevector(s[i + k], s[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            t[i + k + 2] = __builtin_shufflevector(s[i + k], s[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (size_t i = 0; i < 4; i++) {
        const double8 low = __builtin_shufflevector(t[i], t[i + 4], 0, 1, 2, 3, 8, 9, 10, 11),
                      high = __builtin_shufflevector(t[i], t[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
        memcpy(to + i * stride, &low, sizeof low);
        memcpy(to + (i + 4) * stride, &high, sizeof high);
    }
#else
    for (size_t i = 0; i < EIGHT; i++) {
        double row[EIGHT];
        memcpy(row, rays[i], sizeof row);
        for (size_t k = 0; k < EIGHT; k++)
            to[k * stride + i] = row[k];
    }
#endif
}

ALWAYS_INLINE float8 float8_blend(int8x32 mask, float8 a, float8 b)
{
    return (float8)((mask & (int8x32)a) | (~mask & (int8x32)b));
}

/* The least and the largest of n values, n a multiple of 16. In vectors, as gcc unrolls such loops into scalars. */
ALWAYS_INLINE float least_of_row(const float *v, int n)
{
    float8 low = floats_at(v), high = floats_at(v + 8);
    for (int i = LANES; i < n; i += LANES) {
        const float8 a = floats_at(v + i), b = floats_at(v + i + 8);
        low = float8_blend(a < low, a, low);
        high = float8_blend(b < high, b, high);
    }
    low = float8_blend(high < low, high, low);
    float least = low[0];
    for (int k = 1; k < 8; k++)
        least = low[k] < least ? low[k] : least;
    return least;
}

ALWAYS_INLINE float most_of_row(const float *v, int n)
{
    float8 low = floats_at(v), high = floats_at(v + 8);
    for (int i = LANES; i < n; i += LANES) {
        const float8 a = floats_at(v + i), b = floats_at(v + i + 8);
        low = float8_blend(a > low, a, low);
        high = float8_blend(b > high, b, high);
    }
    low = float8_blend(high > low, high, low);
    float most = low[0];
    for (int k = 1; k < 8; k++)
        most = low[k] > most ? low[k] : most;
    return most;
}

/* Converts a batch of at most PACKET_MAX rays. */
void KERNEL(batch_read)(batch_floats *b, const mesh_ray *rays, int count);
/* Starts the packet of the rays at these positions, in order, which are all of one kind. The caller has set rays, hits
 * and blocked. */
void KERNEL(packet_start)(packet *p, const hierarchy *h, const batch_floats *b, const uint8_t *positions, int count);
/* Tests the triangles of a leaf, a node's child, with the rays of a set. */
void KERNEL(packet_leaf)(const hierarchy *h, packet *p, const ray_set *set, enum query_mode mode, const bvh_node *node,
                         uint32_t slot);
