/* Updates of positions and velocities by the integrators, over arrays. One source for all instruction sets, with
 * bit-identical results. */
#include "base/isa.h"
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
ALWAYS_INLINE int64_t has_diverged(const push *p, landed a)
{
    return 1 & ~mask_less_equal(a.u * a.u + a.v * a.v + a.w * a.w, p->speed_limit * p->speed_limit);
}

/* Semi-implicit Euler without the floor. Returns the number of masses below the floor. */
static int64_t fly(push q, const double *__restrict m, FIXED3(f), FIXED3(g), ARRAYS3(p), ARRAYS3(v), size_t begin,
                   size_t end)
{
    int64_t under = 0;
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const int64_t free = mask_less(0.0, m[i]);
        const double u = vx[i] + q.dt_s * (m[i] * (fx[i] + q.pressure * gx[i]) + blend(free, q.gravity.x, 0.0));
        const double v = vy[i] + q.dt_s * (m[i] * (fy[i] + q.pressure * gy[i]) + blend(free, q.gravity.y, 0.0));
        const double w = vz[i] + q.dt_s * (m[i] * (fz[i] + q.pressure * gz[i]) + blend(free, q.gravity.z, 0.0));
        const double y = py[i] + q.dt_s * v;
        px[i] += q.dt_s * u;
        py[i] = y;
        pz[i] += q.dt_s * w;
        vx[i] = u;
        vy[i] = v;
        vz[i] = w;
        under += 1 & free & mask_less(y, q.ground_y);
    }
    return under;
}

static void land(push q, const double *__restrict m, double *__restrict py, ARRAYS3(v), size_t begin, size_t end)
{
    /* VECTORISE */
    for (size_t i = begin; i < end; i++) {
        const landed a = meet_floor(&q, mask_less(0.0, m[i]), py[i], vx[i], vy[i], vz[i]);
        py[i] = a.y;
        vx[i] = a.u;
        vy[i] = a.v;
        vz[i] = a.w;
    }
}

static int64_t count_diverged(push q, FIXED3(v), size_t begin, size_t end)
{
    int64_t bad = 0;
    /* VECTORISE */
    for (size_t i = begin; i < end; i++)
        bad += has_diverged(&q, (landed){.u = vx[i], .v = vy[i], .w = vz[i]});
    return bad;
}

/* `land` is slower than `fly`, and few masses are near the floor: `land` is called only for their blocks. */
static int64_t euler(const push *p, const double *inverse_mass, vectors force, vectors area, vectors at,
                     vectors velocity, size_t begin, size_t end)
{
    enum { BLOCK = 8 * LANES };
    for (size_t i = begin; i < end; i += BLOCK) {
        const size_t last = i + BLOCK < end ? i + BLOCK : end;
        if (fly(*p, inverse_mass, PASS3(force), PASS3(area), PASS3(at), PASS3(velocity), i, last) > 0)
            land(*p, inverse_mass, at.y, PASS3(velocity), i, last);
    }
    return count_diverged(*p, PASS3(velocity), begin, end);
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
        bad += has_diverged(&q, a);
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
        const double k_across = dt * dt * k[i] * greater(0.0, 1.0 - rest[i] * inverse);
        nx[i] = x * inverse;
        ny[i] = y * inverse;
        nz[i] = z * inverse;
        across[i] = k_across;
        along[i] = dt * dt * k[i] + dt * kd[i] - k_across;
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
        const double radial = along[i] * (x * nx[i] + y * ny[i] + z * nz[i]);
        fx[i] += across[i] * x + radial * nx[i];
        fy[i] += across[i] * y + radial * ny[i];
        fz[i] += across[i] * z + radial * nz[i];
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
        bad += has_diverged(&q, a);
    }
    return bad;
}

static int64_t settle(const push *p, const double *inverse_mass, vectors change, vectors at, vectors velocity,
                      size_t begin, size_t end)
{
    return settle_arrays(*p, inverse_mass, PASS3(change), PASS3(at), PASS3(velocity), begin, end);
}

const softbody_kernels KERNEL(softbody_kernels) = {
    .euler = euler, .drift = drift, .kick = kick, .stiffen = stiffen, .resist = resist, .settle = settle};
