/* The set-up of packets: rays are read and scaled eight at a time, then prepared for the box and triangle tests in
 * single precision, 16 at a time. */
#include "geometry/hierarchy/packet.h"

#include <stddef.h>

_Static_assert(offsetof(mesh_ray, t_max) == T_MAX * sizeof(double), "a ray begins with eight doubles");

/* The columns of a batch: the first eight doubles of each ray. */
typedef struct batch_columns {
    _Alignas(64) double column[EIGHT][PACKET_MAX];
} batch_columns;

static void read_columns(batch_columns *c, const mesh_ray *rays, const uint8_t *number, int count, int n)
{
    for (int i = 0; i < n; i += EIGHT) {
        const mesh_ray *eight[EIGHT];
        for (int k = 0; k < EIGHT; k++)
            eight[k] = &rays[number[i + k < count ? i + k : count - 1]];
        ray_lanes_read(&c->column[0][i], PACKET_MAX, eight);
    }
}

/* query_start for n rays. */
static void classify(batch_floats *b, const batch_columns *c, double *restrict scales, int n)
{
    const double *restrict ox = c->column[ORIGIN], *restrict oy = c->column[ORIGIN + 1],
                           *restrict oz = c->column[ORIGIN + 2], *restrict dx = c->column[DIRECTION],
                           *restrict dy = c->column[DIRECTION + 1], *restrict dz = c->column[DIRECTION + 2],
                           *restrict t0 = c->column[T_MIN], *restrict t1 = c->column[T_MAX];
    double *restrict t_limit = b->t_limit;
    float *restrict below = b->t_min, *restrict above = b->t_max;
    int32_t *restrict kinds = b->kind;
    /* VECTORISE */
    for (int k = 0; k < n; k++) {
        const double mx = magnitude(dx[k]), my = magnitude(dy[k]), mz = magnitude(dz[k]);
        const int64_t x_over_y = mask_less(my, mx), x_largest = x_over_y & mask_less(mz, mx),
                      y_largest = ~x_over_y & mask_less(mz, my);
        const double largest = greater(mx, greater(my, mz));
        const int64_t bits = lanes_bits(largest) & ((int64_t)0x7ff << 52);
        const double scale = lanes_double(((int64_t)2046 << 52) - bits), unscale = lanes_double(bits);
        const double sum = ox[k] + oy[k] + oz[k] + dx[k] + dy[k] + dz[k];
        const double reach = greater(greater(magnitude(ox[k]), magnitude(oy[k])), magnitude(oz[k]));
        const double t_min = greater(t0[k], 0.0) * unscale, t_max = t1[k] * unscale;
        const int64_t valid = mask_less_equal(0x1p-1022, largest) & mask_less(largest, 0x1p1023) &
                              mask_less(magnitude(sum), (double)INFINITY) & mask_less_equal(reach, ORIGIN_FAR) &
                              mask_less_equal(t0[k], t1[k]) & mask_less(t_min, (double)INFINITY);
        const int64_t down = (mask_less(dx[k], 0.0) & 1) | (mask_less(dy[k], 0.0) & 2) | (mask_less(dz[k], 0.0) & 4);
        const int64_t axis = (y_largest & 8) | (~(x_largest | y_largest) & 16);
        kinds[k] = (int32_t)(((down | axis) & valid) | ~valid);
        t_limit[k] = t_max;
        scales[k] = scale;
        below[k] = float_below(t_min);
        above[k] = float_above(t_max);
    }
}

/* Positions beyond count repeat the last ray. */
void KERNEL(batch_read)(batch_floats *b, const mesh_ray *rays, int count)
{
    const int n = (count + LANES - 1) / LANES * LANES;
    batch_columns c;
    _Alignas(64) double scales[PACKET_MAX];
    b->count = count;
    for (int i = 0; i < PACKET_MAX; i++)
        b->number[i] = (uint8_t)(count < PACKET_MAX ? i : i / 64 * 64 + i / 4 % 4 * 16 + i / 16 % 4 * 4 + i % 4);
    read_columns(&c, rays, b->number, count, n);
    classify(b, &c, scales, n);
    int32_t differs = 0;
    /* VECTORISE */
    for (int k = 0; k < n; k++)
        differs |= b->kind[k] ^ b->kind[0];
    b->coherent = differs == 0;
    for (int axis = 0; axis < 3; axis++) {
        const double *restrict o = c.column[ORIGIN + axis], *restrict d = c.column[DIRECTION + axis];
        float *restrict origin = b->origin[axis], *restrict direction = b->direction[axis];
        /* VECTORISE */
        for (int k = 0; k < n; k++) {
            origin[k] = (float)o[k];
            direction[k] = (float)(d[k] * scales[k]);
        }
    }
}

/* box_ray_start along one axis. */
static void prepare_axis(packet *p, int k, float reach, const float *restrict origin, const float *restrict direction)
{
    float *restrict inverses = p->inverse[k], *restrict near = p->near_offset[k], *restrict far = p->far_offset[k];
    const int n = p->groups * LANES;
    const float limit = p->near[k] == high_planes(k) ? -STEEPEST : STEEPEST;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const float o = origin[i], d = direction[i];
        const bool steep = !(__builtin_fabsf(d) > 1.0f / STEEPEST);
        const float inverse = steep ? limit : 1.0f / d;
        const float margin = box_margin(reach, o) * __builtin_fabsf(inverse), at = -o * inverse;
        inverses[i] = inverse;
        near[i] = at - margin;
        far[i] = steep ? BEYOND : at + margin;
    }
}

