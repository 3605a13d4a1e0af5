/* Forces and steps over arrays. One source for all instruction sets, with bit-identical results. */
#include "base/kernel.h"
#include "base/lanes.h"
#include "softbody/softbody_private.h"

/* gcc recognises arrays as distinct in a loop only if they are restricted parameters of its function, not locals. */
#define ARRAYS3(name) double *__restrict name##x, double *__restrict name##y, double *__restrict name##z
#define FIXED3(name) \
    const double *__restrict name##x, const double *__restrict name##y, const double *__restrict name##z
#define PASS3(v) v.x, v.y, v.z

static void clear(vectors v, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++)
        v.x[i] = v.y[i] = v.z[i] = 0.0;
}

static void pack(vectors at, vectors velocity, double *state, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++) {
        double *s = state + STATE * i;
        s[0] = at.x[i];
        s[1] = at.y[i];
        s[2] = at.z[i];
        s[4] = velocity.x[i];
        s[5] = velocity.y[i];
        s[6] = velocity.z[i];
    }
}

/* Four vertices at a time. The state of a neighbour is one cache line; transposing four of them costs half as much as
 * gathering numbers. */
typedef double four __attribute__((vector_size(32)));
typedef int64_t four_int __attribute__((vector_size(32)));
typedef struct columns {
    four x, y, z;
} columns;

ALWAYS_INLINE four load(const double *from)
{
    return *(const four *)from;
}

/* The first three numbers at each of four places, by column. */
ALWAYS_INLINE columns turn(const double *a, const double *b, const double *c, const double *d)
{
    const four p = load(a), q = load(b), r = load(c), s = load(d);
    const four even_low = __builtin_shufflevector(p, q, 0, 4, 2, 6),
               even_high = __builtin_shufflevector(r, s, 0, 4, 2, 6);
    const four odd_low = __builtin_shufflevector(p, q, 1, 5, 3, 7),
               odd_high = __builtin_shufflevector(r, s, 1, 5, 3, 7);
    return (columns){__builtin_shufflevector(even_low, even_high, 0, 1, 4, 5),
                     __builtin_shufflevector(odd_low, odd_high, 0, 1, 4, 5),
                     __builtin_shufflevector(even_low, even_high, 2, 3, 6, 7)};
}

ALWAYS_INLINE columns minus(columns a, columns b)
{
    return (columns){a.x - b.x, a.y - b.y, a.z - b.z};
}

ALWAYS_INLINE four dot(columns a, columns b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

ALWAYS_INLINE columns load_columns(vectors v, size_t i)
{
    return (columns){load(v.x + i), load(v.y + i), load(v.z + i)};
}

ALWAYS_INLINE void store_columns(vectors v, size_t i, columns a)
{
    *(four *)(v.x + i) = a.x;
    *(four *)(v.y + i) = a.y;
    *(four *)(v.z + i) = a.z;
}

ALWAYS_INLINE void add_cross(columns *sum, columns a, columns b)
{
    sum->x += a.y * b.z - a.z * b.y;
    sum->y += a.z * b.x - a.x * b.z;
    sum->z += a.x * b.y - a.y * b.x;
}

/* One slot of four vertices: Hooke and damping of softbody.h with opposite signs, since x points to the other end. The
 * result is in *away. */
ALWAYS_INLINE void add_spring(const springs *s, size_t at, const double *state, columns place, columns velocity,
                              columns *force, columns *away)
{
    const int32_t *other = s->other + at;
    const double *a = state + STATE * (size_t)other[0], *b = state + STATE * (size_t)other[1];
    const double *c = state + STATE * (size_t)other[2], *d = state + STATE * (size_t)other[3];
    const columns x = minus(turn(a, b, c, d), place), v = minus(turn(a + 4, b + 4, c + 4, d + 4), velocity);
    const four one = {1.0, 1.0, 1.0, 1.0}, zero = {0.0, 0.0, 0.0, 0.0}, square = dot(x, x);
    const four_int apart = square > zero; /* two masses at one position have no direction of force */
    const four safe = (four)(((four_int)square & apart) | ((four_int)one & ~apart)), inverse = one / safe;
    four length;
    for (int lane = 0; lane < 4; lane++)
        length[lane] = sqrt(safe[lane]);
    const four pull = load(s->stiffness + at) * (one - load(s->rest + at) * length * inverse) +
                      load(s->damping + at) * (dot(v, x) * inverse);
    force->x += pull * x.x;
    force->y += pull * x.y;
    force->z += pull * x.z;
    *away = x;
}

/* The volume of a closed mesh is the sum of a . (b x c) / 6 over its faces (the divergence theorem). Its gradient with
 * respect to a mass is the sum of b x c / 6 over the closed ring of faces around the mass, which does not depend on the
 * origin. The ring's neighbours are the first slots of each mass. */
static void forces(const springs *s, const double *state, vectors at, vectors velocity, vectors force, vectors gradient,
                   size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i += 4) {
        const columns place = load_columns(at, i), speed = load_columns(velocity, i);
        columns sum = {0}, area = {0}, first = {0}, before, now;
        int slot = 0;
        if (s->ring_slots > 0) {
            add_spring(s, i, state, place, speed, &sum, &first);
            before = first;
            for (slot = 1; slot < s->ring_slots; slot++, before = now) {
                add_spring(s, (size_t)slot * s->stride + i, state, place, speed, &sum, &now);
                add_cross(&area, before, now);
            }
            add_cross(&area, before, first);
            store_columns(gradient, i, area);
        }
        for (; slot < s->slots; slot++)
            add_spring(s, (size_t)slot * s->stride + i, state, place, speed, &sum, &now);
        store_columns(force, i, sum);
    }
}

