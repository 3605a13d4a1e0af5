/* The set-up of packets: rays are read and scaled eight at a time, then prepared for the box and triangle tests in
 * single precision, 16 at a time. */
#include "geometry/hierarchy_packet.h"

ALWAYS_INLINE void store_floats(float *to, double8 v)
{
    const float8 f = __builtin_convertvector(v, float8);
    memcpy(to, &f, sizeof f);
}

ALWAYS_INLINE float8 float8_magnitude(float8 v)
{
    return (float8)((int8x32)v & INT32_MAX);
}

/* query_start for eight rays, from number i on. */
static void read_eight(batch_floats *b, int i, const mesh_ray *const *rays)
{
    ray_lanes r;
    ray_lanes_read(&r, rays);
    const double8 zero = double8_all(0.0);
    const double8 mx = double8_magnitude(r.direction[0]), my = double8_magnitude(r.direction[1]),
                  mz = double8_magnitude(r.direction[2]);
    const int8x64 x_largest = (mx > my) & (mx > mz), y_largest = ~(mx > my) & (my > mz);
    const double8 largest = double8_blend(x_largest, mx, double8_blend(y_largest, my, mz));
    const int8x64 exponent = double8_exponent(largest);
    const double8 scale = double8_power(2046 - exponent), unscale = double8_power(exponent);
    const double8 sum = r.origin[0] + r.origin[1] + r.origin[2] + r.direction[0] + r.direction[1] + r.direction[2];
    const double8 reach =
        double8_greater(double8_greater(double8_magnitude(r.origin[0]), double8_magnitude(r.origin[1])),
                        double8_magnitude(r.origin[2]));
    const double8 t_min = double8_greater(r.t_min, zero) * unscale, t_max = r.t_max * unscale;
    const int8x64 valid = (exponent >= 1) & (exponent <= 2045) & (sum - sum == zero) & ~(reach > zero + ORIGIN_FAR) &
                          (r.t_min <= r.t_max) & (t_min < zero + (double)INFINITY);
    for (int k = 0; k < 3; k++) {
        store_floats(&b->origin[k][i], r.origin[k]);
        store_floats(&b->direction[k][i], r.direction[k] * scale);
    }
    const float8 least = __builtin_convertvector(t_min, float8), most = __builtin_convertvector(t_max, float8);
    const float8 below = least - (float8_magnitude(least) * (float)FLOAT_STEP + FLOAT_TINY),
                 above = most + (float8_magnitude(most) * (float)FLOAT_STEP + FLOAT_TINY);
    memcpy(&b->t_min[i], &below, sizeof below);
    memcpy(&b->t_max[i], &above, sizeof above);
    memcpy(&b->t_limit[i], &t_max, sizeof t_max);
    const int8x64 down = ((r.direction[0] < zero) & 1) | ((r.direction[1] < zero) & 2) | ((r.direction[2] < zero) & 4);
    const int8x64 axis = (y_largest & 8) | (~(x_largest | y_largest) & 16);
    const int8x32 kind = __builtin_convertvector(((down | axis) & valid) | ~valid, int8x32);
    memcpy(&b->kind[i], &kind, sizeof kind);
}

/* Numbers beyond count repeat the last ray. */
void KERNEL(batch_read)(batch_floats *b, const mesh_ray *rays, int count)
{
    b->count = count;
    for (int i = 0; i < (count + LANES - 1) / LANES * LANES; i += 8) {
        const mesh_ray *eight[8];
        for (int k = 0; k < 8; k++)
            eight[k] = &rays[i + k < count ? i + k : count - 1];
        read_eight(b, i, eight);
    }
}

/* The prepared arrays of one axis. A parallel component gets a finite inverse near FLT_MAX: an infinite one would make
 * NaN of a distance of 0. Here the threshold is a little above PARALLEL, which only widens boxes. The inverse of the
 * rounded direction has a relative error of two roundings, which BOX_SLACK covers with the other three. */
static void prepare_axis(packet *p, int k, const float *restrict origin, const float *restrict direction)
{
    float *restrict below = p->below[k], *restrict above = p->above[k], *restrict near = p->near_inverse[k],
                    *restrict far = p->far_inverse[k];
    const int n = p->groups * LANES;
    const float huge = p->near[k] >= WIDTH * 3 ? -1e38f : 1e38f;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const float o = origin[i], d = direction[i], size = __builtin_fabsf(d);
        const bool parallel = size < (float)(1.001 * PARALLEL);
        const float margin = __builtin_fabsf(o) * (float)FLOAT_STEP + FLOAT_TINY;
        const float wide = margin + (parallel ? (float)(2.0 * PARALLEL_MARGIN) : 0.0f);
        const float inverse = parallel ? huge : 1.0f / d;
        below[i] = o - wide;
        above[i] = o + wide;
        near[i] = inverse * (float)(1.0 - BOX_SLACK);
        far[i] = inverse * (float)(1.0 + BOX_SLACK);
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
        p->base_x[i] = ox[i] - sx * oz[i];
        p->base_y[i] = oy[i] - sy * oz[i];
    }
}