/* The shears of query_start, and where the ray's line meets z = 0. */
static void prepare_shears(packet *p, const float *restrict ox, const float *restrict oy, const float *restrict oz,
                           const float *restrict dx, const float *restrict dy, const float *restrict dz)
{
    const int n = p->groups * LANES;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const float inverse = 1.0f / dz[i], sx = dx[i] * inverse, sy = dy[i] * inverse;
        p->shear_x[i] = sx;
        p->shear_y[i] = sy;
        p->shear_z[i] = inverse;
        p->origin_z[i] = oz[i];
        p->base_x[i] = ox[i] - sx * oz[i];
        p->base_y[i] = oy[i] - sy * oz[i];
    }
}

/* The margin at the origins bounds the same errors as in box_ray_start. A limited inverse is no bound for the far
 * planes and becomes infinite; a plane at the margin then gives NaN, which bounds_of_distances ignores. */
static void find_bounds(packet *p, const float *reach, const float *const *origins)
{
    const int n = p->groups * LANES;
    packet_bounds *all = &p->all;
    p->reach = 0.0f;
    for (int k = 0; k < 3; k++) {
        const bool down = p->near[k] == high_planes(k);
        const float least = least_of_row(origins[k], n), most = most_of_row(origins[k], n),
                    farthest = -least > most ? -least : most, margin = box_margin(reach[k], farthest);
        all->near_origin[k] = down ? least - margin : most + margin;
        all->far_origin[k] = down ? most + margin : least - margin;
        all->near_inverse[k] = down ? most_of_row(p->inverse[k], n) : least_of_row(p->inverse[k], n);
        const float far_inverse = down ? least_of_row(p->inverse[k], n) : most_of_row(p->inverse[k], n);
        all->far_inverse[k] = __builtin_fabsf(far_inverse) < STEEPEST ? far_inverse : down ? -INFINITY : INFINITY;
        p->reach = farthest > p->reach ? farthest : p->reach;
    }
    all->t_min = least_of_row(p->t_min, n);
    p->t_farthest = most_of_row(p->t_best, n);
}

/* The numbers of the axes as in query_start. */
static void choose_axes(packet *p, int32_t kind)
{
    const int z = kind >> 3, x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1;
    const bool turned = kind >> z & 1;
    p->axis[0] = turned ? y : x;
    p->axis[1] = turned ? x : y;
    p->axis[2] = z;
    for (int k = 0; k < 3; k++) {
        const bool down = kind >> k & 1;
        p->near[k] = down ? high_planes(k) : low_planes(k);
        p->far[k] = down ? low_planes(k) : high_planes(k);
    }
}

/* Copies the values of the rays at those positions. */
static const float *pick(float *restrict to, const float *restrict from, const uint8_t *positions, int count, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[positions[i < count ? i : count - 1]];
    return to;
}

/* Slots beyond count repeat the last ray and are in no set. */
void KERNEL(packet_start)(packet *p, const hierarchy *h, const batch_floats *b, const uint8_t *positions, int count)
{
    p->count = count;
    p->groups = (count + LANES - 1) / LANES;
    p->changed = false;
    memset(&p->alive, 0, sizeof p->alive);
    memset(&p->prepared, 0, sizeof p->prepared);
    for (int i = 0; i < count; i++) {
        p->number[i] = b->number[positions[i]];
        p->t_limit[i] = b->t_limit[positions[i]];
    }
    for (int g = 0; g < p->groups; g++)
        p->alive.bits[g] = (uint16_t)(count - g * LANES >= LANES ? 0xffff : (1 << (count - g * LANES)) - 1);
    const int n = p->groups * LANES;
    const bool all = count == b->count; /* the batch is padded like a packet */
    _Alignas(64) float picked[8][PACKET_MAX];
    const float *from[8] = {b->origin[0],    b->origin[1],    b->origin[2], b->direction[0],
                            b->direction[1], b->direction[2], b->t_min,     b->t_max};
    for (int k = 0; !all && k < 8; k++)
        from[k] = pick(picked[k], from[k], positions, count, n);
    const float *t_min = from[6];
    /* VECTORISE */
    for (int i = 0; i < n; i++)
        p->t_min[i] = t_min[i] > 0.0f ? t_min[i] : 0.0f;
    memcpy(p->t_best, from[7], (size_t)count * sizeof *p->t_best);
    for (int i = count; i < n; i++)
        p->t_best[i] = -1.0f;
    choose_axes(p, b->kind[positions[0]]);
    for (int k = 0; k < 3; k++)
        prepare_axis(p, k, h->reach[k], from[k], from[3 + k]);
    const int x = p->axis[0], y = p->axis[1], z = p->axis[2];
    prepare_shears(p, from[x], from[y], from[z], from[3 + x], from[3 + y], from[3 + z]);
    find_bounds(p, h->reach, from);
}