/* The state of a mass after contact with the floor. */
typedef struct landed {
    double y, u, v, w;
} landed;

/* Contact of a mass below the floor: its normal speed is reflected with the restitution (Newton), and friction reduces
 * its tangential speed by at most the coefficient times that change (Coulomb's law, for the impulse of one step). */
ALWAYS_INLINE landed meet_floor(const push *p, int64_t free, double y, double u, double v, double w)
{
    const int64_t under = free & mask_less(y, p->ground_y), falls = under & mask_less(v, 0.0);
    const double hit = blend(falls, -v, 0.0);
    const double back = blend(mask_less(p->rest_speed, hit), p->restitution * hit, 0.0);
    const double along = sqrt(u * u + w * w), lost = lesser(p->friction * (hit + back), along);
    const double keep = 1.0 - lost / greater(along, 1e-300);
    return (landed){blend(under, p->ground_y, y), blend(falls, u * keep, u), blend(falls, back, v),
                    blend(falls, w * keep, w)};
}

/* 1 for a diverged mass: too fast, or NaN. */
ALWAYS_INLINE int64_t blew_up(const push *p, landed a)
{
    return 1 & ~mask_less_equal(a.u * a.u + a.v * a.v + a.w * a.w, p->speed_limit * p->speed_limit);
}

static int64_t euler_arrays(push q, const double *__restrict m, FIXED3(f), FIXED3(g), ARRAYS3(p), ARRAYS3(v),
                            size_t begin, size_t end)
{
    int64_t bad = 0;
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const int64_t free = mask_less(0.0, m[i]);
        const double u = vx[i] + q.dt_s * (m[i] * (fx[i] + q.pressure * gx[i]) + blend(free, q.gravity.x, 0.0));
        const double v = vy[i] + q.dt_s * (m[i] * (fy[i] + q.pressure * gy[i]) + blend(free, q.gravity.y, 0.0));
        const double w = vz[i] + q.dt_s * (m[i] * (fz[i] + q.pressure * gz[i]) + blend(free, q.gravity.z, 0.0));
        const landed a = meet_floor(&q, free, py[i] + q.dt_s * v, u, v, w);
        px[i] += q.dt_s * u;
        py[i] = a.y;
        pz[i] += q.dt_s * w;
        vx[i] = a.u;
        vy[i] = a.v;
        vz[i] = a.w;
        bad += blew_up(&q, a);
    }
    return bad;
}

static int64_t euler(const push *p, const double *inverse_mass, vectors force, vectors area, vectors at,
                     vectors velocity, size_t begin, size_t end)
{
    return euler_arrays(*p, inverse_mass, PASS3(force), PASS3(area), PASS3(at), PASS3(velocity), begin, end);
}

static void drift(const push *p, vectors acceleration, vectors at, vectors velocity, vectors guess, size_t begin,
                  size_t end)
{
    const double dt = p->dt_s, half = 0.5 * dt;
    double *const a[3] = {acceleration.x, acceleration.y, acceleration.z}, *const x[3] = {at.x, at.y, at.z};
    double *const v[3] = {velocity.x, velocity.y, velocity.z}, *const g[3] = {guess.x, guess.y, guess.z};
    for (int axis = 0; axis < 3; axis++) {
        const double *__restrict from = a[axis];
        double *__restrict place = x[axis], *__restrict speed = v[axis], *__restrict later = g[axis];
        /* VECTORISE */
        for (size_t i = begin; i < end; i++) {
            const double middle = speed[i] + half * from[i];
            later[i] = speed[i] + dt * from[i];
            place[i] += dt * middle;
            speed[i] = middle;
        }
    }
}