/* The least and the largest of n values, n a multiple of 16. */
static void bounds_of(const float *restrict v, int n, float *restrict least, float *restrict most)
{
    _Alignas(64) float low[LANES], high[LANES];
    memcpy(low, v, sizeof low);
    memcpy(high, v, sizeof high);
    for (int i = LANES; i < n; i += LANES)
        /* VECTORISE */
        for (int k = 0; k < LANES; k++) {
            low[k] = v[i + k] < low[k] ? v[i + k] : low[k];
            high[k] = v[i + k] > high[k] ? v[i + k] : high[k];
        }
    for (int half = LANES / 2; half > 0; half /= 2)
        for (int k = 0; k < half; k++) {
            low[k] = low[k + half] < low[k] ? low[k + half] : low[k];
            high[k] = high[k + half] > high[k] ? high[k + half] : high[k];
        }
    *least = low[0];
    *most = high[0];
}

/* The bounds of all rays, by which a node is culled for the whole packet. */
static void find_bounds(packet *p)
{
    const int n = p->groups * LANES;
    box_ray *all = &p->all;
    float least, most;
    p->reach = 0.0f;
    for (int k = 0; k < 3; k++) {
        const bool down = p->near[k] >= WIDTH * 3;
        bounds_of(p->below[k], n, &least, &most);
        *(down ? &all->near_origin[k] : &all->far_origin[k]) = least;
        p->reach = least < -p->reach ? -least : p->reach;
        bounds_of(p->above[k], n, &least, &most);
        *(down ? &all->far_origin[k] : &all->near_origin[k]) = most;
        p->reach = most > p->reach ? most : p->reach;
        bounds_of(p->near_inverse[k], n, &least, &most);
        all->near_inverse[k] = down ? most : least;
        bounds_of(p->far_inverse[k], n, &least, &most);
        all->far_inverse[k] = down ? least : most;
        all->near[k] = p->near[k];
        all->far[k] = p->far[k];
    }
    bounds_of(p->t_min, n, &all->t_min, &most);
    bounds_of(p->t_best, n, &least, &p->t_farthest);
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
        p->near[k] = WIDTH * (k + (down ? 3 : 0));
        p->far[k] = WIDTH * (k + (down ? 0 : 3));
        p->near_origin[k] = down ? p->below[k] : p->above[k];
        p->far_origin[k] = down ? p->above[k] : p->below[k];
    }
}

/* Copies the values of the rays with those numbers. */
static const float *pick(float *restrict to, const float *restrict from, const uint8_t *numbers, int count, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[numbers[i < count ? i : count - 1]];
    return to;
}

/* Slots beyond count repeat the last ray and are in no set. */
void KERNEL(packet_start)(packet *p, const batch_floats *b, const uint8_t *numbers, int count)
{
    p->count = count;
    p->groups = (count + LANES - 1) / LANES;
    p->changed = false;
    memset(&p->alive, 0, sizeof p->alive);
    memset(&p->prepared, 0, sizeof p->prepared);
    memcpy(p->number, numbers, (size_t)count);
    for (int g = 0; g < p->groups; g++)
        p->alive.bits[g] = (uint16_t)(count - g * LANES >= LANES ? 0xffff : (1 << (count - g * LANES)) - 1);
    const int n = p->groups * LANES;
    const bool all = count == b->count; /* the batch is padded like a packet */
    _Alignas(64) float picked[8][TOGETHER];
    const float *from[8] = {b->origin[0],    b->origin[1],    b->origin[2], b->direction[0],
                            b->direction[1], b->direction[2], b->t_min,     b->t_max};
    for (int k = 0; !all && k < 8; k++)
        from[k] = pick(picked[k], from[k], numbers, count, n);
    const float *t_min = from[6];
    /* VECTORISE */
    for (int i = 0; i < n; i++)
        p->t_min[i] = t_min[i] > 0.0f ? t_min[i] : 0.0f;
    memcpy(p->t_best, from[7], (size_t)count * sizeof *p->t_best);
    for (int i = count; i < n; i++)
        p->t_best[i] = -1.0f;
    choose_axes(p, b->kind[numbers[0]]);
    for (int k = 0; k < 3; k++)
        prepare_axis(p, k, from[k], from[3 + k]);
    const int x = p->axis[0], y = p->axis[1], z = p->axis[2];
    prepare_shears(p, from[x], from[y], from[z], from[3 + x], from[3 + y], from[3 + z]);
    find_bounds(p);
}