static int64_t kick_arrays(push q, const double *__restrict m, FIXED3(f), FIXED3(g), double *__restrict py, ARRAYS3(v),
                           ARRAYS3(a), size_t begin, size_t end)
{
    const double half = 0.5 * q.dt_s;
    int64_t bad = 0;
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const int64_t free = mask_less(0.0, m[i]);
        const double x = m[i] * (fx[i] + q.pressure * gx[i]) + blend(free, q.gravity.x, 0.0);
        const double y = m[i] * (fy[i] + q.pressure * gy[i]) + blend(free, q.gravity.y, 0.0);
        const double z = m[i] * (fz[i] + q.pressure * gz[i]) + blend(free, q.gravity.z, 0.0);
        const landed a = meet_floor(&q, free, py[i], vx[i] + half * x, vy[i] + half * y, vz[i] + half * z);
        ax[i] = x;
        ay[i] = y;
        az[i] = z;
        py[i] = a.y;
        vx[i] = a.u;
        vy[i] = a.v;
        vz[i] = a.w;
        bad += blew_up(&q, a);
    }
    return bad;
}

static int64_t kick(const push *p, const double *inverse_mass, vectors force, vectors area, vectors at,
                    vectors velocity, vectors acceleration, size_t begin, size_t end)
{
    return kick_arrays(*p, inverse_mass, PASS3(force), PASS3(area), at.y, PASS3(velocity), PASS3(acceleration), begin,
                       end);
}

/* The stiffness of a spring is k along its axis and k (1 - l / |x|) across it, which is omitted if negative: a
 * compressed spring that buckles would make the matrix indefinite (Choi and Ko, "Stable but responsive cloth", SIGGRAPH
 * 2002). */
static void stiffen_slot(double dt, FIXED3(p), const int32_t *__restrict other, const double *__restrict rest,
                         const double *__restrict k, const double *__restrict kd, ARRAYS3(n), double *__restrict across,
                         double *__restrict along, size_t begin, size_t end)
{
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const int64_t j = other[i];
        const double x = px[j] - px[i], y = py[j] - py[i], z = pz[j] - pz[i];
        const double square = x * x + y * y + z * z;
        const double inverse = 1.0 / sqrt(blend(mask_less(0.0, square), square, 1.0));
        const double share = dt * dt * k[i] * greater(0.0, 1.0 - rest[i] * inverse);
        nx[i] = x * inverse;
        ny[i] = y * inverse;
        nz[i] = z * inverse;
        across[i] = share;
        along[i] = dt * dt * k[i] + dt * kd[i] - share;
    }
}

static void stiffen(const springs *s, double dt_s, vectors at, stiff_slots out, size_t begin, size_t end)
{
    for (int slot = 0; slot < s->slots; slot++) {
        const size_t k = (size_t)slot * s->stride;
        stiffen_slot(dt_s, PASS3(at), s->other + k, s->rest + k, s->stiffness + k, s->damping + k, out.nx + k,
                     out.ny + k, out.nz + k, out.across + k, out.along + k, begin, end);
    }
}

static void resist_slot(const int32_t *__restrict other, FIXED3(n), const double *__restrict across,
                        const double *__restrict along, FIXED3(v), ARRAYS3(f), size_t begin, size_t end)
{
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const int64_t j = other[i];
        const double x = vx[i] - vx[j], y = vy[i] - vy[j], z = vz[i] - vz[j];
        const double share = along[i] * (x * nx[i] + y * ny[i] + z * nz[i]);
        fx[i] += across[i] * x + share * nx[i];
        fy[i] += across[i] * y + share * ny[i];
        fz[i] += across[i] * z + share * nz[i];
    }
}

static void resist(const springs *s, stiff_slots k, vectors field, vectors out, size_t begin, size_t end)
{
    clear(out, begin, end);
    for (int slot = 0; slot < s->slots; slot++) {
        const size_t first = (size_t)slot * s->stride;
        resist_slot(s->other + first, k.nx + first, k.ny + first, k.nz + first, k.across + first, k.along + first,
                    PASS3(field), PASS3(out), begin, end);
    }
}

static int64_t settle_arrays(push q, const double *__restrict m, FIXED3(d), ARRAYS3(p), ARRAYS3(v), size_t begin,
                             size_t end)
{
    int64_t bad = 0;
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const double u = vx[i] + dx[i], v = vy[i] + dy[i], w = vz[i] + dz[i];
        const landed a = meet_floor(&q, mask_less(0.0, m[i]), py[i] + q.dt_s * v, u, v, w);
        px[i] += q.dt_s * u;
        py[i] = a.y;
        pz[i] += q.dt_s * w;
        vx[i] = a.u;
        vy[i] = a.v;
        vz[i] = a.w;
        bad += blew_up(&q, a);
    }
    return bad;
}

static int64_t settle(const push *p, const double *inverse_mass, vectors change, vectors at, vectors velocity,
                      size_t begin, size_t end)
{
    return settle_arrays(*p, inverse_mass, PASS3(change), PASS3(at), PASS3(velocity), begin, end);
}

const softbody_kernels KERNEL(softbody_kernels) = {.pack = pack,
                                                   .forces = forces,
                                                   .euler = euler,
                                                   .drift = drift,
                                                   .kick = kick,
                                                   .stiffen = stiffen,
                                                   .resist = resist,
                                                   .settle = settle};
